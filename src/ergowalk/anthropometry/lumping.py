"""Head, arms and trunk as one rigid body over the hip, as the model has it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from ergowalk.anthropometry.tables import Segment

ARM = ("upper_arm", "forearm", "hand")


@dataclass(frozen=True)
class Part:
    """A rigid part of the upper body: mass [fraction of the body's], height of its centre of mass
    over the hip [m], radius of gyration about that centre [m]."""

    mass: float
    height: float
    gyration: float


def upper_body(
    table: str, segments: Mapping[str, Segment], length: Callable[[str], float]
) -> tuple[Part, ...]:
    """The parts of head, arms and trunk.

    Parameters
    ----------
    table : {"dempster", "deleva"}
    segments : mapping
        The segments of that table.
    length : callable
        Length [m] by its name in the table of lengths, measured ones replaced.
    """
    if table == "dempster":
        # one row of the table, from hip (greater trochanter) to shoulder; the arms hang down
        hat, span = segments["hat"], length("hip_to_shoulder")
        return (Part(hat.mass, hat.com * span, hat.gyration * span),)
    return tuple(_parts(segments, length))


def _parts(segments: Mapping[str, Segment], length: Callable[[str], float]) -> Iterator[Part]:
    """Trunk, head and hanging arms of de Leva, whose ends are found from the table alone.

    The trunk reaches from the middle of the hips to the middle of the shoulders. The same centre
    of mass is given from the 7th cervical vertebra too, which tells how high that lies; the head
    reaches from there to the top, and the top is at body height.
    """
    trunk, long_trunk, head = segments["trunk_3"], segments["trunk_2"], segments["head_2"]
    shoulder = length("hip_to_shoulder")
    neck = shoulder * (1 - trunk.com) / (1 - long_trunk.com)
    top = length("body_height") - length("hip_height")
    yield Part(trunk.mass, (1 - trunk.com) * shoulder, trunk.gyration * shoulder)
    yield Part(head.mass, top - head.com * (top - neck), head.gyration * (top - neck))
    end = shoulder
    for name in ARM:
        row = segments["hand_2" if name == "hand" else name]  # a hand to the tip of its finger
        span = length(name)
        yield Part(2 * row.mass, end - row.com * span, row.gyration * span)
        end -= span
