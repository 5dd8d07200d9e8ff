"""Minima of U_λ reached from a lattice, against its size and the ratio c1γ/c1α."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt

import numpy as np
import numpy.typing as npt

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError, SolverError
from flockana.base.value_checks import FloatArray, Numbers, ensure_count, ensure_positive
from flockana.environment import StaticTarget
from flockana.equilibria.solve import Equilibrium, find_equilibrium
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_spiral
from flockana.laws import Algorithm2
from flockana.measures.metrics import coincident_pairs, min_distance

CONTACT = 1e-6  # of d: closer than this two agents coincide
_LOWEST, _FACTOR = 6e-3, 1.5  # where the search for the threshold starts, of `natural_ratio`, and its steps
_RANGE = 1e5  # least and largest ratio that are tried, under and over the first
_NUDGE = 1e-4  # of d: a symmetric start would be squeezed along its symmetry, past where it is a minimum


@dataclass(frozen=True)
class CollapseDiagram:
    """Minima of U_λ reached from a lattice, against its size and the ratio c1γ/c1α."""

    sizes: npt.NDArray[np.int64]  # shape (N,)
    ratios: FloatArray  # shape (L,): c1γ/c1α
    # shape (N, L): least distance between two agents over d, 0 once some coincide; NaN where the solver failed
    closest: FloatArray
    coincident: npt.NDArray[np.int64]  # shape (N, L): pairs at one place, −1 where the solver failed
    kinds: tuple[tuple[str, ...], ...]  # kind of each equilibrium, ``"failed"`` where there is none

    def onset(self) -> FloatArray:
        """Return, for each flock size, the least ratio c1γ/c1α at which agents coincide; NaN if none."""
        return np.array([self.ratios[row > 0][0] if (row > 0).any() else np.nan for row in self.coincident])


def pulled_law(alpha: AlphaInteraction, ratio: float, m: int = 2) -> Algorithm2:
    """Return Algorithm 2 with c1α = 1, c1γ = ratio and a γ-agent at rest at the origin."""
    return Algorithm2(alpha, Gains(c1_alpha=1.0, c1_gamma=ensure_positive("ratio", ratio)), StaticTarget((0.0,) * m))


def perturbed(q: FloatArray, d: float) -> FloatArray:
    """Return a configuration with a fixed perturbation of 1e-4 d, to leave symmetric saddles."""
    return q + _NUDGE * d * np.random.default_rng(0).standard_normal(q.shape)


def relaxed(alpha: AlphaInteraction, n: int, ratio: float) -> Equilibrium:
    """Return the minimum of U_λ that IPOPT finds from a slightly disturbed hexagonal spiral of n agents."""
    return find_equilibrium(pulled_law(alpha, ratio), perturbed(hexagonal_spiral(n, alpha.d), alpha.d))


@check_kinds
def collapse_diagram(alpha: AlphaInteraction, sizes: Numbers, ratios: Numbers) -> CollapseDiagram:
    """Return shortest distance and coincident pairs of the minima of U_λ over sizes and ratios."""
    counts, rising = [ensure_count("sizes", n) for n in sizes], np.array([ensure_positive("ratios", x) for x in ratios])
    if np.any(np.diff(rising) <= 0.0):
        raise ArgumentError(f"ratios = {list(ratios)}: expected rising numbers")
    shape = (len(counts), rising.size)
    closest, coincident, kinds = np.full(shape, np.nan), np.full(shape, -1), []
    for k, n in enumerate(counts):
        row = []
        for c, ratio in enumerate(rising):
            try:
                minimum = relaxed(alpha, n, float(ratio))
            except SolverError:
                row.append("failed")
                continue
            coincident[k, c] = coincident_pairs(minimum.q, CONTACT * alpha.d)
            closest[k, c] = 0.0 if coincident[k, c] else min_distance(minimum.q) / alpha.d
            row.append(minimum.kind)
        kinds.append(tuple(row))
    return CollapseDiagram(np.array(counts), rising, closest, coincident, tuple(kinds))


def natural_ratio(alpha: AlphaInteraction) -> float:
    """Return the c1γ/c1α at which the pull of the γ-agent at distance d equals the largest repulsion of a pair."""
    return alpha.strength / alpha.d


def threshold(
    collapses: Callable[[float], bool], *, lowest: float = 0.01, factor: float = _FACTOR, halvings: int = 4
) -> tuple[float, float]:
    """Return the largest ratio c1γ/c1α without collapse and the smallest with collapse, found by bisection.

    From below, since far above the threshold agents may rest apart again. Both ends of the bracket have been tried; it
    stays wider where a try inside it fails (near the threshold a flock settles slowly).
    """

    def seen(ratio: float) -> bool | None:
        try:
            return collapses(ratio)
        except SolverError:
            return None

    low = lowest
    while seen(low) is not False:
        low /= factor
        if low * _RANGE < lowest:
            raise SolverError(
                f"collapse, or no result, at all ratios down to {low:.3g}: expected no collapse at the smallest"
            )
    high, doubt = factor * low, False
    while (is_collapsed := seen(high)) is not True:
        doubt = doubt or is_collapsed is None
        low, high = low if doubt else high, factor * high
        if high > _RANGE * lowest:
            raise SolverError(f"no collapse at ratios up to {high:.3g}: expected one below {_RANGE * lowest:.3g}")
    for _ in range(0 if doubt else halvings):
        midpoint = sqrt(low * high)
        if (is_collapsed := seen(midpoint)) is None:
            break
        low, high = (low, midpoint) if is_collapsed else (midpoint, high)
    return low, high


def collapse_threshold(alpha: AlphaInteraction, n: int, *, halvings: int = 4) -> tuple[float, float]:
    """Bracket the ratio c1γ/c1α above which the relaxed spiral of n agents has coincident pairs."""
    return threshold(
        lambda ratio: coincident_pairs(relaxed(alpha, n, ratio).q, CONTACT * alpha.d) > 0,
        lowest=_LOWEST * natural_ratio(alpha),
        halvings=halvings,
    )
