"""Standard output for answers, standard error for everything else."""

from __future__ import annotations

import json
import math
import os
import shutil
import sys
import time
from typing import TYPE_CHECKING, Any, Self, TextIO

from ergowalk.errors import OutputError

if TYPE_CHECKING:
    from ergowalk.solution import Progress

REFRESH = 0.1
"""Shortest time between two refreshed lines on a terminal [s]."""


def emit(text: str) -> None:
    """Print an answer on standard output.

    A reader that closes the pipe early has seen enough: that is no error, and the exit status
    stays that of the answer.

    Raises
    ------
    OutputError
        If standard output cannot take it (a full disk).
    """
    _to_stdout(text + "\n")


def emit_json(value: dict[str, Any]) -> None:
    """Print an answer as one JSON object; what is not a number becomes null."""
    from ergowalk.values import as_json  # with pydantic, which help needs not

    emit(json.dumps(as_json(value), indent=2, allow_nan=False))


def note(line: str) -> None:
    """Print one line on standard error, if there is one."""
    _to_stderr(line + "\n")


def flush() -> None:
    """Empty the buffer of standard output now, so that nothing is left to fail at exit."""
    try:
        _to_stdout("")
    except OutputError as error:
        note(f"ergowalk: {error}")


class ProgressLine:
    """Shows the progress of a solve: one line per stage, refreshed in place on a terminal."""

    def __init__(self, quiet: bool = False) -> None:
        self._stream = None if quiet else sys.stderr
        self._terminal = self._stream is not None and self._stream.isatty()
        self._stage: str | None = None
        self._last = ""
        self._shown = ""
        self._time = -math.inf

    def __call__(self, progress: Progress) -> None:
        """Take the state after an iteration."""
        if progress.stage != self._stage:
            self._finish()
            self._stage = progress.stage
            if not self._terminal:
                self.stage(f"{progress.stage} ({progress.elapsed:.1f} s)")
                return
        self._last = _progress_text(progress, shutil.get_terminal_size().columns - 1)
        if self._terminal and time.monotonic() - self._time >= REFRESH:
            self._show(self._last)

    def stage(self, text: str) -> None:
        """Say what begins now."""
        if self._stream is not None:
            self._finish()
            note(" ".join(text.split()))

    def refresh(self, text: str) -> bool:
        """Show a line that the next one replaces, where there is a terminal; whether there is."""
        if self._terminal:
            self._last = text[: shutil.get_terminal_size().columns - 1]
            self._show(self._last)
        return self._terminal

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._finish()

    def _finish(self) -> None:
        """Leave the last state of a stage standing on its own line."""
        if self._terminal and self._last:
            self._show(self._last)
            _to_stderr("\n")
        self._last = self._shown = ""
        self._time = -math.inf

    def _show(self, line: str) -> None:
        _to_stderr("\r" + line.ljust(len(self._shown)))
        self._shown = line
        self._time = time.monotonic()


def _progress_text(progress: Progress, width: int) -> str:
    """One line of at most ``width`` characters; a long stage gives way to its figures."""
    parts = [f"it {progress.iteration}"]
    if _known(progress.energy_per_metre):
        parts.append(f"{progress.energy_per_metre:.2f} J/m")
    if _known(progress.violation):
        parts.append(f"violation {progress.violation:.0e}")
    figures = ", ".join([*parts, f"{progress.elapsed:.0f} s"])
    room = max(width - len(figures) - 2, 0)
    stage = progress.stage
    stage = stage if len(stage) <= room else stage[: max(room - 3, 0)] + "..."
    return f"{stage}: {figures}"[:width]


def _known(value: float | None) -> bool:
    return value is not None and math.isfinite(value)


def _to_stdout(text: str) -> None:
    if sys.stdout is None:  # closed by whoever started the command
        return
    try:
        sys.stdout.write(_encodable(text, sys.stdout))
        sys.stdout.flush()
    except BrokenPipeError:
        _abandon(sys.stdout)
    except OSError as error:
        _abandon(sys.stdout)
        raise OutputError(
            f"cannot be written ({error.strerror})",
            "send it elsewhere",
            field="standard output",
        ) from None


def _to_stderr(text: str) -> None:
    if sys.stderr is None:
        return
    try:
        sys.stderr.write(_encodable(text, sys.stderr))
        sys.stderr.flush()
    except OSError:
        _abandon(sys.stderr)


def _encodable(text: str, stream: TextIO) -> str:
    """The text with escapes for what the stream's encoding lacks."""
    encoding = stream.encoding or "utf-8"
    return text.encode(encoding, "backslashreplace").decode(encoding)


def _abandon(stream: TextIO) -> None:
    """Let what is still buffered go nowhere; the interpreter flushes it again at exit."""
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), stream.fileno())
