"""What a mesh leaves undone: seen where it is, and in the right size."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from ergowalk.gait.rhythm import PhaseOrder
from ergowalk.problem import preset
from ergowalk.problem.objective import energy_per_metre
from ergowalk.solving.answer import dense_energy, dense_gait
from ergowalk.solving.stages import Effort, OrderSearch, with_times
from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.curves import Trajectory
from ergowalk.transcription.guess import loaded_guess
from ergowalk.transcription.mesh import cut, walking_mesh
from ergowalk.transcription.residuals import Allowance, Residuals, mesh_residuals
from ergowalk.transcription.walker import Smoothing

PROBLEM = preset("berbyuk2002-rhythm")
ORDER = PhaseOrder.TOE_OFF_FIRST


@dataclass(frozen=True)
class Walk:
    """The human mean curves with their loads, put on a mesh: no solution, but a motion."""

    search: OrderSearch
    fit: Trajectory

    def on(self, level: float, halved: bool = False) -> Collocation:
        mesh = walking_mesh(ORDER, self.fit.times, PROBLEM.stride_time_s, level)
        if halved:
            mesh = cut(mesh, [np.full(len(edges) - 1, 2.0) for edges in mesh])
        phased = with_times(self.search.phased, self.fit.times)
        return Collocation(phased, mesh, 3, self.search.store)

    def curves(self, level: float) -> Trajectory:
        """The moments of these curves interpolate inverse dynamics at three instants."""
        collocation = self.on(level)
        guess = loaded_guess(self.search.walker, ORDER, self.fit)
        return collocation.unpack(collocation.pack(guess, self.fit.times))

    def residuals(self, curves: Trajectory, allowed: Allowance | None = None) -> Residuals:
        return mesh_residuals(self.search.halves, curves, allowed)


@pytest.fixture(scope="module")
def walk() -> Walk:
    search = OrderSearch(PROBLEM, (ORDER,), Smoothing(), Effort(), None)
    return Walk(search, search.fit())


UNSEEN = 1e9
"""An allowance so large that nothing is left of an error."""
NOTHING = Allowance(UNSEEN, UNSEEN, UNSEEN, UNSEEN, UNSEEN, UNSEEN)


def changed(curves: Trajectory, phase: int, name: str, change: object) -> Trajectory:
    phases = list(curves.phases)
    phases[phase] = replace(phases[phase], **{name: change})
    return Trajectory(curves.times, tuple(phases))


def test_every_element_has_an_error(walk: Walk) -> None:
    curves = walk.curves(0.3)
    found = walk.residuals(curves)
    assert [len(e) for e in found.errors] == [p.elements for p in curves.phases]
    assert all(np.all(e >= 0) for e in found.errors)
    assert found.largest == max(e.max() for e in found.errors)


def test_the_work_is_that_of_the_dense_curves(walk: Walk) -> None:
    curves = walk.curves(0.6)
    dataset = dense_gait(PROBLEM, walk.search.halves, curves)
    found = energy_per_metre(walk.residuals(curves).work, PROBLEM.step_length_m)
    assert found == pytest.approx(dense_energy(dataset, PROBLEM.step_length_m), rel=2e-3)


def test_a_moment_off_its_dynamics_is_an_error_of_its_element_alone(walk: Walk) -> None:
    allowed = replace(NOTHING, moment_nm_per_kg=1e-3)
    curves = walk.curves(0.6)
    phase = len(curves.phases) - 1
    before = walk.residuals(curves, allowed).errors
    bulges = curves.phases[phase].bulges.copy()
    bulges[5, 0] += 0.05  # N m/kg in the middle of element 5
    after = walk.residuals(changed(curves, phase, "bulges", bulges), allowed).errors
    rise = after[phase] - before[phase]
    assert rise[5] == pytest.approx(50, abs=2 * before[phase][5])
    assert np.all(np.delete(rise, 5) == 0)
    assert all(np.array_equal(a, b) for a, b in zip(before[:-1], after[:-1], strict=True))


def test_cut_elements_hold_the_same_curves(walk: Walk) -> None:
    """Nested: before the solver moves anything, the halves have the errors of the whole."""
    allowed = replace(NOTHING, moment_nm_per_kg=1e-3, height_m=1e-3, angle_deg=0.1)
    curves, halves = walk.curves(0.3), walk.on(0.3, halved=True)
    same = halves.unpack(halves.pack(curves.as_guess(), curves.times))
    before, after = walk.residuals(curves, allowed), walk.residuals(same, allowed)
    for one, two in zip(before.errors, after.errors, strict=True):
        pairs = two.reshape(-1, 2).max(axis=1)  # sampled twice as densely, the same instants too
        assert np.all(pairs > one * (1 - 1e-3))  # the guess is not quite continuous
        assert np.all(pairs < one * 1.3 + 1e-6)
    assert after.work == pytest.approx(before.work, rel=0.02)


def test_half_the_allowance_is_twice_the_error(walk: Walk) -> None:
    curves = walk.curves(0.3)
    whole = walk.residuals(curves).errors
    half = walk.residuals(curves, Allowance(*(v / 2 for v in vars(Allowance()).values()))).errors
    for one, two in zip(whole, half, strict=True):
        np.testing.assert_allclose(two, 2 * one, rtol=1e-12)


def test_curves_that_are_no_numbers_have_an_infinite_error(walk: Walk) -> None:
    curves = walk.curves(0.3)
    accelerations = curves.phases[-1].accelerations.copy()
    accelerations[3, 1, 0] = np.nan
    lost = changed(curves, len(curves.phases) - 1, "accelerations", accelerations)
    assert walk.residuals(lost).errors[-1][3] == np.inf
    assert walk.residuals(lost).largest == np.inf
