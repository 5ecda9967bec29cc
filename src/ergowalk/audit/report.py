"""What an audit says: one line per residual, with value, tolerance and the worst place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ergowalk.errors import InputError

LEGS = ("leg 1", "leg 2")


@dataclass(frozen=True)
class AuditLine:
    """One residual against its tolerance.

    Attributes
    ----------
    key : str
        Stable name for programs.
    what : str
        The same for people.
    value : float or None
        The residual in ``unit``; None where there was nothing to measure, or where the measure
        is not a number (``note`` says which).
    tolerance : float
        Largest value of an acceptable gait, in ``unit``.
    unit : str
        Unit of both; "1" for pure numbers.
    accepted : bool
        The verdict.
    where : str
        Time, leg and joint of the worst violation; empty where the value is zero.
    note : str
        What else a reader must know.
    """

    key: str
    what: str
    value: float | None
    tolerance: float
    unit: str
    accepted: bool
    where: str = ""
    note: str = ""


@dataclass(frozen=True)
class AuditReport:
    """All lines of an audit, in the order of the contract."""

    lines: tuple[AuditLine, ...]

    @property
    def accepted(self) -> bool:
        """Whether every line is within its tolerance."""
        return all(line.accepted for line in self.lines)

    @property
    def failed(self) -> tuple[AuditLine, ...]:
        """The lines that are not."""
        return tuple(line for line in self.lines if not line.accepted)

    def line(self, key: str) -> AuditLine:
        """The line of a key.

        Raises
        ------
        InputError
            If there is no such line.
        """
        for line in self.lines:
            if line.key == key:
                return line
        known = ", ".join(line.key for line in self.lines)
        raise InputError("no such line", f"choose one of {known}", field="key", value=key)

    def as_dict(self) -> dict[str, Any]:
        """Verdict and lines as plain values that JSON can hold (no NaN)."""
        return {"accepted": self.accepted, "lines": [asdict(line) for line in self.lines]}

    def table(self) -> str:
        """Plain text for a terminal: one row per line, then the verdict."""
        rows = [("", "residual", "value", "tolerance", "unit", "worst at")]
        rows += [_row(line) for line in self.lines]
        widths = [max(len(row[i]) for row in rows) for i in range(5)]
        cells = [[c.ljust(w) for c, w in zip(row, widths, strict=False)] for row in rows]
        text = ["  ".join([*padded, row[5]]) for padded, row in zip(cells, rows, strict=True)]
        count = len(self.failed)
        verdict = f"{count} of {len(self.lines)} lines fail" if count else "all lines pass"
        return "\n".join([*(line.rstrip() for line in text), verdict])


def _row(line: AuditLine) -> tuple[str, str, str, str, str, str]:
    value = "-" if line.value is None else f"{line.value:.3g}"
    remarks = "; ".join(part for part in (line.where, line.note) if part)
    verdict = "ok" if line.accepted else "FAIL"
    return verdict, line.what, value, f"{line.tolerance:.3g}", line.unit, remarks


@dataclass(frozen=True)
class Worst:
    """Largest entry of an array of residuals and the place where it stands."""

    value: float
    where: str


def worst(
    residual: ArrayLike, time: NDArray[np.float64], *names: Sequence[str], one_sided: bool = True
) -> Worst:
    """Largest residual and where it is.

    Parameters
    ----------
    residual : (n, ...) array
        Residuals at n instants, 0 where there is no violation. A NaN counts as the worst.
    time : (n,) array
        The instants [s].
    names : sequences of str
        What the entries along each further axis are called.
    one_sided : bool
        Whether negative values are margins and count as zero.
    """
    array = np.asarray(residual, dtype=float)
    array = np.maximum(array, 0.0) if one_sided else np.abs(array)
    place = np.unravel_index(int(np.argmax(array)), array.shape)
    value = float(array[place])
    if value == 0:
        return Worst(0.0, "")
    parts = [f"t = {time[place[0]]:.4f} s"]
    parts += [axis[int(i)] for axis, i in zip(names, place[1:], strict=True)]
    return Worst(value, ", ".join(part for part in parts if part))


def largest(candidates: Sequence[Worst]) -> Worst:
    """The worst of several; a NaN counts as the worst."""
    return max(candidates, key=lambda w: np.inf if np.isnan(w.value) else w.value)


@dataclass(frozen=True)
class Residual:
    """What a line measures: ``key`` and ``what`` it is called, its tolerance and their unit."""

    key: str
    what: str
    tolerance: float
    unit: str = "1"

    def judged(self, found: Worst, note: str = "") -> AuditLine:
        """The line of a measured residual; what is not a finite number fails."""
        measured = bool(np.isfinite(found.value))
        if not measured:
            note = "; ".join(part for part in (note, "a value that it needs is missing") if part)
        return AuditLine(
            self.key,
            self.what,
            found.value if measured else None,
            self.tolerance,
            self.unit,
            measured and found.value <= self.tolerance,
            found.where,
            note,
        )

    def nothing_to_judge(self, note: str) -> AuditLine:
        """An accepted line without a value: nothing is bounded here."""
        return AuditLine(self.key, self.what, None, self.tolerance, self.unit, True, "", note)

    def cannot_be_judged(self, note: str) -> AuditLine:
        """A failing line without a value: nothing to judge by."""
        return AuditLine(self.key, self.what, None, self.tolerance, self.unit, False, "", note)
