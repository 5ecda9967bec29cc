"""Commands about stored gaits: ``audit`` and ``compare``."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import dataclass
from pathlib import Path

from ergowalk.audit import audit
from ergowalk.cli.streams import emit, emit_json
from ergowalk.comparison import Comparison, compare, human_of
from ergowalk.errors import InputError
from ergowalk.solution import Solution


def run_audit(arguments: Namespace) -> bool:
    """Print the audit of a gait; whether it is accepted.

    Raises
    ------
    GaitFileError
        If the file is no gait that can be read.
    """
    path: Path = arguments.gait
    dataset = Solution.load(path).dataset
    report = audit(dataset, path.absolute().parent)
    if arguments.json:
        emit_json({"file": str(path), **report.as_dict()})
    else:
        status = dataset.attrs.get("solver_status", "no solver status stored")
        emit(f"{path}: {status}\n{report.table()}")
    return report.accepted


def run_compare(arguments: Namespace) -> None:
    """Print each gait against the human walking that its problem names.

    Raises
    ------
    GaitFileError, CorridorError
        If a file is no gait that can be read, or its table of human data is lost. Nothing is
        printed then.
    """
    compared = [_compared(path) for path in arguments.gaits]
    if arguments.json:
        emit_json({"gaits": [gait.as_dict() for gait in compared]})
    else:
        emit("\n\n".join(gait.text() for gait in compared))


@dataclass(frozen=True)
class _Compared:
    """One stored gait and what was found."""

    path: Path
    measured: bool
    acceptable: bool
    energy_per_metre: float
    limits: str
    comparison: Comparison

    def as_dict(self) -> dict[str, object]:
        return {
            "file": str(self.path),
            "measured": self.measured,
            "acceptable": self.acceptable,
            "energy_per_metre": self.energy_per_metre,
            "limits": self.limits,
            **self.comparison.as_dict(),
        }

    def text(self) -> str:
        if self.measured:
            head = f"E = {self.energy_per_metre:.2f} J/m, measured"
            return f"{self.path}: {head}\n{self.comparison.table()}"
        mark = "" if self.acceptable else " (NOT ACCEPTABLE)"
        energy = f"E = {self.energy_per_metre:.2f} J/m with {self.limits}"
        return f"{self.path}{mark}: {energy}\n{self.comparison.table()}"


def _compared(path: Path) -> _Compared:
    solution = Solution.load(path)
    dataset = solution.dataset
    try:
        return _Compared(
            path=path,
            measured=solution.measured,
            acceptable=dataset.attrs.get("acceptable") == 1,
            energy_per_metre=solution.energy_per_metre,
            limits=solution.problem.conditions(),
            comparison=compare(dataset, human_of(dataset, path.absolute().parent)),
        )
    except InputError as error:
        raise error.located(str(path)) from None
