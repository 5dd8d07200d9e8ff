"""Law of Cucker and Smale with a weight that is singular at distance 0."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

from flockana.base.natural_scales import Scales
from flockana.base.value_checks import ensure_kind
from flockana.interactions.weights import SingularWeight
from flockana.laws.sum_of_terms import SumOfTerms
from flockana.laws.terms.alignment import AlignmentTerm
from flockana.laws.terms.term import Term


@dataclass(frozen=True)
class SingularAlignment(SumOfTerms):
    """u_i = Σ_j a(‖q_j − q_i‖) (p_j − p_i), a(s) = K (ℓ/s)^α, from distinct positions.

    A run in which two agents meet ends there, and its message names them. Momentum is conserved; the energy is
    ½ Σ‖p_i − p̄‖², which falls.

    Parameters
    ----------
    weight : SingularWeight
        K, α and ℓ.

    Examples
    --------
    >>> law = SingularAlignment(SingularWeight(decay=0.5))
    >>> law.acceleration(0.0, [[0.0], [0.25]], [[0.0], [-3.0]]).tolist()
    [[-6.0], [6.0]]
    """

    weight: SingularWeight = field(default_factory=SingularWeight)

    references: ClassVar[tuple[str, ...]] = ("carrillo-2017", "ahn-2012")
    moving = True

    def __post_init__(self) -> None:
        ensure_kind("weight", self.weight, SingularWeight, "SingularWeight(strength, decay, length)")

    @property
    def scales(self) -> Scales:
        """Length ℓ, and the time 1/K in which two agents at this distance align."""
        return Scales(self.weight.length, 1.0 / self.weight.strength)

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """Alignment term, with the energy ½ Σ‖p_i − p̄‖²."""
        return (AlignmentTerm(self.weight),)
