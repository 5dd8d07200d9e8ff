"""Base class of Algorithms 1 to 3 and compositions: gains and their conversion of units."""

from dataclasses import replace
from typing import Any, Self

from flockana.base.units import scaled_fields
from flockana.interactions import Gains, PairInteraction
from flockana.interactions.weights import Weight
from flockana.laws.sum_of_terms import SumOfTerms


class GainedLaw(SumOfTerms):
    """A sum of terms with `gains`: c1α is 1/time², c2α 1/time, unless pair law or weight carry a time of their own."""

    gains: Gains

    def in_units(self, length: float, time: float) -> Self:
        """Return the law in other units (`flockana.rescale`)."""
        changed: dict[str, Any] = scaled_fields(self, length, time)
        if timed(getattr(self, "alpha", None)):
            changed["gains"] = replace(changed["gains"], c1_alpha=self.gains.c1_alpha)
        if timed(weight := getattr(self, "net", None)) and isinstance(weight, Weight):
            changed["gains"] = replace(changed["gains"], c2_alpha=self.gains.c2_alpha)
        return type(self)(**changed)


def timed(pair: PairInteraction | Weight | None) -> bool:
    """Return whether a pair law or a weight depends on the unit of time."""
    of_formula = (power for _, _, power in getattr(pair, "powers", ()))
    return any(power for _, power in getattr(pair, "units", {}).values()) or any(of_formula)
