"""Readers of films that share nothing with what writes them: straight from the bytes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class Measured:
    """Size [pixels], how long each frame is shown [s], and whether the film begins anew."""

    width: int
    height: int
    delays: tuple[Fraction, ...]
    endless: bool

    @property
    def duration(self) -> Fraction:
        return sum(self.delays, Fraction(0))


def measured(content: bytes) -> Measured:
    """What a film says of itself."""
    if content[:6] == b"GIF89a":
        return _gif(content)
    if content[:4] == b"RIFF" and content[8:12] == b"WEBP":
        return _webp(content)
    assert content[4:8] == b"ftyp", "no gif, webp or mp4"
    return _mp4(content)


def _gif(content: bytes) -> Measured:
    """GIF89a: blocks after the logical screen, and the colours, that the header announces."""
    width, height = (int.from_bytes(content[k : k + 2], "little") for k in (6, 8))
    at = 13 + _colours(content[10])
    delays, endless, delay = [], False, Fraction(0)
    while content[at] != 0x3B:
        if content[at] == 0x21:  # an extension
            if content[at + 1] == 0xF9:
                delay = Fraction(int.from_bytes(content[at + 4 : at + 6], "little"), 100)
            endless |= content[at + 3 : at + 14] == b"NETSCAPE2.0"
            at += 2
        else:
            assert content[at] == 0x2C, hex(content[at])  # an image, its colours, a code size
            delays.append(delay)
            at += 10 + _colours(content[at + 9]) + 1
        while content[at]:  # sub-blocks, each behind its length
            at += 1 + content[at]
        at += 1
    assert at == len(content) - 1
    return Measured(width, height, tuple(delays), endless)


def _colours(flags: int) -> int:
    """Bytes of a table of colours."""
    return 3 * 2 ** ((flags & 7) + 1) if flags & 0x80 else 0


def _webp(content: bytes) -> Measured:
    """Extended WebP: chunks VP8X, ANIM and one ANMF for each frame."""
    assert int.from_bytes(content[4:8], "little") == len(content) - 8
    at, size, delays, endless = 12, (0, 0), [], False
    while at < len(content):
        kind, length = content[at : at + 4], int.from_bytes(content[at + 4 : at + 8], "little")
        body = content[at + 8 : at + 8 + length]
        if kind == b"VP8X":
            size = tuple(1 + int.from_bytes(body[k : k + 3], "little") for k in (4, 7))
        elif kind == b"ANIM":
            endless = body[4:6] == b"\0\0"
        elif kind == b"ANMF":
            delays.append(Fraction(int.from_bytes(body[12:15], "little"), 1000))
        at += 8 + length + length % 2
    return Measured(size[0], size[1], tuple(delays), endless)


def _mp4(content: bytes) -> Measured:
    """ISO base media: boxes in boxes; the index must come before the pictures."""
    names = [name for name, _ in _boxes(content)]
    assert names.index("moov") < names.index("mdat")
    (track,) = (body for name, body in _boxes(_box(content, "moov")) if name == "trak")
    media = _box(track, "mdia")
    header = _box(track, "tkhd")
    width, height = (int.from_bytes(p, "big") >> 16 for p in (header[-8:-4], header[-4:]))
    ticks = int.from_bytes(_box(media, "mdhd")[12:16], "big")
    table = _box(_box(_box(media, "minf"), "stbl"), "stts")
    delays: list[Fraction] = []
    for k in range(int.from_bytes(table[4:8], "big")):
        entry = table[8 + 8 * k : 16 + 8 * k]
        count, step = (int.from_bytes(part, "big") for part in (entry[:4], entry[4:]))
        delays += [Fraction(step, ticks)] * count
    return Measured(width, height, tuple(delays), False)


def _box(content: bytes, name: str) -> bytes:
    return next(body for found, body in _boxes(content) if found == name)


def _boxes(content: bytes) -> Iterator[tuple[str, bytes]]:
    at = 0
    while at < len(content):
        length, head = int.from_bytes(content[at : at + 4], "big"), 8
        if length == 1:
            length, head = int.from_bytes(content[at + 8 : at + 16], "big"), 16
        yield content[at + 4 : at + 8].decode("latin-1"), content[at + head : at + length]
        at += length
