"""A made-up walker whose every curve is known: markers and force plates of Winter's mean angles.

Legs by the human means of hip, knee and ankle angle, half a stride apart; the lower of both feet
is on the ground, and the hips go as fast as the loaded metatarsals fall behind. Forces are the
human mean reactions, their point runs from heel to metatarsals.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ergowalk.body import Body
from ergowalk.corridors import human_gait
from ergowalk.recording import Plate, Recording

Array = NDArray[np.float64]

BODY = Body()
STRIDE = 1.14
TOE_OFF = 0.62
"""Winter's natural cadence: the reaction vanishes here."""

SIDES = {"right": 0.0, "left": 0.5}
NAMES = {"hip": "HJC", "knee": "KJC", "ankle": "AJC", "heel": "CAL", "metatarsal": "MT1"}
"""Names of the points in the set of joint centres."""


@dataclass(frozen=True)
class Walker:
    """Points (n, 2) by side and name, forward and up, and the load of each foot."""

    time: Array
    points: dict[str, dict[str, Array]]
    trunk: Array
    force: dict[str, Array]
    pressure: dict[str, Array]
    fraction: dict[str, Array]


def rod(length: float, angle: Array) -> Array:
    """A rod from the downward vertical, forward +."""
    return length * np.stack([np.sin(angle), -np.cos(angle)], axis=1)


def walker(duration: float = 4.0, rate: float = 100.0) -> Walker:
    """The walker at ``rate`` frames per second."""
    human, leg = human_gait("winter-natural"), BODY.leg(0)
    time = np.arange(int(duration * rate) + 1) / rate
    bare: dict[str, dict[str, Array]] = {}
    force, pressure, fraction = {}, {}, {}
    for side, shift in SIDES.items():
        s = time / STRIDE + shift - 0.3
        angle = {j: np.radians(human.curves[f"{j}_angle"][0](s)) for j in ("hip", "knee", "ankle")}
        shank = angle["hip"] - angle["knee"]
        foot = angle["ankle"] + shank + np.pi / 2 - leg.foot_angle
        knee = rod(leg.thigh_length, angle["hip"])
        ankle = knee + rod(leg.shank_length, shank)
        toes = ankle + rod(leg.ankle_to_metatarsal, foot)
        heel = toes - rod(leg.heel_to_metatarsal, foot + leg.foot_angle)
        bare[side] = {
            "hip": np.zeros_like(knee), "knee": knee, "ankle": ankle, "heel": heel,
            "metatarsal": toes,
        }  # fmt: skip
        loaded = (s % 1.0 < TOE_OFF)[:, None]
        reaction = [human.curves[f"reaction_{a}"][0](s) for a in "xy"]
        force[side] = BODY.total_mass * np.stack(reaction, axis=1) * loaded
        fraction[side] = s % 1.0
    lowest = np.min([p[r][:, 1] for p in bare.values() for r in ("heel", "metatarsal")], axis=0)
    load = {side: np.maximum(f[:, 1], 1e-3) for side, f in force.items()}
    back = sum(load[s] * np.gradient(p["metatarsal"][:, 0], time) for s, p in bare.items())
    speed = -back / sum(load.values())
    way = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 / rate)])
    hip = np.stack([way, -lowest], axis=1)
    points = {side: {role: hip + p for role, p in leg.items()} for side, leg in bare.items()}
    for side, p in points.items():
        share = np.clip(fraction[side] / TOE_OFF, 0, 1)
        pressure[side] = (1 - share) * p["heel"][:, 0] + share * p["metatarsal"][:, 0]
    return Walker(time, points, hip + np.array([0.0, 0.5]), force, pressure, fraction)


def recording(known: Walker, direction: float = 1.0, unit: str = "m") -> Recording:
    """The walker in a laboratory with z up, walking along ``direction`` times y, both feet on a
    plate of their own, the right foot on his right; lengths in mm or m."""
    scale = {"m": 1.0, "mm": 1e3}[unit]

    def placed(points: Array, aside: float) -> Array:
        # forward is y, up is z: right of a walker towards +y is +x
        across = np.full(len(points), direction * aside)
        return scale * np.stack([across, direction * points[:, 0], points[:, 1]], axis=1)

    markers, plates = {"C7": placed(known.trunk, 0.0)}, []
    for side, aside in (("right", 0.1), ("left", -0.1)):
        for role, name in NAMES.items():
            markers[side[0].upper() + name] = placed(known.points[side][role], aside)
        markers[side[0].upper() + "MT2"] = markers[side[0].upper() + "MT1"]
        force = known.force[side]
        vector = np.stack([0 * force[:, 0], direction * force[:, 0], force[:, 1]], axis=1)
        point = placed(np.stack([known.pressure[side], 0 * known.time], axis=1), aside)
        plates.append(Plate(side, known.time, vector, np.zeros_like(vector), point, unit))
    return Recording("made-up", known.time, markers, unit, tuple(plates))


def without_plates(whole: Recording) -> Recording:
    """The markers alone."""
    return replace(whole, plates=())


def trc_text(whole: Recording) -> str:
    """The markers as a TRC file."""
    names, count = list(whole.markers), len(whole.time)
    rate = f"{whole.rate:.2f}"
    head = [
        "PathFileType\t4\t(X/Y/Z)\tmade_up.trc",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame"
        "\tOrigNumFrames",
        f"{rate}\t{rate}\t{count}\t{len(names)}\t{whole.unit}\t{rate}\t1\t{count}",
        "Frame#\tTime\t" + "\t\t\t".join(names) + "\t\t",
        "\t\t" + "\t".join(f"{a}{i}" for i in range(1, len(names) + 1) for a in "XYZ"),
    ]
    table = np.concatenate(list(whole.markers.values()), axis=1)
    rows = [
        "\t".join([str(i + 1), f"{t:.4f}", *("" if v != v else f"{v:.5f}" for v in row)])
        for i, (t, row) in enumerate(zip(whole.time, table, strict=True))
    ]
    return "\n".join([*head, *rows]) + "\n"


def mot_text(whole: Recording) -> str:
    """The plates as a MOT file."""
    names, columns = ["time"], [whole.plates[0].time]
    for i, plate in enumerate(whole.plates, start=1):
        assert plate.point is not None
        metres = plate.in_metres(whole.unit or "m")
        for kind, values in (("v", plate.force), ("p", metres.point)):
            names += [f"ground_force_{i}_{kind}{axis}" for axis in "xyz"]
            columns += list(np.asarray(values).T)
    rows = ["\t".join(f"{value:.6f}" for value in row) for row in np.stack(columns, axis=1)]
    head = ["made_up", "version=1", f"nRows={len(rows)}", f"nColumns={len(names)}", "endheader"]
    return "\n".join([*head, "\t".join(names), *rows]) + "\n"


def csv_text(known: Walker) -> str:
    """The right leg in the plane, with its reaction, as a table in metres."""
    names = {"hip": "hip", "knee": "knee", "ankle": "ankle", "heel": "heel", "metatarsal": "mt5"}
    right = known.points["right"]
    columns = {"time_s": known.time, "rib_cage_x_m": known.trunk[:, 0]}
    columns["rib_cage_y_m"] = known.trunk[:, 1]
    for role, name in names.items():
        columns[f"{name}_x_m"], columns[f"{name}_y_m"] = right[role].T
    columns["grf_x_N"], columns["grf_y_N"] = known.force["right"].T
    columns["cop_x_m"] = known.pressure["right"]
    rows = [",".join(f"{v:.6f}" for v in row) for row in np.stack([*columns.values()], axis=1)]
    return "\n".join([",".join(columns), *rows]) + "\n"


def c3d_bytes(whole: Recording) -> bytes:
    """The markers [mm] and the channels of plates of type 2 as a C3D file of floats (Intel)."""
    frames, count = len(whole.time), len(whole.plates)
    channels, corners = [], []
    for plate in whole.plates:
        assert plate.point is not None
        moment = np.cross(plate.point, plate.force)  # N mm about the origin, the plate's middle
        turn = np.array([1.0, -1.0, -1.0])  # the plate's own axes: x as here, z down
        channels += [*(plate.force * turn).T, *(moment * turn).T]
        corners += [300, -300, 0, -300, -300, 0, -300, 300, 0, 300, 300, 0]
    names = [f"{k}{i}" for i in range(count) for k in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")]
    units = ["N", "N", "N", "Nmm", "Nmm", "Nmm"] * count
    groups = {
        "POINT": {
            "USED": _ints(len(whole.markers)),
            "SCALE": _floats(-1.0),
            "RATE": _floats(whole.rate),
            "DATA_START": _ints(0),
            "FRAMES": _ints(frames),
            "LABELS": _words(list(whole.markers)),
            "UNITS": _words(["mm"]),
        },
        "ANALOG": {
            "USED": _ints(len(names)),
            "LABELS": _words(names or [" "]),
            "GEN_SCALE": _floats(1.0),
            "SCALE": _floats(*[1.0] * len(names)),
            "OFFSET": _ints(*[0] * len(names)),
            "UNITS": _words(units or [" "]),
            "RATE": _floats(whole.rate),
        },
        "FORCE_PLATFORM": {
            "USED": _ints(count),
            "TYPE": _ints(*[2] * count),
            "ZERO": _ints(0, 0),
            "CORNERS": _floats(*map(float, corners), dims=(3, 4, count)),
            "ORIGIN": _floats(*[0.0] * 3 * count, dims=(3, count)),
            "CHANNEL": _ints(*range(1, 6 * count + 1), dims=(6, count)),
        },
    }
    parameters = _section(groups)
    blocks = -(-len(parameters) // 512)
    start = 2 + blocks
    parameters = _section(groups, start, blocks).ljust(512 * blocks, b"\0")
    header = struct.pack(
        "<BBHHHHHfHHf", 2, 0x50, len(whole.markers), len(names), 1, frames, 0, -1.0, start, 1,
        whole.rate,
    )  # fmt: skip
    data = np.zeros((frames, 4 * len(whole.markers) + len(names)), dtype="<f4")
    for i, values in enumerate(whole.markers.values()):
        data[:, 4 * i : 4 * i + 3] = np.nan_to_num(values)
        data[:, 4 * i + 3] = np.where(np.isnan(values).any(axis=1), -1.0, 0.0)
    if channels:
        data[:, 4 * len(whole.markers) :] = np.array(channels).T
    body = data.tobytes()
    return header.ljust(512, b"\0") + parameters + body.ljust(-(-len(body) // 512) * 512, b"\0")


def _ints(*values: int, dims: tuple[int, ...] | None = None) -> bytes:
    return _typed(2, struct.pack(f"<{len(values)}h", *values), len(values), dims)


def _floats(*values: float, dims: tuple[int, ...] | None = None) -> bytes:
    return _typed(4, struct.pack(f"<{len(values)}f", *values), len(values), dims)


def _words(words: list[str]) -> bytes:
    width = max(map(len, words))
    text = "".join(word.ljust(width) for word in words).encode("ascii")
    return _typed(-1, text, len(text), (width, len(words)))


def _typed(kind: int, content: bytes, count: int, dims: tuple[int, ...] | None) -> bytes:
    shape = dims if dims is not None else () if count == 1 else (count,)
    return struct.pack("<bB", kind, len(shape)) + bytes(shape) + content


def _section(groups: dict[str, dict[str, bytes]], start: int = 0, blocks: int = 0) -> bytes:
    """The parameter section; records point to the next one, the last to none."""
    out = bytes([1, 0x50, blocks, 84])
    last = (list(groups)[-1], list(groups[list(groups)[-1]])[-1])
    for number, (group, parameters) in enumerate(groups.items(), start=1):
        name = group.encode("ascii")
        out += struct.pack("<bb", len(name), -number) + name + struct.pack("<hB", 3, 0)
        for key, value in parameters.items():
            if key == "DATA_START":
                value = _ints(start)
            name = key.encode("ascii")
            content = value + b"\0"  # no description
            step = 0 if (group, key) == last else 2 + len(content)
            out += struct.pack("<bb", len(name), number) + name + struct.pack("<h", step) + content
    return out + b"\0\0"
