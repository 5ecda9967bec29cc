"""What holds at phase boundaries because of devices, and which own moments vanish there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ergowalk.gait.rhythm import Contact, Phase
from ergowalk.problem import constraints as c
from ergowalk.transcription.devices import LOADED_JOINTS, RATE
from ergowalk.transcription.phases import Instant, Link, Terms
from ergowalk.transcription.walker import Walker

NEXT = (Contact.TOE, Contact.HEEL)
"""Contact of the leading and of the trailing leg at the start of the next half stride, in which
they exchange their roles; a device stays with its leg."""

BEFORE = (Contact.SWING, Contact.FOREFOOT)
"""Contact of the leading and of the trailing leg at the end of the half stride before."""


def fixed_moments(walker: Walker, phases: Sequence[Phase]) -> dict[tuple[str, str, str], float]:
    """Own moments that are zero at a boundary: (boundary, name, "control") -> 0.

    Those of :func:`~ergowalk.problem.constraints.fixed_at_boundaries`, where there is such a
    moment and no device that it must hold in swing; and those that give way to a lock or to a
    free hinge there, as a limit on their rate demands.
    """
    there = {n for phase in phases for n in _own_names(walker, phase)}
    held = {f"{joint}_{role + 1}" for joint, role, _ in _held(walker, phases)}
    fixed = {
        key: value
        for key, value in c.fixed_at_boundaries(walker.flat).items()
        if key[2] == "control" and key[1] in there and key[1] not in held
    }
    fixed = {k: v for k, v in fixed.items() if _at(walker, phases, *k[:2])}
    for phase, after in zip(phases, (*phases[1:], None), strict=True):
        for role in (0, 1):
            contact = NEXT[role] if after is None else after.legs[role]
            gone, come = _changing(walker, role, phase.legs[role], contact)
            stays = gone if after is None else (*gone, *come)
            fixed |= {(phase.end, name, "control"): 0.0 for name in stays}
    for role, before in enumerate(BEFORE):
        _, come = _changing(walker, role, before, phases[0].legs[role])
        fixed |= {(phases[0].start, name, "control"): 0.0 for name in come}
    return fixed


def _own_names(walker: Walker, phase: Phase) -> Iterator[str]:
    for role, contact in enumerate(phase.legs):
        for joint in LOADED_JOINTS[contact]:
            if walker.fittings.own(role, joint, contact):
                yield f"{joint}_{role + 1}"


def _at(walker: Walker, phases: Sequence[Phase], boundary: str, name: str) -> bool:
    """Whether an own moment exists on either side of a boundary."""
    near = [p for p in phases if boundary in (p.start, p.end)]
    return any(name in set(_own_names(walker, phase)) for phase in near)


def _changing(
    walker: Walker, role: int, before: Contact, after: Contact
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Own moments of a leg that end, and those that begin, although the joint stays loaded."""
    gone, come = [], []
    for joint in ("hip", "knee", "ankle"):
        if joint not in LOADED_JOINTS[before] or joint not in LOADED_JOINTS[after]:
            continue
        here, there = (walker.fittings.own(role, joint, c) for c in (before, after))
        if here and not there:
            gone.append(f"{joint}_{role + 1}")
        elif there and not here:
            come.append(f"{joint}_{role + 1}")
    return tuple(gone), tuple(come)


def _held(walker: Walker, phases: Sequence[Phase]) -> Iterator[tuple[str, int, str]]:
    """(joint, role, boundary) where an own moment takes over a device that it held in swing.

    At heel contact leg 1, at toe-off leg 2, if the device acts on both sides.
    """
    fittings = walker.fittings
    for role, contact, boundary in (
        (0, Contact.HEEL, "heel_contact"),
        (1, Contact.TOE, "other_toe_off"),
    ):
        device = fittings.devices.get((role, "ankle"))
        if device is None or not device.acts(contact):
            continue
        if fittings.holds_swing_foot(role, Contact.SWING) is not None:
            yield "ankle", role, boundary


def device_links(walker: Walker, phases: Sequence[Phase]) -> Iterator[Link]:
    """Conditions of devices at the boundaries of the half stride."""
    for joint, role, boundary in _held(walker, phases):
        yield _balanced(walker, phases, joint, role, boundary)
    after_toe_off = next(p for p in phases if p.start == "other_toe_off")
    if walker.fittings.moves_swing_foot(1, Contact.SWING) is not None:
        device = walker.fittings.devices[1, "ankle"]
        if device.acts(Contact.TOE):  # else a latch opens, and the foot moves on from there
            yield Link(
                "toe_off_of_device",
                "other_toe_off",
                lambda t: _rows("swing foot on its device", _leaving(walker, after_toe_off, t)),
            )
    for phase, after in zip(phases, (*phases[1:], None), strict=True):
        for role in (0, 1):
            contact = NEXT[role] if after is None else after.legs[role]
            yield from _closing(walker, phase, after or phase, role, contact)


def _closing(
    walker: Walker, phase: Phase, seen: Phase, role: int, contact: Contact
) -> Iterator[Link]:
    """Latches of a leg that close at the end of a phase; ``seen`` is where its angles are known."""
    for (owner, joint), device in walker.fittings.devices.items():
        if owner != role or device.acts(phase.legs[role]) or not device.acts(contact):
            continue
        if joint == "metatarsal" and contact is not Contact.TOE:
            continue  # at rest up to heel-off

        def function(t: Instant, joint: str = joint) -> Terms:
            at = walker.at(t.shared)
            return _rows("latch closes", at.fittings.closing(role, joint, at.motion(seen, t)))

        if device.kind in ("locked", "spring", "parallel"):
            yield Link(f"latch_{joint}_{role + 1}_{phase.end}", phase.end, function)


def _leaving(walker: Walker, phase: Phase, instant: Instant) -> list[object]:
    at = walker.at(instant.shared)
    return at.fittings.leaving_the_ground(1, at.motion(phase, instant), instant)


def _balanced(
    walker: Walker, phases: Sequence[Phase], joint: str, role: int, boundary: str
) -> Link:
    """Own moment plus device is zero at a boundary where the foot meets or leaves the ground."""
    phase = next(p for p in phases if p.start == boundary)
    name = f"{joint}_{role + 1}"

    def function(instant: Instant) -> Terms:
        at = walker.at(instant.shared)
        motion = at.motion(phase, instant)
        slips = {n: s.value for n, s in instant.coordinates.items()}
        contact = phase.legs[role]
        device = at.fittings.moment(role, joint, contact, motion, slips, {})
        terms = Terms()
        terms.equal("device held", instant.controls[name] + device)
        return terms

    return Link(f"held_{name}", boundary, function, (name,))


def _rows(label: str, expressions: list[object]) -> Terms:
    terms = Terms()
    terms.equal(label, *(e / RATE for e in expressions))  # type: ignore[operator]
    return terms
