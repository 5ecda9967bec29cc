"""What a solve says: the short table, the JSON object and the report file."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ergowalk.cli.paper import BesidePaper, beside_paper
from ergowalk.problem import JOINTS, GaitProblem

if TYPE_CHECKING:
    from ergowalk.audit import AuditReport
    from ergowalk.comparison import Comparison
    from ergowalk.solution import Solution

RHYTHM_WORDS = {
    "heel_end": "foot flat",
    "heel_off": "heel-off",
    "toe_tip_start": "toe tip",
    "toe_off": "toe-off",
}
"""The rhythm parameters as a reader of the table calls them."""

Rows = list[tuple[str, str]]


@dataclass(frozen=True)
class Result:
    """A solution with everything that is said about it.

    Attributes
    ----------
    solution : Solution
    audit : AuditReport or None
        None where the curves are no gait that an audit could read; ``audit_failure`` says why.
    comparison : Comparison or None
        None where the curves cannot be compared.
    folder : Path
        Where the files are.
    files : tuple of str
        Their names, the report excepted.
    """

    solution: Solution
    audit: AuditReport | None
    audit_failure: str
    comparison: Comparison | None
    folder: Path
    files: tuple[str, ...]

    @property
    def accepted(self) -> bool:
        """Whether the solver converged and the audit passed."""
        audited = self.audit is not None and self.audit.accepted
        return bool(self.solution.acceptable) and audited

    def as_dict(self) -> dict[str, Any]:
        """The table as plain values (SI units, fractions of the stride)."""
        solution, problem = self.solution, self.solution.problem
        attributes = solution.dataset.attrs
        return {
            "name": problem.name,
            "step_length_m": problem.step_length_m,
            "stride_time_s": problem.stride_time_s,
            "acceptable": self.accepted,
            "status": solution.status,
            "energy_per_metre": float(solution.energy_per_metre),
            "energy_error": solution.energy_error,
            "limits": problem.conditions(),
            "objective_per_metre": solution.objective_per_metre,
            "device_energy": {
                joint: {"gives": gives, "takes": takes}
                for joint, (gives, takes) in solution.device_energy.items()
            },
            "design": solution.design,
            "cost_of_transport": solution.cost_of_transport,
            "energy_share": energy_shares(solution),
            "rhythm": solution.rhythm.as_dict(),
            "rhythm_fixed": fixed_instants(problem),
            "phase_order": str(attributes.get("phase_order", solution.rhythm.order)),
            **legs_as_dict(solution),
            "peak_vertical_reaction_body_weights": peak_reaction(solution),
            "method": str(attributes.get("method", "")),
            "iterations": _whole(attributes.get("iterations")),
            "build_time_s": _number(attributes.get("build_time")),
            "solve_time_s": _number(attributes.get("solve_time")),
            "audit": None if self.audit is None else self.audit.as_dict(),
            "comparison": None if self.comparison is None else self.comparison.as_dict(),
            "paper": None if (beside := self.beside_paper()) is None else beside.as_dict(),
            "folder": str(self.folder),
            "files": [*self.files, "report.md"],
        }

    def rows(self) -> Rows:
        """The short table, label and text."""
        found, problem = self.as_dict(), self.solution.problem
        attributes, beside = self.solution.dataset.attrs, self.beside_paper()
        speed = 2 * problem.step_length_m / problem.stride_time_s
        error = found["energy_error"]
        bar = "" if error is None else f" (+- {error:.2f})"
        joules = f"{found['energy_per_metre']:.2f} J/m{bar}"
        shares = [f"{joint} {share:.0%}" for joint, share in found["energy_share"].items()]
        peak = found["peak_vertical_reaction_body_weights"]
        return [
            (
                "problem",
                f"{problem.name}: step {problem.step_length_m:g} m, stride "
                f"{problem.stride_time_s:g} s, {speed:.3g} m/s",
            ),
            ("E", f"{joules} with {found['limits']}"),
            *self._objective_row(),
            *self._device_rows(),
            *design_rows(self.solution.design),
            ("cost of transport", f"{found['cost_of_transport']:.4f} (E / M g)"),
            ("energy share", ", ".join(shares)),
            *self._rhythm_rows(),
            ("phase order", _order_text(found["phase_order"], problem)),
            ("peak R_y", f"{peak:.3f} body weights"),
            ("method", method_text(attributes)),
            (
                "effort",
                f"{found['iterations']} iterations, {found['solve_time_s']:.1f} CPU s, "
                f"{found['build_time_s']:.1f} s to set up",
            ),
            *_minimum_row(json.loads(attributes.get("mesh_history", "[]"))),
            *([] if beside is None else [("paper", beside.line())]),
            *([("starts", starts_text(attributes["starts"]))] if "starts" in attributes else []),
            *(("audit" if i == 0 else "", text) for i, text in enumerate(self._audit_lines())),
            ("status", f"{'acceptable' if self.accepted else 'NOT ACCEPTABLE'}: {found['status']}"),
            ("files", f"{self.folder}: {summarised(found['files'])}"),
        ]

    def _rhythm_rows(self) -> Rows:
        """Contact instants; of both legs, with their steps and energies, where they differ."""
        solution = self.solution
        if not solution.full_stride:
            fixed = fixed_instants(solution.problem)
            return [("rhythm", _rhythm_text(solution.rhythm.as_dict(), fixed))]
        rows: Rows = []
        steps = zip(solution.step_lengths, solution.step_times, strict=True)
        for leg, (length, time) in enumerate(steps):
            energy = solution.energy_by_leg[leg]
            parts = ", ".join(f"{joint} {e:.2f}" for joint, e in energy.items())
            rhythm = solution.rhythms[leg].as_dict()
            fixed = fixed_instants(solution.problem, leg)
            rows += [
                (f"leg {leg + 1}", f"{sum(energy.values()):.2f} J/m: {parts}"),
                ("", f"lands after {length:.4f} m and {time:.4f} s"),
                ("", _rhythm_text(rhythm, fixed)),
            ]
        return rows

    def _objective_row(self) -> Rows:
        """The value of what was minimised, where that is not E."""
        objective = self.solution.problem.objective
        if objective.is_eq10:
            return []
        value = self.solution.objective_per_metre
        return [("objective", f"{value:.2f} J/m = {objective.sentence()}")]

    def _device_rows(self) -> Rows:
        """The devices, and what they give and take."""
        devices = self.solution.problem.devices.sentence()
        if not devices:
            return []
        works = [
            f"{joint} gives {gives:.2f}, takes {takes:.2f}"
            for joint, (gives, takes) in self.solution.device_energy.items()
        ]
        energy = f"{', '.join(works)} J/m" if works else "no work"
        return [("devices", devices), ("their energy", f"{energy} (no part of E)")]

    def beside_paper(self) -> BesidePaper | None:
        """The gait beside what the paper prints, if it was found by the paper's method."""
        return beside_paper(self.solution.dataset, self.comparison)

    def table(self) -> str:
        """The short table as plain text."""
        rows = [(label, " ".join(text.split())) for label, text in self.rows()]
        width = max(len(label) for label, _ in rows)
        return "\n".join(f"{label:<{width}}  {text}" for label, text in rows)

    def markdown(self) -> str:
        """The report: the short table, the audit, the comparison, the figures."""
        name = " ".join(self.solution.problem.name.split())
        rows = [f"| {label} | {_cell(text)} |" for label, text in self.rows()]
        audit = "not possible: " + self.audit_failure
        comparison = "not possible: the curves are not those of a stride"
        if self.audit is not None:
            audit = _preformatted(self.audit.table())
        if self.comparison is not None:
            comparison = _preformatted(self.comparison.table())
        figures, beside = _figure_lines(self.files) or ["none"], self.beside_paper()
        parts = [
            f"# Gait: {name}",
            "\n".join(["| | |", "|---|---|", *rows]),
            "## Audit\n\nEvery residual of the stored curves against its tolerance.",
            audit,
            "## Comparison with human walking",
            comparison,
            *([] if beside is None else [beside.markdown()]),
            "## Figures",
            "\n".join(figures),
            "## Again",
            "    ergowalk solve problem.toml",
        ]
        return "\n\n".join(parts) + "\n"

    def _audit_lines(self) -> list[str]:
        if self.audit is None:
            return [f"not possible: {self.audit_failure}"]
        count = len(self.audit.lines)
        failed = [line for line in self.audit.lines if not line.accepted]
        if not failed:
            return [f"accepted, all {count} residuals within their tolerances"]
        lines = [f"FAILED, {len(failed)} of {count} residuals"]
        for line in failed:
            value = "not measured" if line.value is None else f"{line.value:.3g}"
            unit = "" if line.unit == "1" else f" {line.unit}"
            place = "; ".join(part for part in (line.where, line.note) if part)
            where = f" ({place})" if place else ""
            lines.append(f"{line.what}: {value}, at most {line.tolerance:.3g}{unit}{where}")
        return lines


def design_rows(design: Sequence[Mapping[str, Any]]) -> Rows:
    """Each number that was found with the gait, its bounds, and what an active one costs."""
    rows = []
    for found in design:
        text = f"{found['path']} = {found['value']:.6g}, free from {found['low']:g} to "
        text += f"{found['high']:g}"
        prices = [(w, found[f"{w}_price"]) for w in ("low", "high") if found[f"{w}_price"]]
        told = [f"the {w}est allowed, {p:+.4g} J/m per unit more" for w, p in prices]
        rows.append(("design", f"{text} ({', '.join(told) or 'no bound is active'})"))
    return rows


def energy_shares(solution: Solution) -> dict[str, float]:
    """Share of each joint, both legs together, in the integral (10); NaN if that is zero."""
    parts = solution.energy_by_joint
    total = sum(parts.values())
    return {joint: part / total if total > 0 else math.nan for joint, part in parts.items()}


def _minimum_row(history: Sequence[Mapping[str, Any]]) -> Rows:
    """What first and second derivatives say of the reported point, where the solver told."""
    final = next((record for record in history if record.get("final")), {})
    if final.get("strict_minimum") is None:
        return []
    curvature = (
        "curved upwards in every free direction: a strict local minimum"
        if final["strict_minimum"]
        else "curvature not positive in every free direction: perhaps no strict minimum"
    )
    return [("minimum", f"gradient of the Lagrangian {final['stationarity']:.0e}, {curvature}")]


def starts_text(stored: str) -> str:
    """What became of many starts, from the attribute of a gait."""
    found = json.loads(stored)
    optima = ", ".join(f"{o['energy_per_metre']:.2f} J/m ({o['hits']})" for o in found["optima"])
    return (
        f"{found['accepted']} of {found['starts']} accepted (seed {found['seed']}); "
        f"distinct optima and their hits: {optima or 'none'}"
    )


def peak_reaction(solution: Solution) -> float:
    """Largest vertical reaction of one leg in body weights."""
    body = solution.problem.body
    vertical = solution.dataset["ground_reaction_force"].sel(axis="y").values
    return float(np.max(vertical)) / (body.total_mass * body.gravity_m_s2)


def method_text(attributes: Mapping[str, Any]) -> str:
    """The method, with the choices that E depends on."""
    method = str(attributes.get("method", ""))
    if method != "spline":
        return method
    knots, rho = attributes.get("knots"), attributes.get("rho")
    asked = "the paper's constraints"
    if attributes.get("asked") != "paper":
        asked = "everything the problem asks for"
    return f"spline, {attributes.get('solver')}, {knots} knots, rho {rho:g} s^3, {asked}"


def legs_as_dict(solution: Solution) -> dict[str, Any]:
    """What each leg does, where they differ."""
    if not solution.full_stride:
        return {}
    return {
        "rhythm_leg_2": solution.rhythms[1].as_dict(),
        "step_lengths_m": solution.step_lengths,
        "step_times_s": solution.step_times,
        "energy_by_leg": solution.energy_by_leg,
    }


def fixed_instants(problem: GaitProblem, leg: int = 0) -> list[str]:
    """Rhythm parameters that the problem fixes; the start of the toe-tip phase always is."""
    free, rhythm = ("heel_end", "heel_off", "toe_off"), problem.rhythm_of(leg)
    fixed = [name for name in free if len(set(rhythm.bounds(name))) == 1]
    return sorted([*fixed, "toe_tip_start"], key=list(RHYTHM_WORDS).index)


def summarised(files: Sequence[str]) -> str:
    """File names on one line, figures only counted."""
    figures = [name for name in files if Path(name).suffix in FIGURE_SUFFIXES]
    others = [name for name in files if name not in figures]
    pages = len({Path(name).stem for name in figures})
    return ", ".join([*others, *([f"{pages} figures"] if figures else [])])


FIGURE_SUFFIXES = (".png", ".svg", ".pdf")
"""Files that are pictures of the gait."""


def _rhythm_text(rhythm: dict[str, float], fixed: list[str]) -> str:
    parts = [f"{RHYTHM_WORDS[name]} {100 * value:.1f} %" for name, value in rhythm.items()]
    free = [RHYTHM_WORDS[name] for name in rhythm if name not in fixed]
    kind = "free" if len(free) == len(JOINTS) - 1 else f"free: {', '.join(free)}"
    return f"{', '.join(parts)} of the stride ({kind if free else 'fixed'})"


def _order_text(order: str, problem: GaitProblem) -> str:
    if problem.rhythm.order != "best":
        return f"{order} (as asked)"
    only = len(problem.rhythm.orders()) == 1
    return f"{order} ({'the only one possible' if only else 'the better of both'})"


def _figure_lines(files: Sequence[str]) -> list[str]:
    pages: dict[str, list[str]] = {}
    for name in files:
        if Path(name).suffix in FIGURE_SUFFIXES:
            pages.setdefault(Path(name).stem, []).append(name)
    pictures = [n for n in files if Path(n).suffix == ".png" and "overview" in n]
    return [f"![{Path(n).stem}]({n})\n" for n in pictures] + [
        f"- {page}: " + ", ".join(f"[{Path(n).suffix[1:]}]({n})" for n in names)
        for page, names in sorted(pages.items())
    ]


def _preformatted(text: str) -> str:
    return f"```text\n{text}\n```"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def _number(value: Any) -> float:
    return math.nan if value is None else float(value)


def _whole(value: Any) -> int | None:
    return None if value is None else int(value)
