"""What a solve leaves for the page: the gait, its problem, its report, its frames."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ergowalk.app.problems import short
from ergowalk.errors import InputError

if TYPE_CHECKING:
    from ergowalk.solution import Solution

GAIT, PROBLEM, REPORT, PAYLOAD = "gait.nc", "problem.toml", "report.html", "payload.json"
"""Files in the folder of a result; the last is for the viewer."""

DOWNLOADS = {
    GAIT: "application/x-netcdf",
    REPORT: "text/html; charset=utf-8",
    PROBLEM: "application/toml",
}
"""Files that a page may ask for, and their media types."""


def store(solution: Solution, folder: str | Path, number: int) -> dict[str, Any]:
    """Write the files of a result and return what the page says of it.

    Parameters
    ----------
    solution : Solution
    folder : str or Path
        An empty folder.
    number : int
        Tells the gaits of a session apart.

    Returns
    -------
    dict
        ``label``, ``acceptable``, ``status`` (a sentence), ``energy`` [J/m], ``rows`` (label and
        text of each headline figure), ``files``, ``viewable`` and ``why`` not: a gait that did not
        converge may not bear every look.
    """
    place = Path(folder)
    solution.save(place / GAIT)
    (place / PROBLEM).write_text(str(solution.dataset.attrs["problem"]), "utf-8")
    label = gait_label(solution, number)
    said: dict[str, Any] = {
        "label": label,
        "acceptable": bool(solution.acceptable),
        "status": solution.status,
        "energy": float(solution.energy_per_metre),
        "viewable": False,
        "why": "",
        "rows": [],
    }
    try:
        said["rows"] = _show(solution, place, label)
        said["viewable"] = True
    except InputError as error:
        said["why"] = str(error)
    said["files"] = [name for name in DOWNLOADS if (place / name).exists()]
    return said


def _show(solution: Solution, place: Path, label: str) -> list[tuple[str, str]]:
    """Write payload and report; label and text of each headline figure."""
    from ergowalk.comparison import human_of
    from ergowalk.viewer import gait_payload, report_html
    from ergowalk.viewer.figures import headline

    payload = gait_payload(solution.dataset, human_of(solution.dataset), label)
    text = json.dumps(payload, allow_nan=False, separators=(",", ":"))
    (place / PAYLOAD).write_text(text, "utf-8")
    (place / REPORT).write_text(report_html([solution]), "utf-8")
    return headline(solution, bool(solution.acceptable))


def gait_label(solution: Solution, number: int) -> str:
    """What a gait is called beside the others of its session."""
    problem = solution.problem
    walk = f"{problem.step_length_m:g} m, {problem.stride_time_s:g} s"
    return f"{number}: {short(problem.name)}, {walk}, E = {solution.energy_per_metre:.2f} J/m"
