"""Facts about a function over its whole range: proved, disproved by a counterexample, or assumed."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from flockana.base.short_repr import ShortRepr

FactStatus = Literal["met", "unmet", "assumed"]
_ORDER: tuple[FactStatus, ...] = ("unmet", "assumed", "met")


@dataclass(frozen=True)
class Fact:
    """Fact about a function: met, unmet or assumed, with its reason."""

    status: FactStatus
    detail: str = ""
    witness: tuple[float, float] | None = None
    width: float = 0.0


def conjunction(facts: Iterable[Fact], proof: str = "") -> Fact:
    """Return the status of several facts together: unmet if one is unmet, else assumed if one is assumed, else met."""
    facts = list(facts)
    status: FactStatus = "met"
    worst = min((status, *(fact.status for fact in facts)), key=_ORDER.index)
    deciding_facts = [fact for fact in facts if fact.status == worst]
    if worst == "met":
        return Fact("met", proof)
    detail = "; ".join(dict.fromkeys(fact.detail for fact in deciding_facts if fact.detail))
    return Fact(worst, detail, deciding_facts[0].witness, sum(fact.width for fact in deciding_facts))


@dataclass(frozen=True)
class PairFacts(ShortRepr):
    """Facts about a pair law over all distances up to its range."""

    smooth: Fact  # ψ is C¹ on (0, r], its force vanishes at the range, and so does the adjacency, which is continuous
    weight: Fact  # The adjacency is nowhere negative
    inside: Fact  # The adjacency is positive at every distance below the range
    least: tuple[float, float]  # Bounds of the least potential of a pair, far ones included
    contact: tuple[float, float]  # Bounds of the limit of the potential where two agents meet; infinite at a barrier
    least_weight: tuple[float, float]  # Bounds of the least adjacency within the range
    zeros: tuple[float, ...] | None = None  # Distances below the range at which the force changes its sign; None: open

    @property
    def faults(self) -> tuple[str, ...]:
        """Sentences naming where the pair law is certainly not smooth."""
        return tuple(self.smooth.detail.split("; ")) if self.smooth.status == "unmet" else ()
