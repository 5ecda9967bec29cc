"""A problem whose optimum is impulsive, shown on meshes that are ever finer."""

from __future__ import annotations

from typing import Any

import xarray as xr

from ergowalk.solving.candidate import Candidate, Gait, dense, failed
from ergowalk.solving.stages import OrderSearch
from ergowalk.transcription.mesh import finer

IMPULSIVE_SHARES = (1.0, 0.5)
"""A problem without moment-rate bound or cost is shown on a coarse mesh, on that with this share of
its elements halved, and so on."""


def show_impulses(coarse: Candidate) -> Gait:
    """Three meshes of a problem whose moments may change without bound.

    There is no optimum to converge to: each finer mesh allows sharper peaks and a lower E.
    """
    search = coarse.search
    history: list[dict[str, Any]] = []
    results = [search.impulsive(coarse.result)]
    for share in IMPULSIVE_SHARES:
        last = results[-1]
        mesh = finer(last.collocation.mesh, search.residuals(last).errors, share)
        results.append(search.impulsive(last, mesh))
    shown = [Candidate(search, result) for result in results if result.minimum.converged]
    if not shown:
        return failed(Candidate(search, results[-1]), [], f"on {results[-1].elements} elements")
    for current in shown:
        dataset, _ = dense(current, history)
        history[-1] |= _sharpness(dataset, search)
    history[-1]["final"] = True

    def listed(key: str, form: str) -> str:
        return ", ".join(format(r[key], form) for r in history)

    status = (
        "no smooth minimiser: nothing bounds the rate of the joint moments, so the optimum is "
        f"impulsive; on {listed('elements', 'd')} elements E = "
        f"{listed('energy_per_metre', '.1f')} J/m with moment rates up to "
        f"{listed('peak_moment_rate', '.0f')} N m/(kg s) and reactions up to "
        f"{listed('peak_reaction', '.2f')} body weights"
    )
    return Gait(current, dataset, history, status, settled=False)


def _sharpness(dataset: xr.Dataset, search: OrderSearch) -> dict[str, float]:
    """Largest slope of a hip, knee or ankle moment per kg, and largest vertical reaction."""
    walker = search.walker
    moments = dataset["joint_moment"].to_numpy()[:, :, :3] / walker.mass
    time = dataset["time"].to_numpy()
    step = time[1:] - time[:-1]
    slopes = abs(moments[1:] - moments[:-1])[step > 0] / step[step > 0][:, None, None]
    weight = walker.mass * walker.gravity
    reaction = dataset["ground_reaction_force"].sel(axis="y").to_numpy()
    return {
        "peak_moment_rate": float(slopes.max()),
        "peak_reaction": float(reaction.max() / weight),
    }
