"""What is tried for one case: the neighbour, the human means, further starts; the best is kept."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from ergowalk.errors import GaitFileError
from ergowalk.problem import GaitProblem, preset
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution import Solution
from ergowalk.study import Sweep, sweep
from ergowalk.study.cases import cases_of
from ergowalk.study.searching import COLD, searched
from ergowalk.study.store import Store

from .standins import gait

NEIGHBOUR, MEANS, STARTS = "neighbour", "human means", "starts"


class Solver:
    """Gaits of known E and verdict for each way to begin."""

    def __init__(self, **outcomes: tuple[float, bool]) -> None:
        self.outcomes = {NEIGHBOUR: (50.0, True), MEANS: (51.0, True), STARTS: (52.0, True)}
        self.outcomes |= {name.replace("_", " "): found for name, found in outcomes.items()}
        self.status = "made up"
        self.calls: list[tuple[str, dict[str, Any]]] = []

    def __call__(self, problem: GaitProblem, **choices: Any) -> Solution:
        way = NEIGHBOUR if "start" in choices else STARTS if "starts" in choices else MEANS
        self.calls.append((way, {k: v for k, v in choices.items() if k != "start"}))
        energy, acceptable = self.outcomes[way]
        made = gait(problem, acceptable).dataset
        return Solution(made.assign_attrs(energy_per_metre=energy, solver_status=self.status))


def found(tmp_path: Path, monkeypatch: Any, solver: Solver, begun: bool, starts: int = 1) -> Any:
    """The record of a case, begun at a gait or not."""
    problem = preset("berbyuk2002")
    monkeypatch.setattr(Solution, "load", staticmethod(lambda path: gait(problem)))
    task = {
        "problem": problem_to_toml(problem),
        "gait": str(tmp_path / "gait.nc"),
        "start": "a gait" if begun else None,
        "starts": starts,
        "seed": 7,
    }
    return searched(task, solver)


@pytest.mark.parametrize(
    ("outcomes", "begun", "starts", "tried", "way"),
    [
        ({}, False, 1, [MEANS], MEANS),
        ({}, True, 1, [NEIGHBOUR], NEIGHBOUR),
        ({"neighbour": (40.0, False)}, True, 1, [NEIGHBOUR, MEANS], MEANS),
        ({"neighbour": (52.0, False), "human_means": (53.0, False)}, True, 1,
         [NEIGHBOUR, MEANS], NEIGHBOUR),
        ({}, True, 2, [NEIGHBOUR, MEANS], NEIGHBOUR),
        ({"human_means": (49.0, True)}, True, 2, [NEIGHBOUR, MEANS], MEANS),
        ({"starts": (48.0, True)}, True, 3, [NEIGHBOUR, STARTS], "2 starts"),
        ({"starts": (48.0, False)}, True, 3, [NEIGHBOUR, STARTS], NEIGHBOUR),
        ({}, False, 3, [STARTS], "3 starts"),
        ({"neighbour": (40.0, False)}, True, 0, [NEIGHBOUR], NEIGHBOUR),
        ({}, False, 0, [MEANS], MEANS),
    ],
)  # fmt: skip
def test_the_best_accepted_gait_of_all_that_was_asked_for_is_kept(
    outcomes: Any, begun: bool, starts: int, tried: list[str], way: str,
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    solver = Solver(**outcomes)
    record = found(tmp_path, monkeypatch, solver, begun, starts)
    assert [name for name, _ in solver.calls] == tried
    assert record["way"] == way
    energy, acceptable = solver.outcomes[STARTS if way.endswith("starts") else way]
    assert record["energy_per_metre"] == energy
    assert record["status"] == ("accepted" if acceptable else "rejected")
    for name, choices in solver.calls:
        if name == STARTS:
            assert choices == {"starts": starts - begun, "seed": 7, "workers": 1}


def test_a_start_that_ended_at_the_human_means_is_not_tried_there_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    solver = Solver(neighbour=(50.0, False))
    solver.status = f"not converged; the search {COLD}"
    record = found(tmp_path, monkeypatch, solver, True)
    assert [name for name, _ in solver.calls] == [NEIGHBOUR]
    assert record["way"] == MEANS


def test_the_solver_says_so_in_these_words(tmp_path: Path) -> None:
    from ergowalk.solving import collocation

    assert COLD in Path(collocation.__file__).read_text("utf-8")


def test_a_start_that_is_no_gait_is_refused_before_there_is_a_folder(tmp_path: Path) -> None:
    pytest.importorskip("distributed", reason="dask is not installed")
    definition = Sweep(base=preset("berbyuk2002"), grid={"step_length_m": [0.7]})
    for name, match in (("none.nc", "no such file; give the path"), ("text.nc", "is not a NetCDF")):
        (tmp_path / "text.nc").write_text("no gait")
        with pytest.raises(GaitFileError, match=f"{name}: {match}"):
            sweep(definition.replace(start=tmp_path / name), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_the_start_is_kept_where_workers_see_it(tmp_path: Path, paper_gait_file: Path) -> None:
    definition = Sweep(base=preset("berbyuk2002"), grid={"step_length_m": [0.7]})
    store = Store(tmp_path / "out")
    store.prepare(definition, cases_of(definition))
    kept = store.keep_start(paper_gait_file)
    assert kept is not None
    assert kept.parent == tmp_path / "out" / "starts"
    assert kept.read_bytes() == paper_gait_file.read_bytes()
    assert store.keep_start(paper_gait_file) == kept
    assert store.keep_start(None) is None


def test_a_table_of_human_data_goes_with_the_sweep(tmp_path: Path) -> None:
    from importlib import resources

    from ergowalk.problem.files import problem_from_toml

    content = resources.files("ergowalk").joinpath("data/winter1991/slow.csv").read_bytes()
    (tmp_path / "mine.csv").write_bytes(content)
    base = preset("berbyuk2002").replace(folder=tmp_path)
    base = base.replace(corridors=base.corridors.replace(source="mine.csv"))
    definition = Sweep(base=base, grid={"step_length_m": [0.7]})
    (case,) = cases_of(definition)
    store = Store(tmp_path / "out")
    store.prepare(definition, [case])
    (tmp_path / "mine.csv").unlink()
    text = store.problem_text(case)
    assert problem_from_toml(text, folder=store.gait(case.key).parent).human().curves
