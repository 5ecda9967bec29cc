"""Line about the objective: its weighted terms, from the curves and the table of the problem."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ergowalk.audit import residuals
from ergowalk.audit.bounds import physical_moment
from ergowalk.audit.record import JOINTS, Record, as_number
from ergowalk.audit.report import AuditLine, Worst

WORK = ("absolute_work", "positive_work", "muscle_work", "regenerative_work")
SQUARES = ("moment_squared_s_per_m2", "moment_rate_squared_s3_per_m2")
EQ10 = {name: float(name == "absolute_work") for name in (*WORK, *SQUARES)}


def objective_line(record: Record) -> AuditLine:
    """The stated value of what was minimised against its terms."""
    line = residuals.OBJECTIVE
    asked = record.table("objective")
    numbers = {name: as_number(value) for name, value in asked.items()}
    only_e = {name: numbers.get(name) for name in (*WORK, *SQUARES)} == EQ10
    if "objective_per_metre" not in record.stated and (only_e or not asked):
        return line.nothing_to_judge("no other objective than (10)")
    for name in (*WORK, *SQUARES) if asked else ():
        if not np.isfinite(numbers.get(name, np.nan)):
            return line.cannot_be_judged(f"the stored problem does not state objective.{name}")
    value = _per_metre(record, numbers if asked else {"absolute_work": 1.0})
    stated = record.objective_per_metre
    error = abs(stated - value) / abs(value) if value else np.inf
    return line.judged(Worst(error, ""), f"stated {stated:.6g} J/m, integral {value:.6g} J/m")


def _per_metre(record: Record, weights: Mapping[str, float]) -> float:
    """Weighted sum of all terms [J/m]."""
    mass, total = record.walker.mass, 0.0
    gain, loss = _work_parts(record)
    total += weights.get("absolute_work", 0.0) * (gain + loss)
    total += weights.get("positive_work", 0.0) * gain
    if weights.get("muscle_work"):
        muscle = gain / weights.get("positive_efficiency", np.nan)
        muscle += loss / weights.get("negative_efficiency", np.nan)
        total += weights["muscle_work"] * muscle
    if weights.get("regenerative_work"):
        share = weights.get("regenerated_share", np.nan)
        total += weights["regenerative_work"] * (gain - share * loss)
    moments = [physical_moment(record, j)[:, leg] for j in range(len(JOINTS)) for leg in (0, 1)]
    if weights.get(SQUARES[0]):
        squared = sum(record.pieces.cumulative(m**2)[-1] for m in moments)
        total += weights[SQUARES[0]] * float(squared) / mass
    if weights.get(SQUARES[1]):
        rates = sum(record.pieces.squared_slope_integral(m) for m in moments)
        total += weights[SQUARES[1]] * rates / mass
    return total / (2 * record.step_length)


def _work_parts(record: Record) -> tuple[float, float]:
    """Positive and negative work [J] of all joints over the stride, both as positive numbers."""
    power = record.raw["joint_power"].reshape(len(record.time), -1)
    net = float(np.sum(record.pieces.cumulative(power)[-1]))
    both = sum(record.pieces.absolute_integral(column) for column in power.T)
    return (both + net) / 2, (both - net) / 2
