"""Where the feet stand: (4) and (5)."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ergowalk.body import Body
from ergowalk.gait.footprints import Footprint, footprint, leading_print, trailing_print

LAW = settings(deadline=None, max_examples=50, derandomize=True, database=None)

BODY = Body(heel_to_metatarsal_m=(0.2, 0.25), toe_length_m=(0.1, 0.12))


def test_leading_foot_lands_at_the_origin() -> None:
    assert leading_print(BODY.leg(0)) == Footprint(0.0, 0.2, 0.2 + 0.1)


def test_trailing_foot_stands_one_step_behind() -> None:
    """x_m2(0) = -L + l_h, (5)."""
    found = trailing_print(BODY.leg(1), 0.76)
    assert found.heel == -0.76
    assert found.metatarsal == pytest.approx(-0.76 + 0.25)
    assert found.toe_tip == pytest.approx(-0.76 + 0.25 + 0.12)


@LAW
@given(st.floats(-10, 10), st.floats(0.1, 1.5))
def test_next_print_of_a_foot_is_a_stride_further(heel: float, step: float) -> None:
    leg = BODY.leg(0)
    first, second = footprint(leg, heel), footprint(leg, heel + 2 * step)
    assert second.heel - first.heel == pytest.approx(2 * step, abs=1e-12)
    assert second.metatarsal - first.metatarsal == pytest.approx(2 * step, abs=1e-12)
    assert second.toe_tip - first.toe_tip == pytest.approx(2 * step, abs=1e-12)


@LAW
@given(st.floats(0.1, 1.5))
def test_other_leg_repeats_the_print_a_step_further(step: float) -> None:
    """The mirrored second half stride: leg 2's heel lands at L when leg 1's is at 0."""
    leg = Body().leg(0)
    behind, ahead = trailing_print(leg, step), leading_print(leg)
    for point in ("heel", "metatarsal", "toe_tip"):
        assert getattr(ahead, point) - getattr(behind, point) == pytest.approx(step, abs=1e-12)
