"""Damages recorded files and reads them: ``python scripts/fuzz_recordings.py --count 10000``.

Each case is one file of a made-up walk, damaged by a seeded hand and read; of those that can be
read one in ten is measured, too. Right is a walk, or one sentence that says why not; wrong is any
other exception, a reader that takes longer than its time, or a process that dies untold.
"""

from __future__ import annotations

import argparse
import os
import signal
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random
from typing import Any

import ergowalk.recording.c3d as c3d
from ergowalk.errors import InputError
from ergowalk.measured.choices import Choices
from ergowalk.measured.walk import measure
from ergowalk.recording import read_recording
from ergowalk.recording.c3d_child import answer, limit_resources
from made_up_walk import c3d_bytes, csv_text, mot_text, recording, trc_text, walker

READERS = ("c3d", "trc", "mot", "csv")

PATIENCE = 20
"""Longest time for one file [s]."""

WORDS = ("nan", "inf", "-inf", "1e308", "-1e999", "0", "", "x", "1,5", "99999999999", "\ufeff", '"')


def seed_files() -> dict[str, bytes]:
    """A small good file for each reader."""
    known = walker(duration=2.0, rate=50.0)
    whole = recording(known, unit="mm")
    return {
        "c3d": c3d_bytes(whole),
        "trc": trc_text(whole).encode(),
        "mot": mot_text(whole).encode(),
        "csv": csv_text(known).encode(),
    }


def damaged(content: bytes, kind: str, random: Random) -> bytes:
    """The content with one to four damages."""
    data = bytearray(content)
    for _ in range(random.choice((1, 1, 2, 4))):
        if not data:
            break
        choose = random.choice(_BINARY if kind == "c3d" or random.random() < 0.3 else _TEXT)
        data = choose(data, random)
    return bytes(data)


def _flip(data: bytearray, random: Random) -> bytearray:
    for _ in range(random.choice((1, 3, 30))):
        data[_place(data, random)] = random.choice((0, 1, 127, 128, 255, random.randrange(256)))
    return data


def _cut(data: bytearray, random: Random) -> bytearray:
    return data[: random.randrange(len(data))]


def _remove(data: bytearray, random: Random) -> bytearray:
    start = _place(data, random)
    del data[start : start + random.choice((1, 2, 7, 512, 4096))]
    return data


def _repeat(data: bytearray, random: Random) -> bytearray:
    start = _place(data, random)
    piece = data[start : start + random.choice((1, 4, 64, 512))]
    data[start:start] = piece * random.choice((1, 2, 50))
    return data


def _blank(data: bytearray, random: Random) -> bytearray:
    start = _place(data, random)
    length = min(random.choice((2, 16, 512)), len(data) - start)
    data[start : start + length] = bytes([random.choice((0, 255, 32))]) * length
    return data


def _word(data: bytearray, random: Random) -> bytearray:
    """A 16-bit count replaced: where a header of a C3D file holds its claims."""
    start = _place(data, random) & ~1
    data[start : start + 2] = random.choice((b"\xff\xff", b"\0\0", b"\xff\x7f", b"\1\0"))
    return data


def _place(data: bytearray, random: Random) -> int:
    """A place, near the beginning as often as anywhere: there a header stands."""
    return random.randrange(min(len(data), random.choice((20, 512, 2048, len(data)))))


def _cell(data: bytearray, random: Random) -> bytearray:
    """A cell of a row replaced."""
    lines = data.split(b"\n")
    row = random.randrange(min(len(lines), random.choice((6, len(lines)))))
    mark = b"," if lines[row].count(b",") else b"\t"
    cells = lines[row].split(mark)
    cells[random.randrange(len(cells))] = random.choice(WORDS).encode()
    lines[row] = mark.join(cells)
    return bytearray(b"\n".join(lines))


def _row(data: bytearray, random: Random) -> bytearray:
    """A row lost, doubled, or moved."""
    lines = data.split(b"\n")
    row = lines.pop(random.randrange(len(lines)))
    for _ in range(random.choice((0, 1, 2))):
        lines.insert(random.randrange(len(lines) + 1), row)
    return bytearray(b"\n".join(lines))


def _column(data: bytearray, random: Random) -> bytearray:
    """A column scaled, emptied or made constant throughout."""
    lines = data.split(b"\n")
    mark = b"," if any(line.count(b",") > 2 for line in lines) else b"\t"
    at, how = random.randrange(12), random.choice(("", "nan", "0", "1e3", "-1"))
    for i, line in enumerate(lines):
        cells = line.split(mark)
        if len(cells) > at and i > 8:
            cells[at] = how.encode()
            lines[i] = mark.join(cells)
    return bytearray(b"\n".join(lines))


_BINARY = (_flip, _cut, _remove, _repeat, _blank, _word)
_TEXT = (_cell, _cell, _row, _column)


class Late(Exception):
    """A case that took too long."""


@contextmanager
def patience(seconds: int) -> Iterator[None]:
    """Raise :class:`Late` in here after some seconds."""

    def late(*_: object) -> None:
        raise Late

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def asked_by_fork(path: Path) -> dict[str, Any]:
    """As the reader asks ezc3d, in a fork of this process: a new interpreter takes too long."""
    import ezc3d  # noqa: F401 - here, so that no fork has to

    target = path.with_suffix(".npz")
    target.unlink(missing_ok=True)
    child = os.fork()
    if child == 0:
        try:
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, 1)
            os.dup2(nowhere, 2)
            signal.alarm(PATIENCE - 5)
            limit_resources()
            answer(path, target)
        finally:
            os._exit(0)
    _, status = os.waitpid(child, 0)
    if os.waitstatus_to_exitcode(status) < 0:
        DEATHS[os.waitstatus_to_exitcode(status)] += 1
    return c3d.answered(target, os.waitstatus_to_exitcode(status), str(path))


DEATHS: Counter[int] = Counter()
"""Signals that ended a reading process: the parent told of each in one sentence."""


MEASURED = 10
"""Of the cases in which a file could be read, one in so many goes on to be measured."""


def outcome(path: Path, others: list[Path], case: int) -> str:
    """What a file leads to: "measured", "read", "no walk", "refused", or what went wrong."""
    try:
        with patience(PATIENCE), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            found = read_recording([path, *others])
            if case % MEASURED:
                return "read"
            try:
                measure(found, Choices(mass_kg=73.0))
            except InputError as error:
                return _told(error, "no walk")
            return "measured"
    except InputError as error:
        return _told(error, "refused")
    except Late:
        return "WRONG: late"
    except Exception as error:
        return f"WRONG: {type(error).__name__}: {error}"


def _told(error: InputError, what: str) -> str:
    text = str(error)
    return what if text and "\n" not in text and len(text) < 1500 else f"WRONG: message {text!r}"


def fuzz(kind: str, count: int, seed: int) -> Counter[str]:
    """Outcomes of ``count`` damaged files of a kind, counted."""
    files, random, found = seed_files(), Random(f"{kind} {seed}"), Counter[str]()
    with tempfile.TemporaryDirectory() as folder:
        path, markers = Path(folder) / f"walk.{kind}", Path(folder) / "markers.trc"
        markers.write_bytes(files["trc"])
        for case in range(count):
            path.write_bytes(damaged(files[kind], kind, random))
            result = outcome(path, [markers] if kind == "mot" else [], case)
            found[result] += 1
            if result.startswith("WRONG") and found[result] <= 2:
                keep = Path(tempfile.gettempdir()) / f"fuzz-{seed}-{case}.{kind}"
                keep.write_bytes(path.read_bytes())
                print(f"{result} (kept as {keep})", file=sys.stderr)
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--reader", choices=READERS, action="append")
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    c3d._asked = asked_by_fork
    wrong = 0
    for kind in arguments.reader or READERS:
        start = time.monotonic()
        found = fuzz(kind, arguments.count, arguments.seed)
        bad = {k: n for k, n in found.items() if k.startswith("WRONG")}
        wrong += sum(bad.values())
        print(
            f"{kind}: {arguments.count} files, seed {arguments.seed}: {found['refused']} refused, "
            f"{found['read']} read, {found['measured']} measured, {found['no walk']} read but no "
            f"walk, {sum(bad.values())} wrong; {time.monotonic() - start:.0f} s"
        )
        if kind == "c3d" and DEATHS:
            print(
                f"c3d: reading processes ended by signals {dict(DEATHS)}, each told in a sentence"
            )
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
