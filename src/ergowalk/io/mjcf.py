"""The walker for MuJoCo: its body in MJCF, standing as the gait begins.

x is forward, z up; all joints turn about -y, counter-clockwise seen from the right, so that a
motor's torque is the joint moment of the model. ``qpos`` is hip x, hip z, psi, then for each leg
alpha - psi, beta - alpha, the ankle angle mu_a and the toe angle epsilon - gamma - phi_m.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from xml.etree import ElementTree as Xml

import xarray as xr

from ergowalk import __version__
from ergowalk.body import Body, LegParameters
from ergowalk.comparison import body_of, curve
from ergowalk.io.rigid import RigidLeg, Rod, rigid
from ergowalk.mechanics.kinematics import joint_angles, joint_rates
from ergowalk.quantities import JOINTS, LEGS, SEGMENTS, TRUNK_DRAWN

FOOT_INERTIA, TOE_MASS = 1e-8, 1e-8
"""Inertia of foot and toes [kg m2] and mass of the toes [kg]. The model's have none; MuJoCo asks
for some. At the accelerations of walking these make moments below 1e-4 N m."""

CONTACT_RADIUS = 0.005
"""Radius of the spheres in heel, metatarsal joint and toe tip that touch the floor [m]; the floor
lies that much below y = 0, so that they touch where the points of the model do."""

THICKNESS = 0.03
"""Radius of the drawn segments [m]."""


def mjcf(dataset: xr.Dataset) -> str:
    """The walker of a gait in MJCF, with the first instant of the gait as key ``start``.

    Parameters
    ----------
    dataset : xarray.Dataset
        A gait in the format of ``gait.nc``.

    Raises
    ------
    GaitFileError, BodyError
        If a variable or an attribute is missing or not usable, or its body has no rigid bodies.
    """
    body = body_of(dataset)
    return body_mjcf(body, _start(dataset, body))


def body_mjcf(body: Body, start: tuple[Sequence[float], Sequence[float]] | None = None) -> str:
    """A body in MJCF.

    Mass matrix, energies and joint moments are those of the model. Where an inertia about a
    centre of mass would not be positive, a little mass is moved across a joint, which changes
    none of them: see :mod:`ergowalk.io.rigid`.

    Parameters
    ----------
    body : Body
    start : (qpos, qvel), optional
        State of the key ``start``.

    Raises
    ------
    BodyError
        If no rigid bodies move like this body.
    """
    root = Xml.Element("mujoco", model="ergowalk")
    root.append(Xml.Comment(f" Written by ergowalk {__version__}: x forward, z up, SI units. "))
    _add(root, "compiler", angle="radian", inertiafromgeom="false", autolimits="true")
    _add(root, "option", gravity=_text((0, 0, -body.gravity_m_s2)), timestep="0.0005")
    default = _add(root, "default")
    _add(default, "geom", contype="0", conaffinity="0", group="1", rgba="0.4 0.5 0.7 1")
    _add(default, "joint", axis="0 -1 0", limited="false")
    world = _add(root, "worldbody")
    floor = {"type": "plane", "size": "0 0 1", "conaffinity": "1", "rgba": "0.85 0.85 0.85 1"}
    _add(world, "geom", name="floor", pos=_text((0, 0, -CONTACT_RADIUS)), **floor)
    _add(world, "light", pos="0 0 4", directional="true")
    _walker(world, body)
    actuators = _add(root, "actuator")
    for leg in LEGS:
        for joint in JOINTS:
            _add(actuators, "motor", name=f"leg{leg}_{joint}", joint=f"leg{leg}_{joint}")
    if start is not None:
        keys = _add(root, "keyframe")
        _add(keys, "key", name="start", qpos=_text(start[0]), qvel=_text(start[1]))
    Xml.indent(root)
    return Xml.tostring(root, encoding="unicode") + "\n"


def _walker(world: Xml.Element, body: Body) -> None:
    """Trunk on two slides and a hinge, and the legs below it."""
    parts = rigid(body)
    trunk = _add(world, "body", name="trunk")
    _add(trunk, "joint", name="hip_x", type="slide", axis="1 0 0")
    _add(trunk, "joint", name="hip_z", type="slide", axis="0 0 1")
    _add(trunk, "joint", name="trunk", type="hinge")
    _inertial(trunk, parts.trunk, 1.0)
    _drawn(trunk, (0, 0, TRUNK_DRAWN * body.trunk_com_m), 2 * THICKNESS)
    for i, leg in enumerate(LEGS):
        _leg(trunk, f"leg{leg}", body.leg(i), parts.legs[i])


def _leg(trunk: Xml.Element, name: str, leg: LegParameters, parts: RigidLeg) -> None:
    thigh = _hinged(trunk, f"{name}_thigh", f"{name}_hip", (0, 0, 0))
    _inertial(thigh, parts.thigh, -1.0)
    _drawn(thigh, (0, 0, -leg.thigh_length))
    shank = _hinged(thigh, f"{name}_shank", f"{name}_knee", (0, 0, -leg.thigh_length))
    _inertial(shank, parts.shank, -1.0)
    _drawn(shank, (0, 0, -leg.shank_length))
    foot = _hinged(shank, f"{name}_foot", f"{name}_ankle", (0, 0, -leg.shank_length))
    _point_mass(foot, parts.foot_mass)
    ball = (
        leg.ankle_to_metatarsal * math.cos(leg.foot_angle),
        0,
        -leg.ankle_to_metatarsal * math.sin(leg.foot_angle),
    )
    heel = (ball[0] - leg.heel_to_metatarsal, 0, ball[2])
    _contact(foot, f"{name}_heel", heel)
    _contact(foot, f"{name}_metatarsal", ball)
    _drawn(foot, ball, THICKNESS / 2)
    _drawn(foot, heel, THICKNESS / 2)
    _drawn(foot, ball, THICKNESS / 4, heel)
    toes = _hinged(foot, f"{name}_toes", f"{name}_metatarsal", ball)
    _point_mass(toes, TOE_MASS)
    tip = (leg.toe_length, 0, 0)
    _contact(toes, f"{name}_toe_tip", tip)
    _drawn(toes, tip, THICKNESS / 2)


def _hinged(parent: Xml.Element, name: str, joint: str, place: Sequence[float]) -> Xml.Element:
    body = _add(parent, "body", name=name, pos=_text(place))
    _add(body, "joint", name=joint, type="hinge")
    return body


def _inertial(body: Xml.Element, rod: Rod, up: float) -> None:
    """Inertia of a segment along z; only that about y matters in the plane."""
    about = rod.central_inertia
    _add(
        body,
        "inertial",
        pos=_text((0, 0, up * rod.com)),
        mass=_text((rod.mass,)),
        diaginertia=_text((about, about, about / 10)),
    )


def _point_mass(body: Xml.Element, mass: float) -> None:
    inertia = _text((FOOT_INERTIA,) * 3)
    _add(body, "inertial", pos="0 0 0", mass=_text((mass,)), diaginertia=inertia)


def _contact(body: Xml.Element, name: str, place: Sequence[float]) -> None:
    """A point of the foot: a site to be found by name, and a small sphere that meets the floor."""
    _add(body, "site", name=name, pos=_text(place), size=_text((CONTACT_RADIUS,)))
    _add(body, "geom", type="sphere", pos=_text(place), size=_text((CONTACT_RADIUS,)), contype="1")


def _drawn(
    body: Xml.Element,
    end: Sequence[float],
    radius: float = THICKNESS,
    start: Sequence[float] = (0, 0, 0),
) -> None:
    line = _text((*start, *end))
    _add(body, "geom", type="capsule", fromto=line, size=_text((radius,)))


def _start(dataset: xr.Dataset, body: Body) -> tuple[list[float], list[float]]:
    """``qpos`` and ``qvel`` at the first instant."""

    def first(variable: str, **labels: int | str) -> float:
        return float(curve(dataset, variable, labels)[0])

    position = [first("hip_position", axis=axis) for axis in "xy"]
    velocity = [first("hip_velocity", axis=axis) for axis in "xy"]
    trunk, spin = first("trunk_angle"), first("trunk_angular_velocity")
    position.append(trunk)
    velocity.append(spin)
    for i, leg in enumerate(LEGS):
        angles = [first("segment_angle", leg=leg, segment=s) for s in SEGMENTS]
        rates = [first("segment_angular_velocity", leg=leg, segment=s) for s in SEGMENTS]
        hip, knee, ankle, toes = joint_angles(body.leg(i), trunk, *angles)
        position += [hip, -knee, ankle, toes]  # the knee's hinge extends
        velocity += joint_rates(spin, *rates)
    return position, velocity


def _add(parent: Xml.Element, tag: str, **attributes: str) -> Xml.Element:
    return Xml.SubElement(parent, tag, attributes)


def _text(values: Sequence[float]) -> str:
    return " ".join(repr(float(value)) for value in values)  # every digit
