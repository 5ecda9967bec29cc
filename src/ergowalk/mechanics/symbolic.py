"""The equations of motion (1) as CasADi functions, for simulation and control.

Nothing is derived here: CasADi's symbols go through the same lines as the numbers do, in
:mod:`ergowalk.mechanics.dynamics` and :mod:`ergowalk.mechanics.energy`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ergowalk.body import Body
from ergowalk.mechanics.dynamics import (
    LegMoments,
    coefficients,
    joint_moments_from,
    mass_matrix,
    motion_of,
    net_load,
    total_reaction,
)
from ergowalk.mechanics.energy import kinetic_energy, potential_energy
from ergowalk.mechanics.kinematics import Vector

if TYPE_CHECKING:
    import casadi


@dataclass(frozen=True)
class MechanicsFunctions:
    """The mechanics of one body as ``casadi.Function`` objects.

    Coordinates ``q`` (7, 1) are :data:`ergowalk.mechanics.dynamics.COORDINATES` [m, rad], ``qd``
    and ``qdd`` their rates and accelerations. ``moments`` (3, 2) has rows hip, knee, ankle (q, u,
    p of the paper [N m]), ``reactions`` (2, 2) rows x, y [N]; their columns are legs 1 and 2. A
    reaction is taken at the ankle: where it acts on the ground is in the ankle moment.

    Attributes
    ----------
    mass_matrix : q -> (7, 7)
        Mass matrix of (1) [kg, kg m, kg m2].
    inverse_dynamics : q, qd, qdd, trailing_reaction, trailing_ankle -> moments, reactions
        What the motion needs. Reaction (2, 1) [N] and ankle moment (1, 1) [N m] of leg 2 are
        given: zero in its swing, in double support the sharing of load.
    forward_dynamics : q, qd, moments, reactions -> qdd
        Accelerations [m/s2, rad/s2]; the inverse of ``inverse_dynamics``.
    kinetic_energy : q, qd -> (1, 1)
        Kinetic energy [J].
    potential_energy : q -> (1, 1)
        Potential energy [J], zero at the ground.
    """

    mass_matrix: casadi.Function
    inverse_dynamics: casadi.Function
    forward_dynamics: casadi.Function
    kinetic_energy: casadi.Function
    potential_energy: casadi.Function


def casadi_functions(body: Body) -> MechanicsFunctions:
    """The equations of motion (1) and the energies of a body as CasADi functions."""
    import casadi as ca  # heavy, and not everyone who reads a gait needs it

    c = coefficients(body)
    shapes = {"q": (7,), "qd": (7,), "qdd": (7,), "moments": (3, 2), "reactions": (2, 2)}
    shapes |= {"trailing_reaction": (2,), "trailing_ankle": (1,)}
    given = {name: ca.SX.sym(name, *shape) for name, shape in shapes.items()}

    state = motion_of(given["q"], given["qd"])
    motion = motion_of(given["q"], given["qd"], given["qdd"])
    moments, reactions = _leg_moments(given["moments"]), _vectors(given["reactions"])
    matrix = ca.vertcat(*(ca.horzcat(*row) for row in mass_matrix(c, state)))
    right = ca.vertcat(*net_load(c, state, moments, reactions))
    total, (r_x, r_y) = total_reaction(c, motion), ca.vertsplit(given["trailing_reaction"])
    shared = (total[0] - r_x, total[1] - r_y), (r_x, r_y)
    needed = joint_moments_from(c, motion, shared, given["trailing_ankle"])

    def function(name: str, inputs: str, **outputs: Any) -> casadi.Function:
        names = inputs.split()
        symbols = [given[key] for key in names]
        return ca.Function(name, symbols, list(outputs.values()), names, list(outputs))

    return MechanicsFunctions(
        mass_matrix=function("mass_matrix", "q", mass_matrix=matrix),
        inverse_dynamics=function(
            "inverse_dynamics",
            "q qd qdd trailing_reaction trailing_ankle",
            moments=_columns(needed),
            reactions=_columns(shared),
        ),
        # L D L' keeps the digits that CasADi's default, a symbolic Q R, loses
        forward_dynamics=function(
            "forward_dynamics", "q qd moments reactions", qdd=ca.ldl_solve(right, *ca.ldl(matrix))
        ),
        kinetic_energy=function("kinetic_energy", "q qd", energy=kinetic_energy(body, state)),
        potential_energy=function("potential_energy", "q", energy=potential_energy(body, state)),
    )


def _vectors(reactions: Any) -> tuple[Vector, Vector]:
    first, second = ((reactions[0, leg], reactions[1, leg]) for leg in (0, 1))
    return first, second


def _leg_moments(moments: Any) -> tuple[LegMoments, LegMoments]:
    first, second = (
        LegMoments(moments[0, leg], moments[1, leg], moments[2, leg], metatarsal=0.0)
        for leg in (0, 1)
    )
    return first, second


def _columns(legs: tuple[tuple[Any, ...], tuple[Any, ...]]) -> Any:
    import casadi as ca

    return ca.horzcat(*(ca.vertcat(*leg) for leg in legs))
