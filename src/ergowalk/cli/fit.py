"""Command ``fit``: a recorded walk becomes a problem with this person's body and corridors."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ergowalk.cli.output import check_not_foreign, default_folder, result_folder, write_text
from ergowalk.cli.parser import build_parser
from ergowalk.cli.report import Result
from ergowalk.cli.streams import emit, emit_json, note
from ergowalk.errors import InputError, RecordingError
from ergowalk.measured.choices import Choices
from ergowalk.measured.dataset import measured_dataset
from ergowalk.measured.problem import TABLE, corridor_table, measured_problem
from ergowalk.measured.walk import MeasuredWalk, Spread, measure
from ergowalk.problem import GaitProblem
from ergowalk.problem.files import problem_to_toml
from ergowalk.recording import read_recording
from ergowalk.solution import Solution

PROBLEM, MEASURED, SOLVED = "problem.toml", "measured.nc", "solved"


def run_fit(arguments: Namespace) -> bool:
    """Measure, write, and print; with ``--solve`` whether the cheapest walk is acceptable.

    Raises
    ------
    InputError
        If no walk can be measured from the files, or the folder cannot be written.
    """
    choices = _choices(arguments)
    walk = _measured(arguments, choices)
    try:
        problem = measured_problem(walk)
    except InputError as error:
        raise error.located(walk.trial.recording.file) from None
    folder: Path = arguments.output or default_folder(choices.name)
    files = _write(walk, problem, folder)
    result = _solved(folder, arguments) if arguments.solve else None
    fitted = Fitted(walk, problem, folder, tuple(files), result)
    if arguments.json:
        emit_json(fitted.as_dict())
    else:
        emit(fitted.table())
    return result is None or result.accepted


def _choices(arguments: Namespace) -> Choices:
    return Choices(
        name=arguments.name or arguments.files[0].stem,
        markers=arguments.markers,
        units=arguments.units,
        flip_forces=arguments.flip_forces,
        mass_kg=arguments.mass,
        height_m=arguments.height,
        sex=arguments.sex,
        cutoff_hz=arguments.cutoff,
        force_cutoff_hz=arguments.force_cutoff,
        sd_floor_deg=arguments.sd_floor,
        kinematic_events=arguments.kinematic_events,
    )


def _measured(arguments: Namespace, choices: Choices) -> MeasuredWalk:
    first = str(arguments.files[0])
    try:
        recording = read_recording(arguments.files)
        static = None if arguments.static is None else read_recording([arguments.static])
        return measure(recording, choices, static)
    except RecordingError as error:
        raise error.located(first) from None


def _write(walk: MeasuredWalk, problem: GaitProblem, folder: Path) -> list[str]:
    texts = {PROBLEM: problem_to_toml(problem, commented=True), TABLE: corridor_table(walk)}
    files = [*texts, *([MEASURED] if walk.kinetic else [])]
    with result_folder(folder, files):
        for name, text in texts.items():
            check_not_foreign(folder / name, text.encode("utf-8"), MEASURED)
        for name, text in texts.items():
            write_text(folder / name, text)
        if walk.kinetic:
            dataset = measured_dataset(walk, problem.replace(folder=folder.absolute()))
            Solution(dataset).save(folder / MEASURED)
    return files


def _solved(folder: Path, arguments: Namespace) -> Result:
    from ergowalk.cli.solve import solve_and_write

    asked = ["solve", str(folder / PROBLEM), "-o", str(folder / SOLVED)]
    if arguments.quiet:
        asked.append("--quiet")
    else:
        note(f"measured; the cheapest walk in the same corridors goes to {folder / SOLVED}")
    return solve_and_write(build_parser().parse_args(asked))


@dataclass(frozen=True)
class Fitted:
    """What was measured and written, and the cheapest walk if it was asked for."""

    walk: MeasuredWalk
    problem: GaitProblem
    folder: Path
    files: tuple[str, ...]
    result: Result | None

    def table(self) -> str:
        """Plain text, a line for each fact."""
        rows = [*self._measured(), *self._written(), *self._cheapest()]
        width = max(len(name) for name, _ in rows)
        return "\n".join(f"{name:<{width}}  {text}" for name, text in rows)

    def _measured(self) -> list[tuple[str, str]]:
        walk, lengths = self.walk, self.walk.lengths
        step, time = walk.step_length, walk.stride_time
        rhythm, foot = walk.rhythm, lengths.foot
        many = len(walk.strides) > 1
        sides = ", ".join(
            f"{sum(s.side == side for s in walk.strides)} {side}" for side in walk.legs
        )
        return [
            ("walk", f"{walk.choices.name}: {_strides(len(walk.strides))} ({sides}), "
             f"{len(walk.kinetic)} with forces"),
            ("markers", f"{walk.trial.marker_set.name}, low-pass {walk.choices.cutoff_hz:g} Hz"),
            ("step", f"{_spread(step, many)} m, stride {_spread(time, many)} s, "
             f"{2 * step.mean / time.mean:.2f} m/s"),
            ("rhythm", f"foot flat {rhythm.heel_end:.1%}, heel-off {rhythm.heel_off:.1%}, toe-off "
             f"{rhythm.toe_off:.1%} of the stride"),
            ("body", f"{walk.body.total_mass:.1f} kg; thigh {lengths.thigh:.3f}, shank "
             f"{lengths.shank:.3f}, heel to metatarsals {foot.metatarsal_ahead:.3f} m"),
            ("this walk spends", _spent(walk)),
        ]  # fmt: skip

    def _written(self) -> list[tuple[str, str]]:
        notes = [("note" if i == 0 else "", text) for i, text in enumerate(self.walk.notes)]
        return [
            *notes,
            ("corridors", f"mean +- SD between strides, at least "
             f"{self.walk.choices.sd_floor_deg:g} deg"),
            ("limits", self.problem.limits.sentence()),
            ("files", f"{self.folder}: {', '.join(self.files)}"),
        ]  # fmt: skip

    def _cheapest(self) -> list[tuple[str, str]]:
        if self.result is None:
            return []
        solution = self.result.solution
        verdict = "accepted by the audit" if self.result.accepted else "NOT ACCEPTABLE"
        hint = "" if self.result.accepted else _HINT
        return [
            ("the cheapest", f"{solution.energy_per_metre:.2f} J/m in these corridors, {verdict}: "
             f"{solution.status}{hint}"),
            ("", f"{self.folder / SOLVED}: {', '.join(self.result.files)}"),
        ]  # fmt: skip

    def as_dict(self) -> dict[str, Any]:
        """The same as plain values."""
        walk, energy = self.walk, self.walk.energy_per_metre
        found: dict[str, Any] = {
            "name": walk.choices.name,
            "strides": len(walk.strides),
            "strides_with_forces": len(walk.kinetic),
            "marker_set": walk.trial.marker_set.name,
            "step_length_m": vars(walk.step_length),
            "stride_time_s": vars(walk.stride_time),
            "rhythm": walk.rhythm.as_dict(),
            "mass_kg": walk.body.total_mass,
            "energy_per_metre": None if energy is None else vars(energy),
            "energy_by_joint": walk.energy_by_joint(),
            "toes_measured": walk.toes_seen,
            "notes": list(walk.notes),
            "limits": self.problem.limits.sentence(),
            "folder": str(self.folder),
            "files": list(self.files),
        }
        if self.result is not None:
            found["cheapest"] = self.result.as_dict()
        return found


_HINT = (
    "; a model with both hips in one point may have no walk this near to the person's: widen the "
    "corridors with --sd-floor"
)


def _strides(count: int) -> str:
    return "1 stride" if count == 1 else f"{count} strides"


def _spread(value: Spread, many: bool) -> str:
    return f"{value.mean:.3f} +- {value.sd:.3f}" if many else f"{value.mean:.3f}"


def _spent(walk: MeasuredWalk) -> str:
    energy = walk.energy_per_metre
    if energy is None:
        return "unknown: the plates have seen no whole stance of a stride"
    parts = {k: v for k, v in walk.energy_by_joint().items() if walk.toes_seen or k != "metatarsal"}
    shares = ", ".join(f"{joint} {part:.1f}" for joint, part in parts.items())
    spread = f" +- {energy.sd:.1f}" if len(walk.kinetic) > 1 else ""
    toes = "" if walk.toes_seen else "; no toe marker, so without the metatarsal joint"
    return f"{energy.mean:.1f}{spread} J/m ({shares}{toes})"
