"""Files of one trial, of whatever kinds, as one recording."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from ergowalk.errors import RecordingError
from ergowalk.recording.c3d import read_c3d
from ergowalk.recording.recording import Plate, Recording
from ergowalk.recording.storage import read_reactions
from ergowalk.recording.table import read_table
from ergowalk.recording.trc import read_trc

MARKER_READERS: dict[str, Callable[[Path], Recording]] = {
    ".c3d": read_c3d,
    ".trc": read_trc,
    ".csv": read_table,
    ".tsv": read_table,
    ".txt": read_table,
}
FORCE_READERS: dict[str, Callable[[Path], tuple[Plate, ...]]] = {
    ".mot": read_reactions,
    ".sto": read_reactions,
}


def read_recording(paths: Sequence[str | Path]) -> Recording:
    """The recording of one trial: one file with markers, and any number with force plates.

    Parameters
    ----------
    paths : sequence of str or Path
        C3D, TRC or a table (CSV, TSV, TXT) for markers; MOT or STO, or a table, for forces. All
        count time from the same instant.

    Raises
    ------
    RecordingError
        If a file cannot be read, or the files have no markers or too many.
    """
    found: Recording | None = None
    plates: list[Plate] = []
    for path in map(Path, paths):
        suffix = path.suffix.lower()
        if suffix in FORCE_READERS:
            plates += FORCE_READERS[suffix](path)
        elif suffix in MARKER_READERS:
            recording = MARKER_READERS[suffix](path)
            if recording.markers and found is not None:
                raise RecordingError(
                    f"has markers, and {found.file} has",
                    "give the files of one trial",
                    file=str(path),
                )
            if recording.markers:
                found = recording
            else:
                plates += recording.plates
        else:
            known = ", ".join((*MARKER_READERS, *FORCE_READERS))
            raise RecordingError(
                f"is of no kind that is known by its name ({known})",
                "rename or export it",
                file=str(path),
            )
    if found is None:
        raise RecordingError(
            "no file has markers",
            "give the C3D, TRC or table of the markers too",
            field="files",
            value=[str(path) for path in paths],
        )
    return found.with_plates(tuple(plates))
