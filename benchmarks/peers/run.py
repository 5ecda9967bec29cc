"""Compare ergowalk's transcription with others, in one run: ``python run.py``; see README.md."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

from environments import interpreter

HERE = Path(__file__).resolve().parent
AGREEMENT = 1e-6
"""By how much, relatively, an optimum may differ from the reference."""
FOUND = 1e-3
"""By how much the optimum from a random start may, to count as the same one."""
REFERENCE_ELEMENTS = 40
"""Mesh of the reference, plain CasADi: four times as fine as the mesh that is timed."""
PARTS = ("impact", "posture", "walking", "methods")


@dataclass(frozen=True)
class Peer:
    """A program: its script, its environment, its elements, and those for random starts.

    A program of second order starts on half as many, and its optimum is that of both meshes
    extrapolated.
    """

    name: str
    script: str
    environment: str
    elements: int
    start_elements: int

    @property
    def second_order(self) -> bool:
        """Whether the optimum is extrapolated."""
        return self.start_elements < self.elements


PEERS = (
    Peer("ergowalk", "five_link_ours.py", "ours", 10, 10),
    Peer("CasADi by hand", "five_link_casadi.py", "ours", 10, 10),
    Peer("opty", "five_link_opty.py", "opty", 200, 100),
    Peer("OpenSim Moco", "five_link_moco.py", "moco", 10, 10),
)


@dataclass(frozen=True)
class Run:
    """One process: what it printed, or why it did not; CPU time [s] and peak memory [MB]."""

    answer: dict[str, Any] | None
    reason: str
    cpu: float
    memory: float


def run(python: Path, script: str, arguments: Sequence[str], limit: float) -> Run:
    """Run a script to its end, or for so many seconds by the clock."""
    environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    command = [str(python), str(HERE / script), *arguments]
    # a folder of its own: compilers and solvers leave files
    with (
        tempfile.TemporaryDirectory() as folder,
        tempfile.TemporaryFile("w+") as out,
        tempfile.TemporaryFile("w+") as err,
    ):
        process = subprocess.Popen(command, stdout=out, stderr=err, cwd=folder, env=environment)
        timer = threading.Timer(limit, process.kill)
        timer.start()
        _, status, used = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        lines, complaint = out.read().strip().splitlines(), err.read().strip().splitlines()
    cpu, memory = used.ru_utime + used.ru_stime, used.ru_maxrss / 1024
    if process.returncode == 0 and lines:
        return Run(json.loads(lines[-1]), "", cpu, memory)
    reason = complaint[-1] if complaint else "nothing was printed"
    if process.returncode == -9:
        reason = f"stopped after {limit:.0f} s"
    return Run(None, reason, cpu, memory)


class Benchmark:
    """All parts, with the environments and the patience that the user gave."""

    def __init__(self, chosen: argparse.Namespace) -> None:
        self.chosen = chosen
        self.failures: list[str] = []

    def python(self, environment: str) -> Path | None:
        """The interpreter for an environment; this one serves for ergowalk's own."""
        if self.chosen.environments is not None:
            found = interpreter(self.chosen.environments, environment)
            if found.exists():
                return found
        return Path(sys.executable) if environment == "ours" else None

    def five_link(self, variant: str) -> None:
        """Problem 1: all programs on one variant of the five-link walker."""
        limit, runs = self.chosen.limit, {peer.name: [] for peer in PEERS}
        for _ in range(self.chosen.runs):  # interleaved: a busy minute hits all alike
            for peer in PEERS:
                python = self.python(peer.environment)
                if python is None:
                    runs[peer.name].append(Run(None, "no environment", 0.0, 0.0))
                    continue
                arguments = ["--variant", variant, "--elements", str(peer.elements)]
                runs[peer.name].append(run(python, peer.script, arguments, limit))
                self.note(f"{variant}, {peer.name}: {runs[peer.name][-1].cpu:.1f} CPU s")
        fine = ["--variant", variant, "--elements", str(REFERENCE_ELEMENTS)]
        reference = run(self.python("ours"), "five_link_casadi.py", fine, limit)
        best = _effort(reference)
        print(
            f"Five-link walker, variant {variant}; reference effort {best:.6f} N2 m2 s; "
            f"{_times(self.chosen.runs)}\n"
        )
        print(
            "| program | mesh | effort | from reference | build [CPU s] | solve [CPU s] "
            "| cold total [CPU s] | memory [MB] | random starts: converged, to the same optimum |"
        )
        print("|" + " --- |" * 9)
        for peer in PEERS:
            print(self.row(peer, variant, runs[peer.name], best), flush=True)
        print()

    def row(self, peer: Peer, variant: str, runs: list[Run], best: float) -> str:
        """One line of the table, with the starts of that peer."""
        good = [r for r in runs if r.answer is not None]
        if len(good) < len(runs):
            reason = next(r.reason for r in runs if r.answer is None)
            return f"| {peer.name} | {reason} |" + " |" * 7
        answers = [r.answer for r in good]
        outcome, (starts, halved) = answers[0]["outcomes"][0], self.starts(peer, variant, best)
        effort = outcome["effort"]
        shown, mesh = f"{effort:.6f}", answers[0]["mesh"]
        if peer.second_order:
            effort = (4 * effort - halved) / 3
            shown = f"{effort:.6f}, from {outcome['effort']:.6f} and {halved:.6f} on half the mesh"
        apart = effort / best - 1
        if not outcome["converged"] or not abs(apart) <= AGREEMENT:
            self.failures.append(f"{variant}, {peer.name}: {apart:+.1e}, {outcome['message']}")
        cells = [
            f"{peer.name} ({answers[0]['versions']})",
            mesh,
            shown,
            f"{apart:+.1e}",
            f"{median(a['build_cpu_s'] for a in answers):.2f}",
            f"{median(a['solve_cpu_s'] for a in answers):.2f}",
            f"{median(r.cpu for r in good):.2f}",
            f"{median(r.memory for r in good):.0f}",
            starts,
        ]
        return "| " + " | ".join(cells) + " |"

    def starts(self, peer: Peer, variant: str, best: float) -> tuple[str, float]:
        """How many random starts converge, how many of them to the optimum of their mesh, and that
        optimum [N2 m2 s]."""
        if not self.chosen.starts and not peer.second_order:
            return "not asked for", best
        arguments = ["--variant", variant, "--elements", str(peer.start_elements)]
        arguments += ["--seeds", str(self.chosen.starts), "--budget", str(self.chosen.limit)]
        done = run(self.python(peer.environment), peer.script, arguments, 2 * self.chosen.limit)
        self.note(f"{variant}, {peer.name}, starts: {done.cpu:.1f} CPU s")
        if done.answer is None:
            return done.reason, float("nan")
        first, *outcomes = done.answer["outcomes"]
        converged = [o for o in outcomes if o["converged"]]
        same = [o for o in converged if abs(o["effort"] / first["effort"] - 1) <= FOUND]
        on = f" on {peer.start_elements} elements" if peer.second_order else ""
        return f"{len(converged)}, {len(same)} of {len(outcomes)}{on}", first["effort"]

    def walking(self) -> None:
        """Problem 2: Problem A by hand against ``ergowalk.solve``."""
        ours = run(self.python("ours"), "walking_ours.py", [], 10 * self.chosen.limit)
        self.note(f"walking, ergowalk: {ours.cpu:.1f} CPU s")
        limit = ["--limit", str(self.chosen.opti_limit)]
        print(f"Problem A, rhythm fixed; IPOPT by hand gets {self.chosen.opti_limit:.0f} CPU s\n")
        print("| program | E [J/m] | cold total [CPU s] | memory [MB] | what it says |")
        print("|" + " --- |" * 5)
        print(_walking_row("ergowalk.solve", ours), flush=True)
        for name, more in (("", []), (", smooth problem first", ["--smooth-first"])):
            patience = 20 * self.chosen.opti_limit
            hand = run(self.python("ours"), "walking_opti.py", [*limit, *more], patience)
            print(_walking_row(f"CasADi Opti by hand{name}", hand), flush=True)
        print()

    def methods(self) -> None:
        """Problem 3: ergowalk's two methods."""
        print("Problem A, rhythm fixed: ergowalk's methods\n")
        print("| method | E [J/m] | cold total [CPU s] | memory [MB] | audit and status |")
        print("|" + " --- |" * 5)
        for method in ("collocation", "spline"):
            arguments = ["--method", method]
            done = run(self.python("ours"), "walking_ours.py", arguments, 10 * self.chosen.limit)
            print(_walking_row(method, done), flush=True)
        print()

    def note(self, words: str) -> None:
        """Say how far it is, apart from the tables."""
        print(words, file=sys.stderr, flush=True)


def _times(count: int) -> str:
    return "one run" if count == 1 else f"median of {count} runs"


def _effort(done: Run) -> float:
    if done.answer is None:
        raise SystemExit(f"the reference was not found: {done.reason}")
    return float(done.answer["outcomes"][0]["effort"])


def _walking_row(name: str, done: Run) -> str:
    if done.answer is None:
        return f"| {name} | none | {done.cpu:.1f} | {done.memory:.0f} | {done.reason} |"
    answer = done.answer
    if "status" in answer:
        verdict = "accepted" if answer["accepted"] else "rejected"
        says = f"audit: {verdict}; {answer['status']}"
    else:
        end = "converged" if answer["converged"] else "not converged"
        says = (
            f"{end}: {answer['message']} after {answer['iterations']} iterations, "
            f"{answer['unknowns']} unknowns"
        )
    energy = f"{answer['energy_j_per_m']:.2f}"
    return f"| {name} | {energy} | {done.cpu:.1f} | {done.memory:.0f} | {says} |"


def main() -> int:
    """Run the parts asked for; 1 if optima of the first problem disagree."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--environments", type=Path, help="folder given to environments.py")
    arguments.add_argument("--runs", type=int, default=3, help="of which the median is printed")
    arguments.add_argument("--starts", type=int, default=20, help="random starts of each program")
    arguments.add_argument("--only", nargs="+", choices=PARTS, default=PARTS)
    arguments.add_argument("--limit", type=float, default=600.0, help="clock s for one process")
    arguments.add_argument("--opti-limit", type=float, default=300.0, help="CPU s for Opti")
    benchmark = Benchmark(arguments.parse_args())
    for variant in PARTS[:2]:
        if variant in benchmark.chosen.only:
            benchmark.five_link(variant)
    if "walking" in benchmark.chosen.only:
        benchmark.walking()
    if "methods" in benchmark.chosen.only:
        benchmark.methods()
    for failure in benchmark.failures:
        print(f"optima disagree: {failure}")
    return 1 if benchmark.failures else 0


if __name__ == "__main__":
    sys.exit(main())
