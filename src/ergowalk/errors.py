"""One exception tree; every message says where, which value, which rule, and what to do."""

from __future__ import annotations

import copyreg
from typing import Any


class ErgowalkError(Exception):
    """Root of everything that ergowalk raises on purpose."""


class InputError(ErgowalkError, ValueError):
    """Unusable input, told in one line: file, field, value, rule and remedy.

    Parameters
    ----------
    rule : str
        What is required, as a clause ("must be positive").
    remedy : str
        What the user can do, as an imperative ("give a mass in kg").
    field : str, optional
        Dotted name of the offending field ("body.thigh_mass_kg").
    value : object, optional
        The offending value as the user gave it.
    file : str, optional
        The file that the value came from.
    """

    def __init__(
        self,
        rule: str,
        remedy: str,
        *,
        field: str | None = None,
        value: object = None,
        file: str | None = None,
    ) -> None:
        self.rule = rule
        self.remedy = remedy
        self.field = field
        self.value = value
        self.file = file
        super().__init__(str(self))

    def __reduce__(self) -> tuple[Any, ...]:
        """Rebuilt from its attributes, so that it can come back from a worker process."""
        return copyreg.__newobj__, (type(self), *self.args), dict(vars(self))  # type: ignore[attr-defined]

    def located(self, file: str) -> InputError:
        """The same error, with the file it came from (kept if already known)."""
        self.file = self.file or file
        return self

    def __str__(self) -> str:
        parts = []
        if self.file is not None:
            parts.append(f"{self.file}: ")
        if self.field is not None:
            parts.append(self.field)
            parts.append(f" = {_short(self.value)}: " if self.value is not None else ": ")
        parts.append(f"{self.rule}; {self.remedy}")
        return " ".join("".join(parts).split())


class BodyError(InputError):
    """A body that cannot exist: negative mass, impossible foot triangle, singular mass matrix."""


class CorridorError(InputError):
    """A table of human data that cannot be used as a corridor."""


class ProblemError(InputError):
    """A gait problem that contradicts itself or that nothing can solve."""


class GaitFileError(InputError):
    """A stored gait that cannot be read."""


class RecordingError(InputError):
    """A recording of a walk that cannot be read, or from which no walk can be measured."""


class OutputError(InputError):
    """A place that cannot be written."""


class SweepError(InputError):
    """A sweep that cannot be run, or whose results cannot be used."""


def _short(value: object, limit: int = 60) -> str:
    text = repr(value)
    return text if len(text) <= limit else text[: limit - 1] + "…"
