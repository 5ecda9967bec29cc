"""The answer: a labelled dataset that saves, loads and measures itself."""

from __future__ import annotations

import contextlib
import json
import os
import secrets
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import xarray as xr

from ergowalk.errors import GaitFileError, OutputError
from ergowalk.gait.rhythm import Rhythm
from ergowalk.problem import GaitProblem
from ergowalk.problem.files import problem_from_toml
from ergowalk.solution.energy import device_works, joint_energies, leg_energies

if TYPE_CHECKING:
    from ergowalk.audit import AuditReport


MESH_SHARE = 0.006
"""Least share of E that the error bar takes for the mesh."""


@dataclass(frozen=True, eq=False)
class Solution:
    """A gait: every curve of the stride, and how it was found.

    ``dataset`` is exactly the gait file; ``folder`` is where a corridor table named in its problem
    may lie.
    """

    dataset: xr.Dataset
    folder: Path | None = None

    @property
    def status(self) -> str:
        """One sentence on how the solver ended."""
        return str(self.dataset.attrs["solver_status"])

    @property
    def acceptable(self) -> bool:
        """Whether the solver converged and every line of the audit held when it was written."""
        return bool(self.dataset.attrs["acceptable"])

    @property
    def measured(self) -> bool:
        """Whether this is a person's walk from 'ergowalk fit' and not the answer of a problem."""
        return self.dataset.attrs.get("method") == "measured"

    @property
    def energy_per_metre(self) -> float:
        """E of (10) [J/m] on the dense grid, as stored."""
        return float(self.dataset.attrs["energy_per_metre"])

    @property
    def objective_per_metre(self) -> float:
        """What was minimised [J/m], as stored: E itself unless the problem says otherwise."""
        return float(self.dataset.attrs.get("objective_per_metre", self.energy_per_metre))

    @property
    def cost_of_transport(self) -> float:
        """E / (M g): energy per weight and distance."""
        body = self.problem.body
        return self.energy_per_metre / (body.total_mass * body.gravity_m_s2)

    @property
    def energy_error(self) -> float | None:
        """How far E may be from that of ever finer meshes [J/m]; None where that is not known.

        Twice what the check on a finer mesh changes, and at least :data:`MESH_SHARE` of E: what
        halving every element twice has shown, in "How sure is this number?". Of a gait on
        splines E depends on the knots, which no check moves.
        """
        attributes = self.dataset.attrs
        if attributes.get("method") != "collocation" or "mesh_history" not in attributes:
            return None
        found = {k: e for e in self.mesh_history for k in ("final", "finer") if e.get(k)}
        if len(found) < 2 or not found["finer"].get("converged"):
            return None
        change = found["finer"]["energy_per_metre"] - found["final"]["energy_per_metre"]
        return float(max(2 * abs(change), MESH_SHARE * self.energy_per_metre))

    @property
    def rhythm(self) -> Rhythm:
        """Contact instants of leg 1 as fractions of T."""
        return Rhythm(**json.loads(self.dataset.attrs["rhythm"]))

    @property
    def rhythms(self) -> tuple[Rhythm, Rhythm]:
        """Contact instants of each leg as fractions of T after its own heel contact."""
        second = self.dataset.attrs.get("rhythm_leg_2", self.dataset.attrs["rhythm"])
        return self.rhythm, Rhythm(**json.loads(second))

    @property
    def step_lengths(self) -> tuple[float, float]:
        """Lengths of the steps with which leg 1 and leg 2 land [m]; together 2 L."""
        length = float(self.dataset.attrs["step_length"])
        stored = self.dataset.attrs.get("step_lengths")
        first, second = json.loads(stored) if stored else (length, length)
        return float(first), float(second)

    @property
    def step_times(self) -> tuple[float, float]:
        """Durations of the steps that end as leg 1 and leg 2 land [s]; together T."""
        time = float(self.dataset.attrs["stride_time"])
        second = self.rhythm.toe_tip_start * time
        return time - second, second

    @property
    def mesh_history(self) -> list[dict[str, Any]]:
        """One record per mesh that was solved: elements, energy_per_metre, iterations, ..."""
        history: list[dict[str, Any]] = json.loads(self.dataset.attrs["mesh_history"])
        return history

    @cached_property
    def problem(self) -> GaitProblem:
        """The problem that this gait answers."""
        return problem_from_toml(str(self.dataset.attrs["problem"]), folder=self.folder)

    @cached_property
    def energy_by_joint(self) -> dict[str, float]:
        """Part of E of each joint, both legs together [J/m]."""
        distance = 2 * float(self.dataset.attrs["step_length"])
        return {j: e / distance for j, e in joint_energies(self.dataset).items()}

    @cached_property
    def energy_by_leg(self) -> tuple[dict[str, float], dict[str, float]]:
        """Part of E of each joint of leg 1 and of leg 2 [J/m]."""
        distance = 2 * float(self.dataset.attrs["step_length"])
        names = [str(j) for j in self.dataset["joint"].to_numpy()]
        first, second = (
            {j: float(e) / distance for j, e in zip(names, leg, strict=True)}
            for leg in leg_energies(self.dataset)
        )
        return first, second

    @property
    def full_stride(self) -> bool:
        """Whether each leg has its own curves; else leg 2 mirrors leg 1."""
        return "rhythm_leg_2" in self.dataset.attrs

    @cached_property
    def device_energy(self) -> dict[str, tuple[float, float]]:
        """What the devices at each joint give and take, both legs together [J/m].

        It is no part of E, which counts the walker's own moments.
        """
        distance = 2 * float(self.dataset.attrs["step_length"])
        works = device_works(self.dataset)
        return {j: (gives / distance, takes / distance) for j, (gives, takes) in works.items()}

    @property
    def design(self) -> list[dict[str, Any]]:
        """Numbers of the design found with the gait: path, value, low, high and their prices.

        ``low_price`` and ``high_price`` are what moving a bound changes [J/m per unit], 0 where
        it is not active. Empty where nothing was free.
        """
        found: list[dict[str, Any]] = json.loads(self.dataset.attrs.get("design", "[]"))
        return found

    def audit(self) -> AuditReport:
        """Every residual of the audit, recomputed from the curves by independent code."""
        from ergowalk.audit import audit

        return audit(self.dataset, self.folder)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the gait as NetCDF-4; an interrupted call leaves the old file or none.

        Raises
        ------
        OutputError
            If the place cannot be written.
        """
        target = Path(path)
        draft = target.parent / f".gait-{secrets.token_hex(8)}.nc"
        try:
            draft.touch(exist_ok=False)  # the netCDF library does not say what is wrong
            self.dataset.to_netcdf(draft, engine="netcdf4", format="NETCDF4")
            os.replace(draft, target)
        except (OSError, RuntimeError, ValueError) as error:  # full disk; null byte in the name
            raise _unwritable(target, error) from None
        finally:
            with contextlib.suppress(OSError):  # never written, or renamed
                draft.unlink()
        return target

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Solution:
        """Read a gait file.

        Raises
        ------
        GaitFileError
            If it is no NetCDF file or lacks a variable or an attribute.
        """
        from ergowalk.audit import check_readable

        source = Path(path)
        try:
            with xr.open_dataset(source, engine="netcdf4") as stored:
                dataset = stored.load()
        except FileNotFoundError:
            raise GaitFileError(
                "no such file", "give the path of a gait.nc", file=str(source)
            ) from None
        except (OSError, ValueError, RuntimeError) as error:
            detail = getattr(error, "strerror", None) or "not readable"
            raise GaitFileError(
                f"is not a NetCDF file ({detail})",
                "give a gait.nc written by 'ergowalk solve'",
                file=str(source),
            ) from None
        check_readable(dataset, str(source))
        return cls(dataset, source.parent)


def _unwritable(target: Path, error: Exception) -> OutputError:
    reason = getattr(error, "strerror", None) or str(error)
    return OutputError(
        f"cannot be written ({reason})",
        "choose another place or its permissions",
        file=str(target),
    )
