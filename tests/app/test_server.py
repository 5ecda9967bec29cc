"""The server of the app: whom it answers, what it refuses, and what it never opens."""

from __future__ import annotations

import re
import socket
import time
from collections.abc import Iterator
from typing import Any

import pytest

from ergowalk.app.guard import Guard
from ergowalk.app.options import Options
from ergowalk.problem import preset
from ergowalk.problem.files import problem_to_toml

from .serving import Browser, app

GOOD = problem_to_toml(preset("winter-slow")).encode()


@pytest.fixture(scope="module")
def url() -> Iterator[str]:
    with app(upload_limit_kib=4) as address:
        yield address


@pytest.fixture
def browser(url: str) -> Browser:
    return Browser(url)


def upload(browser: Browser, content: bytes, name: str = "mine.toml", **headers: Any) -> Any:
    return browser.ask("POST", "/problem", content, X_File_Name=name, **headers)


def test_the_page_and_its_parts_are_served_and_nothing_else(browser: Browser) -> None:
    page = browser.ask("GET", "/")
    assert page.status == 200
    text = page.body.decode()
    parts = re.findall(r'(?:src|href)="([^"]*)"', text)
    assert len(parts) == 6
    assert {browser.ask("GET", part).status for part in parts} == {200}
    assert 'class="viewer"' in text
    for path in ("/app.html", "/static/app.js", "/routes.py", "/../pyproject.toml", "/%2e%2e/x"):
        assert browser.ask("GET", path).status == 404, path


def test_nothing_of_the_page_is_elsewhere(browser: Browser) -> None:
    for path in ("/", "/app.js", "/app.css", "/viewer.js", "/viewer.css", "/page.css"):
        answer = browser.ask("GET", path)
        assert not re.findall(r"https?:|url\(|@import|<script>", answer.body.decode()), path
        policy = answer.headers["content-security-policy"]
        assert policy.startswith("default-src 'none'; script-src 'self'; style-src 'self';")
        assert "frame-ancestors 'none'" in policy
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert answer.headers["cross-origin-resource-policy"] == "same-origin"
        assert answer.headers["access-control-allow-origin"] is None


def test_the_cookie_of_a_session_is_for_this_page_alone(browser: Browser) -> None:
    assert re.fullmatch(
        r"ergowalk-\d+=[\w-]{32}; HttpOnly; Path=/; SameSite=strict", browser.set_cookie
    )
    again = browser.ask("POST", "/session")
    assert again.headers["set-cookie"] is None  # it is known
    made_up = browser.cookie.split("=")[0] + "=made-up"
    assert browser.ask("POST", "/session", Cookie=made_up).headers["set-cookie"] is not None


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("GET", "/events"),
        ("POST", "/problem"),
        ("POST", "/solves"),
        ("POST", "/solves/x/cancel"),
        ("DELETE", "/solves/x"),
        ("GET", "/solves/x/gait.nc"),
        ("GET", "/solves/x/payload"),
        ("GET", "/solves/x/film.mp4"),
    ],
)
def test_without_a_session_nothing_is_done(url: str, method: str, path: str) -> None:
    stranger = Browser(url, session=False)
    answer = stranger.ask(method, path, b"" if method == "POST" else None)
    assert answer.status == 404
    assert answer.json["error"] == "this page is no longer known to the server; load it again"


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "127.0.0.1.evil.example", ""])
def test_a_foreign_name_for_this_machine_is_refused(browser: Browser, host: str) -> None:
    """A page that rebinds its name to 127.0.0.1 sends that name, whatever it may do else."""
    for method, path in (("GET", "/"), ("POST", "/session")):
        answer = browser.ask(method, path, Host=host, Origin=f"http://{host}")
        assert answer.status == 403
        assert b"does not go by that name" in answer.body
        assert answer.headers["set-cookie"] is None


@pytest.mark.parametrize("host", ["localhost:9", "127.0.0.1", "[::1]:9", "[::1]"])
def test_names_of_this_machine_are_answered(browser: Browser, host: str) -> None:
    assert browser.ask("GET", "/", Host=host).status == 200


@pytest.mark.parametrize(
    "headers",
    [
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": None},
        {"Origin": "http://127.0.0.1:1"},
        {"Sec_Fetch_Site": "cross-site"},
        {"Sec_Fetch_Site": "same-site"},
    ],
)
def test_a_page_of_another_site_or_port_can_start_nothing(
    browser: Browser, headers: dict[str, str | None]
) -> None:
    for method, path in (("POST", "/session"), ("POST", "/solves"), ("DELETE", "/solves/x")):
        answer = browser.ask(method, path, b"{}", **headers)
        assert answer.status == 403
        assert b"Only the page of this server" in answer.body


def test_a_link_from_another_site_leads_to_the_page_and_no_further(browser: Browser) -> None:
    assert browser.ask("GET", "/", Sec_Fetch_Site="cross-site").status == 200
    assert browser.ask("GET", "/solves/x/gait.nc", Sec_Fetch_Site="cross-site").status == 403


@pytest.mark.parametrize(
    ("host", "name", "answered"),
    [
        ("127.0.0.1", "192.168.1.2:8765", False),
        ("127.0.0.1", socket.gethostname() + ".evil.example", False),
        ("0.0.0.0", "192.168.1.2:8765", True),
        ("0.0.0.0", socket.gethostname() + ":8765", True),
        ("0.0.0.0", "evil.example", False),
        ("laptop.local", "laptop.local:8765", True),
        ("::", "[fe80::1]:8765", True),
    ],
)
def test_a_server_for_others_answers_to_addresses_and_its_own_names(
    host: str, name: str, answered: bool
) -> None:
    guard = Guard(None, Options(host=host))  # type: ignore[arg-type]
    scope = {"type": "http", "method": "GET", "path": "/", "headers": [(b"host", name.encode())]}
    assert (guard._refusal(scope) is None) is answered


def test_an_uploaded_file_fills_the_form(browser: Browser) -> None:
    answer = upload(browser, GOOD)
    assert answer.status == 200
    problem = answer.json["problem"]
    assert (problem["name"], problem["step_length_m"]) == ("winter-slow", 0.69)
    assert "folder" not in problem


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"step_length_m = -1\nstride_time_s = 1\n", "mine.toml: step_length_m = -1: should be"),
        (b"nonsense", "mine.toml: not valid TOML"),
        (b"\x89PNG\r\n", "mine.toml: not UTF-8 text (byte 0)"),
        (GOOD.replace(b'winter-slow"\nw', b'/etc/passwd"\nw'), "the app opens none on this machi"),
        (b"#" * 5000, "mine.toml: larger than 4 KiB; give a problem file"),
    ],
    ids=["value", "syntax", "picture", "path", "size"],
)
def test_a_bad_upload_is_refused_in_the_librarys_sentence(
    browser: Browser, content: bytes, sentence: str
) -> None:
    answer = upload(browser, content)
    assert answer.status == 422
    assert sentence in answer.json["error"]
    assert "\n" not in answer.json["error"]


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("../../etc/passwd", "../../etc/passwd: not valid"),  # shown, and looked up nowhere
        ("%E5%8F%B0.toml", "台.toml: not valid"),
        ("a%0Ab%00.toml", "a b .toml: not valid"),
        ("", "problem file: not valid"),
        ("n" * 500, "n…: not valid"),
    ],
)
def test_the_name_of_an_upload_is_only_shown(browser: Browser, name: str, shown: str) -> None:
    assert shown in upload(browser, b"nonsense", name).json["error"]


def test_an_upload_that_says_it_is_too_large_is_refused_before_it_is_read(
    browser: Browser,
) -> None:
    connection = browser.connect()
    connection.putrequest("POST", "/problem")
    for name, value in (browser.headers() | {"Content-Length": str(10**12)}).items():
        connection.putheader(name, value)
    connection.endheaders()  # and not a byte of it
    answer = connection.getresponse()
    assert answer.status == 422
    assert b"larger than 4 KiB" in answer.read()


def test_an_upload_that_does_not_say_how_large_it_is_is_cut_off(browser: Browser) -> None:
    connection = browser.connect()
    chunks = iter([b"#" * 1000] * 6)
    connection.request("POST", "/problem", chunks, browser.headers(), encode_chunked=True)
    answer = connection.getresponse()
    assert answer.status == 422
    assert b"larger than 4 KiB" in answer.read()


def test_a_form_that_is_none_is_refused(browser: Browser) -> None:
    for body in (b"", b"[]", b'{"problem": {"step_length_m": {}}}'):
        answer = browser.ask("POST", "/solves", body)
        assert answer.status == 422
        assert ";" in answer.json["error"]


def test_a_small_limit_for_files_leaves_the_form_alone() -> None:
    with app(upload_limit_kib=1) as url:
        browser = Browser(url)
        assert browser.solve("quick").status == 200
        assert browser.solve("n" * 20_000).status == 422


def test_a_refusal_names_its_field(browser: Browser) -> None:
    answer = browser.solve("quick", stride_time_s="soon")
    assert (answer.status, answer.json["field"]) == (422, "stride_time_s")


@pytest.mark.parametrize("file", ["payload.json", "said.json", "..%2f..%2fx", "gait.nc%00", "x"])
def test_only_the_files_of_a_result_can_be_asked_for(browser: Browser, file: str) -> None:
    with browser.page() as page:
        job = browser.solve("quick").json["id"]
        page.ended()
    assert browser.ask("GET", f"/solves/{job}/{file}").status == 404


def test_a_fault_of_the_server_is_a_sentence(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*arguments: Any) -> None:
        raise KeyError("x")

    monkeypatch.setattr("ergowalk.app.routes.uploaded_problem", broken)
    answer = upload(browser, GOOD)
    assert answer.status == 500
    assert "the server stopped where it should not (KeyError: 'x')" in answer.json["error"]


def test_sessions_make_room_for_others_when_nobody_uses_them(
    url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    with app() as own:
        monkeypatch.setattr("ergowalk.app.sessions.SESSIONS", 2)
        first, second = Browser(own), Browser(own)
        with first.page() as page:
            page.next()
            third = Browser(own)  # in the place of the second, which has no page open
            assert second.ask("GET", "/events").status == 404
            with third.page() as other:
                other.next()
                refused = Browser(own, session=False).ask("POST", "/session")
                assert refused.status == 422
                assert "2 pages are open" in refused.json["error"]


def test_a_garbled_request_disturbs_nobody(url: str, browser: Browser) -> None:
    with socket.create_connection(browser.host.split(":")) as raw:
        raw.sendall(b"\x16\x03\x01 what\r\n\r\n")
        raw.settimeout(5)
        assert raw.recv(100).startswith(b"HTTP/1.1 400")
    began = time.monotonic()
    assert browser.ask("GET", "/").status == 200
    assert time.monotonic() - began < 5
