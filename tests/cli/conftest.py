"""A solved gait without a solver: the command line is tested for what it does with one."""

from __future__ import annotations

import importlib
import json
import signal
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from ergowalk.audit import AuditReport
from ergowalk.audit.report import AuditLine
from ergowalk.cli import main
from ergowalk.errors import GaitFileError
from ergowalk.gait.rhythm import Rhythm
from ergowalk.problem import GaitProblem, preset
from ergowalk.problem.files import problem_to_toml
from ergowalk.solution import Solution

JOINTS = ("hip", "knee", "ankle", "metatarsal")
POWERS = dict(zip(JOINTS, (40.0, 30.0, 20.0, 10.0), strict=True))


def human_dataset(problem: GaitProblem) -> xr.Dataset:
    """Both legs move as the human mean of leg 1; constant joint powers of known shares."""
    human, mass = problem.human(), problem.body.total_mass
    stride = np.linspace(0, 1, 401)
    angle, moment = np.zeros((401, 2, 4)), np.zeros((401, 2, 4))
    for i, joint in enumerate(JOINTS[:3]):
        angle[:, :, i] = np.radians(human.curves[f"{joint}_angle"][0](stride))[:, None]
        if f"{joint}_moment" in human.curves:
            moment[:, :, i] = mass * human.curves[f"{joint}_moment"][0](stride)[:, None]
    force = np.full((401, 2, 2), 1.25 * mass * problem.body.gravity_m_s2)
    power = np.tile(
        [POWERS[j] * s for j, s in zip(JOINTS, (1, -1, 1, -1), strict=True)], (401, 2, 1)
    )
    return xr.Dataset(
        {
            "joint_angle": (("time", "leg", "joint"), angle),
            "joint_moment": (("time", "leg", "joint"), moment),
            "joint_power": (("time", "leg", "joint"), power),
            "ground_reaction_force": (("time", "leg", "axis"), force),
        },
        coords={
            "time": stride * problem.stride_time_s,
            "leg": [1, 2],
            "axis": ["x", "y"],
            "joint": list(JOINTS),
        },
        attrs={
            "acceptable": 1,
            "solver_status": "the solver found an optimum",
            "energy_per_metre": 71.79,
            "step_length": problem.step_length_m,
            "rhythm": json.dumps(Rhythm(0.078, 0.233, 0.618).as_dict()),
            "method": "collocation",
            "iterations": 123,
            "solve_time": 9.25,
            "build_time": 0.5,
            "problem": problem_to_toml(problem),
            "body_parameters": json.dumps(problem.body.by_symbol()),
        },
    )


def audit_report(accepted: bool = True) -> AuditReport:
    """Two lines, one of them failing unless accepted."""
    pressure = 0.5 if accepted else 3.25
    return AuditReport(
        (
            AuditLine("feet", "feet on the ground", 1e-5, 1e-4, "m", True),
            AuditLine(
                "pressure", "centre of pressure", pressure, 2.0, "mm", accepted, "t = 0.1 s, leg 1"
            ),
        )
    )


class Auditor:
    """Stands in for ``ergowalk.audit.audit`` with a report or an error; knows what it saw."""

    def __init__(self) -> None:
        self.answer: AuditReport | Exception = audit_report()
        self.folders: list[Path | None] = []

    def __call__(self, dataset: xr.Dataset, folder: Path | None = None) -> AuditReport:
        self.folders.append(folder)
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer


class FakeSolver:
    """Stands in for ``ergowalk.solving.solve``; ``attributes`` are those of every gait."""

    def __init__(self) -> None:
        self.attributes: dict[str, object] = {}
        self.error: BaseException | None = None
        self.calls: list[GaitProblem] = []
        self.choices: list[dict[str, object]] = []
        self.interrupts = 0
        self.afterwards: Callable[[], object] | None = None
        self.stages: tuple[tuple[str, int], ...] = (("kinematic fit", 2), ("free rhythm", 3))

    def __call__(self, problem, *, progress=None, **choices):
        self.calls.append(problem)
        self.choices.append(choices)
        for _ in range(self.interrupts):
            signal.raise_signal(signal.SIGINT)
        for stage, count in self.stages:
            for iteration in range(count):
                progress(
                    SimpleNamespace(
                        stage=stage,
                        iteration=iteration,
                        energy_per_metre=float("nan") if stage == "kinematic fit" else 71.8,
                        violation=1e-3,
                        elapsed=0.1 * iteration,
                    )
                )
        if self.error is not None:
            raise self.error
        solution = Solution(human_dataset(problem).assign_attrs(self.attributes))
        if self.afterwards is not None:
            self.afterwards()
        return solution


@pytest.fixture(name="audit_report")
def audit_report_fixture() -> Callable[..., AuditReport]:
    """What makes an audit that passes or fails."""
    return audit_report


@pytest.fixture
def powers() -> dict[str, float]:
    """Constant joint powers of the solved gait [W], without sign."""
    return POWERS


@pytest.fixture
def auditor(monkeypatch) -> Auditor:
    """The audit replaced by a verdict."""
    fake = Auditor()
    monkeypatch.setattr("ergowalk.audit.audit", fake)
    monkeypatch.setattr("ergowalk.cli.gaits.audit", fake)
    return fake


@pytest.fixture
def solver(monkeypatch, auditor) -> FakeSolver:
    """The solver replaced by one that knows the answer."""
    fake = FakeSolver()
    monkeypatch.setattr(importlib.import_module("ergowalk.solving"), "solve", fake)
    return fake


@pytest.fixture
def stored(monkeypatch, auditor) -> dict[str, Solution]:
    """Gaits that can be loaded, by file name; any other file is no gait."""
    gaits: dict[str, Solution] = {}

    def load(path):
        if Path(path).name not in gaits:
            raise GaitFileError("not a gait", "give another", file=str(path))
        return gaits[Path(path).name]

    monkeypatch.setattr(Solution, "load", staticmethod(load))
    return gaits


@pytest.fixture
def gait() -> Solution:
    """The default problem, solved."""
    return Solution(human_dataset(preset("berbyuk2002")))


@dataclass
class Answer:
    """Exit status and both streams of a command."""

    status: int
    out: str
    err: str


@pytest.fixture
def run(capsys, tmp_path, monkeypatch):
    """Run a command in an empty folder."""
    monkeypatch.chdir(tmp_path)

    def command(*arguments: object) -> Answer:
        status = main([str(argument) for argument in arguments])
        return Answer(status, *capsys.readouterr())

    return command
