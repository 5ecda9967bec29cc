"""Solves of the app, with a worker that stands in: queue, cancelling, ends of all kinds."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from .serving import Browser, app, gone, visit

pytestmark = pytest.mark.skipif(not hasattr(os, "killpg"), reason="needs POSIX processes")


def test_a_solve_goes_from_the_form_to_its_files() -> None:
    with app() as url:
        browser = Browser(url)
        with browser.page() as page:
            job = browser.solve("quick").json["id"]
            done = page.ended()
        assert (done["id"], done["state"]) == (job, "done")
        assert done["said"]["label"] == "1: quick"
        assert done["title"] == "quick: step 0.76 m, stride 1.14 s, 1.33 m/s"
        for file, kind in (
            ("gait.nc", "netcdf"),
            ("report.html", "html"),
            ("problem.toml", "toml"),
        ):
            answer = browser.ask("GET", f"/solves/{job}/{file}")
            assert answer.status == 200
            assert answer.body.decode() == f"{file} of quick"
            assert answer.headers["content-disposition"] == f'attachment; filename="{file}"'
            assert kind in answer.headers["content-type"]
        problem = browser.ask("GET", f"/solves/{job}/problem").json["problem"]
        assert problem["name"] == "quick"


def test_progress_reaches_the_page_while_the_solve_runs() -> None:
    with visit() as (browser, page):
        browser.solve("endless")
        page.pid()
        (job,) = page.jobs
        assert job["state"] == "running"
        assert job["progress"]["stage"] == "begun"
        assert (job["progress"]["iteration"], job["progress"]["energy"]) == (1, 50.0)


def test_a_cancelled_solve_and_its_children_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("STAND_IN_NOTES", str(tmp_path))
    with visit() as (browser, page):
        job = browser.solve("parent").json["id"]
        pid, note = page.pid(), tmp_path / "child"
        while not (note.exists() and note.read_text()):
            time.sleep(0.02)
        assert browser.ask("POST", f"/solves/{job}/cancel").status == 200
        ended = page.ended()
        assert (ended["state"], ended["message"]) == ("cancelled", "cancelled")
        assert gone(pid)
        assert gone(int(note.read_text()))
        assert browser.ask("POST", f"/solves/{job}/cancel").status == 200  # once more is no harm


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("refuses", "name: cannot be solved by a stand-in; ask somebody else"),
        ("killed", "the system ended the solver, most likely because the memory ran out; end"),
        ("hungry", "the memory ran out; end other programs, or solve fewer gaits at once"),
        ("quits", "the solver ended without an answer (status 3); try again"),
        ("stumbles", "the solver stopped where it should not (KeyError: 'a bug"),
    ],
)
def test_a_worker_that_ends_without_a_gait_is_a_sentence(name: str, sentence: str) -> None:
    with visit(workers=1) as (browser, page):
        browser.solve(name)
        ended = page.ended()
        assert ended["state"] == "failed"
        assert sentence in ended["message"]
        assert "\n" not in ended["message"]
        browser.solve("quick")  # the only worker is free again
        assert page.ended(2)["state"] == "done"


def test_a_worker_that_cannot_be_started_is_a_sentence() -> None:
    with visit(["/nowhere/python"]) as (browser, page):
        browser.solve("quick")
        assert "cannot be started (No such file" in page.ended()["message"]


def test_a_worker_that_talks_nonsense_is_a_sentence() -> None:
    with visit(["/bin/echo", "nonsense"]) as (browser, page):
        browser.solve("quick")
        assert "cannot be understood" in page.ended()["message"]


def test_a_solve_that_takes_too_long_is_ended_with_a_sentence() -> None:
    with visit(time_limit_s=3.0) as (browser, page):  # time to start on a busy machine too
        browser.solve("endless")
        pid = page.pid()
        assert "took longer than 3 s and was ended; make" in page.ended()["message"]
        assert gone(pid)


def test_solves_wait_for_a_worker_in_the_order_in_which_they_came() -> None:
    with visit(workers=1) as (browser, page):
        first = browser.solve("endless").json["id"]
        for name in ("a", "b"):
            browser.solve(name)
        jobs = page.until(lambda jobs: len(jobs) == 3 and jobs[0]["state"] == "running")
        assert [(j["state"], j["ahead"]) for j in jobs[1:]] == [("waiting", 0), ("waiting", 1)]
        browser.ask("POST", f"/solves/{first}/cancel")
        assert page.ended(3)["state"] == "done"
        assert [j["state"] for j in page.jobs] == ["cancelled", "done", "done"]


def test_a_full_queue_is_a_sentence_and_cancelling_makes_room() -> None:
    with visit(workers=1, queue=1) as (browser, _):
        browser.solve("endless")
        waiting = browser.solve("endless").json["id"]
        refused = browser.solve("endless")
        assert refused.status == 422
        assert refused.json["error"] == (
            "the queue is full, as no more than 1 solves may wait; try again when one of them "
            "has ended"
        )
        browser.ask("POST", f"/solves/{waiting}/cancel")
        assert browser.solve("endless").status == 200


def test_who_has_no_solve_running_comes_before_who_has() -> None:
    with app(workers=2) as url:
        greedy, modest = Browser(url), Browser(url)
        with greedy.page() as many, modest.page() as one:
            for name in ("endless", "short", "endless"):
                greedy.solve(name)
            many.until(lambda jobs: [j["state"] for j in jobs][:2] == ["running"] * 2)
            modest.solve("quick")
            assert one.ended()["state"] == "done"
            many.until(lambda jobs: jobs[1]["state"] == "done")


def test_two_people_do_not_see_or_touch_what_is_the_others() -> None:
    with app(workers=2) as url:
        ann, bob = Browser(url), Browser(url)
        assert ann.cookie != bob.cookie
        with ann.page() as hers, bob.page() as his:
            job = ann.solve("quick").json["id"]
            running = bob.solve("endless").json["id"]
            assert hers.ended()["said"]["label"] == "1: quick"
            his.pid()
            assert [j["title"].split(":")[0] for j in his.jobs] == ["endless"]
            for method, path in (
                ("GET", f"/solves/{job}/gait.nc"),
                ("GET", f"/solves/{job}/problem"),
                ("DELETE", f"/solves/{job}"),
            ):
                answer = bob.ask(method, path)
                assert (answer.status, answer.json["error"]) == (404, "there is no such solve")
            assert ann.ask("POST", f"/solves/{running}/cancel").status == 404
            assert his.jobs[0]["state"] == "running"


def test_a_closed_page_ends_its_solves_and_nobody_elses() -> None:
    with app(workers=3, grace_s=0.3) as url:
        leaving, staying = Browser(url), Browser(url)
        with staying.page() as other:
            staying.solve("endless")
            kept = other.pid()
            with leaving.page() as page:
                for _ in range(3):
                    leaving.solve("endless")
                pids = [page.pid(1), page.pid(2)]
            assert all(gone(pid) for pid in pids)
            assert not gone(kept, within=0.5)
        with leaving.page() as page:
            jobs = page.until(lambda jobs: jobs)
            assert [j["message"] for j in jobs] == ["ended because its page was closed"] * 3


def test_a_reload_within_the_grace_period_keeps_the_solve() -> None:
    with app(grace_s=2.0) as url:
        browser = Browser(url)
        with browser.page() as page:
            browser.solve("endless")
            pid = page.pid()
        time.sleep(0.2)
        with browser.page() as page:
            assert page.pid() == pid
            assert not gone(pid, within=2.5)
            (job,) = page.jobs
            assert job["seconds"] > 0
    assert gone(pid)


def test_one_of_two_pages_of_a_session_may_close() -> None:
    with app(grace_s=0.2) as url:
        browser = Browser(url)
        with browser.page() as first:
            browser.solve("endless")
            pid = first.pid()
            with browser.page() as second:
                assert second.pid() == pid
            assert not gone(pid, within=0.6)


def test_a_solve_that_no_page_ever_watched_ends() -> None:
    with app(grace_s=0.5) as url:
        browser = Browser(url)
        browser.solve("endless")
        time.sleep(0.8)
        with browser.page() as page:
            assert page.ended()["message"] == "ended because its page was closed"


def test_a_removed_gait_is_gone_with_its_files() -> None:
    with app() as url:
        browser = Browser(url)
        with browser.page() as page:
            job = browser.solve("quick").json["id"]
            page.ended()
            assert browser.ask("DELETE", f"/solves/{job}").status == 200
            page.until(lambda jobs: jobs == [])
        assert browser.ask("GET", f"/solves/{job}/gait.nc").status == 404


def test_removing_a_solve_that_runs_ends_it() -> None:
    with visit() as (browser, page):
        job = browser.solve("endless").json["id"]
        pid = page.pid()
        browser.ask("DELETE", f"/solves/{job}")
        assert gone(pid)


def test_a_session_that_keeps_too_much_is_told_to_remove_something(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("ergowalk.app.sessions.SOLVES", 1)
    with app() as url:
        browser = Browser(url)
        with browser.page() as page:
            browser.solve("quick")
            page.ended()
            refused = browser.solve("quick")
        assert refused.status == 422
        assert (
            "that is all that there is room for; remove one from the list"
            in (refused.json["error"])
        )


def test_a_film_is_made_when_it_is_asked_for() -> None:
    with app() as url:
        browser = Browser(url)
        with browser.page() as page:
            job = browser.solve("quick").json["id"]
            assert page.ended()["said"]["film"] == "film.mp4"
        for _ in range(2):
            film = browser.ask("GET", f"/solves/{job}/film.mp4")
            assert (film.status, film.body) == (200, b"moving pictures")
            assert film.headers["content-type"] == "video/mp4"
            assert film.headers["content-disposition"] == 'attachment; filename="film.mp4"'


def test_a_film_that_nobody_waits_for_any_longer_is_not_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))

    def maker() -> int:
        while not (notes := [n for n in tmp_path.rglob("film.pid") if n.read_text()]):
            time.sleep(0.02)
        pid = int(notes[0].read_text())
        notes[0].unlink()
        return pid

    with app() as url:
        browser = Browser(url)
        with browser.page() as page:
            job = browser.solve("long film").json["id"]
            page.ended()
        for _ in range(2):  # the first one does not hold up the second
            connection = browser.connect()
            connection.request("GET", f"/solves/{job}/film.mp4", headers=browser.headers())
            pid = maker()
            connection.close()
            assert gone(pid)
        last = browser.connect()
        last.request("GET", f"/solves/{job}/film.mp4", headers=browser.headers())
        pid = maker()
    assert gone(pid, within=0.5)  # with the server


def test_a_server_that_ends_takes_its_workers_and_files_along(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with visit() as (browser, page):
        browser.solve("endless")
        pid = page.pid()
        assert list(tmp_path.iterdir())
        began = time.monotonic()
    assert time.monotonic() - began < 5
    assert gone(pid, within=0.5)
    assert list(tmp_path.iterdir()) == []
