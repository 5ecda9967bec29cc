"""Rows of an element: the chain rule gives the derivatives of the composed expressions."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest

from ergowalk.gait.rhythm import PhaseOrder
from ergowalk.nlp import Kernel
from ergowalk.problem import preset
from ergowalk.transcription.kernel import KernelStore
from ergowalk.transcription.scheme import GaussScheme
from ergowalk.transcription.walking import kinematic_problem, walking_problem

PROBLEM = preset("berbyuk2002")
STORE = KernelStore()
CASES = [
    (build, order, i, points)
    for build, points in ((walking_problem, 3), (walking_problem, 2), (kinematic_problem, 2))
    for order in PhaseOrder
    for i in range(4)
]


@pytest.fixture(
    scope="module",
    params=CASES,
    ids=lambda c: f"{c[0].__name__}-{c[1]}-{c[2]}-{c[3]}",
)
def kernel(request: pytest.FixtureRequest) -> Kernel:
    build, order, i, points = request.param
    problem = build(PROBLEM, (order,) if build is walking_problem else order)
    store = STORE if build is walking_problem else KernelStore()
    return store.kernel(problem.phases[i], GaussScheme(points)).kernel


def somewhere(kernel: Kernel, seed: int) -> list[np.ndarray]:
    """Variables and parameters of a plausible size."""
    rng = np.random.default_rng(seed)
    variables = rng.uniform(-0.5, 0.5, kernel.variables.numel())
    variables[:2] = 0.1, 0.3  # start and end of the phase
    parameters = rng.uniform(0.1, 0.3, kernel.parameters.numel())
    return [variables, parameters]


def test_jacobian_and_hessian_are_those_of_the_expressions(kernel: Kernel) -> None:
    direct = replace(kernel, chain=None)
    assert kernel.chain is not None
    point = somewhere(kernel, 1)
    multipliers = np.random.default_rng(2).uniform(-1, 1, kernel.rows.numel())
    for found, expected in (
        (kernel.jacobian(*point), direct.jacobian(*point)),
        (
            kernel.hessian(*point, 0.7, multipliers),
            direct.hessian(*point, 0.7, multipliers),
        ),
    ):
        a, b = (np.asarray(ca.densify(m)) for m in (found, expected))
        np.testing.assert_allclose(a, b, rtol=1e-9, atol=1e-9 * np.abs(b).max())


def test_the_chain_rule_is_the_shorter_way(kernel: Kernel) -> None:
    direct = replace(kernel, chain=None)
    assert kernel.jacobian.n_instructions() <= direct.jacobian.n_instructions()
    assert kernel.hessian.n_instructions() < direct.hessian.n_instructions()
