"""IPOPT through CasADi, with the programme's own exact derivatives."""

from __future__ import annotations

import contextlib
import math
import signal
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from types import FrameType
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ergowalk.errors import ProblemError
from ergowalk.nlp import NonlinearProgramme

Array = NDArray[np.float64]
Monitor = Callable[[int, float, float], None]
"""Called once an iteration with (iteration, objective, largest violation)."""


@dataclass(frozen=True)
class Ipopt:
    """IPOPT as a frozen choice of options.

    ``push`` is how far a start on a bound is moved inside; a small one keeps a good start. With
    ``barrier_end`` the solver stops at the minimum of that barrier, inside of all bounds.
    """

    tolerance: float = 1e-7
    constraint_tolerance: float = 1e-8
    max_iterations: int = 400
    strategy: str = "adaptive"
    barrier_start: float | None = None
    barrier_end: float = 0.0
    push: float = 1e-2
    extra: Mapping[str, object] = field(default_factory=dict)

    def minimise(
        self,
        programme: NonlinearProgramme,
        start: Array,
        monitor: Monitor | None = None,
        multipliers: tuple[Array, Array] | None = None,
    ) -> Minimum:
        """Minimise from ``start``; failing to converge is an answer.

        ``multipliers`` of variables and rows near the solution, if known, save iterations.

        Raises
        ------
        ProblemError
            If CasADi was built without IPOPT.
        KeyboardInterrupt
            If the user interrupts: the iteration is finished first.
        Exception
            Whatever ``monitor`` raises, after it has stopped the solver.
        """
        if not ca.has_nlpsol("ipopt"):  # asks quietly; nlpsol would print where it has looked
            raise ProblemError(
                "CasADi cannot load it",
                "reinstall casadi from a wheel that has IPOPT",
                field="solver",
                value="ipopt",
            )
        oracle = programme.oracle
        lower, upper = programme.row_bounds
        watch = _Watch(programme.size, len(lower), lower, upper, monitor)
        began = time.process_time()
        options: dict[str, Any] = {
            "ipopt": self._options() | (_WARM_DUALS if multipliers is not None else {}),
            "grad_f": oracle.gradient,
            "jac_g": oracle.jacobian,
            "hess_lag": oracle.hessian,
            "iteration_callback": watch,
            "print_time": False,
            "error_on_fail": False,
            "show_eval_warnings": False,
        }
        solver = ca.nlpsol("ipopt", "ipopt", oracle.values, options)
        built = time.process_time()
        duals = (
            {} if multipliers is None else dict(zip(("lam_x0", "lam_g0"), multipliers, strict=True))
        )
        with _interrupts_to(watch):
            answer = solver(
                x0=start, lbx=programme.lower, ubx=programme.upper, lbg=lower, ubg=upper, **duals
            )
        if watch.stopped_by is not None:
            raise watch.stopped_by
        stats = solver.stats()
        rows = np.asarray(answer["g"]).ravel()
        return Minimum(
            x=np.asarray(answer["x"]).ravel(),
            objective=float(answer["f"]),
            row_multipliers=np.asarray(answer["lam_g"]).ravel(),
            variable_multipliers=np.asarray(answer["lam_x"]).ravel(),
            converged=bool(stats["success"]),
            message=_sentence(stats["return_status"]),
            iterations=int(stats["iter_count"]),
            violation=_violation(rows, lower, upper),
            build_time=built - began,
            solve_time=time.process_time() - built,
            **_last(stats.get("iterations")),
        )

    def _options(self) -> dict[str, object]:
        options: dict[str, object] = {
            "tol": self.tolerance,
            "constr_viol_tol": self.constraint_tolerance,
            "acceptable_tol": 1e-5,
            "acceptable_constr_viol_tol": 1e-6,
            "acceptable_iter": 15,
            "max_iter": self.max_iterations,
            "mu_strategy": self.strategy,
            "mu_target": self.barrier_end,
            "nlp_scaling_method": "none",
            "linear_solver": "mumps",
            "print_level": 0,
            "sb": "yes",
        }
        if self.barrier_start is not None:
            options["mu_init"] = self.barrier_start
        for name in ("bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac"):
            options[name] = self.push
        return options | dict(self.extra)


@dataclass(frozen=True)
class Minimum:
    """Where a solver stopped, and what it says of it.

    ``stationarity`` is the largest entry of the gradient of the Lagrangian, ``regularisation``
    what was added to its Hessian in the last iteration.
    """

    x: Array
    objective: float
    row_multipliers: Array
    variable_multipliers: Array
    converged: bool
    message: str
    iterations: int
    violation: float
    build_time: float
    solve_time: float
    stationarity: float = math.nan
    regularisation: float = math.nan

    @property
    def strict(self) -> bool | None:
        """Whether the reduced Hessian of the last barrier problem is positive definite there.

        It is if the last system had the right inertia without anything added to the Hessian;
        None if that is not known.
        """
        return None if math.isnan(self.regularisation) else self.regularisation == 0.0


_WARM_DUALS = {
    "warm_start_init_point": "yes",
    "warm_start_bound_push": 1e-4,
    "warm_start_bound_frac": 1e-4,
    "warm_start_slack_bound_push": 1e-4,
    "warm_start_slack_bound_frac": 1e-4,
    "warm_start_mult_bound_push": 1e-4,
}

_SENTENCES = {
    "Solve_Succeeded": "converged",
    "Solved_To_Acceptable_Level": "converged to the looser of two tolerances",
    "Infeasible_Problem_Detected": "no point satisfies all constraints near where it looked",
    "Maximum_Iterations_Exceeded": "ran out of iterations",
    "Restoration_Failed": "could not restore feasibility",
    "Search_Direction_Becomes_Too_Small": "the search direction became too small",
    "Diverging_Iterates": "the iterates diverge",
    "Error_In_Step_Computation": "no step could be computed",
    "Invalid_Number_Detected": "a function returned no number",
    "Feasible_Point_Found": "converged to a feasible point",
    "Not_Enough_Degrees_Of_Freedom": "there are more equations than free variables",
}
"""IPOPT's return status in the words that users read."""


def _sentence(status: str) -> str:
    return _SENTENCES.get(status, status.replace("_", " ").lower())


def _last(iterations: Mapping[str, Sequence[float]] | None) -> dict[str, float]:
    """First- and second-order state of the last iteration, where the solver tells."""
    if not iterations or not iterations.get("inf_du"):
        return {}
    return {
        "stationarity": float(iterations["inf_du"][-1]),
        "regularisation": float(iterations["regularization_size"][-1]),
    }


def _violation(rows: Array, lower: Array, upper: Array) -> float:
    return float(max(0.0, np.max(lower - rows, initial=0.0), np.max(rows - upper, initial=0.0)))


class _Watch(ca.Callback):
    """Reports each iteration; an exception stops the solver, which cannot let it through."""

    def __init__(
        self, n_x: int, n_g: int, lower: Array, upper: Array, monitor: Monitor | None
    ) -> None:
        ca.Callback.__init__(self)
        self.sizes = {"x": n_x, "f": 1, "g": n_g, "lam_x": n_x, "lam_g": n_g, "lam_p": 0}
        self.lower, self.upper, self.monitor = lower, upper, monitor
        self.stopped_by: BaseException | None = None
        self.iteration = 0
        self.construct("watch", {})

    def get_n_in(self) -> int:
        return int(ca.nlpsol_n_out())

    def get_n_out(self) -> int:
        return 1

    def get_name_in(self, i: int) -> str:
        return str(ca.nlpsol_out(i))

    def get_name_out(self, i: int) -> str:
        return "ret"

    def get_sparsity_in(self, i: int) -> ca.Sparsity:
        n = self.sizes[ca.nlpsol_out(i)]
        return ca.Sparsity.dense(n) if n else ca.Sparsity(0, 0)

    def eval(self, arguments: Sequence[ca.DM]) -> list[int]:
        try:
            if self.monitor is not None:
                rows = np.asarray(arguments[2]).ravel()
                violation = _violation(rows, self.lower, self.upper)
                self.monitor(self.iteration, float(arguments[1]), violation)
            self.iteration += 1
        except BaseException as error:  # raised again once the solver has stopped
            self.stopped_by = error
        return [int(self.stopped_by is not None)]


@contextlib.contextmanager
def _interrupts_to(watch: _Watch) -> Iterator[None]:
    """An interrupt from the keyboard stops the solver at its next iteration.

    Raised inside the solver, KeyboardInterrupt would be lost there; what the present handler
    raises is kept until the solver has stopped. Signal handlers belong to the main thread.
    """
    previous = signal.getsignal(signal.SIGINT)
    in_main_thread = threading.current_thread() is threading.main_thread()
    if not in_main_thread or not callable(previous):
        yield
        return

    def keep(number: int, frame: FrameType | None) -> None:
        try:
            previous(number, frame)
        except BaseException as error:
            watch.stopped_by = watch.stopped_by or error

    signal.signal(signal.SIGINT, keep)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous)
