"""Law of Cucker and Smale: velocity consensus of all agents, weighted by distance."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base.natural_scales import Scales
from flockana.base.value_checks import FloatArray, ensure_flag, ensure_kind, normalise
from flockana.interactions.weights import RationalWeight
from flockana.laws.law import Arrays
from flockana.laws.sum_of_terms import SumOfTerms
from flockana.laws.terms.alignment import AlignmentTerm
from flockana.laws.terms.term import Term
from flockana.laws.usual_laws import Candidate
from flockana.measures.metrics import spreads


@dataclass(frozen=True)
class CuckerSmale(SumOfTerms):
    """u_i = Σ_j a(‖q_j − q_i‖) (p_j − p_i), a(s) = K (1 + s²/ℓ²)^−β; divided by n in the form of Ha and Liu.

    No force depends on positions alone, and momentum is conserved; the energy is ½ Σ‖p_i − p̄‖², which falls.

    Parameters
    ----------
    weight : RationalWeight
        K, β and ℓ.
    mean : bool
        Whether the sum is divided by n (Ha and Liu); it is not by default (Cucker and Smale).

    Examples
    --------
    >>> law = CuckerSmale(RationalWeight(strength=2.0, decay=1.0))
    >>> law.acceleration(0.0, [[0.0], [1.0]], [[0.0], [3.0]]).tolist()
    [[3.0], [-3.0]]
    """

    weight: RationalWeight = field(default_factory=RationalWeight)
    mean: bool = False

    references: ClassVar[tuple[str, ...]] = ("cucker-smale-2007", "ha-liu-2009")
    moving = True

    def __post_init__(self) -> None:
        ensure_kind("weight", self.weight, RationalWeight, "RationalWeight(strength, decay, length)")
        normalise(self, ensure_flag, "mean")

    @property
    def scales(self) -> Scales:
        """Length ℓ, and the time 1/K in which two near agents align."""
        return Scales(self.weight.length, 1.0 / self.weight.strength)

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """Terms with the energy ½ Σ‖p_i − p̄‖², which falls at the rate Σ_{i<j} a_ij ‖p_j − p_i‖²."""
        return (AlignmentTerm(self.weight, 1.0, self.mean),)

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Arrays) -> Mapping[str, Any]:  # noqa: D102
        return {
            "position_spread": ("√Σ‖q_i − q̄‖² (length)", np.sqrt(2.0 * spreads(q))),
            "velocity_spread": ("√Σ‖p_i − p̄‖² (length/time)", np.sqrt(2.0 * spreads(p))),
        }


CANDIDATES = {"Cucker-Smale": Candidate(CuckerSmale, length=1.0)}
