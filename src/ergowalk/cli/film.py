"""The command ``animate``: stored gaits as a film."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from ergowalk.cli.output import write_bytes
from ergowalk.cli.streams import emit, emit_json
from ergowalk.errors import InputError, OutputError
from ergowalk.solution import Solution


def run_animate(arguments: Namespace) -> None:
    """Write a film of some gaits, whole or not at all.

    Raises
    ------
    GaitFileError, CorridorError
        If a file is no gait that can be read, or its table of human data is lost.
    InputError
        If there is no such format, size or time, or what writes it is not installed.
    OutputError
        If the film cannot be written, or would replace one of the gaits.
    """
    from ergowalk.film import FilmOptions, film
    from ergowalk.viewer import payloads

    target: Path = arguments.output
    width, height = arguments.size
    options = FilmOptions(
        format=_format(target),
        width=width,
        height=height,
        fps=arguments.fps,
        strides=arguments.strides,
        speed=arguments.speed,
        dark=arguments.dark,
        trail=arguments.trail,
    )
    paths: list[Path] = arguments.gaits
    _check_place(target, paths)
    gaits = payloads([Solution.load(p) for p in paths], [str(p) for p in paths], arguments.human)
    content = film(gaits, options)
    write_bytes(target, content)
    frames = options.frames(gaits[0]["stride_time"])
    told = {
        "film": str(target),
        "bytes": len(content),
        "width": width,
        "height": height,
        "frames": frames,
        "frames_per_second": options.fps,
        "duration_s": frames / options.fps,
        "strides": options.count,
        "gaits": [gait["label"] for gait in gaits],
    }
    if arguments.json:
        emit_json(told)
    else:
        lines = [_line(gait) for gait in gaits]
        size = f"{width}x{height}, {frames} frames, {frames / options.fps:.2f} s"
        emit("\n".join([*lines, f"film: {target}: {size}, {len(content) / 1000:.0f} kB"]))


def _format(target: Path) -> str:
    from ergowalk.film import FORMATS

    suffix = target.suffix.lower().lstrip(".")
    if suffix not in FORMATS:
        raise InputError(
            "the name of a film must say its format",
            f"let it end on {', '.join('.' + kind for kind in FORMATS)}",
            file=str(target),
        )
    return suffix


def _check_place(target: Path, gaits: list[Path]) -> None:
    """Refuse, before the film is made, a place that takes no file or holds a gait."""
    if not target.parent.is_dir():
        raise OutputError("no such folder", "make it, or choose another", file=str(target.parent))
    if target.is_dir():
        raise OutputError("is a folder", "choose another name", file=str(target))
    if any(target.exists() and gait.exists() and target.samefile(gait) for gait in gaits):
        raise OutputError("is one of the gaits", "choose another file with -o", file=str(target))


def _line(gait: dict[str, object]) -> str:
    mark = "" if gait["acceptable"] else " (NOT ACCEPTABLE)"
    limits = f" with {gait['limits']}" if gait["limits"] else ""
    return f"{gait['label']}{mark}{limits}"
