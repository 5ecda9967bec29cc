"""Command ``solve``: a problem becomes a folder with a gait and what is said of it."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from ergowalk.cli.interrupts import Interrupts
from ergowalk.cli.output import (
    check_not_foreign,
    default_folder,
    result_folder,
    write_bytes,
    write_text,
)
from ergowalk.cli.report import Result
from ergowalk.cli.streams import ProgressLine, emit, emit_json, note
from ergowalk.corridors import BUILT_IN, HumanGait
from ergowalk.errors import CorridorError, InputError
from ergowalk.problem import DEFAULT_PRESET, GaitProblem, preset
from ergowalk.problem.files import problem_from_toml, problem_to_toml, read_problem

if TYPE_CHECKING:
    from ergowalk.solution import Progress, Solution

FILES = ("gait.nc", "problem.toml", "report.md")

T = TypeVar("T")


def run_solve(arguments: Namespace) -> bool:
    """Solve, write, and print; whether the answer is acceptable.

    Raises
    ------
    InputError
        As :func:`solve_and_write`.
    """
    result = solve_and_write(arguments)
    if arguments.json:
        emit_json(result.as_dict())
    else:
        emit(result.table())
    return result.accepted


def solve_and_write(arguments: Namespace) -> Result:
    """Solve and write, without printing.

    Raises
    ------
    InputError
        If the problem cannot be used or the folder cannot be written, before anything is
        solved.
    """
    problem = _problem(arguments)
    inputs, choices = stored_inputs(problem), _choices(arguments)
    human = problem.human()  # now: its table may be gone when the solver is done
    folder = arguments.output or default_folder(problem.name)
    with (
        result_folder(folder, [*FILES, *inputs]),
        ProgressLine(arguments.quiet) as progress,
    ):
        for name, content in inputs.items():
            check_not_foreign(folder / name, content)
        progress.stage(f"solving {problem.name}: {problem.conditions()}")
        solution = _solved(problem, choices, progress)
        progress.stage(f"writing {folder}")
        stored = _store(solution, inputs, folder)
        figures = [] if arguments.no_figures else _draw(stored, human, folder)
        result = _told(stored, human, folder, ("gait.nc", *inputs, *figures))
        write_text(folder / "report.md", result.markdown())
    return result


def _problem(arguments: Namespace) -> GaitProblem:
    if arguments.problem is not None:
        return read_problem(arguments.problem)
    return preset(arguments.preset or DEFAULT_PRESET)


def stored_inputs(problem: GaitProblem) -> dict[str, bytes]:
    """Files that make the result self-contained: the problem, and a table it names beside it."""
    source, files = problem.corridors.source, {}
    if source not in BUILT_IN:
        path = (problem.folder or Path()) / source
        name = path.name if path.suffix == ".csv" else f"{path.name}.csv"
        try:
            files[name] = path.read_bytes()
        except OSError as error:
            raise CorridorError(
                f"cannot be read ({error.strerror})", "give a CSV table", file=str(path)
            ) from None
        problem = problem.replace(corridors=problem.corridors.replace(source=name))
    return {**files, "problem.toml": problem_to_toml(problem).encode("utf-8")}


def _choices(arguments: Namespace) -> dict[str, Any]:
    """How to solve: what ``ergowalk.solve`` takes beside the problem, checked."""
    chosen: dict[str, Any] = {"method": arguments.method, "solver": arguments.solver}
    spline = {k: getattr(arguments, k) for k in ("knots", "rho", "asked")}
    spline = {name: value for name, value in spline.items() if value is not None}
    if spline or arguments.method == "spline":
        from ergowalk.solving import SplineOptions

        chosen["spline"] = SplineOptions(**spline)
    if arguments.start is not None:
        from ergowalk.solution import Solution

        chosen |= {"start": Solution.load(arguments.start), "recheck": arguments.recheck}
    if arguments.starts is not None:
        chosen |= {k: getattr(arguments, k) for k in ("starts", "seed", "workers")}
    return chosen


def _solved(problem: GaitProblem, choices: dict[str, Any], progress: ProgressLine) -> Solution:
    from ergowalk.solving import solve  # the solver takes longest to import

    with Interrupts() as interrupts:

        def watch(state: Progress) -> None:
            interrupts.check()
            progress(state)

        solution = solve(problem, progress=watch, **choices)
        interrupts.check()
    return solution


def _store(solution: Solution, inputs: dict[str, bytes], folder: Path) -> Solution:
    """Write the gait, with the problem as it stands beside it: what fails later cannot lose it."""
    text = inputs["problem.toml"].decode("utf-8")
    if solution.problem.design:  # what was free has been found
        source = problem_from_toml(text).corridors
        text = problem_to_toml(solution.problem.replace(corridors=source))
        inputs = {**inputs, "problem.toml": text.encode("utf-8")}
    stored = type(solution)(solution.dataset.assign_attrs(problem=text))
    for name, content in inputs.items():
        write_bytes(folder / name, content)
    stored.save(folder / "gait.nc")
    return stored


def _draw(solution: Solution, human: HumanGait, folder: Path) -> list[str]:
    from ergowalk.plots import write_figures

    drawn, why = _attempt(lambda: write_figures(solution.dataset, folder, human=human))
    if drawn is None:
        note(f"ergowalk: no figures: {why}")
    return [path.name for path in drawn or []]


def _told(solution: Solution, human: HumanGait, folder: Path, files: tuple[str, ...]) -> Result:
    from ergowalk.audit import audit
    from ergowalk.comparison import compare

    report, failure = _attempt(lambda: audit(solution.dataset, folder))
    comparison, _ = _attempt(lambda: compare(solution.dataset, human))
    return Result(solution, report, failure, comparison, folder, files)


def _attempt(work: Callable[[], T]) -> tuple[T | None, str]:
    """The result, or None and why: a gait that did not converge may not bear every look."""
    try:
        return work(), ""
    except InputError as error:
        return None, str(error)
