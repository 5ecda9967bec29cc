"""Meshes of the half stride: counts, gradings, minima."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ergowalk.gait.rhythm import (
    PRINTED_RHYTHM,
    Contact,
    PhaseOrder,
    Rhythm,
    boundary_fractions,
    half_stride_phases,
)
from ergowalk.transcription.mesh import cut, finer, graded, walking_mesh

LAW = settings(deadline=None, max_examples=50, derandomize=True, database=None)

STRIDE = 1.14
RHYTHMS = {
    PhaseOrder.TOE_OFF_FIRST: PRINTED_RHYTHM,
    PhaseOrder.FLAT_FIRST: Rhythm(heel_end=0.08, heel_off=0.23, toe_off=0.62),
}


def mesh(order: PhaseOrder, level: float, stride: float = STRIDE) -> tuple[np.ndarray, ...]:
    times = {n: f * stride for n, f in boundary_fractions(RHYTHMS[order]).items()}
    return walking_mesh(order, times, stride, level)


def counts(order: PhaseOrder, level: float) -> list[int]:
    return [len(edges) - 1 for edges in mesh(order, level)]


@LAW
@given(st.sampled_from(PhaseOrder), st.floats(0.05, 4))
def test_every_phase_is_cut_from_beginning_to_end(order: PhaseOrder, level: float) -> None:
    phases = mesh(order, level)
    assert len(phases) == 4
    for edges in phases:
        assert (edges[0], edges[-1]) == (0.0, 1.0)
        assert np.all(np.diff(edges) > 0)


@LAW
@given(st.sampled_from(PhaseOrder), st.floats(0.05, 4), st.floats(1.0, 3.0))
def test_a_higher_level_has_no_fewer_elements_anywhere(
    order: PhaseOrder, level: float, factor: float
) -> None:
    coarse, fine = counts(order, level), counts(order, level * factor)
    assert all(a <= b for a, b in zip(coarse, fine, strict=True))


@pytest.mark.parametrize("order", PhaseOrder)
def test_twice_the_level_has_twice_the_elements(order: PhaseOrder) -> None:
    one, two = counts(order, 2.0), counts(order, 4.0)
    assert all(2 * a - 2 < b <= 2 * a for a, b in zip(one, two, strict=True))


@pytest.mark.parametrize("order", PhaseOrder)
def test_every_phase_gets_its_minimum_however_coarse_the_mesh(order: PhaseOrder) -> None:
    least = counts(order, 1e-9)
    assert least == counts(order, 1e-3)
    assert min(least) >= 3
    short = {n: f * STRIDE for n, f in boundary_fractions(Rhythm(0.1, 0.102, 0.599)).items()}
    at_least = dict(zip(half_stride_phases(PhaseOrder.TOE_OFF_FIRST), least, strict=True))
    if order is PhaseOrder.TOE_OFF_FIRST:
        found = walking_mesh(order, short, STRIDE, 0.3)
        for (phase, count), edges in zip(at_least.items(), found, strict=True):
            if phase.legs in ((Contact.HEEL, Contact.SWING), (Contact.FLAT, Contact.SWING)):
                assert len(edges) - 1 == count  # 0.001 and 0.002 of the stride


@pytest.mark.parametrize("order", PhaseOrder)
def test_elements_are_smaller_while_both_feet_carry(order: PhaseOrder) -> None:
    """Most of the error of E sits where the load passes from leg to leg."""
    fractions = boundary_fractions(RHYTHMS[order])
    sizes: dict[bool, list[float]] = {True: [], False: []}
    for phase, edges in zip(half_stride_phases(order), mesh(order, 1.0), strict=True):
        share = fractions[phase.end] - fractions[phase.start]
        sizes[phase.double_support].append(share / (len(edges) - 1))
    assert max(sizes[True]) < np.mean(sizes[False])


def test_the_mesh_does_not_depend_on_the_unit_of_time() -> None:
    for order in PhaseOrder:
        for one, two in zip(mesh(order, 0.7), mesh(order, 0.7, 100 * STRIDE), strict=True):
            np.testing.assert_allclose(one, two, atol=1e-12)


@LAW
@given(st.integers(9, 60), st.floats(0.05, 1.0), st.floats(0.05, 1.0))
def test_graded_elements_shrink_geometrically_towards_both_ends(
    n: int, first: float, last: float
) -> None:
    sizes = np.diff(graded(n, first, last))
    assert len(sizes) == n
    ratio = sizes / sizes.max()
    assert ratio[0] == pytest.approx(first)
    assert ratio[-1] == pytest.approx(last)
    grows = np.log(ratio[1:5] / ratio[:4])
    falls = np.log(ratio[-4:] / ratio[-5:-1])
    np.testing.assert_allclose(grows, np.log(1 / first) / 4, atol=1e-9)
    np.testing.assert_allclose(falls, np.log(last) / 4, atol=1e-9)
    np.testing.assert_allclose(ratio[4:-4], 1.0)


@pytest.mark.parametrize("n", range(1, 8))
def test_few_elements_are_graded_too(n: int) -> None:
    edges = graded(n, 0.3, 0.6)
    assert len(edges) == n + 1
    assert (edges[0], edges[-1]) == (0.0, 1.0)
    assert np.all(np.diff(edges) > 0)


def test_equal_grades_are_equal_elements() -> None:
    np.testing.assert_allclose(np.diff(graded(9, 1.0, 1.0)), 1 / 9)


# --- cutting elements --------------------------------------------------------------------------

meshes_with_errors = st.lists(
    st.lists(st.tuples(st.floats(0.05, 1.0), st.floats(0.0, 40.0)), min_size=1, max_size=12),
    min_size=1,
    max_size=4,
)


def built(
    parts: list[list[tuple[float, float]]],
) -> tuple[tuple[np.ndarray, ...], list[np.ndarray]]:
    """A mesh from the sizes of its elements, and their errors."""
    mesh = []
    for part in parts:
        edges = np.concatenate([[0.0], np.cumsum([size for size, _ in part])])
        mesh.append(edges / edges[-1])
    return tuple(mesh), [np.array([error for _, error in part]) for part in parts]


@LAW
@given(meshes_with_errors, st.sampled_from([0.6, 1.0]))
def test_elements_are_cut_by_their_error_and_stay_nested(
    parts: list[list[tuple[float, float]]], above: float
) -> None:
    mesh, errors = built(parts)
    for old, new, error in zip(mesh, cut(mesh, errors, above), errors, strict=True):
        assert set(old) <= set(new)
        pieces = np.diff(np.searchsorted(new, old))
        expected = np.where(error > 6, 3, np.where(error > above, 2, 1))
        np.testing.assert_array_equal(pieces, expected)
        sizes = np.split(np.diff(new), np.cumsum(pieces)[:-1])
        for size, whole in zip(sizes, np.diff(old), strict=True):
            np.testing.assert_allclose(size, whole / len(size), rtol=1e-9)


@LAW
@given(meshes_with_errors, st.floats(0.05, 1.0))
def test_the_next_finer_mesh_halves_the_worst_elements(
    parts: list[list[tuple[float, float]]], share: float
) -> None:
    mesh, errors = built(parts)
    new = finer(mesh, errors, share)
    pieces = [np.diff(np.searchsorted(b, a)) for a, b in zip(mesh, new, strict=True)]
    halved, every = np.concatenate(pieces) == 2, np.concatenate(errors)
    assert set(np.concatenate(pieces)) <= {1, 2}
    assert halved.sum() == max(1, math.ceil(share * len(every)))
    assert every[halved].min() >= every[~halved].max(initial=0.0)


def test_an_infinite_error_is_cut_too() -> None:
    (new,) = cut((np.array([0.0, 0.5, 1.0]),), [np.array([np.inf, 0.0])])
    np.testing.assert_allclose(new, [0, 1 / 6, 1 / 3, 0.5, 1.0])
