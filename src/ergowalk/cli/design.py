"""Command ``design``: one design for several operating points, and their gaits."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ergowalk.cli.interrupts import Interrupts
from ergowalk.cli.output import default_folder, result_folder, write_bytes
from ergowalk.cli.report import design_rows
from ergowalk.cli.solve import stored_inputs
from ergowalk.cli.streams import ProgressLine, emit, emit_json
from ergowalk.problem.files import problem_from_toml, problem_to_toml

if TYPE_CHECKING:
    from ergowalk.solution import Progress, Solution
    from ergowalk.solving.common_design import CommonDesign
    from ergowalk.solving.design_file import DesignTask

PROBLEM = "problem.toml"


def run_design(arguments: Namespace) -> bool:
    """Find the design, write a gait for each point, and print; whether all are acceptable.

    Raises
    ------
    InputError
        If the file cannot be used or the folder cannot be written, before anything is solved.
    """
    from ergowalk.solving.design_file import read_design

    task = read_design(arguments.design)
    inputs = stored_inputs(task.base)
    folder = arguments.output or default_folder(task.name)
    files = [f"point-{k}.nc" for k in range(1, len(task.point) + 1)]
    with result_folder(folder, [*files, *inputs]), ProgressLine(arguments.quiet) as progress:
        progress.stage(f"design {task.name}: {task.base.conditions()}")
        found = _found(task, progress)
        for name, content in inputs.items():
            if name != PROBLEM:  # the table of corridors
                write_bytes(folder / name, content)
        source = problem_from_toml(inputs[PROBLEM].decode("utf-8")).corridors
        for name, point in zip(files, found.points, strict=False):
            _beside(point.common, source).save(folder / name)
    told = _told(task, found, folder, files)
    if arguments.json:
        emit_json(told)
    else:
        emit(_table(told))
    return found.acceptable


def _found(task: DesignTask, progress: ProgressLine) -> CommonDesign:
    from ergowalk.solving import design  # the solver takes longest to import

    with Interrupts() as interrupts:

        def watch(state: Progress) -> None:
            interrupts.check()
            progress(state)

        found = design(task.problems, task.weights, progress=watch)
        interrupts.check()
    return found


def _beside(gait: Solution, corridors: Any) -> Solution:
    """The gait whose problem names the table of corridors as it stands beside the file."""
    text = problem_to_toml(gait.problem.replace(corridors=corridors))
    return type(gait)(gait.dataset.assign_attrs(problem=text))


def _told(task: DesignTask, found: CommonDesign, folder: Path, files: list[str]) -> dict[str, Any]:
    points = []
    for name, point in zip(files, found.points, strict=False):
        gait = point.common
        points.append(
            {
                "file": name,
                "step_length_m": gait.problem.step_length_m,
                "stride_time_s": gait.problem.stride_time_s,
                "weight": point.weight,
                "energy_per_metre": gait.energy_per_metre,
                "objective_per_metre": gait.objective_per_metre,
                "alone": {n["path"]: n["value"] for n in point.alone.design},
                "alone_energy_per_metre": point.alone.energy_per_metre,
                "alone_objective_per_metre": point.alone.objective_per_metre,
                "acceptable": gait.acceptable,
                "status": gait.status,
            }
        )
    return {
        "name": task.name,
        "acceptable": found.acceptable,
        "status": found.status,
        "energy_per_metre": found.energy_per_metre,
        "objective_per_metre": found.objective_per_metre,
        "limits": task.base.conditions(),
        "design": [vars(number) for number in found.found],
        "points": points,
        "folder": str(folder),
    }


def _table(told: dict[str, Any]) -> str:
    rows = [
        ("design", f"{told['name']}: {len(told['points'])} operating points"),
        ("E", f"{told['energy_per_metre']:.2f} J/m, weighted mean, with {told['limits']}"),
        *(("found" if i == 0 else "", text) for i, (_, text) in enumerate(_numbers(told))),
    ]
    lines = [f"{label:<7} {text}" for label, text in rows]
    lines.append("point   step [m]  stride [s]  weight  E [J/m]  by itself  which alone would have")
    for point in told["points"]:
        alone = ", ".join(f"{path} = {value:.5g}" for path, value in point["alone"].items())
        mark = "" if point["acceptable"] else "  NOT ACCEPTABLE"
        lines.append(
            f"{point['file']:<11} {point['step_length_m']:5g}  {point['stride_time_s']:10g}  "
            f"{point['weight']:6.3f}  {point['energy_per_metre']:7.2f}  "
            f"{point['alone_energy_per_metre']:9.2f}  {alone}{mark}"
        )
    verdict = "acceptable" if told["acceptable"] else "NOT ACCEPTABLE"
    return "\n".join([*lines, f"status  {verdict}: {told['status']}", f"files   {told['folder']}"])


def _numbers(told: dict[str, Any]) -> list[tuple[str, str]]:
    return design_rows(told["design"])
