"""The command ``figures``: the paper's figures of a stored gait for a journal."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from ergowalk.cli.output import result_folder
from ergowalk.cli.streams import emit, emit_json
from ergowalk.comparison import human_of
from ergowalk.errors import InputError
from ergowalk.solution import Solution

FOLDER = "figures"


def run_figures(arguments: Namespace) -> None:
    """Write Figures 2-10 of a gait in the formats of a journal.

    Raises
    ------
    GaitFileError, CorridorError
        If the file is no gait that can be read, or its table of human data is lost.
    OutputError
        If the figures cannot be written.
    """
    from ergowalk.plots import JOURNAL, write_figures
    from ergowalk.plots.pages import names_on
    from ergowalk.plots.style import PRINTED

    path: Path = arguments.gait
    folder: Path = arguments.output or path.parent / FOLDER
    sheet = JOURNAL[arguments.column]
    solution = Solution.load(path)
    dataset = solution.dataset
    files = [f"{name}.{kind}" for name in names_on(sheet) for kind in PRINTED]
    try:
        human = human_of(dataset, solution.folder)
        with result_folder(folder, files):
            drawn = write_figures(dataset, folder, PRINTED, human, sheet)
    except InputError as error:
        raise error.located(str(path)) from None
    width = round(25.4 * sheet.curve.width)
    if arguments.json:
        emit_json(
            {
                "file": str(path),
                "acceptable": solution.acceptable,
                "folder": str(folder),
                "width_mm": width,
                "files": [p.name for p in drawn],
            }
        )
    else:
        mark = "" if solution.acceptable else " (NOT ACCEPTABLE)"
        kinds = " and ".join(PRINTED)
        emit(f"{path}{mark}: {len(names_on(sheet))} figures, {width} mm wide, {kinds}: {folder}")
