"""Programmes with common unknowns: the weighted sum of all is least, whatever each would like."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from ergowalk.nlp import Block, Kernel, NonlinearProgramme
from ergowalk.solvers.ipopt import Ipopt, Minimum
from ergowalk.solving.joint import Part, joined

ROOM = 10.0


def quadratic(wish: float, *, common_first: bool = True) -> NonlinearProgramme:
    """(s - wish)^2 + y^2 subject to y >= s - wish, so that y = max(s - wish, 0)."""
    s, y = ca.SX.sym("s"), ca.SX.sym("y")
    kernel = Kernel(
        "toy", ca.vertcat(s, y), ca.SX.sym("none", 0), (s - wish) ** 2 + y**2, y - s + wish
    )
    order = [0, 1] if common_first else [1, 0]
    block = Block(
        kernel,
        np.array(order)[:, None],
        np.zeros((0, 1)),
        np.zeros(1),
        np.full(1, np.inf),
        ("row",),
    )
    return NonlinearProgramme(np.full(2, -ROOM), np.full(2, ROOM), [block])


def part(wish: float, weight: float, *, common_first: bool = True) -> Part:
    programme = quadratic(wish, common_first=common_first)
    place = 0 if common_first else 1
    return Part(programme, solved(programme), weight, np.array([place]))


def solved(programme: NonlinearProgramme) -> Minimum:
    return Ipopt(tolerance=1e-10).minimise(programme, np.zeros(programme.size))


@pytest.mark.parametrize(("one", "other"), [(1.0, 1.0), (3.0, 1.0), (0.1, 2.0)])
def test_the_common_unknown_is_where_the_weighted_sum_is_least(one: float, other: float) -> None:
    """w1 ((s - 1)^2 + (s - 1)^2) + w2 (s - 4)^2 for s in [1, 4]: above a wish y costs as much."""
    whole = joined([part(1.0, one), part(4.0, other, common_first=False)])
    found = solved(whole.programme)
    assert found.converged
    assert found.x[0] == pytest.approx((2 * one + 4 * other) / (2 * one + other), abs=1e-6)
    assert found.x[1] == pytest.approx(found.x[0] - 1.0, abs=1e-6)


def test_it_begins_at_the_minima_of_its_parts() -> None:
    parts = [part(1.0, 3.0), part(4.0, 1.0)]
    whole = joined(parts)
    assert whole.start[0] == pytest.approx((3 * 1.0 + 4.0) / 4, abs=1e-4)
    assert whole.start[1:] == pytest.approx([p.minimum.x[1] for p in parts])
    assert len(whole.multipliers[1]) == len(whole.programme.labels)


def test_one_part_alone_is_itself() -> None:
    alone = part(2.0, 1.0)
    again = solved(joined([alone]).programme)
    assert again.x == pytest.approx(alone.minimum.x, abs=1e-7)


def test_bounds_without_common_room_are_refused() -> None:
    low, high = part(0.0, 1.0), part(1.0, 1.0)
    programme = NonlinearProgramme(np.full(2, 20.0), np.full(2, 30.0), high.programme.blocks)
    far = Part(programme, high.minimum, 1.0, high.common)
    with pytest.raises(ValueError, match="no common room"):
        joined([low, far])
