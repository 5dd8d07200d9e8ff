"""Base class of Algorithms 1 to 3 and compositions: gains and their conversion of units."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Self

import numpy as np

from flockana.base.natural_scales import Scales
from flockana.base.units import scaled_fields
from flockana.base.value_checks import ensure_kind
from flockana.environment.target import Target
from flockana.interactions import Gains, PairInteraction
from flockana.interactions.gains import GainsField, gains_of
from flockana.interactions.weights import Weight
from flockana.laws.sum_of_terms import SumOfTerms
from flockana.laws.terms.pairs import PairTerm

PAIR = "AlphaInteraction(...), or another pair interaction"
GAINS = "Gains(...)"
TARGET = "a γ-agent such as StaticTarget((0.0, 0.0))"


def ensure_gains(law: Any) -> None:
    """Check the gains of a law; a dictionary of gains becomes `Gains`."""
    if isinstance(law.gains, Mapping):
        object.__setattr__(law, "gains", gains_of(law.gains))
    ensure_kind("gains", law.gains, Gains, GAINS)


def alpha_scales(alpha: PairInteraction, gains: Gains) -> Scales:
    """Return d, and the time in which the leading term (c1α, c1γ, c2α or c2γ) moves an agent by d."""
    pair, pull = gains.c1_alpha * alpha.strength / alpha.length, np.max(gains.c1_gamma)
    rates = (np.sqrt(pair), np.sqrt(pull), gains.c2_alpha, np.max(gains.c2_gamma))
    return Scales(alpha.length, 1.0 / float(next((rate for rate in rates if rate > 0.0), 1.0)))


class GainedLaw(SumOfTerms):
    """Sum of terms with `gains`: c1α is 1/time², c2α 1/time, unless pair law or weight have their own time unit."""

    alpha: Any  # the pair law; a composition may lack one
    gains: GainsField

    def __post_init__(self) -> None:
        ensure_kind("alpha", self.alpha, PairInteraction, PAIR)
        ensure_gains(self)
        if "target" in vars(self):
            ensure_kind("target", self.target, Target, TARGET)

    @property
    def scales(self) -> Scales:  # noqa: D102
        return alpha_scales(self.alpha, self.gains)

    @property
    def pair_term(self) -> PairTerm:
        """Gradient and velocity consensus among agents."""
        return PairTerm(self.alpha, self.gains.c1_alpha, self.gains.c2_alpha)

    def in_units(self, length: float, time: float) -> Self:
        """Return the law in other units (`flockana.rescale`)."""
        changed_fields: dict[str, Any] = scaled_fields(self, length, time)
        if timed(getattr(self, "alpha", None)):
            changed_fields["gains"] = replace(changed_fields["gains"], c1_alpha=self.gains.c1_alpha)
        if timed(weight := getattr(self, "net", None)) and isinstance(weight, Weight):
            changed_fields["gains"] = replace(changed_fields["gains"], c2_alpha=self.gains.c2_alpha)
        return type(self)(**changed_fields)


def timed(pair: PairInteraction | Weight | None) -> bool:
    """Return whether a pair law or a weight depends on the unit of time."""
    time_powers = (power for _, _, power in getattr(pair, "powers", ()))
    return any(power for _, power in getattr(pair, "units", {}).values()) or any(time_powers)
