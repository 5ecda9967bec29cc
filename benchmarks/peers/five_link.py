"""The five-link walker that all programs are given: numbers, equations, boundaries, starts.

Nothing but the standard library and NumPy, so that every peer can import it in its own
environment; sine and cosine are handed in, so the same lines make numbers, CasADi and SymPy.

Model and data: M. Kelly, "An Introduction to Trajectory Optimization: How to Do Your Own Direct
Collocation", SIAM Review 59(4), 2017, section 6; masses and lengths are those of the robot RABBIT.
Angles are absolute, zero upright, positive counter-clockwise. Links: stance shank, stance thigh,
trunk, swing thigh, swing shank. Moments: on the stance shank from the ground, then at stance knee,
stance hip, swing hip, swing knee, each on the link that is farther from the stance foot.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

LINKS = 5
LENGTH = np.array([0.4, 0.4, 0.625, 0.4, 0.4])
"""Lengths of the links [m]."""
MASS = np.array([3.2, 6.8, 20.0, 6.8, 3.2])
"""Masses of the links [kg]."""
COM = np.array([0.128, 0.163, 0.2, 0.163, 0.128])
"""Centres of mass [m] from the joint nearer to the hip: knee, hip, hip, hip, knee."""
INERTIA = np.array([0.93, 1.08, 2.22, 1.08, 0.93])
"""Moments of inertia about the centres of mass [kg m2]."""
GRAVITY = 9.81
"""[m/s2]"""
STEP_LENGTH = 0.5
"""[m]"""
STEP_TIME = 0.7
"""[s]"""
EFFORT_SCALE = 1000.0
"""Every program minimises the effort divided by this [N2 m2 s], so that tolerances compare."""

VARIANTS = ("impact", "posture")
"""``impact``: Kelly's periodic step with heel strike. ``posture``: state given at both ends."""

START_STATE = (
    np.array([0.50, 0.08, -0.16, -0.36, -0.35]),
    np.array([-2.6, 0.5, -0.2, -0.7, -1.2]),
)
"""Angles [rad] and rates [rad/s] at the start of the variant ``posture``: those of the cheapest
``impact`` step, rounded, so that the effort is as small."""
END_STATE = (
    np.array([-0.35, -0.36, -0.16, 0.08, 0.50]),
    np.array([-1.4, -1.7, 0.6, 4.0, -2.2]),
)
"""The same at its end."""

GUESS = np.array([-0.3, 0.7, 0.0, -0.5, -0.6])
"""Angles [rad] at the start of Kelly's starting guess; at its end the legs are exchanged."""

Scalar = Any
Function = Callable[[Scalar], Scalar]


def _directions() -> tuple[np.ndarray, np.ndarray]:
    """Factors [m] of the links' unit vectors: centres of mass (5, 5), swing foot (5,)."""
    at_com = np.zeros((LINKS, LINKS))
    at_com[0, 0] = LENGTH[0] - COM[0]
    at_com[1, :2] = LENGTH[0], LENGTH[1] - COM[1]
    at_com[2, :3] = LENGTH[0], LENGTH[1], COM[2]
    at_com[3, [0, 1, 3]] = LENGTH[0], LENGTH[1], -COM[3]
    at_com[4, [0, 1, 3, 4]] = LENGTH[0], LENGTH[1], -LENGTH[3], -COM[4]
    at_foot = np.array([LENGTH[0], LENGTH[1], 0.0, -LENGTH[3], -LENGTH[4]])
    return at_com, at_foot


AT_COM, AT_FOOT = _directions()
WEIGHTED = MASS[:, None] * AT_COM
INERTIAL = AT_COM.T @ WEIGHTED + np.diag(INERTIA)
"""Mass matrix [kg m2] but for the cosines of the angles between links."""
GRAVITATIONAL = GRAVITY * WEIGHTED.sum(axis=0)
"""Moments of gravity [N m] but for the sines of the angles."""
AFTER = (AT_COM - AT_FOOT).T @ (MASS[:, None] * (AT_COM - AT_FOOT)) + np.diag(INERTIA)
BEFORE = (AT_COM - AT_FOOT).T @ WEIGHTED + np.diag(INERTIA)
"""Momentum [kg m2] after and before heel strike but for cosines; the new contact stays where it is,
so motions about it see no impulse."""


def equations(
    q: Sequence[Scalar],
    v: Sequence[Scalar],
    a: Sequence[Scalar],
    u: Sequence[Scalar],
    sin: Function,
    cos: Function,
) -> list[Scalar]:
    """Equations of motion, five moments [N m] that are zero.

    ``q``, ``v``, ``a`` are angles [rad], rates [rad/s], accelerations [rad/s2] and ``u`` the joint
    moments [N m].
    """
    rows = []
    for i in range(LINKS):
        row = -GRAVITATIONAL[i] * sin(q[i]) - u[i]
        if i + 1 < LINKS:
            row = row + u[i + 1]
        for j in range(LINKS):
            if INERTIAL[i, j] == 0.0:
                continue
            if i == j:
                row = row + INERTIAL[i, i] * a[i]
            else:
                apart = q[i] - q[j]
                row = row + INERTIAL[i, j] * (cos(apart) * a[j] + sin(apart) * v[j] ** 2)
        rows.append(row)
    return rows


def foot(q: Sequence[Scalar], sin: Function, cos: Function) -> tuple[Scalar, Scalar]:
    """Swing foot [m] from the stance foot, forward and up."""
    forward = sum(-AT_FOOT[i] * sin(q[i]) for i in range(LINKS) if AT_FOOT[i])
    up = sum(AT_FOOT[i] * cos(q[i]) for i in range(LINKS) if AT_FOOT[i])
    return forward, up


def strike(
    q: Sequence[Scalar], before: Sequence[Scalar], after: Sequence[Scalar], cos: Function
) -> list[Scalar]:
    """Heel strike in the posture ``q`` [rad]: five momenta [N m s] that are zero.

    ``before`` are the rates [rad/s] before it, ``after`` those of the next step at its start: there
    the links are counted from the new stance foot.
    """
    rows = []
    for i in range(LINKS):
        row: Scalar = 0.0
        for j in range(LINKS):
            turn = 1.0 if i == j else cos(q[i] - q[j])
            row = row + turn * (AFTER[i, j] * after[LINKS - 1 - j] - BEFORE[i, j] * before[j])
        rows.append(row)
    return rows


@dataclass(frozen=True)
class Start:
    """A guess: angles [rad], rates [rad/s], moments [N m] at instants (n,), each (n, 5)."""

    ends: tuple[np.ndarray, np.ndarray]
    bulges: np.ndarray
    moments: np.ndarray

    def angles(self, t: np.ndarray) -> np.ndarray:
        """Angles: a line from end to end, and one arch."""
        s = np.asarray(t)[:, None] / STEP_TIME
        return self.ends[0] + s * (self.ends[1] - self.ends[0]) + self.bulges * np.sin(np.pi * s)

    def rates(self, t: np.ndarray) -> np.ndarray:
        """Their time derivative."""
        s = np.asarray(t)[:, None] / STEP_TIME
        slope = self.ends[1] - self.ends[0] + np.pi * self.bulges * np.cos(np.pi * s)
        return slope / STEP_TIME

    def accelerations(self, t: np.ndarray) -> np.ndarray:
        """Their second time derivative [rad/s2]."""
        s = np.asarray(t)[:, None] / STEP_TIME
        return -((np.pi / STEP_TIME) ** 2) * self.bulges * np.sin(np.pi * s)

    def controls(self, t: np.ndarray) -> np.ndarray:
        """Moments, constant."""
        return np.repeat(self.moments[None, :], len(np.asarray(t)), axis=0)


def start(seed: int | None) -> Start:
    """Kelly's guess, a straight line without moments; with a seed, disturbed at random.

    Ends and arch are disturbed with 0.25 rad, moments with 20 N m standard deviation.
    """
    ends = (GUESS, GUESS[::-1])
    zero = np.zeros(LINKS)
    if seed is None:
        return Start(ends, zero, zero)
    chance = np.random.default_rng(seed)
    disturbed = tuple(end + 0.25 * chance.standard_normal(LINKS) for end in ends)
    return Start(
        (disturbed[0], disturbed[1]),
        0.25 * chance.standard_normal(LINKS),
        20.0 * chance.standard_normal(LINKS),
    )
