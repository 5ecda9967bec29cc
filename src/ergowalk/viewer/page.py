"""A report as one self-contained HTML file: the viewer, and what is known of each gait."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import Any

from ergowalk.audit import AuditReport
from ergowalk.comparison import Comparison, compare, human_of
from ergowalk.corridors import BUILT_IN, SIGNALS
from ergowalk.errors import GaitFileError, InputError
from ergowalk.quantities import JOINTS
from ergowalk.solution import Solution
from ergowalk.viewer.document import document
from ergowalk.viewer.figures import headline, work_by_joint
from ergowalk.viewer.human import human_payload
from ergowalk.viewer.looks import asset
from ergowalk.viewer.payload import gait_payload


def report_html(
    solutions: Sequence[Solution], files: Sequence[str] | None = None, human: bool = False
) -> str:
    """The report of one or more gaits, as the text of an HTML file that refers to no other.

    ``files`` are the names of their files for error messages. With ``human`` the walker of the
    human mean angles, on the body of the first gait, is laid over them.

    Raises
    ------
    GaitFileError
        If a gait lacks something.
    ProblemError, BodyError, CorridorError
        If its problem cannot be read, or its table of human data is lost.
    """
    reports = _reports(solutions, files)
    title = f"Gait report: {', '.join(report.label for report in reports)}"
    main = _MAIN.format(
        heading=escape("Gait report" if len(reports) > 1 else title),
        warnings="".join(report.warning() for report in reports),
        viewer=viewer_html(_payloads(reports, human)),
        reports="\n".join(report.html(i) for i, report in enumerate(reports, 1)),
    )
    return document(title, ("viewer.css", "page.css"), main)


def payloads(
    solutions: Sequence[Solution], files: Sequence[str] | None = None, human: bool = False
) -> list[dict[str, Any]]:
    """What :func:`report_html` gives the viewer of these gaits, told apart by their labels.

    Raises
    ------
    GaitFileError, ProblemError, BodyError, CorridorError
        As :func:`report_html`.
    """
    return _payloads(_reports(solutions, files), human)


def viewer_html(payloads: Sequence[dict[str, Any]]) -> str:
    """The viewer of some gaits, each from ``gait_payload``, as a part of a page with its style.

    The last may be from ``human_payload``.
    """
    return _VIEWER.format(
        viewer=asset("viewer.html"), gaits=json_in_html(payloads), script=asset("viewer.js")
    )


def json_in_html(value: Any) -> str:
    """JSON that may stand in a script element: no "<" that could end the element."""
    text = json.dumps(value, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c")


@dataclass(frozen=True)
class _Report:
    """One gait with everything that is said about it."""

    solution: Solution
    label: str
    audit: AuditReport
    comparison: Comparison
    payload: dict[str, Any]

    @classmethod
    def of(cls, solution: Solution) -> _Report:
        name = " ".join(solution.problem.name.split())
        label = f"{name}, E = {solution.energy_per_metre:.2f} J/m"
        human = human_of(solution.dataset, solution.folder)
        audit, comparison = solution.audit(), compare(solution.dataset, human)
        payload = gait_payload(solution.dataset, human, label)
        # a person is no nine-link model: a measured walk has nothing to be accepted
        payload["acceptable"] = solution.measured or (solution.acceptable and audit.accepted)
        return cls(solution, label, audit, comparison, payload)

    def named(self, label: str) -> _Report:
        return replace(self, label=label, payload={**self.payload, "label": label})

    def warning(self) -> str:
        if self.payload["acceptable"]:
            return ""
        failed = len(self.audit.failed)
        reason = f"; {failed} of {len(self.audit.lines)} audit lines fail" if failed else ""
        text = f"Not acceptable: {self.label}: {self.solution.status}{reason}."
        return f'<p class="warning" role="note">{escape(text)}</p>\n'

    def html(self, number: int) -> str:
        rows = headline(self.solution, self.payload["acceptable"])
        return _REPORT.format(
            number=number,
            label=escape(self.label),
            figures=_table((), rows, "headline figures"),
            work=_work_table(self.solution),
            comparison=_comparison_table(self.comparison),
            audit=_MEASURED if self.solution.measured else _audit_table(self.audit),
            problem=_listing(str(self.solution.dataset.attrs["problem"]), "problem file"),
            version=escape(str(self.solution.dataset.attrs.get("ergowalk_version", "?"))),
            commands=_listing(_commands(self.solution), "commands"),
        )


def _reports(solutions: Sequence[Solution], files: Sequence[str] | None) -> list[_Report]:
    known: Sequence[str | None] = files or [None] * len(solutions)
    return _told_apart([_report(s, f) for s, f in zip(solutions, known, strict=True)])


def _payloads(reports: Sequence[_Report], human: bool) -> list[dict[str, Any]]:
    found = [report.payload for report in reports]
    if human:
        first = reports[0].solution
        found.append(human_payload(first.dataset, human_of(first.dataset, first.folder)))
    return found


_MEASURED = "<p>A measured walk: a person is no nine-link model, so it is not audited.</p>"


def _report(solution: Solution, file: str | None) -> _Report:
    try:
        _check_attributes(solution)
        return _Report.of(solution)
    except InputError as error:
        raise (error.located(file) if file else error) from None


def _check_attributes(solution: Solution) -> None:
    """Refuse a gait that does not say how its solve ended, which no audit asks for."""
    for name, read in _ATTRIBUTES.items():
        try:
            read(solution)
        except (KeyError, ValueError, TypeError):
            raise GaitFileError(
                "missing or not as the solver writes it",
                "write the gait again with 'ergowalk solve'",
                field=f"attribute {name}",
            ) from None


_ATTRIBUTES: dict[str, Callable[[Solution], object]] = {
    "solver_status": lambda solution: solution.status,
    "acceptable": lambda solution: solution.acceptable,
    "mesh_history": lambda solution: solution.energy_error,
}


def _told_apart(reports: Sequence[_Report]) -> list[_Report]:
    """The same, numbered where several have one label."""
    labels = [report.label for report in reports]
    return [
        report.named(f"{label} ({labels[: i + 1].count(label)})")
        if labels.count(label) > 1
        else report
        for i, (report, label) in enumerate(zip(reports, labels, strict=True))
    ]


def _work_table(solution: Solution) -> str:
    work = work_by_joint(solution)
    whole = sum(part.total for part in work.values())
    rows = [
        (j, f"{w.positive:.2f}", f"{w.negative:.2f}", f"{w.total:.2f}", _share(w.total, whole))
        for j, w in ((joint, work[joint]) for joint in JOINTS)
    ]
    positive, negative = (sum(getattr(w, k) for w in work.values()) for k in _SIGNS)
    rows.append(("all", f"{positive:.2f}", f"{negative:.2f}", f"{whole:.2f}", "100 %"))
    head = ("joint", "positive [J/m]", "negative [J/m]", "together [J/m]", "share of E")
    return _table(head, rows, "energy by joint")


_SIGNS = ("positive", "negative")


def _share(part: float, whole: float) -> str:
    return f"{100 * part / whole:.0f} %" if whole > 0 else "-"


def _comparison_table(comparison: Comparison) -> str:
    head = ("signal", "RMS distance", "within 1 SD", "within 2 SD", "correlation", "gait", "human")
    rows = []
    for s in comparison.signals:
        correlation = f"{s.correlation:.2f}" if s.correlation == s.correlation else "-"
        spans = (f"{e.min:.2f} to {e.max:.2f}" for e in (s.gait, s.human))
        rows.append(
            (
                f"{SIGNALS[s.name].label} [{s.unit}]",
                f"{s.rms_sd:.2f} SD",
                f"{100 * s.inside_1sd:.0f} %",
                f"{100 * s.inside_2sd:.0f} %",
                correlation,
                *spans,
            )
        )
    missing = f"<p>No mean and SD for {escape(', '.join(comparison.missing))}.</p>"
    spread = " between people" if comparison.source in BUILT_IN else ""
    source = f"<p>Leg 1 against {escape(comparison.source)}, mean ± SD{spread}.</p>"
    table = _table(head, rows, "comparison with human walking")
    return source + table + (missing if comparison.missing else "")


def _audit_table(audit: AuditReport) -> str:
    head = ("residual", "verdict", "value", "tolerance", "unit", "worst at")
    rows = [
        (
            line.what,
            "ok" if line.accepted else "FAILS",
            "-" if line.value is None else f"{line.value:.3g}",
            f"{line.tolerance:.3g}",
            line.unit,
            "; ".join(part for part in (line.where, line.note) if part),
        )
        for line in audit.lines
    ]
    count = len(audit.failed)
    verdict = f"{count} of {len(rows)} lines fail" if count else f"all {len(rows)} lines pass"
    return f"<p>{verdict}.</p>{_table(head, rows, 'audit')}"


def _commands(solution: Solution) -> str:
    """The commands that find the gait again from its problem file."""
    attributes = solution.dataset.attrs
    solve = "ergowalk solve problem.toml"
    if attributes.get("method") == "spline":
        solve += f" --method spline --solver {attributes.get('solver')}"
        solve += f" --knots {attributes.get('knots')} --rho {attributes.get('rho'):g}"
        solve += f" --asked {attributes.get('asked')}"
    if "starts" in attributes:
        starts = json.loads(attributes["starts"])
        solve += f" --starts {starts['starts']} --seed {starts['seed']}"
    gait = "gait/gait.nc"
    others = (f"ergowalk {name} {gait}" for name in ("audit", "compare", "report"))
    return "\n".join([f"{solve} -o gait", *others])


def _table(head: Sequence[str], rows: Iterable[Sequence[str]], name: str) -> str:
    """A table of escaped texts; the first cell of a row is its heading."""
    top = "".join(f'<th scope="col">{escape(cell)}</th>' for cell in head)
    body = "\n".join(
        f'<tr><th scope="row">{escape(first)}</th>'
        + "".join(f"<td>{escape(cell)}</td>" for cell in rest)
        + "</tr>"
        for first, *rest in rows
    )
    thead = f"<thead><tr>{top}</tr></thead>" if head else ""
    return _scrolling(f"<table>{thead}<tbody>\n{body}\n</tbody></table>", name)


def _listing(text: str, name: str) -> str:
    return _scrolling(f"<pre>{escape(text)}</pre>", name)


def _scrolling(content: str, name: str) -> str:
    """What is wider than a narrow screen scrolls by itself, with the keyboard too."""
    return f'<div class="scrolls" tabindex="0" role="group" aria-label="{name}">{content}</div>'


_MAIN = """\
<h1>{heading}</h1>
{warnings}{viewer}
{reports}"""

_VIEWER = """\
{viewer}
<script type="application/json" id="gaits">{gaits}</script>
<script>
{script}
ergowalkViewer(
  document.querySelector(".viewer"),
  JSON.parse(document.getElementById("gaits").textContent),
);
</script>
"""

_REPORT = """\
<article aria-labelledby="gait-{number}">
<h2 id="gait-{number}">{label}</h2>
<h3>Headline figures</h3>
{figures}
<h3>Energy by joint</h3>
<p>Work of both legs per metre: done on the walker (positive) and taken up (negative).</p>
{work}
<h3>Comparison with human walking</h3>
{comparison}
<h3>Audit</h3>
<p>Every residual, recomputed from the curves by code that shares nothing with the solver.</p>
{audit}
<h3>Problem file</h3>
<details><summary>Show problem.toml, all defaults filled in</summary>
{problem}
</details>
<h3>How to reproduce</h3>
<p>With ergowalk {version}, save the problem file as <code>problem.toml</code>, then</p>
{commands}
</article>
"""
