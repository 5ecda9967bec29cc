"""Measures the spline method, and puts the tables into the pages: ``<!-- study: NAME -->``.

``python scripts/spline_study.py [NAME ...]`` takes about a quarter of an hour of CPU time for all;
run it with ``OMP_NUM_THREADS=1``. All with the printed rhythm.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cache

import numpy as np

import ergowalk
from blocks import table, write_studies
from ergowalk.solving import SplineOptions

PRINTED = ergowalk.preset("berbyuk2002-rhythm")

KNOTS = (4, 6, 8, 12, 20, 30, 40)
RHOS = (0.0, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3)
SHARED_KNOTS = 12
"""Knots on which the two solvers meet."""


@cache
def spline(solver: str, knots: int, asked: str = "paper", rho: float = 1e-6) -> ergowalk.Solution:
    """A gait by the spline method."""
    options = SplineOptions(knots=knots, rho=rho, asked=asked)
    return _told(lambda: ergowalk.solve(PRINTED, method="spline", solver=solver, spline=options))


@cache
def collocation() -> ergowalk.Solution:
    """The gait by collocation, from the human means."""
    return _told(lambda: ergowalk.solve(PRINTED))


@cache
def continued(solver: str, knots: int, asked: str) -> ergowalk.Solution:
    """The gait by collocation, begun from one by splines."""
    return _told(lambda: ergowalk.solve(PRINTED, start=spline(solver, knots, asked)))


def knots() -> str:
    """E against the number of knots, for the measures of (19) alone."""
    rows = []
    for count in KNOTS:
        found = spline("ipopt", count)
        peak, rate = _peaks(found)
        rows.append(
            (
                str(count),
                str(found.dataset.attrs["unknowns"]),
                *_energies(found),
                f"{peak:.2f}",
                f"{rate:.0f}",
                f"{_cpu(found):.0f}",
            )
        )
    header = ("knots n", "unknowns C", "E [J/m]", "E with twice the samples")
    return table(
        (*header, "largest R_y [body weights]", "largest moment rate [N m/(kg s)]", "CPU s"), rows
    )


def rho() -> str:
    """E against rho on 12 knots."""
    spacing = PRINTED.stride_time_s / 2 / SHARED_KNOTS
    rows = []
    for value in RHOS:
        found = spline("ipopt", SHARED_KNOTS, rho=value)
        iterations = str(found.dataset.attrs["iterations"])
        rows.append((f"{value:g}", f"{value / spacing**3:.1g}", _energies(found)[0], iterations))
    return table(("rho [s^3]", "rho / h^3", "E [J/m]", "IPOPT iterations"), rows)


def solvers() -> str:
    """Rosenbrock's method against IPOPT on the same 12 knots."""
    descent, climb = (spline(solver, SHARED_KNOTS) for solver in ("rosenbrock", "ipopt"))
    weights = descent.dataset["trace_weight"].to_numpy()[-1]
    power = float(descent.dataset.attrs["penalty_power"])

    def row(name: str, found: ergowalk.Solution, effort: int) -> tuple[str, ...]:
        measures = found.dataset["measure_value"] / found.dataset["measure_tolerance"]
        energy = float(found.dataset.attrs["energy_at_samples"])
        penalised = energy + weights @ measures.to_numpy() ** power
        largest = float(measures.max())
        return (
            name,
            f"{effort:,}",
            f"{_cpu(found):.0f}",
            f"{penalised:.2f}",
            f"{found.energy_per_metre:.2f}",
            f"{largest:.2f}",
        )

    evaluations = int(descent.dataset.attrs["evaluations"])
    iterations = int(climb.dataset.attrs["iterations"])
    factors = (
        "factor",
        f"{evaluations / iterations:,.0f}",
        f"{_cpu(descent) / _cpu(climb):.1f}",
        *3 * ("",),
    )
    header = ("solver", "evaluations or iterations", "CPU s", "Q_1 [J/m]", "E [J/m]")
    rows = [
        row("Rosenbrock", descent, evaluations),
        row("IPOPT, exact derivatives", climb, iterations),
        factors,
    ]
    return table((*header, "largest G_l / tolerance"), rows)


def transcriptions() -> str:
    """Splines against collocation: E, time, audit."""
    cases = {
        f"splines, {SHARED_KNOTS} knots, Rosenbrock, (19) alone": spline(
            "rosenbrock", SHARED_KNOTS
        ),
        f"splines, {SHARED_KNOTS} knots, IPOPT, (19) alone": spline("ipopt", SHARED_KNOTS),
        "splines, 30 knots, IPOPT, everything": spline("ipopt", 30, "everything"),
        "collocation from the human means": collocation(),
        f"collocation from splines, {SHARED_KNOTS} knots, Rosenbrock": continued(
            "rosenbrock", SHARED_KNOTS, "paper"
        ),
        "collocation from splines, 30 knots, IPOPT": continued("ipopt", 30, "everything"),
    }
    rows = [
        (
            name,
            _energies(found)[0],
            str(found.dataset.attrs["iterations"]) if "IPOPT" in name or "coll" in name else "-",
            f"{_cpu(found):.0f}",
            ", ".join(f"`{line.key}`" for line in found.audit().failed) or "all lines hold",
        )
        for name, found in cases.items()
    ]
    return table(("method", "E [J/m]", "iterations", "CPU s", "audit: lines that fail"), rows)


def _told(work: Callable[[], ergowalk.Solution]) -> ergowalk.Solution:
    found = work()
    print(f"{_cpu(found):.0f} s: {found.status}", file=sys.stderr, flush=True)
    return found


def _cpu(found: ergowalk.Solution) -> float:
    """CPU seconds of solving, the check included."""
    return float(found.dataset.attrs["solve_time"])


def _energies(found: ergowalk.Solution) -> tuple[str, str]:
    """E as reported, with a mark where the solver did not converge; and with more samples."""
    final = [m for m in found.mesh_history if m.get("final")]
    finer = [m["energy_per_metre"] for m in found.mesh_history if m.get("finer")]
    mark = "" if final and final[-1]["converged"] else " (not converged)"
    return f"{found.energy_per_metre:.1f}{mark}", f"{finer[0]:.1f}" if finer else "-"


def _peaks(found: ergowalk.Solution) -> tuple[float, float]:
    """Largest vertical reaction [body weights] and moment rate at hip, knee, ankle [N m/(kg s)]."""
    body, data = found.problem.body, found.dataset
    weight = body.total_mass * body.gravity_m_s2
    peak = float(data["ground_reaction_force"].sel(axis="y").max()) / weight
    moments = data["joint_moment"].to_numpy()[:, :, :3] / body.total_mass
    step = np.diff(data["time"].to_numpy())
    slopes = np.abs(np.diff(moments, axis=0))[step > 0] / step[step > 0][:, None, None]
    return peak, float(slopes.max())


STUDIES = {
    "spline knots": knots,
    "spline rho": rho,
    "spline solvers": solvers,
    "spline transcriptions": transcriptions,
}


if __name__ == "__main__":
    write_studies(STUDIES, sys.argv[1:])
