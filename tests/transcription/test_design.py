"""A programme with free numbers is, at any value of them, the programme of that problem."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import casadi as ca
import numpy as np
import pytest

from ergowalk.body import Body
from ergowalk.errors import ProblemError
from ergowalk.gait.rhythm import PhaseOrder
from ergowalk.nlp import NonlinearProgramme
from ergowalk.problem import Device, Devices, DoubleSupport, GaitProblem, preset
from ergowalk.problem.design import held_at, value_at
from ergowalk.problem.devices import LegDevices
from ergowalk.transcription.collocation import Collocation
from ergowalk.transcription.design import reference_mass
from ergowalk.transcription.layout import Mesh
from ergowalk.transcription.steps import STEP_1
from ergowalk.transcription.walker import Smoothing, Walker
from ergowalk.transcription.walking import walking_problem

ORDER = PhaseOrder.FLAT_FIRST
SPRINGS = Devices(
    hip=Device(kind="spring", stiffness_nm_per_rad=30.0, stiffness_below_nm_per_rad=50.0),
    knee=Device(kind="series", stiffness_nm_per_rad=30.0, damping_nms_per_rad=2.0),
    ankle=Device(
        kind="parallel",
        own_moment=False,
        stiffness_nm_per_rad=180.0,
        damping_nms_per_rad=5.0,
        rest_angle_deg=2.0,
    ),
)
FOOT = Devices(ankle=Device(kind="spring", stiffness_nm_per_rad=180.0, rest_angle_deg=3.0))
BASE = preset("berbyuk2002-rhythm")
LINEAR = BASE.replace(double_support=DoubleSupport.LINEAR)
CASES = {
    "devices": (
        BASE.replace(devices=SPRINGS),
        (
            *(f"devices.hip.{name}" for name in ("stiffness_nm_per_rad", "rest_angle_deg")),
            "devices.hip.stiffness_below_nm_per_rad",
            *(
                f"devices.{joint}.{name}"
                for joint in ("knee", "ankle")
                for name in ("stiffness_nm_per_rad", "damping_nms_per_rad", "rest_angle_deg")
            ),
        ),
    ),
    "a device held in swing": (
        BASE.replace(devices=FOOT),
        ("devices.ankle.stiffness_nm_per_rad", "devices.ankle.rest_angle_deg"),
    ),
    "links": (
        BASE,
        (
            *(f"body.{link}_length_m" for link in ("shank", "thigh", "toe")),
            *(f"body.{link}_inertia_kgm2" for link in ("trunk", "thigh")),
        ),
    ),
    "foot": (
        BASE,
        ("body.heel_to_ankle_m", "body.ankle_to_metatarsal_m", "body.heel_to_metatarsal_m"),
    ),
    "masses": (
        BASE.replace(devices=SPRINGS),
        ("body.foot_mass_kg", "body.thigh_inertia_kgm2", "body.trunk_com_m"),
    ),
    "linear sharing": (LINEAR, ("body.toe_length_m",)),
    "one leg": (
        BASE.replace(
            body=BASE.body.replace(foot_mass_kg=(1.24, 0.6), shank_length_m=(0.53, 0.51)),
            devices=Devices(leg_2=LegDevices(ankle=SPRINGS.ankle, knee=SPRINGS.knee)),
        ),
        (
            "body.foot_mass_kg.2",
            "body.shank_length_m.1",
            "devices.leg_2.ankle.stiffness_nm_per_rad",
            "devices.leg_2.knee.damping_nms_per_rad",
        ),
    ),
}


def programme(problem: GaitProblem) -> Collocation:
    phased = walking_problem(problem, (ORDER,) * (1 + problem.full_stride), Smoothing())
    mesh: Mesh = tuple(np.linspace(0.0, 1.0, 3) for _ in phased.phases)
    return Collocation(phased, mesh, 3)


def own(collocation: Collocation) -> np.ndarray:
    """Which variables are not free numbers."""
    mask = np.ones(collocation.layout.size, dtype=bool)
    mask[[i for name, i in collocation.layout.shared.items() if name != STEP_1]] = False
    return mask


def pairs(rows: np.ndarray, nlp: NonlinearProgramme) -> Iterator[tuple[str, np.ndarray]]:
    """The rows of each block that has a counterpart without a design."""
    edges = np.cumsum([0, *(len(b.labels) * b.uses for b in nlp.blocks)])
    for block, (first, last) in zip(nlp.blocks, pairwise(edges), strict=True):
        yield block.kernel.name, rows[first:last]


@pytest.mark.parametrize("name", CASES)
def test_free_numbers_are_those_of_the_problem(name: str) -> None:
    problem, paths = CASES[name]
    values = {path: 1.02 * value_at(problem, path) or 5.0 for path in paths}
    values |= {path: 0.9 * value_at(problem, path) for path in paths if path.endswith("com_m")}
    bounds = {}
    for path, value in values.items():
        low, high = sorted((float(value), float(value_at(problem, path))))
        bounds[path] = (low, high)
    free = programme(problem.replace(design=bounds))
    fixed = programme(problem.with_design(values))
    generator = np.random.default_rng(1)
    x = generator.normal(scale=0.3, size=free.layout.size)
    for start, end in pairwise(sorted(free.layout.times.values())):
        x[end] = x[start] + 0.1
    for path, value in values.items():
        index = free.layout.shared[path]
        x[index] = value / free.layout.scale[index]
    z = x[own(free)]
    flat_at = [
        fixed.layout.boundary[boundary, "foot_1", "value"] for boundary in ("heel_end", "heel_off")
    ]
    cost, rows = free.programme.evaluate(x)
    wanted, expected = fixed.programme.evaluate(z)
    found, there = dict(pairs(rows, free.programme)), dict(pairs(expected, fixed.programme))
    extra = {n: r for n, r in found.items() if n not in there}
    assert set(extra) == ({"flat_heel_end", "flat_heel_off"} if name == "foot" else set())
    for block, values_there in there.items():
        here = found[block]
        if name == "linear sharing" and len(here) > len(values_there):
            continue  # a row more: the toes end where they end
        np.testing.assert_allclose(here, values_there, rtol=1e-9, atol=1e-9, err_msg=block)
    reference = reference_mass(problem.replace(design=bounds))
    mass = problem.with_design(values).body.total_mass
    assert cost * reference == pytest.approx(wanted * mass, rel=1e-9)
    if name == "foot":
        flat = Walker(problem.with_design(values), Smoothing()).flat
        for row, index in zip(extra.values(), flat_at, strict=True):
            assert row[0] == pytest.approx(z[index] - flat, abs=1e-12)


def test_bounds_and_other_numbers_alone_set_the_programme() -> None:
    """A gait found can be recalled: where its search began is nowhere in it."""
    path = "body.foot_mass_kg"
    one = BASE.replace(design={path: (1.0, 2.0)})
    other = one.with_design({path: 1.9})
    a, b = programme(one), programme(other)
    assert reference_mass(one) == reference_mass(other)
    np.testing.assert_array_equal(a.layout.scale, b.layout.scale)
    x = np.random.default_rng(2).normal(size=a.layout.size)
    np.testing.assert_array_equal(a.programme.evaluate(x)[1], b.programme.evaluate(x)[1])


def test_a_stiffness_of_zero_that_is_free_is_an_unknown_like_others() -> None:
    """Where a search may begin without a spring it may not find that there is none."""
    devices = Devices(ankle=Device(kind="spring", stiffness_nm_per_rad=0.0))
    path = "devices.ankle.stiffness_nm_per_rad"
    none = BASE.replace(devices=devices, design={path: (0.0, 100.0)})
    some = none.with_design({path: 50.0})
    held = held_at(none, {path: 0.0})
    assert len({programme(p).signature for p in (none, some, held)}) == 1


def test_numbers_that_make_no_walker_are_told_of() -> None:
    path = "body.foot_mass_kg"
    walker = Walker(BASE.replace(design={path: (1.0, 2.0)}), Smoothing())
    assert walker.at({path: 1.5}).problem.body.foot_mass_kg == 1.5
    assert walker.at({path: 2.0 + 1e-9}).problem.body.foot_mass_kg == 2.0
    light = Body.model_construct(**{**dict(walker.problem.body), "trunk_inertia_kgm2": 1e-3})
    walker.asked = walker.asked.model_copy(update={"body": light})
    with pytest.raises(ProblemError, match=r"ended where no walker can be: .*narrow the bounds"):
        walker.at({path: 1.5})


def test_a_free_mass_weighs_in_what_is_minimised() -> None:
    """Work per kg times M: a heavier walker must not be cheaper for being heavier."""
    path = "body.trunk_mass_kg"
    problem = BASE.replace(design={path: (40.0, 46.7)})
    phase = walking_problem(problem, (ORDER,), Smoothing()).phases[0]
    assert phase.cost_factor is not None
    mass = ca.SX.sym("mass")
    factor = ca.Function("factor", [mass], [phase.cost_factor({path: mass})])
    rest = BASE.body.total_mass - BASE.body.trunk_mass_kg
    assert float(factor(46.7)) == pytest.approx((46.7 + rest) / (43.35 + rest), rel=1e-12)
    assert walking_problem(BASE, (ORDER,), Smoothing()).phases[0].cost_factor is None
