"""Which marker is what: named sets, sets from a file, and the hip centre from the pelvis."""

from __future__ import annotations

import tomllib
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, Self

from pydantic import Field, model_validator

from ergowalk.errors import RecordingError
from ergowalk.values import Value, invalid

Names = tuple[str, ...]

ROLES = ("hip", "knee", "ankle", "heel", "metatarsal", "toe")
"""Points of a leg; several markers for one of them count as their mean."""

NEEDED = ("knee", "ankle", "heel", "metatarsal")
SIDES = ("right", "left")


class LegMarkers(Value):
    """The markers of a leg."""

    _error = RecordingError

    hip: Names = Field(default=(), description="hip, greater trochanter; none: from the pelvis")
    knee: Names = Field(default=(), description="knee, lateral and perhaps medial epicondyle")
    ankle: Names = Field(default=(), description="ankle, lateral and perhaps medial malleolus")
    heel: Names = Field(default=(), description="heel")
    metatarsal: Names = Field(default=(), description="heads of metatarsals")
    toe: Names = Field(default=(), description="toe tip; may be missing")

    @model_validator(mode="after")
    def _whole(self) -> Self:
        if self.given and any(not getattr(self, role) for role in NEEDED):
            missing = next(role for role in NEEDED if not getattr(self, role))
            raise invalid(missing, [], "has no marker", f"a leg needs {', '.join(NEEDED)}")
        return self

    @property
    def given(self) -> bool:
        """Whether the leg has markers at all."""
        return any(getattr(self, role) for role in ROLES)


class PelvisMarkers(Value):
    """Markers of the pelvis, for hip centres by regression."""

    _error = RecordingError

    right_asis: str = Field(description="right anterior superior iliac spine")
    left_asis: str = Field(description="left anterior superior iliac spine")
    back: Names = Field(description="sacrum, or both posterior superior iliac spines")


class MarkerSet(Value):
    """Names of markers by what they mark.

    ``clusters`` are groups of markers on one rigid segment; a marker that the walk lacks is rebuilt
    from a static trial by the cluster in which it stands.
    """

    _error = RecordingError

    name: str = Field(default="custom", description="a name for the set")
    summary: str = Field(default="", description="a line about it")
    right: LegMarkers = Field(default=LegMarkers(), description="the right leg")
    left: LegMarkers = Field(default=LegMarkers(), description="the left leg")
    trunk: Names = Field(
        default=(), description="upper end of the trunk; none: the trunk is taken as upright"
    )
    shoulder: bool = Field(
        default=False, description="whether the trunk's upper end is at the shoulders"
    )
    pelvis: PelvisMarkers | None = Field(default=None, description="for hips without marker")
    clusters: tuple[Names, ...] = Field(default=(), description="markers of one segment each")

    def leg(self, side: str) -> LegMarkers:
        """The markers of the right or left leg."""
        markers: LegMarkers = getattr(self, side)
        return markers

    @model_validator(mode="after")
    def _hips(self) -> Self:
        legs = [self.leg(side) for side in SIDES if self.leg(side).given]
        if not legs:
            raise invalid("right", None, "no leg has markers", f"give {', '.join(ROLES)}")
        if self.pelvis is None and not all(leg.hip for leg in legs):
            raise invalid(
                "hip", [], "has neither marker nor pelvis", "give a marker or a table [pelvis]"
            )
        return self

    @property
    def sides(self) -> tuple[str, ...]:
        """The legs that have markers."""
        return tuple(side for side in SIDES if self.leg(side).given)

    def used(self) -> tuple[str, ...]:
        """Every marker without which this set says nothing; toes may be missing."""
        names: list[str] = []
        for side in self.sides:
            roles = [role for role in ROLES if role != "toe"]
            names += [name for role in roles for name in getattr(self.leg(side), role)]
            if not self.leg(side).hip and self.pelvis is not None:
                names += [self.pelvis.right_asis, self.pelvis.left_asis, *self.pelvis.back]
        return tuple(dict.fromkeys([*names, *self.trunk]))


def read_marker_set(path: Path) -> MarkerSet:
    """A set from a TOML file with the fields of :class:`MarkerSet`.

    Raises
    ------
    RecordingError
        If the file cannot be read or describes no set.
    """
    try:
        data = tomllib.loads(path.read_bytes().decode("utf-8-sig"))
    except (OSError, ValueError, RecursionError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise RecordingError(
            f"cannot be read as TOML ({reason})", "give a marker set", file=str(path)
        ) from None
    try:
        return MarkerSet(**_tuples(data))
    except RecordingError as error:
        raise error.located(str(path)) from None


def _tuples(data: Mapping[str, Any]) -> dict[str, Any]:
    """Lists of names, and single names where a list may stand, as tuples."""
    found: dict[str, Any] = {}
    for key, value in data.items():
        if isinstance(value, Mapping):
            found[key] = _tuples(value)
        elif isinstance(value, list):
            found[key] = tuple(tuple(v) if isinstance(v, list) else v for v in value)
        elif isinstance(value, str) and key in (*ROLES, "trunk", "back"):
            found[key] = (value,)
        else:
            found[key] = value
    return found


def choose_marker_set(names: Collection[str], wanted: str | None = None) -> MarkerSet:
    """The named set, or the one whose markers are all among ``names``; the largest counts.

    Raises
    ------
    RecordingError
        If there is no such set, or markers of it are missing.
    """
    if wanted is not None:
        known = {s.name: s for s in MARKER_SETS}
        if wanted in known:
            return known[wanted]
        if wanted.endswith(".toml"):
            return read_marker_set(Path(wanted))
        raise RecordingError(
            "no such marker set",
            f"choose one of {', '.join(known)}, or give a TOML file",
            field="markers",
            value=wanted,
        )
    here = set(names)
    lacks = {s.name: [m for m in s.used() if m not in here] for s in MARKER_SETS}
    whole = [s for s in MARKER_SETS if not lacks[s.name]]
    if whole:
        return max(whole, key=lambda s: len(s.used()))
    nearest = max(MARKER_SETS, key=lambda s: 1 - len(lacks[s.name]) / len(s.used()))
    missing = lacks[nearest.name]
    if len(missing) <= len(nearest.used()) // 2:
        rule = f"markers of the nearest known set {nearest.name} are missing: {', '.join(missing)}"
        static = " or a static trial that has them" if nearest.clusters else ""
        raise RecordingError(rule, f"give a map with --markers{static}", field="markers")
    raise RecordingError(
        f"no known set fits {', '.join(sorted(here)[:8])} ...",
        "give a map of their names with --markers MAP.toml",
        field="markers",
    )


def _both(**roles: str) -> dict[str, Any]:
    """Legs whose names differ in a letter, written ?."""
    return {
        side: LegMarkers(
            **{
                r: tuple(n.replace("?", side[0].upper()) for n in v.split())
                for r, v in roles.items()
            }
        )
        for side in SIDES
    }


# each joint by the segment below it: markers on a thigh move over its bone most
_OPENSIM_CLUSTERS = tuple(
    tuple(name.replace("?", side) for name in names.split())
    for side in "RL"
    for names in (
        "?.Shank.Upper ?.Shank.Front ?.Shank.Rear ?.Knee.Lat ?.Knee.Med",
        "?.Heel ?.Midfoot.Sup ?.Midfoot.Lat ?.Toe.Lat ?.Toe.Med ?.Ankle.Lat ?.Ankle.Med",
    )
)

MARKER_SETS = (
    MarkerSet(
        name="winter",
        summary="right leg in the plane: rib_cage hip knee ankle heel mt5 toe (Winter's subject)",
        right=LegMarkers(
            hip=("hip",),
            knee=("knee",),
            ankle=("ankle",),
            heel=("heel",),
            metatarsal=("mt5",),
            toe=("toe",),
        ),
        trunk=("rib_cage",),
    ),
    MarkerSet(
        name="gatk-2d",
        summary="right leg in the plane: RSHO RGTRO RLEK RLM RHEE RMT5 (Gait Analysis Toolkit)",
        right=LegMarkers(
            hip=("RGTRO",), knee=("RLEK",), ankle=("RLM",), heel=("RHEE",), metatarsal=("RMT5",)
        ),
        trunk=("RSHO",),
        shoulder=True,
    ),
    MarkerSet(
        name="bmclab",
        summary="right leg: FH LE ME LM MM CA FM VM, no trunk",
        right=LegMarkers(
            hip=("FH",),
            knee=("LE", "ME"),
            ankle=("LM", "MM"),
            heel=("CA",),
            metatarsal=("FM", "VM"),
        ),
    ),
    MarkerSet(
        name="plug-in-gait",
        summary="both legs: RASI LASI RPSI LPSI ?KNE ?ANK ?HEE ?TOE C7",
        **_both(knee="?KNE", ankle="?ANK", heel="?HEE", metatarsal="?TOE"),
        trunk=("C7",),
        shoulder=True,
        pelvis=PelvisMarkers(right_asis="RASI", left_asis="LASI", back=("RPSI", "LPSI")),
    ),
    MarkerSet(
        name="joint-centres",
        summary="both legs: joint centres ?HJC ?KJC ?AJC, ?CAL ?MT1 ?MT2 C7",
        **_both(hip="?HJC", knee="?KJC", ankle="?AJC", heel="?CAL", metatarsal="?MT1 ?MT2"),
        trunk=("C7",),
        shoulder=True,
    ),
    MarkerSet(
        name="opensim-gait",
        summary="both legs: the set of OpenSim's walking examples, knees and ankles by a static "
        "trial",
        **_both(
            knee="?.Knee.Lat ?.Knee.Med",
            ankle="?.Ankle.Lat ?.Ankle.Med",
            heel="?.Heel",
            metatarsal="?.Toe.Lat ?.Toe.Med",
            toe="?.Toe.Tip",
        ),
        trunk=("R.Acromium", "L.Acromium"),
        shoulder=True,
        pelvis=PelvisMarkers(right_asis="R.ASIS", left_asis="L.ASIS", back=("V.Sacral",)),
        clusters=_OPENSIM_CLUSTERS,
    ),
)
"""The sets that are known by name."""
