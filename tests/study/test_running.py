"""A sweep ends with every case recorded, does nothing twice, and does not depend on who works."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ergowalk.errors import OutputError, SweepError
from ergowalk.solution import Solution
from ergowalk.study import Sweep, Tally, collect, sweep
from ergowalk.study.event_loop import event_loop
from ergowalk.study.store import Store

from . import standins
from .conftest import begun, index, run, small

pytest.importorskip("distributed", reason="dask is not installed")


def test_every_case_of_a_grid_is_solved_measured_and_stored(here: str, tmp_path: Path) -> None:
    told: list[Tally] = []
    found = run(small(), tmp_path / "out", here, progress=told.append)
    assert found["energy_per_metre"].dims == ("step_length_m", "stride_time_s")
    for length in (0.6, 0.7, 0.8):
        for time in (1.0, 1.2):
            case = found.sel(step_length_m=length, stride_time_s=time)
            energy = standins.energy(length, time)
            assert case["energy_per_metre"] == pytest.approx(energy)
            # E as the sum of what the joints do, from the stored powers
            assert case["energy_by_joint"].sum() == pytest.approx(energy, rel=1e-6)
            assert case["speed_m_s"] == pytest.approx(2 * length / time)
            assert case["peak_reaction"].sel(axis="y") == pytest.approx(1.1)
            assert case["rhythm"].sel(instant="toe_off") == pytest.approx(0.62, abs=0.05)
            gait = Solution(_dataset(tmp_path / "out", str(case["key"].item())))
            assert gait.problem.step_length_m == length
    assert bool((found["status"] == "accepted").all())
    last = told[-1]
    assert (last.total, last.done, last.accepted, last.failed, last.running) == (6, 6, 6, 0, 0)
    assert last.left_s == 0
    assert last.per_minute > 0


def _dataset(folder: Path, key: str) -> Any:
    import xarray as xr

    with xr.open_dataset(Store(folder).gait(key)) as stored:
        return stored.load()


def test_each_case_begins_at_the_neighbour_that_the_plan_names(here: str, tmp_path: Path) -> None:
    found = run(small(), tmp_path / "out", here)
    keys = {str(k) for k in found["key"].to_numpy().ravel()}
    begun_at = [str(k) for k in found["begun_at"].to_numpy().ravel()]
    assert begun_at.count("") == 1  # the case next to the base problem
    assert set(begun_at) - {""} <= keys
    # made-up gaits are no starts: they lack curves, so the solver begins as if there were none
    assert {str(w) for w in found["way"].to_numpy().ravel()} == {"human means"}


def test_the_same_sweep_again_does_only_what_is_missing(here: str, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    first = run(small(), folder, here)
    before = index(folder)
    assert len(begun(folder)) == 6
    keys = [str(key) for key in first["key"].to_numpy().ravel()]
    Store(folder).record_path(keys[3]).unlink()
    Store(folder).record_path(keys[0]).write_text("{half a rec")
    Store(folder).gait(keys[4]).unlink()
    run(small(), folder, here)
    assert sorted(begun(folder)[6:]) == sorted([keys[0], keys[3], keys[4]])
    assert index(folder) == before


def test_what_fails_is_recorded_with_its_reason_and_the_rest_goes_on(
    here: str, tmp_path: Path
) -> None:
    lengths = [*standins.TROUBLES, 0.56, 0.57, 3.0]
    limits = {"time_limit_s": 4.0, "memory_limit_mb": 1000.0}
    definition = small("bad", "troubled", grid={"step_length_m": lengths}, solve=limits)
    folder = tmp_path / "out"
    found = run(definition, folder, here)
    status = dict(zip(lengths, found["status"].to_numpy().tolist(), strict=True))
    reason = dict(zip(lengths, found["reason"].to_numpy().tolist(), strict=True))
    assert status == {
        0.51: "out of time",
        0.52: "out of memory",
        0.53: "crashed",
        0.54: "error",
        0.55: "rejected",
        0.56: "accepted",
        0.57: "accepted",
        3.0: "refused",
    }
    assert reason[0.51] == "killed after its limit of 4 s"
    assert reason[0.52] == "needed more than its limit of 1000 MB"
    assert reason[0.53] == "ended with SIGSEGV"
    assert reason[0.54] == "ZeroDivisionError: division by zero"
    assert "out of reach: these legs span at most" in reason[3.0]
    assert np.isnan(found["energy_per_metre"].sel(step_length_m=0.51))
    # those beyond a case without a gait begin at the last gait on the way to it
    key = {length: str(found["key"].sel(step_length_m=length).item()) for length in lengths}
    assert str(found["begun_at"].sel(step_length_m=0.51).item()) == key[0.56]

    before, count = index(folder), len(begun(folder))
    assert set(before) == set(key.values())
    run(definition, folder, here)
    assert len(begun(folder)) == count
    run(definition, folder, here, retry=True)
    assert set(begun(folder)[count:]) == {key[length] for length in (0.51, 0.52, 0.53, 0.54)}
    assert index(folder) == before


def test_second_looks_mend_the_map_and_are_not_done_twice(here: str, tmp_path: Path) -> None:
    lengths = [0.6, 0.62, 0.64, 0.66, 0.68, 0.7, 0.72, 0.74, 0.76]
    definition = small("mended", "rough", grid={"step_length_m": lengths})
    plain = run(definition, tmp_path / "plain", here)["energy_per_metre"]
    for length, dearer in standins.MISSED.items():
        least = standins.energy(length, definition.base.stride_time_s)
        assert plain.sel(step_length_m=length) == pytest.approx(dearer * least)

    looking = definition.replace(solve={"probes": 1, "second_looks": 5})
    folder = tmp_path / "out"
    told: list[Tally] = []
    found = run(looking, folder, here, progress=told.append)
    right = [standins.energy(length, looking.base.stride_time_s) for length in lengths]
    assert found["energy_per_metre"].to_numpy() == pytest.approx(right)
    assert bool((found["searches"].sel(step_length_m=list(standins.MISSED)) > 1).all())
    words = list(dict.fromkeys(tally.words for tally in told))
    assert words[:3] == ["cases", "probes", "looks of round 1"]
    done = begun(folder)
    assert len(done) == len(set(done)) == int(found["searches"].sum())

    before = index(folder)
    names = {row["case"] for row in before.values()}
    assert len(before) == len(done)
    assert len(names) == len(lengths)
    looks = sorted(key for key, row in before.items() if key != row["case"])
    Store(folder).record_path(looks[0]).unlink()
    Store(folder).record_path(looks[-1]).unlink()
    again = run(looking, folder, here)
    assert sorted(begun(folder)[len(done) :]) == sorted({looks[0], looks[-1]})
    assert index(folder) == before
    assert again["key"].to_numpy().tolist() == found["key"].to_numpy().tolist()


def test_two_sweeps_in_one_folder_share_their_cases(here: str, tmp_path: Path) -> None:
    folder, failed = tmp_path / "out", []
    wider = small("wider", grid={"step_length_m": [0.7, 0.8, 0.9], "stride_time_s": [1.0, 1.2]})

    def work(definition: Sweep) -> None:
        try:
            run(definition, folder, here)
        except BaseException as error:
            failed.append(error)

    threads = [threading.Thread(target=work, args=(d,)) for d in (small(), wider, small())]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert failed == []
    assert len(index(folder)) == 8
    for name in ("small", "wider"):
        assert bool((collect(folder, name)["acceptable"] == 1).all())
    shared = collect(folder, "small")["key"].sel(step_length_m=0.8).to_numpy()
    assert (shared == collect(folder, "wider")["key"].sel(step_length_m=0.8).to_numpy()).all()
    assert not [p for p in folder.rglob(".*") if p.name != ".lock"]


def test_a_folder_of_something_else_is_left_alone(here: str, tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("mine")
    with pytest.raises(OutputError, match="is not empty and not the folder of a sweep; choose"):
        run(small(), tmp_path, here)
    assert [p.name for p in tmp_path.iterdir()] == ["thesis.txt"]


def test_a_scheduler_that_is_not_there_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ergowalk.study.cluster.CONNECT_S", 0.5)
    with pytest.raises(SweepError, match="scheduler = 'tcp://127.0.0.1:9': there is no scheduler"):
        sweep(small(), tmp_path / "out", scheduler="tcp://127.0.0.1:9")
    with pytest.raises(SweepError, match="scheduler = 'nonsense': there is no scheduler"):
        sweep(small(), tmp_path / "out", scheduler="nonsense")


def test_workers_and_scheduler_exclude_each_other(tmp_path: Path) -> None:
    with pytest.raises(SweepError, match="workers and scheduler: have their own workers"):
        sweep(small(), tmp_path / "out", workers=2, scheduler="tcp://127.0.0.1:9")
    with pytest.raises(SweepError, match="workers = 0: must be 1 or more"):
        sweep(small(), tmp_path / "out", workers=0)
    assert not (tmp_path / "out").exists()


def test_a_solver_that_cannot_be_loaded_is_one_line(here: str, tmp_path: Path) -> None:
    with pytest.raises(SweepError, match="solver = 'nowhere:walk': cannot be loaded by worker .*"):
        sweep(small(), tmp_path / "out", scheduler=here, solver="nowhere:walk")


def test_no_thread_of_a_sweep_has_only_the_ten_seconds_of_dask_to_start(
    here: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A starved machine takes longer; what Dask starts by itself would not wait."""
    monkeypatch.setattr("distributed.utils.LoopRunner._start_unlocked", only_a_running_loop)
    one = small(grid={"step_length_m": [0.7], "stride_time_s": [1.2]})
    found = run(one, tmp_path / "out", here)
    assert bool((found["status"] == "accepted").all())


def only_a_running_loop(runner: Any) -> None:
    assert runner._loop is not None
    assert runner._loop.asyncio_loop.is_running()
    runner._started = True


def test_a_thread_that_never_comes_to_run_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ergowalk.study.event_loop.START_S", 0.0)
    monkeypatch.setattr("threading.Thread.start", lambda thread: None)
    with (
        pytest.raises(SweepError, match="cluster: could not start a thread within 0 s; give the"),
        event_loop(),
    ):
        pass


def test_workers_that_cannot_be_started_are_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def starved(**_: Any) -> None:
        raise RuntimeError("Nanny failed\nto start.")

    monkeypatch.setattr("distributed.LocalCluster", starved)
    with pytest.raises(SweepError, match=r"workers = 2: cannot be started \(Nanny failed to start"):
        sweep(small(), tmp_path / "out", workers=2)


def test_without_dask_one_sentence_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(
        SweepError, match="a sweep needs distributed; pip install 'ergowalk.sweep.'"
    ):
        sweep(small(), tmp_path / "out")
