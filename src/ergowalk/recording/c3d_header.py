"""The first bytes of a C3D file: what it claims to hold, against what it holds.

Layout of the header block and of the first bytes of the parameter section as in the C3D user guide
(c3d.org).
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass

from ergowalk.errors import RecordingError
from ergowalk.recording.recording import FASTEST, MOST_NUMBERS, SLOWEST

BLOCK = 512
_ORDERS = {84: "<", 85: "<", 86: ">"}
"""Byte order by processor: Intel, DEC, MIPS."""


@dataclass(frozen=True)
class C3DHeader:
    """Counts of the header: points and analog samples of a frame, frames, bytes of a number."""

    points: int
    analogs: int
    first_frame: int
    last_frame: int
    data_block: int
    width: int

    @property
    def frame_bytes(self) -> int:
        """Size of a frame [bytes]."""
        return self.width * (4 * self.points + self.analogs)


def check_header(content: bytes, file: str) -> C3DHeader:
    """The header of a C3D file whose content can be what the header claims.

    Raises
    ------
    RecordingError
        If this is no C3D file, a count cannot be, or the file is shorter than it claims.
    """
    if len(content) < 2 * BLOCK or content[1] != 0x50:
        raise RecordingError("is no C3D file", "give the file of the trial itself", file=file)
    start = (content[0] - 1) * BLOCK
    if start < BLOCK or start + 4 > len(content) or content[start + 3] not in _ORDERS:
        raise RecordingError(
            "has no parameter section where its header says", "export the trial again", file=file
        )
    header = _header(content, start)
    end_of_parameters = start + BLOCK * max(1, content[start + 2])
    if end_of_parameters > len(content):
        raise _truncated(end_of_parameters, len(content), file)
    _check_parameters(content, start, end_of_parameters, file)
    _check_counts(header, file)
    frames = header.last_frame - header.first_frame + 1
    if header.last_frame == 0xFFFF:  # the header cannot count further: by the bytes that are there
        frames = 1
    if frames * (4 * header.points + header.analogs) > MOST_NUMBERS:
        raise RecordingError(f"claims more than {MOST_NUMBERS} numbers", "cut the trial", file=file)
    needed = (header.data_block - 1) * BLOCK + frames * header.frame_bytes
    if needed > len(content):
        raise _truncated(needed, len(content), file)
    return header


def _header(content: bytes, start: int) -> C3DHeader:
    order = _ORDERS[content[start + 3]]
    words = struct.unpack(order + "9H", content[2:20])
    scale = content[12:16]
    if content[start + 3] == 85:  # DEC: as Intel with the halves swapped; its sign bit stands there
        scale = scale[2:] + scale[:2]
    negative = struct.unpack(order + "f", scale)[0] < 0
    return C3DHeader(
        points=words[0],
        analogs=words[1],
        first_frame=words[2],
        last_frame=words[3],
        data_block=words[7],
        width=4 if negative else 2,
    )


def _check_parameters(content: bytes, start: int, end: int, file: str) -> None:
    """Walk through the parameters: each leads forward to the next, and holds what it claims.

    A reader that trusts them may otherwise walk in a circle.
    """
    order = "<" if content[start + 3] != 86 else ">"
    at = start + 4
    while at + 2 <= end:
        length, group = struct.unpack("bb", content[at : at + 2])
        if length == 0:
            return
        after_name = at + 2 + abs(length)
        if group == 0 or after_name + 4 > end:
            raise _lost_way(at, file)
        step = struct.unpack(order + "h", content[after_name : after_name + 2])[0]
        last = step == 0
        after = end if last else after_name + step
        if step < 0 or after > end or (group > 0 and not _holds(content, after_name + 2, after)):
            raise _lost_way(at, file)
        if last:
            return
        at = after


def _holds(content: bytes, at: int, end: int) -> bool:
    """Whether a parameter's values end before ``end``."""
    kind, dimensions = struct.unpack("bB", content[at : at + 2])
    if kind not in _SIZES or dimensions > 7 or at + 2 + dimensions > end:
        return False
    values = math.prod(content[at + 2 : at + 2 + dimensions])
    return bool(at + 2 + dimensions + _SIZES[kind] * values <= end)


_SIZES = {-1: 1, 1: 1, 2: 2, 4: 4}
"""Bytes of a character, a byte, an integer and a float."""


def _lost_way(at: int, file: str) -> RecordingError:
    return RecordingError(
        f"is damaged: the parameter at byte {at} does not lead to the next",
        "copy or export the trial again",
        file=file,
    )


def _check_counts(header: C3DHeader, file: str) -> None:
    if header.points == 0:
        raise RecordingError("has no markers", "give a trial with markers", file=file)
    if header.last_frame < header.first_frame or header.data_block < 2:
        raise RecordingError(
            f"claims frames {header.first_frame} to {header.last_frame} in block "
            f"{header.data_block}",
            "export the trial again",
            file=file,
        )


def check_rate(rate: float, file: str) -> None:
    """Refuse a sampling rate that is none.

    Raises
    ------
    RecordingError
        If it is not that of a motion capture.
    """
    if not SLOWEST <= rate <= FASTEST:
        raise RecordingError(
            f"must lie between {SLOWEST:g} and {FASTEST:g} Hz",
            "export the trial again",
            field="POINT:RATE",
            value=rate,
            file=file,
        )


def _truncated(needed: int, there: int, file: str) -> RecordingError:
    return RecordingError(
        f"is truncated: its header claims {needed} bytes, it has {there}",
        "copy or export the trial again",
        file=file,
    )
