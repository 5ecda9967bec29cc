"""MuJoCo reads the walker and finds the mechanics of the model in it."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.errors import BodyError
from ergowalk.io import Samples, body_mjcf
from ergowalk.io.rigid import rigid
from ergowalk.mechanics.dynamics import coefficients, mass_matrix, motion_of
from ergowalk.mechanics.energy import kinetic_energy, potential_energy
from ergowalk.mechanics.kinematics import LegMotion, Point, Rotation, joint_angles, leg_points

from .readers import floats, read_csv

Array = NDArray[np.float64]

DIFFERENT: dict[str, Any] = {
    "thigh_mass_kg": (8.0, 9.0),
    "shank_length_m": (0.5, 0.45),
    "toe_length_m": (0.08, 0.09),
    "shank_inertia_kgm2": (0.2, 0.18),
}

BODIES = {
    "paper": Body(),
    "dempster": Body.from_height_mass(1.75, 72.0),
    "de Leva": Body.from_height_mass(1.55, 50.0, "female"),
    "legs that differ": Body(**DIFFERENT),
    "thighs of less than m r^2": Body(thigh_inertia_kgm2=0.56),
    "moon": Body(gravity_m_s2=1.62),
}

FEET = 1e-6
"""Relative: MuJoCo's feet and toes have a mass of 1e-8 kg and an inertia of 1e-8 kg m2."""


def model(body: Body) -> Any:
    return mujoco.MjModel.from_xml_string(body_mjcf(body))


def state(body: Body, seed: int) -> tuple[Array, Array]:
    """Random absolute coordinates x, y, psi, then alpha, beta, gamma, epsilon, and their rates."""
    rng = np.random.default_rng(seed)
    return rng.uniform(-1.5, 1.5, 11), rng.uniform(-4, 4, 11)


RELATIVE = np.zeros((11, 11))
"""From absolute coordinates (hip, trunk, then alpha, beta, gamma, epsilon) to those of MuJoCo."""
RELATIVE[:3, :3] = np.eye(3)
for _leg in (3, 7):
    RELATIVE[_leg, [2, _leg]] = -1, 1
    for _joint in range(1, 4):
        RELATIVE[_leg + _joint, [_leg + _joint - 1, _leg + _joint]] = -1, 1


def qpos(body: Body, absolute: Array) -> Array:
    """Coordinates of MuJoCo: feet are flat, toes in line with the sole, where theirs are zero."""
    q = RELATIVE @ absolute
    for i, row in enumerate((3, 7)):
        phi = body.leg(i).foot_angle
        q[row + 2] += phi - np.pi / 2
        q[row + 3] -= phi
    return q


def posed(body: Body, absolute: Array, rates: Array) -> tuple[Any, Any]:
    m = model(body)
    d = mujoco.MjData(m)
    m.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    d.qpos, d.qvel = qpos(body, absolute), RELATIVE @ rates
    mujoco.mj_forward(m, d)
    return m, d


def seven(body: Body, absolute: Array, rates: Array) -> Any:
    """The motion of the seven coordinates of (1)."""
    kept = [0, 1, 2, 3, 4, 7, 8]
    return motion_of(absolute[kept], rates[kept])


@pytest.mark.parametrize("name", BODIES)
def test_masses_and_gravity_are_those_of_the_body(name: str) -> None:
    body, m = BODIES[name], model(BODIES[name])
    assert m.nq == m.nv == 11
    assert m.body_mass.sum() == pytest.approx(body.total_mass, abs=1e-7)
    assert m.opt.gravity.tolist() == [0, 0, -body.gravity_m_s2]


@pytest.mark.parametrize("name", ["dempster", "de Leva"])
def test_segments_that_are_rigid_bodies_are_left_as_they_are(name: str) -> None:
    """Mass, centre of mass and inertia of every segment, to the last digits."""
    body, m = BODIES[name], model(BODIES[name])
    parts = [("trunk", body.trunk_mass_kg, body.trunk_com_m, body.trunk_inertia_kgm2)]
    for i in (0, 1):
        leg = body.leg(i)
        parts += [
            (f"leg{i + 1}_thigh", leg.thigh_mass, -leg.thigh_com, leg.thigh_inertia),
            (f"leg{i + 1}_shank", leg.shank_mass, -leg.shank_com, leg.shank_inertia),
        ]
        assert m.body(f"leg{i + 1}_foot").mass[0] == pytest.approx(leg.foot_mass, rel=1e-12)
    for part, mass, com, inertia in parts:
        found = m.body(part)
        assert found.mass[0] == pytest.approx(mass, rel=1e-12)
        assert found.ipos == pytest.approx([0, 0, com], abs=1e-12)
        assert found.inertia[1] == pytest.approx(inertia - mass * com**2, rel=1e-9)


def test_the_papers_segments_keep_their_masses_to_one_percent() -> None:
    m, body = model(Body()), Body()
    assert m.body("trunk").mass[0] == pytest.approx(body.trunk_mass_kg, rel=2e-3)
    for part in ("thigh", "shank", "foot"):
        mass = m.body(f"leg1_{part}").mass[0]
        assert mass == pytest.approx(getattr(body.leg(0), f"{part}_mass"), rel=0.01)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", BODIES)
def test_points_of_the_feet_are_where_the_kinematics_say(name: str, seed: int) -> None:
    body = BODIES[name]
    absolute, rates = state(body, seed)
    _, d = posed(body, absolute, rates)
    hip = Point((absolute[0], absolute[1]))
    for i, row in enumerate((3, 7)):
        motion = LegMotion(*(Rotation(a) for a in absolute[row : row + 4]))
        points = leg_points(body.leg(i), motion, hip)
        for point in ("heel", "metatarsal", "toe_tip"):
            x, y, z = d.site(f"leg{i + 1}_{point}").xpos
            assert (x, z) == pytest.approx(getattr(points, point).position, abs=1e-12)
            assert y == 0
        x, _, z = d.body(f"leg{i + 1}_foot").xpos
        assert (x, z) == pytest.approx(points.ankle.position, abs=1e-12)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", BODIES)
def test_mass_matrix_is_that_of_the_equations_of_motion(name: str, seed: int) -> None:
    body = BODIES[name]
    absolute, rates = state(body, seed)
    m, d = posed(body, absolute, rates)
    relative = np.zeros((11, 11))
    mujoco.mj_fullM(m, d, relative)
    found = RELATIVE.T @ relative @ RELATIVE
    kept = [0, 1, 2, 3, 4, 7, 8]
    expected = np.array(mass_matrix(coefficients(body), seven(body, absolute, rates)), dtype=float)
    np.testing.assert_allclose(found[np.ix_(kept, kept)], expected, atol=FEET * body.total_mass)
    feet = [5, 6, 9, 10]
    assert np.max(np.abs(found[feet])) < 1e-7  # massless


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", BODIES)
def test_energies_are_those_of_the_model(name: str, seed: int) -> None:
    body = BODIES[name]
    absolute, rates = state(body, seed)
    m, d = posed(body, absolute, rates)
    mujoco.mj_energyPos(m, d)
    mujoco.mj_energyVel(m, d)
    motion = seven(body, absolute, rates)
    expected = potential_energy(body, motion), kinetic_energy(body, motion)
    assert d.energy == pytest.approx(expected, rel=FEET, abs=1e-5)  # J


@pytest.fixture(scope="module")
def replay(export) -> dict[str, Array]:
    """The exported motion, read from the CSV table, and the loads that MuJoCo finds for it.

    The reaction acts on the toes at the centre of pressure, as in the last line of (1).
    """
    table, samples = read_csv(export.text("csv")), Samples(export.gait)
    body = samples.body
    m = mujoco.MjModel.from_xml_string(export.text("mjcf"))
    d = mujoco.MjData(m)
    m.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT

    def absolute(kind: str, hip: str, unit: str) -> Array:
        lengths = {"rad": "m", "rad_s": "m_s", "rad_s2": "m_s2"}
        names = [f"hip_{hip}_{axis}_{lengths[unit]}" for axis in "xy"] + [f"trunk_{kind}_{unit}"]
        parts = ("thigh", "shank", "foot", "toes")
        names += [f"segment_{kind}_leg{leg}_{part}_{unit}" for leg in (1, 2) for part in parts]
        return np.stack([floats(table[name]) for name in names], axis=1)

    position = absolute("angle", "position", "rad")
    rate = absolute("angular_velocity", "velocity", "rad_s")
    acceleration = absolute("angular_acceleration", "acceleration", "rad_s2")
    found = np.zeros_like(position)
    for k in range(len(position)):
        d.qpos, d.qvel = qpos(body, position[k]), RELATIVE @ rate[k]
        d.qacc = RELATIVE @ acceleration[k]
        mujoco.mj_inverse(m, d)
        load = d.qfrc_inverse.copy()
        for leg in (1, 2):
            force = [float(table[f"ground_reaction_force_leg{leg}_{a}_N"][k]) for a in "xy"]
            place = table[f"center_of_pressure_leg{leg}_m"][k]
            if place:
                toes = m.body(f"leg{leg}_toes").id
                jacobian = np.zeros((3, 11))
                mujoco.mj_jac(m, d, jacobian, None, np.array([float(place), 0, 0]), toes)
                load -= jacobian.T @ [force[0], 0, force[1]]
        found[k] = load
    moments = [
        floats(table[f"joint_moment_leg{leg}_{joint}_Nm"])
        for leg in (1, 2)
        for joint in ("hip", "knee", "ankle", "metatarsal")
    ]
    return {"found": found, "moments": np.stack(moments, axis=1)}


def test_nothing_but_joints_and_ground_moves_the_walker(replay: dict[str, Array]) -> None:
    """Residual force on the hip point [N] and moment on the trunk [N m], of 700 N: 1e-3."""
    assert np.max(np.abs(replay["found"][:, :3])) < 1e-3


def test_inverse_dynamics_of_mujoco_gives_the_joint_moments(replay: dict[str, Array]) -> None:
    """All four joints of both legs at every instant, of up to 200 N m: 1e-3 N m."""
    np.testing.assert_allclose(replay["found"][:, 3:], replay["moments"], atol=1e-3)
    assert np.max(np.abs(replay["moments"])) > 80


def test_the_key_start_is_the_first_instant_with_the_heel_on_the_floor(export) -> None:
    m = mujoco.MjModel.from_xml_string(export.text("mjcf"))
    d = mujoco.MjData(m)
    mujoco.mj_resetDataKeyframe(m, d, m.key("start").id)
    mujoco.mj_forward(m, d)
    gait = export.gait
    leg = Samples(gait).body.leg(0)
    first = gait.isel(time=0)
    segments = first["segment_angle"].sel(leg=1).values
    hip, knee, ankle, toes = joint_angles(leg, float(first["trunk_angle"]), *segments)
    assert d.qpos[:3] == pytest.approx(
        [*first["hip_position"].values, float(first["trunk_angle"])], abs=1e-15
    )
    assert d.qpos[3:7] == pytest.approx([hip, -knee, ankle, toes], abs=1e-12)
    heel = d.site("leg1_heel").xpos
    assert heel[[0, 2]] == pytest.approx([0, 0], abs=1e-4)  # m, as audited
    assert max((-contact.dist for contact in d.contact), default=0.0) < 1e-4
    assert d.ncon >= 2  # the heel of leg 1, the toe tip of leg 2


def test_a_moment_on_a_motor_is_the_moment_of_the_model(export) -> None:
    m = mujoco.MjModel.from_xml_string(export.text("mjcf"))
    d = mujoco.MjData(m)
    for i in range(m.nu):
        d.ctrl[:] = 0
        d.ctrl[i] = 7.0
        mujoco.mj_forward(m, d)
        name = m.actuator(i).name
        expected = np.zeros(11)
        expected[m.joint(name).dofadr[0]] = 7.0
        assert d.qfrc_actuator.tolist() == expected.tolist()


def test_mass_moved_across_a_joint_leaves_the_segments_positive() -> None:
    """The paper's trunk and shank have central inertias of -0.007 and -0.0007 kg m2."""
    body = Body()
    assert body.trunk_inertia_kgm2 - body.trunk_mass_kg * body.trunk_com_m**2 < 0
    parts = rigid(body)
    for rod in (parts.trunk, parts.legs[0].thigh, parts.legs[0].shank):
        assert rod.central_inertia > 0
    moved = parts.trunk.mass - body.trunk_mass_kg
    assert 0 < moved < 0.1  # kg


@st.composite
def body_fields(draw: st.DrawFn) -> dict[str, Any]:
    """A body with unlike legs around the paper's; inertias from a hair below m r^2 up."""
    scale = st.floats(0.7, 1.4)
    fields: dict[str, Any] = {}
    for part in ("trunk", "thigh", "shank"):
        count = 1 if part == "trunk" else 2
        mass = [draw(scale) * getattr(Body(), f"{part}_mass_kg") for _ in range(count)]
        com = [draw(scale) * getattr(Body(), f"{part}_com_m") for _ in range(count)]
        inertia = [draw(st.floats(0.99, 1.3)) * m * r**2 for m, r in zip(mass, com, strict=True)]
        for name, value in (("mass_kg", mass), ("com_m", com), ("inertia_kgm2", inertia)):
            fields[f"{part}_{name}"] = value[0] if part == "trunk" else tuple(value)
    return fields


@given(fields=body_fields())
def test_moving_mass_changes_no_constant_of_the_equations_of_motion(fields: dict[str, Any]) -> None:
    """M, K_r, J and of each leg K_a, K_b, J_i, J_c, of the rigid parts by themselves."""
    try:
        body = Body(**fields)
        parts = rigid(body)
    except BodyError:
        assume(False)
    c = coefficients(body)
    assert parts.trunk.moment == pytest.approx(c.K_r, rel=1e-12)
    assert parts.trunk.inertia == pytest.approx(c.J, rel=1e-12)
    total = parts.trunk.mass
    for i, (leg, expected) in enumerate(zip(parts.legs, c.legs, strict=True)):
        a, b = body.leg(i).thigh_length, body.leg(i).shank_length
        below = leg.shank.mass + leg.foot_mass
        total += leg.thigh.mass + below
        assert min(leg.thigh.central_inertia, leg.shank.central_inertia, leg.foot_mass) > 0
        assert leg.thigh.moment + a * below == pytest.approx(expected.K_a, rel=1e-12)
        assert leg.shank.moment + b * leg.foot_mass == pytest.approx(expected.K_b, rel=1e-12)
        assert leg.thigh.inertia + a**2 * below == pytest.approx(expected.J_i, rel=1e-12)
        assert leg.shank.inertia + b**2 * leg.foot_mass == pytest.approx(expected.J_c, rel=1e-12)
    assert total == pytest.approx(c.M, rel=1e-12)


def smallest(field: str) -> Body:
    """The paper's body with the smallest inertia that its mass matrix allows, to ten digits."""
    low, high = 0.0, getattr(Body(), field)
    while high - low > 1e-10 * high:
        middle = (low + high) / 2
        given_: dict[str, Any] = {field: middle}
        try:
            Body(**given_)
            high = middle
        except BodyError:
            low = middle
    given_ = {field: high}
    return Body(**given_)


@pytest.mark.parametrize("field", ["trunk_inertia_kgm2", "thigh_inertia_kgm2"])
def test_a_body_that_no_rigid_bodies_make_is_refused(field: str) -> None:
    with pytest.raises(
        BodyError, match=": is too small (for a rigid body|to lend).*; (give|raise)"
    ):
        body_mjcf(smallest(field))
