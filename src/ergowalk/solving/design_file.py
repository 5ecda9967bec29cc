"""A design for several operating points as a value, and the TOML file that says so."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any, Self

from pydantic import Field, model_validator

from ergowalk.errors import InputError, ProblemError
from ergowalk.problem import DEFAULT_PRESET, GaitProblem, preset
from ergowalk.problem.files import read_problem
from ergowalk.values import PositiveFloat, Value, invalid

MOST_POINTS = 20


class Point(Value):
    """A speed at which the device is to serve, by its steps."""

    _error = ProblemError

    step_length_m: PositiveFloat = Field(description="step length L of this point, m")
    stride_time_s: PositiveFloat = Field(description="stride time T of this point, s")
    weight: PositiveFloat = Field(
        default=1.0, description="how much this point counts, against those of the others"
    )


class DesignTask(Value):
    """A problem with free numbers, and the operating points that these are to serve.

    Raises
    ------
    ProblemError
        If nothing is free, or there is no point, or one twice.
    """

    _error = ProblemError

    name: str = Field(default="design", pattern=r"^[A-Za-z0-9_][A-Za-z0-9_.-]{0,59}$")
    base: GaitProblem = Field(description="the problem, whose design all points share")
    point: tuple[Point, ...] = Field(description="the operating points, a table [[point]] for each")

    @property
    def problems(self) -> tuple[GaitProblem, ...]:
        """The problem of each point."""
        return tuple(
            self.base.replace(
                name=f"{self.name}-{k}",
                step_length_m=point.step_length_m,
                stride_time_s=point.stride_time_s,
            )
            for k, point in enumerate(self.point, start=1)
        )

    @property
    def weights(self) -> tuple[float, ...]:
        """How much each point counts."""
        return tuple(point.weight for point in self.point)

    @model_validator(mode="after")
    def _makes_sense(self) -> Self:
        if not self.base.design:
            raise invalid(
                "design",
                None,
                "nothing is free",
                'give bounds, as "devices.ankle.stiffness_nm_per_rad" = [50.0, 600.0]',
            )
        if not 1 <= len(self.point) <= MOST_POINTS:
            raise invalid(
                "point",
                len(self.point),
                f"there must be 1 to {MOST_POINTS} operating points",
                "give a table [[point]] for each speed",
            )
        seen = [(p.step_length_m, p.stride_time_s) for p in self.point]
        for k, steps in enumerate(seen):
            if steps in seen[:k]:
                raise invalid("point", list(steps), "stands twice", "add its weight to the first")
        return self


def read_design(path: str | Path) -> DesignTask:
    """The task of a TOML file.

    ``problem`` is the name of a problem file beside it, or ``preset`` a preset. ``[design]`` has
    the bounds as a problem file has them, and takes the place of that file's; each ``[[point]]``
    has ``step_length_m``, ``stride_time_s``, ``weight``.

    Raises
    ------
    ProblemError, BodyError, CorridorError
        If the file or its problem cannot be read, or makes no task. The message names the file.
    """
    path = Path(path)
    try:
        data = tomllib.loads(path.read_bytes().decode("utf-8-sig"))
    except (OSError, ValueError, RecursionError) as error:
        unread = isinstance(error, OSError)
        reason = getattr(error, "strerror", None) or str(error) or "nested too deeply"
        raise ProblemError(
            f"cannot be read ({reason})" if unread else f"not valid TOML: {reason}",
            "give a design file: a problem, a table [design], tables [[point]]",
            file=str(path),
        ) from None
    try:
        return _from_data(data, path.absolute().parent)
    except InputError as error:
        raise error.located(str(path)) from None


def _from_data(data: dict[str, Any], folder: Path) -> DesignTask:
    if "base" in data:
        raise ProblemError("unknown key", "name a problem file or a preset", field="base")
    rest = {key: value for key, value in data.items() if key not in ("problem", "preset", "design")}
    base = _base(data.get("problem"), data.get("preset"), folder)
    if "design" in data:
        base = base.replace(design=data["design"])
    return DesignTask(base=base, **rest)


def _base(problem: Any, name: Any, folder: Path) -> GaitProblem:
    if problem is not None and name is not None:
        raise ProblemError("contradicts preset", "give one of them", field="problem", value=problem)
    for key, value in (("problem", problem), ("preset", name)):
        if value is not None and not isinstance(value, str):
            raise ProblemError("should be a string", "give a name", field=key, value=value)
    if problem is not None:
        return read_problem(folder / problem)
    return preset(name or DEFAULT_PRESET)
