"""What is minimised: (10), the work of the joints per metre, and other costs beside it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any, Self

from pydantic import Field, model_validator

from ergowalk.errors import ProblemError
from ergowalk.mechanics.dynamics import LegMoments
from ergowalk.mechanics.kinematics import LegMotion, Rotation, joint_rates
from ergowalk.values import NonNegativeFloat, PositiveFloat, Value, invalid

Share = Annotated[float, Field(ge=0, lt=1, strict=True)]


def _weight(of: str, default: float = 0.0) -> Any:
    return Field(default=default, description=f"weight of {of}")


class Objective(Value):
    """A weighted sum of costs per metre; the default is (10) alone.

    With P the power of a joint's own moment m, P+ and P- its positive and negative part and M the
    total mass, each cost is 1/(2L) times the integral over the stride of the sum over all joints of

    ============================== =====================================
    ``absolute_work``              P+ + P-, which is (10)
    ``positive_work``              P+
    ``muscle_work``                P+ / 0.25 + P- / 1.2 (the efficiencies)
    ``regenerative_work``          P+ - share P-
    ``moment_squared``             m^2 / M
    ``moment_rate_squared``        m'^2 / M
    ============================== =====================================
    """

    _error = ProblemError

    absolute_work: NonNegativeFloat = _weight("E (10), positive plus negative work", default=1.0)
    positive_work: NonNegativeFloat = _weight("the positive work alone")
    muscle_work: NonNegativeFloat = _weight(
        "the work of muscles, positive and negative work each divided by its efficiency"
    )
    positive_efficiency: PositiveFloat = Field(
        default=0.25, description="efficiency of positive muscle work"
    )
    negative_efficiency: PositiveFloat = Field(
        default=1.2, description="efficiency of negative muscle work"
    )
    regenerative_work: NonNegativeFloat = _weight(
        "the positive work less a share of the negative work, which is won back"
    )
    regenerated_share: Share = Field(
        default=0.5, description="share of the negative work that is won back, from 0 to below 1"
    )
    moment_squared_s_per_m2: NonNegativeFloat = _weight("the squared moments, s/m2")
    moment_rate_squared_s3_per_m2: NonNegativeFloat = _weight(
        "the squared moment rates, s3/m2; a smooth alternative to the bound on the rate in [limits]"
    )

    @property
    def is_eq10(self) -> bool:
        """Whether E of (10) alone is minimised."""
        weights = {name: getattr(self, name) for name in WEIGHTS}
        return weights == {**dict.fromkeys(WEIGHTS, 0.0), "absolute_work": 1.0}

    @property
    def of_work(self) -> tuple[float, float]:
        """What a joule of positive and a joule of negative work cost, all terms together."""
        positive = self.absolute_work + self.positive_work + self.regenerative_work
        negative = self.absolute_work - self.regenerated_share * self.regenerative_work
        if self.muscle_work:
            positive += self.muscle_work / self.positive_efficiency
            negative += self.muscle_work / self.negative_efficiency
        return positive, negative

    @property
    def charges_work(self) -> bool:
        """Whether any work is charged at all."""
        return sum(self.of_work) > 0

    @property
    def charges_moments(self) -> bool:
        """Whether a cost of the moments, or of their rates, keeps them from growing to spikes."""
        return self.moment_squared_s_per_m2 > 0 or self.moment_rate_squared_s3_per_m2 > 0

    def sentence(self) -> str:
        """The weighted sum in words."""
        muscle = f"muscle work ({self.positive_efficiency:g}, {self.negative_efficiency:g})"
        regenerated = f"positive work less {100 * self.regenerated_share:g} % of the negative"
        words = ("E", "positive work", muscle, regenerated, "squared moments", "squared rates")
        units = ("", "", "", "", " s/m2", " s3/m2")
        parts = []
        for name, word, unit in zip(WEIGHTS, words, units, strict=True):
            weight = getattr(self, name)
            if weight:
                parts.append(word if weight == 1 and not unit else f"{weight:g}{unit} x {word}")
        return " + ".join(parts)

    @model_validator(mode="after")
    def _costs_something(self) -> Self:
        if not any(getattr(self, name) for name in WEIGHTS):
            raise invalid(
                "absolute_work",
                self.absolute_work,
                "all weights of the objective are zero",
                f"give one of {', '.join(WEIGHTS)} a positive weight",
            )
        return self


WEIGHTS = (
    "absolute_work",
    "positive_work",
    "muscle_work",
    "regenerative_work",
    "moment_squared_s_per_m2",
    "moment_rate_squared_s3_per_m2",
)
"""The weights of the terms, in their order."""


def eq10_joint_powers(
    moments: LegMoments, trunk: Rotation, leg: LegMotion
) -> tuple[Any, Any, Any, Any]:
    """Powers [W] of hip, knee, ankle and metatarsal moment of one leg, terms of (10).

    Moment times relative rate, distal minus proximal: positive where the moment puts energy into
    the walker. (10) writes the rates with the other sign; the absolute value does not mind.
    """
    rates = joint_rates(trunk.rate, leg.thigh.rate, leg.shank.rate, leg.foot.rate, leg.toes.rate)
    values = (moments.hip, moments.knee, moments.ankle, moments.metatarsal)
    hip, knee, ankle, metatarsal = (m * r for m, r in zip(values, rates, strict=True))
    return hip, knee, ankle, metatarsal


def squared_moments(moments: Iterable[Any]) -> Any:
    """Sum of the squares of joint moments per kg [(N m/kg)^2], the cost ``moment_squared``."""
    return sum(m**2 for m in moments)


def energy_per_metre(half_stride_integral: Any, step_length: float) -> Any:
    """E of (10) [J/m] from the integral of all absolute powers over half a stride [J].

    By the symmetry of the legs, 1/(2L) over T equals 1/L over T/2.
    """
    return half_stride_integral / step_length
