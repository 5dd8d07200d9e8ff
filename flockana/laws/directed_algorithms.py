"""Algorithms 1 to 3 on directed nets: ranges of each agent, and conic neighbourhoods.

The source allows for directed nets, "if agents have different ranges or a conic neighbourhood", and does not follow
them up. Where i sees j and j does not see i, action is not reaction: momentum is not conserved, no energy is known, and
none of the theorems applies. What still holds is in the theorem `directed-nets`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import cos, pi
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.units import Powers
from flockana.base.value_checks import (
    FloatArray,
    ensure_finite_scalar,
    ensure_positive,
    ensure_state,
    normalise,
    per_agent,
)
from flockana.interactions import AlphaInteraction
from flockana.interactions.alpha import slopes_within
from flockana.interactions.distance_functions import DistanceFunction, InnerValues, LawFunction, SlopeBound
from flockana.interactions.pair_interaction import kernel_values
from flockana.kernels.alpha import R_ALPHA
from flockana.kernels.directed_sums import directed_forces, seen_edges
from flockana.kernels.neighbours import pair_list
from flockana.kernels.scalars import bump_slope, taper
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.law import Arrays
from flockana.laws.law_features import Feature, function_feature
from flockana.laws.law_matrices import assembled
from flockana.laws.olfati_saber import Algorithm1, Algorithm2, paper_pair
from flockana.laws.terms.pairs import PairTerm
from flockana.laws.terms.term import Derivatives
from flockana.laws.wrapper_base import WrappingLaw
from flockana.measures.perception import Edges

_ALL_ROUND = 2.0 * pi
_SLOW = 0.01  # of the law's own speed
_SEEN = 0.5  # sight from which on an agent counts as seen, where edges are counted


@dataclass(frozen=True)
class Reaching(DistanceFunction):
    """Pair law with an agent's own range, at which its bump function ends; the distance d is unchanged."""

    alpha: AlphaInteraction
    r: float

    @property
    def range(self) -> float:
        """Range of sight of an agent, at which its pair force ends."""
        return self.r

    @property
    def feature(self) -> float:
        """Length of the pair force's repulsion: the distance d, or the range if that is smaller."""
        return min(self.alpha.d, self.r)

    def slopes(self, parts: int = 64) -> tuple[SlopeBound, ...]:  # noqa: D102
        return slopes_within(self.alpha, self.r, parts)

    def inner(self, s2: FloatArray) -> InnerValues:  # noqa: D102
        par = self.alpha.par.copy()
        par[R_ALPHA] = self.alpha.sigma_norm(self.r)
        return kernel_values(self.alpha.kernels, par, s2)


@dataclass(frozen=True)
class DirectedNet(WrappingLaw):
    """Law of Olfati-Saber with individual ranges of sight, and a cone of view ahead of each agent.

    u_i = Σ w_ij (c1α φ_α n_ij + c2α a_ij (p_j − p_i)) over the j that i sees, in which the bump ends at agent i's own
    range (a_ij ≠ a_ji then), and the other terms as they are. A range at most d makes an agent that repels and never
    attracts. The source does not say how a cone ends: here as a range does, w_ij = ρ_h((1 − cos θ)/(1 − cos ½view)) of
    the angle θ between p_i and q_j − q_i, so that the force is continuous. An agent at rest has no way ahead and looks
    all round, one much slower than `slow` nearly so: 1 − w_ij shrinks by ‖p_i‖²/(slow² + ‖p_i‖²).

    Parameters
    ----------
    law : Algorithm1, Algorithm2 or Algorithm3
        The law on undirected nets, with the paper's pair law.
    ranges : float or array_like, shape (n,), optional
        Range of each agent, > 0; by default that of the pair law, for all.
    view : float
        Whole angle of view in radians, 0 < view <= 2π; 2π, all round, by default.
    slow : float, optional
        Speed below which an agent looks round, > 0; a hundredth of the law's own by default.

    Raises
    ------
    ArgumentError
        On another law, ranges that are not positive, or an angle that is none.

    Examples
    --------
    Agent 0 sees agent 1 and is drawn to it, which does not see agent 0:

    >>> law = DirectedNet(Algorithm1(), ranges=(8.4, 3.0))
    >>> u = law.acceleration(0.0, [[0.0], [8.0]], [[0.0], [0.0]])
    >>> bool(u[0, 0] > 0.0), float(u[1, 0])
    (True, 0.0)
    """

    law: Algorithm1 | Algorithm2 | Algorithm3
    ranges: Any = None
    view: float = _ALL_ROUND
    slow: float | None = None

    units: ClassVar[Mapping[str, Powers]] = {"ranges": (1, 0), "slow": (1, -1)}

    references = ("olfati-saber-2006",)
    lattice = None  # links are not mutual

    def __post_init__(self) -> None:
        if type(self.law) not in (Algorithm1, Algorithm2, Algorithm3):
            raise ArgumentError(
                f"law = {format_value(self.law)}: expected Algorithm1(...), Algorithm2(...) or Algorithm3(...)"
            )
        paper_pair(self.law)
        if self.ranges is not None:
            normalise(self, per_agent, "ranges")
        normalise(self, ensure_finite_scalar, "view")
        if not 0.0 < self.view <= _ALL_ROUND * (1.0 + 1e-12):
            raise ArgumentError(f"view = {self.view:g}: expected an angle in radians, 0 < view <= 2π")
        if self.slow is not None:
            normalise(self, ensure_positive, "slow")

    @property
    def alpha(self) -> AlphaInteraction:
        """Olfati-Saber's pair law φ_α among the agents."""
        return paper_pair(self.law)

    @property
    def surfaces(self) -> tuple[float | tuple[float, ...], ...]:  # noqa: D102
        return (self.alpha.r if self.ranges is None else self.ranges,)

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Pair law once for each range, with the agents that have this range."""
        gains = self.law.gains.c1_alpha, self.law.gains.c2_alpha
        if not isinstance(self.ranges, tuple):
            return (LawFunction("the pair law", self._with_range(self.ranges), *gains),)
        agents = {r: tuple(i for i, r_i in enumerate(self.ranges) if r_i == r) for r in sorted({*self.ranges})}
        return tuple(
            LawFunction("the pair law", self._with_range(r), *gains, listeners=who) for r, who in agents.items()
        )

    def features(self) -> tuple[Feature, ...]:
        """Return the narrowest features of the pair law with the agents' ranges, and of the other terms."""
        others = (term for term in self.law.terms if not isinstance(term, PairTerm))
        return (*map(function_feature, self.functions), *(feature for term in others for feature in term.features()))

    def _with_range(self, r: float | None) -> DistanceFunction:
        """Return the pair law with range r, at which its bump function ends; the distance d is unchanged."""
        return self.alpha if r is None else Reaching(self.alpha, r)

    def check_agents(self, n: int) -> None:  # noqa: D102
        super().check_agents(n)
        if isinstance(self.ranges, tuple) and len(self.ranges) != n:
            raise ArgumentError(f"there are {len(self.ranges)} ranges and {n} agents: expected one range each")

    def _reach(self, n: int) -> FloatArray:
        return np.full(n, self.alpha.r if self.ranges is None else self.ranges, dtype=np.float64)

    @cached_property
    def _width(self) -> float:
        """Width 1 − cos of half the angle of view; 2 for a view all round."""
        return 2.0 if self.view >= _ALL_ROUND * (1.0 - 1e-12) else 1.0 - cos(0.5 * self.view)

    @cached_property
    def _slow2(self) -> float:
        return float((_SLOW * self.law.scales.speed if self.slow is None else self.slow) ** 2)

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """Return the acceleration u of every agent, with NaN for the unknown energy rate."""
        u, reach = np.zeros(q.shape), self._reach(len(q))
        for term in self.law.terms:
            if isinstance(term, PairTerm):
                pairs = pair_list(q, float(reach.max()))
                gains, sight_cone = (term.stiffness, term.damping), (self._width, self._slow2)
                directed_forces(q, p, pairs, reach, self.alpha.par, gains, sight_cone, u)
            else:
                term.act(t, q, p, u)
        return u, float("nan")

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Derivatives:
        """Return (∂u/∂q, ∂u/∂p), sparse: each agent's pair law in its cone of view, plus the other terms."""
        pairs = [term for term in self.law.terms if isinstance(term, PairTerm)]
        rest = [term.derivatives(t, q, p) for term in self.law.terms if not isinstance(term, PairTerm)]
        by_position, by_velocity = zip(*(self._pair_derivatives(term, q, p) for term in pairs), *rest, strict=True)
        return assembled(by_position), assembled(by_velocity)

    def _pair_derivatives(self, term: PairTerm, q: FloatArray, p: FloatArray) -> tuple[Any, Any]:
        """Return the derivatives of Σ_j w_ij (c1 s_ij Δ + c2 a_ij (p_j − p_i)), Δ = q_j − q_i."""
        (n, m), reach = q.shape, self._reach(len(q))
        first, second = pair_list(q, float(reach.max()))
        i, j = np.concatenate([first, second]), np.concatenate([second, first])
        delta, slip = q[j] - q[i], p[j] - p[i]
        s2 = np.einsum("kc,kc->k", delta, delta)
        near = s2 < reach[i] ** 2
        i, j, delta, slip, s2 = i[near], j[near], delta[near], slip[near], s2[near]
        stress, weight, slope, fade = np.zeros((4, i.size))
        for r in np.unique(reach[i]):
            mask = reach[i] == r
            stress[mask], weight[mask], slope[mask], fade[mask] = Reaching(self.alpha, float(r)).inner(s2[mask])
        sight, by_delta, by_own = self._sight_slopes(delta, p[i], s2)
        force = term.stiffness * stress[:, None] * delta + term.damping * weight[:, None] * slip
        bend = 2.0 * (term.stiffness * slope[:, None] * delta + term.damping * fade[:, None] * slip)
        towards = bend[:, :, None] * delta[:, None, :] + term.stiffness * stress[:, None, None] * np.eye(m)
        towards = sight[:, None, None] * towards + force[:, :, None] * by_delta[:, None, :]
        drag = (term.damping * sight * weight)[:, None, None] * np.eye(m)
        sight_terms = force[:, :, None] * by_own[:, None, :]
        return _rows(n, m, (i, j, towards), (i, i, -towards)), _rows(n, m, (i, j, drag), (i, i, sight_terms - drag))

    def _sight_slopes(
        self, delta: FloatArray, ahead: FloatArray, s2: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the visibility w_ij of pairs, and its derivatives by q_j − q_i and by p_i."""
        sight, position_slopes, velocity_slopes = np.ones(len(s2)), np.zeros(delta.shape), np.zeros(delta.shape)
        if self._width >= 2.0:
            return sight, position_slopes, velocity_slopes
        speed2 = np.einsum("kc,kc->k", ahead, ahead)
        for k in np.flatnonzero(s2 * speed2 > 0.0):
            bearing, direction = delta[k] / s2[k] ** 0.5, ahead[k] / speed2[k] ** 0.5
            cosine, total = float(bearing @ direction), self._slow2 + speed2[k]
            z = max(0.0, 1.0 - cosine) / self._width
            cone, taper_slope = taper(z, self.alpha.h), -bump_slope(z, self.alpha.h) / self._width
            sight[k] = (self._slow2 + speed2[k] * cone) / total
            share = speed2[k] * taper_slope / total
            position_slopes[k] = share * (direction - cosine * bearing) / s2[k] ** 0.5
            velocity_slopes[k] = share * (bearing - cosine * direction) / speed2[k] ** 0.5
            velocity_slopes[k] += 2.0 * self._slow2 * (cone - 1.0) / total**2 * ahead[k]
        return sight, position_slopes, velocity_slopes

    def perceived(self, q: Any, p: Any) -> Edges:
        """Return the directed edges (j, i) of a state, where i sees j.

        Examples
        --------
        >>> DirectedNet(Algorithm1(), view=3.0).perceived([[0.0], [5.0]], [[1.0], [1.0]])
        ((1, 0),)
        """
        q, p = ensure_state(q, p)
        self.check_agents(len(q))
        reach = self._reach(len(q))
        sight = (self._width, self._slow2, self.alpha.h, _SEEN)
        head, tail = seen_edges(q, p, *pair_list(q, float(reach.max())), reach, *sight)
        return tuple(sorted(zip(tail.tolist(), head.tolist(), strict=True)))

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Arrays) -> Mapping[str, Any]:  # noqa: D102
        def one_way() -> FloatArray:
            edges = [self.perceived(*state) for state in zip(q, p, strict=True)]
            return np.array([len({*pairs} - {(i, j) for j, i in pairs}) / max(1, len(pairs)) for pairs in edges])

        def energy() -> FloatArray:
            return np.array([self.law.hamiltonian(float(time), *state) for time, *state in zip(t, q, p, strict=True)])

        return {
            "momentum": ("‖Σ p_i‖ (length/time)", np.linalg.norm(p.sum(axis=1), axis=1)),
            "one_way": ("share of the directed edges that have no counterpart", one_way),
            "undirected_energy": ("energy of the law on an undirected net (length²/time²)", energy),
        }


def _rows(n: int, m: int, *entries: tuple[Any, Any, FloatArray]) -> Any:
    """Return the sparse matrix (n m, n m) of blocks at (row, column); repeated blocks add up."""
    from scipy.sparse import csr_array

    rows, columns, blocks = (np.concatenate(part) for part in zip(*entries, strict=True))
    places = np.indices((m, m))
    across = [
        m * at[:, None, None] + place for at, place in zip((rows.astype(int), columns.astype(int)), places, strict=True)
    ]
    return csr_array(
        (blocks.ravel(), tuple(np.broadcast_to(part, blocks.shape).ravel() for part in across)), shape=(n * m,) * 2
    )
