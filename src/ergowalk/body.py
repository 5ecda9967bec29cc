"""The body: masses, lengths and inertias of the nine-link walker.

Field names carry their units; the paper's symbols are in each description and in
:meth:`Body.by_symbol`. A leg's value is one number, or a pair (leg 1, leg 2) where the legs
differ.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from pydantic import Field, model_validator

from ergowalk.anthropometry import Person
from ergowalk.errors import BodyError
from ergowalk.values import PositiveFloat, Value, invalid

SMALLEST, LARGEST = 1e-6, 1e6
"""Range of every parameter, in its SI unit."""

PerLeg = PositiveFloat | tuple[PositiveFloat, PositiveFloat]


@dataclass(frozen=True)
class LegParameters:
    """Parameters of one leg in SI units, as the mechanics use them."""

    thigh_mass: float
    thigh_length: float
    thigh_com: float
    thigh_inertia: float
    shank_mass: float
    shank_length: float
    shank_com: float
    shank_inertia: float
    foot_mass: float
    heel_to_ankle: float
    ankle_to_metatarsal: float
    heel_to_metatarsal: float
    toe_length: float

    @property
    def foot_angle(self) -> float:
        """Angle phi_m = AMH of the foot triangle [rad], by the law of cosines."""
        c, l_h = self.ankle_to_metatarsal, self.heel_to_metatarsal
        cosine = (c**2 + l_h**2 - self.heel_to_ankle**2) / (2 * c * l_h)
        return cosine.arccos() if hasattr(cosine, "arccos") else math.acos(cosine)

    @property
    def ankle_height(self) -> float:
        """Height of the ankle over the sole of a flat foot [m]."""
        return self.ankle_to_metatarsal * math.sin(self.foot_angle)


class Body(Value):
    """Parameters of the walker; the defaults are those of Berbyuk et al. (2002), section 5.

    The paper's inertias are printed with the unit of a moment; they are kg m2 about the proximal
    joint. Its foot triangle lacks |HM| = l_h: 0.20 m gives an ankle 0.102 m high and a foot of
    0.30 m.

    Raises
    ------
    BodyError
        For a value that is not positive or absurdly small or large, a foot triangle that cannot
        close, or a mass matrix that is not positive definite in some posture.
    """

    _error = BodyError

    trunk_mass_kg: PositiveFloat = Field(default=46.7, description="trunk mass, m")
    trunk_com_m: PositiveFloat = Field(default=0.39, description="hip to trunk centre of mass, r")
    trunk_inertia_kgm2: PositiveFloat = Field(
        default=7.096, description="trunk inertia about the hip, J"
    )
    thigh_mass_kg: PerLeg = Field(default=8.49, description="thigh mass, m_a")
    thigh_length_m: PerLeg = Field(default=0.47, description="thigh length, a")
    thigh_com_m: PerLeg = Field(default=0.258, description="hip to thigh centre of mass, r_a")
    thigh_inertia_kgm2: PerLeg = Field(default=0.57, description="thigh inertia about the hip, J_a")
    shank_mass_kg: PerLeg = Field(default=3.51, description="shank mass, m_b")
    shank_length_m: PerLeg = Field(default=0.53, description="shank length, b")
    shank_com_m: PerLeg = Field(default=0.214, description="knee to shank centre of mass, r_b")
    shank_inertia_kgm2: PerLeg = Field(
        default=0.16, description="shank inertia about the knee, J_b"
    )
    foot_mass_kg: PerLeg = Field(default=1.24, description="foot mass, at the ankle, m_f")
    heel_to_ankle_m: PerLeg = Field(default=0.12, description="heel to ankle, HA")
    ankle_to_metatarsal_m: PerLeg = Field(default=0.17, description="ankle to metatarsal joint, AM")
    heel_to_metatarsal_m: PerLeg = Field(default=0.2, description="heel to metatarsal joint, l_h")
    toe_length_m: PerLeg = Field(default=0.1, description="metatarsal joint to toe tip, l_m")
    gravity_m_s2: PositiveFloat = Field(default=9.81, description="gravity, g")

    def leg(self, index: int) -> LegParameters:
        """Parameters of leg ``index`` (0 is leg 1 of the paper)."""
        values = {name: getattr(self, field) for name, field in _LEG_FIELDS.items()}
        return LegParameters(
            **{k: v[index] if isinstance(v, tuple) else v for k, v in values.items()}
        )

    def exchanged(self) -> Self:
        """The body with the legs exchanged."""
        pairs = {f: v for f in _LEG_FIELDS.values() if isinstance(v := getattr(self, f), tuple)}
        return self.model_copy(update={f: v[::-1] for f, v in pairs.items()})

    def mirrored(self, share: float = 0.0) -> Self:
        """The body with two equal legs, the mean of both, or with a share of their difference."""

        def nearer(pair: tuple[float, float]) -> float | tuple[float, float]:
            mean = sum(pair) / 2
            if share == 0:
                return mean
            return mean + share * (pair[0] - mean), mean + share * (pair[1] - mean)

        pairs = {f: v for f in _LEG_FIELDS.values() if isinstance(v := getattr(self, f), tuple)}
        changed: Self = self.replace(**{f: nearer(v) for f, v in pairs.items()}) if pairs else self
        return changed

    @property
    def legs_equal(self) -> bool:
        """Whether both legs have the same parameters."""
        return self.leg(0) == self.leg(1)

    @property
    def total_mass(self) -> float:
        """Total mass M [kg]."""
        legs = (self.leg(0), self.leg(1))
        return self.trunk_mass_kg + sum(p.thigh_mass + p.shank_mass + p.foot_mass for p in legs)

    def by_symbol(self) -> dict[str, float | tuple[float, float]]:
        """The parameters under the paper's symbols (m, r, J, m_a, ... l_h, g)."""
        return {symbol: getattr(self, field) for symbol, field in SYMBOLS.items()}

    @classmethod
    def from_height_mass(
        cls,
        height_m: float,
        mass_kg: float,
        sex: str | None = None,
        table: str | None = None,
        **measured_m: float,
    ) -> Self:
        """The body of a person, after published tables.

        Lengths are fractions of height (Drillis & Contini), masses, centres of mass and inertias
        those of a table of segments. Head, arms and trunk make the trunk, and the mass of a foot
        lies at the ankle.

        Parameters
        ----------
        height_m, mass_kg : float
            Body height [m] and mass [kg].
        sex : {"male", "female"}, optional
            Which of de Leva's tables; male unless said. Dempster's table knows no sexes.
        table : {"dempster", "deleva"}, optional
            Unless said, "deleva" where a sex is given and "dempster" where not.
        **measured_m : float
            Measured lengths [m] instead of fractions of height: thigh_length_m, shank_length_m,
            ankle_height_m, foot_length_m, hip_to_shoulder_m, heel_to_ball_m,
            ankle_ahead_of_heel_m.

        Raises
        ------
        BodyError
            For values that no adult has, or that contradict each other.
        """
        given: dict[str, Any] = {"sex": sex, "table": table, **measured_m}
        return cls(**Person(height_m=height_m, mass_kg=mass_kg, **given).parameters())

    @classmethod
    def from_symbols(cls, symbols: Mapping[str, Any]) -> Self:
        """Inverse of :meth:`by_symbol`; a pair may be a list, as in JSON.

        Raises
        ------
        BodyError
            If this is no mapping, a symbol is unknown or missing (nothing is filled in), or no
            such body can exist.
        """
        if not isinstance(symbols, Mapping):
            raise BodyError("should map symbols to values", f"give {', '.join(SYMBOLS)}")
        for key in (*symbols, *SYMBOLS):
            if key not in SYMBOLS or key not in symbols:
                rule = "required but missing" if key in SYMBOLS else "unknown symbol"
                raise BodyError(rule, f"give exactly {', '.join(SYMBOLS)}", field=str(key))
        return cls(**{field: symbols[symbol] for symbol, field in SYMBOLS.items()})

    @model_validator(mode="after")
    def _can_exist(self) -> Self:
        self._check_sizes()
        for i in (0, 1):
            self._check_foot(self.leg(i))
        self._check_mass_matrix()
        return self

    def _check_sizes(self) -> None:
        """Far beyond any walker, squares and products leave the range of floating point."""
        for field in type(self).model_fields:
            value = getattr(self, field)
            for number in value if isinstance(value, tuple) else (value,):
                if not SMALLEST <= number <= LARGEST:
                    raise invalid(
                        field,
                        number,
                        f"must lie between {SMALLEST:g} and {LARGEST:g}",
                        "give it in SI units, for one person",
                    )

    def _check_foot(self, leg: LegParameters) -> None:
        sides = (leg.heel_to_ankle, leg.ankle_to_metatarsal, leg.heel_to_metatarsal)
        if 2 * max(sides) >= (1 - 1e-9) * sum(sides):  # not flat up to rounding either
            raise invalid(
                "heel_to_metatarsal_m",
                leg.heel_to_metatarsal,
                "the foot triangle cannot close: each of heel_to_ankle_m, ankle_to_metatarsal_m, "
                f"heel_to_metatarsal_m {sides} must be shorter than the other two together",
                f"give l_h between {abs(sides[0] - sides[1]):.3g} and {sides[0] + sides[1]:.3g} m",
            )

    def _check_mass_matrix(self) -> None:
        """Positive definiteness of the mass matrix of (1) in every posture.

        Eliminating the translation leaves c_ij cos(phi_i - phi_j) with constants c_ij. The matrix
        of cosines is positive semidefinite with ones on the diagonal, so by Schur's product
        theorem the mass matrix is positive definite in every posture exactly when it is so with
        all links parallel. The paper's inertias, rounded to a hair under m r^2, pass.
        """
        aligned = np.zeros((6, 6))
        aligned[0, 0] = self.total_mass
        aligned[0, 1] = aligned[1, 0] = self.trunk_mass_kg * self.trunk_com_m
        aligned[1, 1] = self.trunk_inertia_kgm2
        for i in (0, 1):
            p, row = self.leg(i), 2 + 2 * i
            below = p.shank_mass + p.foot_mass
            k_a = p.thigh_mass * p.thigh_com + p.thigh_length * below
            k_b = p.shank_mass * p.shank_com + p.shank_length * p.foot_mass
            coupling = p.thigh_length * k_b
            aligned[0, row : row + 2] = aligned[row : row + 2, 0] = k_a, k_b
            aligned[row, row] = p.thigh_inertia + p.thigh_length**2 * below
            aligned[row + 1, row + 1] = p.shank_inertia + p.shank_length**2 * p.foot_mass
            aligned[row, row + 1] = aligned[row + 1, row] = coupling
        if np.linalg.eigvalsh(aligned)[0] <= 0:
            field = self._slimmest_inertia()
            raise invalid(
                field,
                getattr(self, field),
                "the mass matrix is not positive definite with these inertias",
                "give inertias about the proximal joint: each about m r^2 or more",
            )

    def _slimmest_inertia(self) -> str:
        """The field of the inertia that falls shortest of m r^2: the first to look at."""
        point = self.trunk_mass_kg * self.trunk_com_m**2
        ratio = {"trunk_inertia_kgm2": self.trunk_inertia_kgm2 / point}
        legs = (self.leg(0), self.leg(1))
        ratio["thigh_inertia_kgm2"] = min(
            p.thigh_inertia / (p.thigh_mass * p.thigh_com**2) for p in legs
        )
        ratio["shank_inertia_kgm2"] = min(
            p.shank_inertia / (p.shank_mass * p.shank_com**2) for p in legs
        )
        return min(ratio, key=lambda field: ratio[field])


SYMBOLS = {
    "m": "trunk_mass_kg",
    "r": "trunk_com_m",
    "J": "trunk_inertia_kgm2",
    "m_a": "thigh_mass_kg",
    "a": "thigh_length_m",
    "r_a": "thigh_com_m",
    "J_a": "thigh_inertia_kgm2",
    "m_b": "shank_mass_kg",
    "b": "shank_length_m",
    "r_b": "shank_com_m",
    "J_b": "shank_inertia_kgm2",
    "m_f": "foot_mass_kg",
    "HA": "heel_to_ankle_m",
    "AM": "ankle_to_metatarsal_m",
    "l_m": "toe_length_m",
    "l_h": "heel_to_metatarsal_m",
    "g": "gravity_m_s2",
}
"""The paper's symbol of each field."""

_LEG_FIELDS = {
    field.rsplit("_", 1)[0]: field
    for field in SYMBOLS.values()
    if not field.startswith(("trunk", "gravity"))
}
