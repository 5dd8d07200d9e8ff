"""Algorithms 1 and 2 of Olfati-Saber (2006), in one, two and three dimensions."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar

from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.value_checks import ensure_kind, ensure_state
from flockana.environment.target import Target
from flockana.interactions import AlphaInteraction, Gains, PairInteraction
from flockana.interactions.gains import GainsField
from flockana.laws.gain_laws import GAINS, GainedLaw, alpha_scales
from flockana.laws.terms.navigation import Navigation
from flockana.laws.terms.term import Term
from flockana.measures.centre_frame import moving_frame


def ensure_one_gain(gains: Gains) -> None:
    """Raise unless `gains` are Gains with one c1γ and c2γ for all agents, under which shape and centre decouple."""
    ensure_kind("gains", gains, Gains, GAINS)
    if gains.per_agent:
        raise ArgumentError(
            "c1_gamma or c2_gamma is given per agent: expected one of each, or the shape does not separate from the "
            "centre of mass; find_equilibrium and the stability functions take both kinds"
        )


def paper_pair(law: Any) -> AlphaInteraction:
    """Return a law's pair law; raise unless it is Olfati-Saber's, whose φ_α has proved properties."""
    ensure_kind("alpha", law.alpha, AlphaInteraction, "AlphaInteraction(...), as proofs need it")
    return law.alpha


@dataclass(frozen=True)
class Algorithm1(GainedLaw):
    """u_i = c1α Σ_j φ_α(‖q_j−q_i‖_σ) n_ij + c2α Σ_j a_ij (p_j − p_i)   (Olfati-Saber 2006, eq. (23), (24)).

    Parameters
    ----------
    gains : Gains or mapping of str to float
        Only c1_alpha and c2_alpha are used.

    Examples
    --------
    Two agents farther apart than d attract each other:

    >>> law = Algorithm1()
    >>> u = law.acceleration(0.0, [[0.0, 0.0], [8.0, 0.0]], [[0.0, 0.0], [0.0, 0.0]])
    >>> bool(u[0, 0] > 0.0), float(u.sum())
    (True, 0.0)
    """

    alpha: PairInteraction = field(default_factory=AlphaInteraction)
    gains: GainsField = field(default_factory=Gains)  # type: ignore[assignment]

    references: ClassVar[tuple[str, ...]] = ("olfati-saber-2006",)

    @property
    def scales(self) -> Scales:  # noqa: D102
        return alpha_scales(self.alpha, replace(self.gains, c1_gamma=0.0, c2_gamma=0.0))

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """Pair term, with the energy c1α V(q) + ½ Σ‖p_i‖² in the given frame (with the ½ that the slides omit: E1)."""
        return (self.pair_term,)

    def structural_energy(self, q: Any, p: Any) -> float:
        """H(x, v) = c1α V(x) + K(v), the energy in the frame that moves with the centre of mass.

        Parameters
        ----------
        q, p : array_like, shape (n, m)
            Positions and velocities in any frame.
        """
        q, p = ensure_state(q, p)
        return self.hamiltonian(0.0, q, moving_frame(p))


@dataclass(frozen=True)
class Algorithm2(GainedLaw):
    """Algorithm 1 − c1γ (q_i − q_r) − c2γ (p_i − p_r): flocking with a γ-agent   (Olfati-Saber 2006, eq. (25), (26)).

    Parameters
    ----------
    gains : Gains or mapping of str to float
        c1 and c2 of α and γ are used.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> law = Algorithm2(gains=Gains(c1_gamma=1.0), target=StaticTarget((10.0, 0.0)))
    >>> law.acceleration(0.0, [[0.0, 0.0]], [[0.0, 0.0]]).tolist()
    [[10.0, 0.0]]
    """

    alpha: PairInteraction = field(default_factory=AlphaInteraction)
    gains: GainsField = field(default_factory=Gains)  # type: ignore[assignment]
    target: Target = None  # type: ignore[assignment]  # no default makes sense: checked below

    references: ClassVar[tuple[str, ...]] = ("olfati-saber-2006",)

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """Pair term and linear pull, with the energy c1α V(x) + c1γ J(x) + K(v) in the moving frame for every target.

        With per-agent gains the flock's shape does not separate from its centre, and no frame but the given one will
        do for every target: H(t, q, p) = c1α V(q) + ½ Σ c1γ_i ‖q_i − q_r‖² + ½ Σ‖p_i‖², as under Algorithm 3.
        """
        return self.pair_term, Navigation(self.target, self.gains)

    def structural_energy(self, q: Any, p: Any) -> float:
        """Return the structural energy H_λ(x, v), which equals `energy`, both in the moving frame.

        Parameters
        ----------
        q, p : array_like, shape (n, m)
            Positions and velocities in any frame.

        Raises
        ------
        ArgumentError
            With per-agent gains, under which the shape has no energy of its own.
        """
        q, p = ensure_state(q, p)
        ensure_one_gain(self.gains)
        return self.hamiltonian(0.0, q, p)
