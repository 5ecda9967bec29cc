"""solve(problem) gives a Solution whatever happens, and always the same one."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from ergowalk.audit import check_readable
from ergowalk.body import LegParameters
from ergowalk.errors import ProblemError
from ergowalk.gait.rhythm import PRINTED_RHYTHM, Contact, PhaseOrder
from ergowalk.mechanics.foot import toe_chain
from ergowalk.mechanics.kinematics import Point, Rotation, Vector
from ergowalk.problem import GaitProblem, preset
from ergowalk.solution import Progress, Solution
from ergowalk.solution.progress import Report
from ergowalk.solvers.ipopt import Ipopt
from ergowalk.solving import SplineOptions, stages, verb
from ergowalk.solving.answer import describe, judged, rhythms_of
from ergowalk.solving.candidate import Candidate, failed
from ergowalk.solving.memory import recall
from ergowalk.solving.stages import with_times
from ergowalk.transcription import halves, motion
from ergowalk.transcription.layout import Mesh
from ergowalk.transcription.mesh import walking_mesh
from ergowalk.transcription.walking import Smoothing, walking_problem

FIXED = preset("berbyuk2002-rhythm")


def coarse_mesh(order: PhaseOrder, times: Mapping[str, float], stride: float, level: float) -> Mesh:
    """A fifth of the elements of the real ones."""
    return walking_mesh(order, times, stride, level / 5)


def hurried(problem: GaitProblem, progress: Report | None = None) -> Solution:
    """The answer when every stage stops after four iterations on a very coarse mesh."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stages, "Ipopt", partial(Ipopt, max_iterations=4))
        patch.setattr(halves, "walking_mesh", coarse_mesh)
        return verb.solve(problem, progress=progress)


@dataclass(frozen=True)
class Run:
    """A search that was stopped, and what it said meanwhile."""

    answer: Solution
    told: list[Progress]


@pytest.fixture(scope="module")
def stopped() -> Run:
    told: list[Progress] = []
    return Run(hurried(FIXED, told.append), told)


@pytest.mark.parametrize(
    ("choices", "match"),
    [
        ({"method": "magic"}, "method = 'magic': no such method; use 'collocation' or 'spline'"),
        ({"solver": "magic"}, "solver = 'magic': no such solver; use 'ipopt' for method 'coll"),
        (
            {"solver": "rosenbrock"},
            "solver = 'rosenbrock': cannot solve method 'collocation'; use 'ipopt', or method 'spl",
        ),
        ({"spline": SplineOptions()}, "spline: means nothing to method 'collocation'; leave knots"),
    ],
)
def test_what_does_not_go_together_is_refused(choices: dict[str, Any], match: str) -> None:
    with pytest.raises(ProblemError, match=match):
        verb.solve(FIXED, **choices)


def test_a_start_is_for_a_collocation(paper_gait_file: Path) -> None:
    with pytest.raises(ProblemError, match=r"start: means nothing to method 'spline'.*; start a"):
        verb.solve(FIXED, method="spline", start=Solution.load(paper_gait_file))


# --- when it does not converge -----------------------------------------------------------------


def test_not_converging_is_an_answer(stopped: Run) -> None:
    answer = stopped.answer
    assert answer.acceptable is False
    assert answer.status == "not converged on the coarse mesh: ran out of iterations"
    check_readable(answer.dataset)
    assert answer.mesh_history[-1]["converged"] is False
    assert answer.mesh_history[-1]["final"] is True
    assert answer.problem == FIXED
    assert answer.energy_per_metre > 0
    assert not answer.audit().accepted


def test_a_motion_out_of_reach_is_an_answer_too(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The trailing foot cannot reach its print: there the angles, and what follows, are missing."""

    def out_of_reach(
        leg: LegParameters, ankle: Point, toe_tip: Vector
    ) -> tuple[Rotation, Rotation]:
        foot, toes = toe_chain(leg, ankle, toe_tip)
        lost = np.where(np.arange(len(foot.angle)) % 7 == 3, np.nan, 0.0)
        return Rotation(foot.angle + lost, foot.rate + lost, foot.acceleration + lost), toes

    monkeypatch.setattr(motion, "toe_chain", out_of_reach)
    answer = hurried(FIXED)
    assert answer.acceptable is False
    assert answer.status.startswith("not converged")
    assert "finite" in {line.key for line in answer.audit().failed}
    assert Solution.load(answer.save(tmp_path / "gait.nc")).status == answer.status


def test_the_loads_are_those_of_the_motion_even_then(stopped: Run) -> None:
    """Whatever the solver left undone, the file is consistent in itself."""
    lines = {line.key: line for line in stopped.answer.audit().lines}
    exact = ("equations_of_motion", "joint_angles", "joint_power", "energy", "leg_symmetry")
    assert {key: lines[key].accepted for key in exact} == dict.fromkeys(exact, True)


def test_the_same_problem_twice_gives_the_same_bytes(stopped: Run) -> None:
    one, two = stopped.answer.dataset, hurried(FIXED).dataset
    assert list(one.variables) == list(two.variables)
    for name in one.variables:
        first, second = one[name].to_numpy(), two[name].to_numpy()
        if first.dtype == object:  # labels
            assert first.tolist() == second.tolist()
        else:
            assert first.tobytes() == second.tobytes(), name
    clocks = {"solve_time", "build_time", "mesh_times"}
    assert clocks <= set(one.attrs)
    first, second = ({k: v for k, v in d.attrs.items() if k not in clocks} for d in (one, two))
    assert first == second


def test_both_orders_are_tried_where_both_are_possible() -> None:
    answer = hurried(preset("berbyuk2002"))
    tried = json.loads(answer.dataset.attrs["phase_orders_tried"])
    assert set(tried) == {"toe-off-first", "flat-first"}
    assert answer.dataset.attrs["phase_order"] == min(
        tried, key=lambda order: tried[order]["energy_at_nodes"]
    )


# --- progress ----------------------------------------------------------------------------------


def test_progress_is_told_once_an_iteration(stopped: Run) -> None:
    told = stopped.told
    names = list(dict.fromkeys(line.stage for line in told))
    assert len(names) == 2  # the fit, then the first dynamics
    assert all(name.startswith("toe-off-first, ") for name in names)
    assert "fit to human means" in names[0]
    for name in names:
        numbers = [line.iteration for line in told if line.stage == name]
        assert numbers == list(range(5))
    assert int(stopped.answer.dataset.attrs["iterations"]) == 4 + 4
    elapsed = [line.elapsed for line in told]
    assert elapsed == sorted(elapsed)
    assert elapsed[0] >= 0
    assert all(np.isfinite(line.energy_per_metre) and line.violation >= 0 for line in told)


def test_an_interrupt_in_the_progress_callback_ends_the_search() -> None:
    calls: list[Progress] = []

    def interrupt(line: Progress) -> None:
        calls.append(line)
        raise KeyboardInterrupt("enough")

    with pytest.raises(KeyboardInterrupt, match="enough"):
        hurried(FIXED, interrupt)
    assert len(calls) == 1


# --- when it converges -------------------------------------------------------------------------


@pytest.fixture(scope="module")
def gait(paper_gait_file: Path) -> Solution:
    """The gait at the printed rhythm that all tests share."""
    return Solution.load(paper_gait_file)


def entry(gait: Solution, flag: str) -> dict[str, Any]:
    """The entry of the mesh history with a flag: "final" or "finer"."""
    (found,) = (e for e in gait.mesh_history if e.get(flag))
    return found


def test_a_converged_gait_says_so_with_its_meshes(gait: Solution) -> None:
    assert all(e["converged"] for e in gait.mesh_history)
    final, finer = entry(gait, "final"), entry(gait, "finer")
    assert final["elements"] < finer["elements"]
    assert final["energy_per_metre"] == pytest.approx(gait.energy_per_metre, rel=1e-12)
    assert f"E = {gait.energy_per_metre:.2f} J/m on {final['elements']} elements" in gait.status
    change = 100 * (finer["energy_per_metre"] / final["energy_per_metre"] - 1)
    assert f"{change:+.2f} % on {finer['elements']}" in gait.status


def test_what_the_audit_says_decides(gait: Solution) -> None:
    assert gait.acceptable == gait.audit().accepted
    failed = ", ".join(line.key for line in gait.audit().failed)
    assert gait.acceptable == gait.status.startswith("converged: ") or failed in gait.status


def test_what_holds_by_construction_holds_on_any_mesh(gait: Solution) -> None:
    """Only what the transcription approximates may be off: bounds, corridors, pressure, E."""
    lines = {line.key: line for line in gait.audit().lines}
    exact = (
        "equations_of_motion",
        "swing_unloaded",
        "velocities",
        "accelerations",
        "no_impact",
        "feet_fixed",
        "joint_angles",
        "periodicity",
        "leg_symmetry",
        "load_symmetry",
        "energy",
        "joint_power",
        "work_energy",
        "time_span",
        "time_steps",
        "smooth_pieces",
        "phases",
        "rhythm_order",
        "rhythm_as_asked",
        "attributes",
        "finite",
    )
    broken = {key: lines[key].value for key in exact if not lines[key].accepted}
    assert broken == {}


def test_the_gait_file_has_the_attributes_of_the_contract(gait: Solution) -> None:
    attributes = gait.dataset.attrs
    assert attributes["step_length"] == FIXED.step_length_m
    assert attributes["stride_time"] == FIXED.stride_time_s
    assert attributes["method"] == "collocation"
    assert attributes["limits"] == FIXED.limits.sentence()
    assert json.loads(attributes["body_parameters"]) == FIXED.body.by_symbol()
    assert gait.problem.replace(folder=None) == FIXED
    assert gait.rhythm.as_dict() == pytest.approx(PRINTED_RHYTHM.as_dict(), abs=1e-12)
    assert attributes["iterations"] >= sum(e["iterations"] for e in gait.mesh_history)
    assert attributes["solve_time"] > 0
    assert attributes["build_time"] > 0
    assert attributes["ergowalk_version"]


def test_the_grid_is_dense_and_jumps_stand_twice(gait: Solution) -> None:
    time, stride = gait.dataset["time"].to_numpy(), FIXED.stride_time_s
    steps = np.diff(time)
    assert (time[0], time[-1]) == (0.0, stride)
    assert steps.min() == 0.0
    assert steps.max() <= stride / 400 * (1 + 1e-9)
    ends = np.flatnonzero(steps == 0.0)
    pieces = np.diff(np.concatenate([[-1], ends, [len(time) - 1]]))
    assert pieces.min() >= 5
    assert len(pieces) == 2 * entry(gait, "final")["elements"]
    phase = gait.dataset["contact_phase"].to_numpy()
    changes = np.flatnonzero(np.any(np.diff(phase, axis=0) != 0, axis=1))
    assert set(changes) <= set(ends)  # a phase changes only where the instant stands twice
    first = [Contact(p).name for p in dict.fromkeys(phase[time <= stride / 2, 0].tolist())]
    assert first[:3] == ["HEEL", "FLAT", "FOREFOOT"]


def test_legs_repeat_each_other_half_a_stride_later(paper_gait: xr.Dataset) -> None:
    half = paper_gait.sizes["time"] // 2
    moment = paper_gait["joint_moment"].to_numpy()
    np.testing.assert_array_equal(moment[half:], moment[:half, ::-1])


# --- parts -------------------------------------------------------------------------------------


def test_times_can_be_held() -> None:
    phased = walking_problem(FIXED, (PhaseOrder.TOE_OFF_FIRST,), Smoothing())
    times = {name: 0.1 * i for i, name in enumerate(phased.times)}
    held = with_times(phased, times)
    assert held.times == {name: (t, t) for name, t in times.items()}
    assert held.phases is phased.phases


@pytest.mark.parametrize("heel_off", [0.02, 0.51])
def test_phases_that_overlap_in_a_failed_search_do_not_hide_its_answer(
    paper_gait_file: Path, heel_off: float
) -> None:
    """Rows of the rhythm may be violated where a solver stops; time still goes forward."""
    search, found = recall(Solution.load(paper_gait_file))
    x, layout = found.minimum.x.copy(), found.collocation.layout
    index = layout.times["heel_off"]
    x[index] = heel_off * search.problem.stride_time_s / layout.scale[index]
    minimum = replace(found.minimum, x=x, converged=False, message="ran out of iterations")
    result = replace(found, trajectory=found.collocation.unpack(x), minimum=minimum)
    gait = failed(Candidate(search, result), [], "on 86 elements")
    time = gait.dataset["time"].to_numpy()
    assert bool((np.diff(time) >= 0).all())
    answer = judged(
        describe(
            gait.dataset,
            search.problem,
            rhythms_of(search.halves, result.trajectory, search.problem.stride_time_s),
            energy=1.0,
            method="collocation",
            status=gait.status,
            history=gait.history,
            extra={},
        ),
        gait.settled,
        None,
    )
    assert not answer.acceptable
    assert answer.status.startswith("not converged on 86 elements: ran out of iterations")
