"""Algorithm 2 without a leader: each agent follows a copy of the γ-agent of its own."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base.value_checks import FloatArray, ensure_kind
from flockana.base.vector_norms import lengths
from flockana.environment.gamma_agent_copies import Copies
from flockana.interactions import AlphaInteraction, Gains, PairInteraction
from flockana.interactions.gains import GainsField
from flockana.laws.gain_laws import GainedLaw
from flockana.laws.law import Arrays
from flockana.laws.terms.target_copies import CopiesTerm
from flockana.laws.terms.term import Term


@dataclass(frozen=True)
class PeerToPeer(GainedLaw):
    """Algorithm 2, where agent i follows its own copy: −c1γ (q_i − q_r^i) − c2γ (p_i − p_r^i).

    Copies that are alike make it Algorithm 2. As the forces between agents cancel, the centre of mass follows the mean
    of the copies whatever they do: q_c'' = −c1γ (q_c − q̄_r) − c2γ (p_c − p̄_r).

    Parameters
    ----------
    copies : Copies
        The γ-agents, one for each agent.
    gains : Gains or mapping of str to float
        c1 and c2 of α and γ are used.

    Examples
    --------
    >>> from flockana.environment.spring import Spring
    >>> law = PeerToPeer(Copies([[10.0, 0.0]], [[0.0, 0.0]], Spring((0.0, 0.0), 0.0)), gains=Gains(c1_gamma=1.0))
    >>> law.acceleration(0.0, [[0.0, 0.0]], [[0.0, 0.0]]).tolist()
    [[10.0, 0.0]]
    """

    copies: Copies
    alpha: PairInteraction = field(default_factory=AlphaInteraction)
    gains: GainsField = field(default_factory=Gains)  # type: ignore[assignment]

    references: ClassVar[tuple[str, ...]] = ("olfati-saber-2006",)

    def __post_init__(self) -> None:
        ensure_kind("copies", self.copies, Copies, "Copies(q, p, force)")
        super().__post_init__()

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """Terms with the energy c1α V(q) + ½ Σ c1γ_i ‖q_i − q_r^i‖² + ½ Σ‖p_i‖² in the given frame."""
        return self.pair_term, CopiesTerm(self.copies, self.gains)

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Arrays) -> Mapping[str, Any]:  # noqa: D102
        positions = np.array([self.copies.state(float(time))[0] for time in t])
        spread = lengths(positions - positions.mean(axis=1, keepdims=True)).max(axis=1)
        distance = np.linalg.norm(q.mean(axis=1) - positions.mean(axis=1), axis=1)
        return {
            "copies_apart": ("largest distance of a copy from the mean of all (length)", spread),
            "centre_to_copies": ("distance of the centre of mass from the mean of the copies (length)", distance),
        }
