"""The five-link walker that the benchmark gives to every program."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

PEERS = Path(__file__).resolve().parents[1] / "benchmarks" / "peers"
NAMES = ("five_link", "peer", "five_link_ours", "five_link_casadi")


@pytest.fixture(scope="module")
def peers() -> Iterator[dict[str, ModuleType]]:
    """The benchmark's own modules, which are scripts beside one another."""
    sys.path.insert(0, str(PEERS))
    yield {name: importlib.import_module(name) for name in NAMES}
    sys.path.remove(str(PEERS))
    for name in NAMES:
        sys.modules.pop(name, None)


def centres(walker: ModuleType, q: np.ndarray) -> np.ndarray:
    """Centres of mass (5, 2) [m], joint by joint along the chain."""
    along = np.stack([-np.sin(q), np.cos(q)], axis=1)
    knee = walker.LENGTH[0] * along[0]
    hip = knee + walker.LENGTH[1] * along[1]
    other_knee = hip - walker.LENGTH[3] * along[3]
    ends = (knee, hip, hip, hip, other_knee)
    signs = (-1, -1, 1, -1, -1)
    return np.array(
        [e + s * c * a for e, s, c, a in zip(ends, signs, walker.COM, along, strict=True)]
    )


def slope(function, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Derivative along v, by central differences."""
    h = 1e-6
    return (function(q + h * v) - function(q - h * v)) / (2 * h)


def test_power_of_the_moments_is_the_change_of_energy(peers: dict[str, ModuleType]) -> None:
    walker, chance = peers["five_link"], np.random.default_rng(3)
    q, v, u = chance.uniform(-1, 1, 5), chance.uniform(-3, 3, 5), chance.uniform(-20, 20, 5)

    def residual(a: np.ndarray) -> np.ndarray:
        return np.array(walker.equations(q, v, a, u, np.sin, np.cos))

    rest = residual(np.zeros(5))
    a = -np.linalg.solve(np.stack([residual(e) - rest for e in np.eye(5)], axis=1), rest)

    def energy(t: float) -> float:
        """Kinetic and potential energy [J] on the parabola that the motion touches."""
        at, rate = q + t * v + t**2 / 2 * a, v + t * a
        velocity = slope(lambda x: centres(walker, x), at, rate)
        kinetic = walker.MASS @ (velocity**2).sum(axis=1) + walker.INERTIA @ rate**2
        return kinetic / 2 + walker.GRAVITY * walker.MASS @ centres(walker, at)[:, 1]

    relative = np.diff(v, prepend=0.0)
    assert (energy(1e-4) - energy(-1e-4)) / 2e-4 == pytest.approx(u @ relative, rel=1e-5)


def test_heel_strike_keeps_the_momentum_about_the_new_contact(
    peers: dict[str, ModuleType],
) -> None:
    walker, chance = peers["five_link"], np.random.default_rng(4)
    q, before = chance.uniform(-0.6, 0.6, 5), chance.uniform(-3, 3, 5)
    zero = np.zeros(5)
    rest = np.array(walker.strike(q, before, zero, np.cos))
    matrix = np.stack([walker.strike(q, zero, e, np.cos) for e in np.eye(5)], axis=1)
    after = np.linalg.solve(matrix, -rest)[::-1]  # counted as before the strike
    contact = np.array(walker.foot(q, np.sin, np.cos))

    def momentum(places, velocities: np.ndarray, rates: np.ndarray) -> float:
        arm = places - contact
        spin = arm[:, 0] * velocities[:, 1] - arm[:, 1] * velocities[:, 0]
        return float(walker.MASS @ spin + walker.INERTIA @ rates)

    def about_new_contact(x: np.ndarray) -> np.ndarray:
        return centres(walker, x) - np.array(walker.foot(x, np.sin, np.cos))

    places = centres(walker, q)
    earlier = momentum(places, slope(lambda x: centres(walker, x), q, before), before)
    later = momentum(places, slope(about_new_contact, q, after), after)
    assert later == pytest.approx(earlier, rel=1e-6)


@pytest.mark.parametrize("variant", ["impact", "posture"])
def test_two_programs_find_the_same_optimum(peers: dict[str, ModuleType], variant: str) -> None:
    start = peers["five_link"].start(None)
    ours, other = (
        peers[name].build(variant, 6)(start) for name in ("five_link_ours", "five_link_casadi")
    )
    assert ours.converged
    assert other.converged
    assert ours.effort == pytest.approx(other.effort, rel=1e-5)  # both are off by about as much
