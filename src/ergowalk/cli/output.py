"""The folder of a result, and files that are there whole or not at all."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ergowalk.errors import OutputError


def default_folder(name: str) -> Path:
    """``ergowalk-NAME`` in the current folder, without what a file name should not have."""
    plain = re.sub(r"[^\w.-]+", "-", name).strip("-.")[:60]
    return Path(f"ergowalk-{plain or 'custom'}")


@contextmanager
def result_folder(folder: Path, files: Iterable[str]) -> Iterator[Path]:
    """A folder that exists and takes ``files``; one that was made and stayed empty is removed.

    Raises
    ------
    OutputError
        If the folder cannot be made or written; raised before the body runs.
    """
    made = [path for path in (folder, *folder.parents) if not os.path.exists(path)]
    try:
        _check_writable(folder, files)
        yield folder
    finally:
        for path in made:
            with suppress(OSError):  # not empty: the result is in it
                path.rmdir()


def _check_writable(folder: Path, files: Iterable[str]) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = _draft(folder / "ergowalk")
        probe.touch()
        probe.unlink()
        reason = next((f"{n} is a folder" for n in files if os.path.isdir(folder / n)), None)
    except OSError as error:
        reason = error.strerror
    if reason is not None:
        raise OutputError(
            f"cannot be written ({reason})", "choose another folder with -o", file=str(folder)
        )


def write_text(path: Path, text: str) -> None:
    """Write a UTF-8 file beside its target and rename it.

    Raises
    ------
    OutputError
        If that is not possible; an old file is then still whole.
    """
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: Path, content: bytes) -> None:
    """As :func:`write_text`, for bytes."""
    draft = _draft(path)
    try:
        draft.write_bytes(content)
        os.replace(draft, path)
    except OSError as error:
        raise OutputError(
            f"cannot be written ({error.strerror})", "choose another place", file=str(path)
        ) from None
    finally:
        with suppress(OSError):
            draft.unlink()


def check_not_foreign(path: Path, content: bytes, mark: str = "gait.nc") -> None:
    """Refuse to replace somebody's own file: another content, and no ``mark`` beside it.

    A result's folder holds ``gait.nc``, or what else marks it, and there everything may be
    replaced.

    Raises
    ------
    OutputError
        If the file would be lost.
    """
    if os.path.exists(path.parent / mark) or not os.path.exists(path):
        return
    try:
        same = path.read_bytes() == content
    except OSError:
        same = False
    if not same:
        raise OutputError(
            f"would be replaced, and no {mark} beside it says that it is a result",
            "choose another folder with -o",
            file=str(path),
        )


def _draft(path: Path) -> Path:
    return path.with_name(f".{path.name}.{os.getpid()}.part")
