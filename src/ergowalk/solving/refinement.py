"""From a gait on few elements to the reported one: cut, checked on a finer mesh, and recorded."""

from __future__ import annotations

from typing import Any

from ergowalk.problem.objective import energy_per_metre
from ergowalk.solving.candidate import Candidate, Gait, dense, failed, record
from ergowalk.solving.check import MeshCheck
from ergowalk.solving.verdict import moved
from ergowalk.transcription.mesh import cut, finer

ROUNDS, MOST_ELEMENTS = 6, 250
"""How often elements are cut whose errors are too large, and how many there may be."""

NEARLY = 0.6
"""Error from which elements of a neighbour's mesh are cut when one of them has to be: so the mesh
is cut once, and the next neighbour finds it ready."""

MESH_TOLERANCE = 0.005
"""E may differ by this share between the reported and the next finer mesh."""


def refine(coarse: Candidate, check_before: MeshCheck | None) -> Gait:
    """The reported gait and the check of its mesh, or a neighbour's where that holds.

    Elements are cut until none has too large an error, then until E stands still: if it moves by
    more than :data:`MESH_TOLERANCE` on the mesh of the check, that mesh is the next to be checked.
    """
    search, final = coarse.search, coarse
    history: list[dict[str, Any]] = []
    if not coarse.result.minimum.converged:
        return failed(coarse, history, "on the coarse mesh")
    residuals = search.residuals(coarse.result)
    above = NEARLY if coarse.continued else 1.0
    for _ in range(ROUNDS):
        if residuals.largest <= 1.0 or final.result.elements > MOST_ELEMENTS:
            break
        energy = energy_per_metre(residuals.work, search.distance)
        history.append(record(final.result, energy))
        mesh = cut(final.result.collocation.mesh, residuals.errors, above)
        final = Candidate(search, search.refined(final.result, mesh, residuals.largest))
        if not final.result.minimum.converged:
            return failed(final, history, f"on {final.result.elements} elements")
        residuals = search.residuals(final.result)
    neighbour = taken_over(final, check_before, history)
    if neighbour is not None:
        return neighbour
    dataset, reported = dense(final, history)
    while True:
        mesh = finer(final.result.collocation.mesh, residuals.errors)
        check = Candidate(search, search.refined(final.result, mesh, 1.0))
        checked, confirmed = dense(check, history)
        change = confirmed / reported - 1
        far = moved(history[-2], history[-1])
        converged = check.result.minimum.converged
        if not converged or far <= MESH_TOLERANCE:
            break
        if check.result.elements > MOST_ELEMENTS:
            break
        final, dataset, reported = check, checked, confirmed
        residuals = search.residuals(final.result)
    history[-2]["final"], history[-1]["finer"] = True, True
    if not converged:
        status = (
            f"converged on {final.result.elements} elements, but the check on "
            f"{check.result.elements} did not: {check.result.minimum.message}"
        )
        return Gait(final, dataset, history, status, settled=False)
    settled = far <= MESH_TOLERANCE
    status = (
        f"{'converged' if settled else 'not converged with the mesh'}: "
        f"E = {reported:.2f} J/m on {final.result.elements} elements, "
        f"{100 * change:+.2f} % on {check.result.elements}"
    )
    if not search.problem.objective.is_eq10:
        value = history[-2]["objective_per_metre"]
        change = history[-1]["objective_per_metre"] / value - 1
        status += f"; objective {value:.2f} J/m, {100 * change:+.2f} %"
    return Gait(final, dataset, history, status, settled)


def taken_over(
    found: Candidate, check: MeshCheck | None, history: list[dict[str, Any]]
) -> Gait | None:
    """The gait with the check of its neighbour's mesh, where that holds for it too.

    The mesh is the neighbour's, or that with some elements cut.
    """
    if check is None:
        return None
    meshes = list(history)
    dataset, energy = dense(found, meshes, final=True)
    if not check.holds_for(energy, found.result.elements):
        return None
    meshes.append(check.record(energy))
    status = check.words(energy, found.result.elements)
    return Gait(found, dataset, meshes, status, settled=True)
