"""The walker as rigid bodies with positive inertia, moving exactly like the model.

A segment enters the equations of motion (1) through three numbers: mass, mass times distance of
its centre, inertia about its proximal joint. The paper's, rounded in print, leave trunk and shank
an inertia about the centre of mass that is a hair below zero, which no rigid body has. But a mass
point in a joint belongs to either of its segments without any change to (1): so a little mass is
moved across a joint to the segment that needs it.
"""

from __future__ import annotations

from dataclasses import dataclass

from ergowalk.body import Body, LegParameters
from ergowalk.errors import BodyError

SLENDER = 1e-4
"""Least inertia about the centre of mass, as a part of that about the proximal joint."""


@dataclass(frozen=True)
class Rod:
    """A segment: ``mass`` [kg], ``moment`` = mass times distance of its centre of mass from the
    proximal joint [kg m], ``inertia`` about that joint [kg m2]."""

    mass: float
    moment: float
    inertia: float

    @property
    def com(self) -> float:
        """Distance of the centre of mass from the proximal joint [m]."""
        return self.moment / self.mass

    @property
    def central_inertia(self) -> float:
        """Inertia about the centre of mass [kg m2]."""
        return self.inertia - self.moment**2 / self.mass

    def with_point(self, mass: float, distance: float) -> Rod:
        """With a mass point [kg] at a distance [m] from the proximal joint; negative: without."""
        return Rod(
            self.mass + mass, self.moment + mass * distance, self.inertia + mass * distance**2
        )

    def lacks(self, distance: float) -> float:
        """Mass [kg] that must go to a point at ``distance`` [m] so that the central inertia is
        :data:`SLENDER` of the inertia; zero where nothing must."""
        least = SLENDER * self.inertia
        missing = self.mass * (least - self.central_inertia)
        if missing <= 0:
            return 0.0
        gain = self.inertia + self.mass * distance**2 - 2 * self.moment * distance - least
        return missing / gain if gain > 0 else float("inf")


@dataclass(frozen=True)
class RigidLeg:
    """Thigh and shank of one leg, and the mass point of its foot at the ankle [kg]."""

    thigh: Rod
    shank: Rod
    foot_mass: float


@dataclass(frozen=True)
class RigidBody:
    """Trunk and legs with positive inertia."""

    trunk: Rod
    legs: tuple[RigidLeg, RigidLeg]


def rigid(body: Body) -> RigidBody:
    """The same walker with positive inertia about every centre of mass.

    Raises
    ------
    BodyError
        If no shift of mass across hip, knee and ankle makes all of them positive.
    """
    m, r = body.trunk_mass_kg, body.trunk_com_m
    trunk = Rod(m, m * r, body.trunk_inertia_kgm2)
    lifted = trunk.lacks(0.0)
    legs = tuple(_leg(body.leg(i), lifted / 2) for i in (0, 1))
    found = RigidBody(trunk.with_point(lifted, 0.0), (legs[0], legs[1]))
    rods = [("trunk", found.trunk)]
    rods += [(name, getattr(leg, name)) for leg in legs for name in ("thigh", "shank")]
    for name, rod in rods:
        if not (0 < rod.mass < float("inf") and rod.central_inertia > 0):
            raise BodyError(
                "is too small for a rigid body with this mass and centre of mass",
                "give the mass times the square of the distance to the centre of mass, or more",
                field=f"{name}_inertia_kgm2",
                value=getattr(body, f"{name}_inertia_kgm2"),
            )
    for leg in legs:
        if leg.foot_mass <= 0:
            raise BodyError(
                "is too small to lend the shank what it lacks for a rigid body",
                "raise shank_inertia_kgm2",
                field="foot_mass_kg",
                value=body.foot_mass_kg,
            )
    return found


def _leg(leg: LegParameters, lifted: float) -> RigidLeg:
    """A leg that gives ``lifted`` [kg] at the hip to the trunk."""
    thigh = Rod(leg.thigh_mass, leg.thigh_mass * leg.thigh_com, leg.thigh_inertia)
    shank = Rod(leg.shank_mass, leg.shank_mass * leg.shank_com, leg.shank_inertia)
    thigh = thigh.with_point(-lifted, 0.0)
    from_knee = thigh.lacks(leg.thigh_length)
    thigh, shank = thigh.with_point(from_knee, leg.thigh_length), shank.with_point(-from_knee, 0.0)
    from_ankle = shank.lacks(leg.shank_length)
    shank = shank.with_point(from_ankle, leg.shank_length)
    return RigidLeg(thigh, shank, leg.foot_mass - from_ankle)
