"""Gains that make the slowest mode decay fastest: one c1γ and c2γ for all agents, or one of each per agent.

What was found for thirty agents is in docs/gain-design.md.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product
from typing import Any, TypedDict, Unpack, overload

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import (
    ComplexArray,
    FloatArray,
    ensure_count,
    ensure_kind,
    ensure_known,
    ensure_nonnegative,
    ensure_positive,
)
from flockana.interactions import Gains
from flockana.stability.gain_problems import GainProblem
from flockana.stability.specifications import AT_MOST, Specifications, SpecifiedGains, evaluated

_ROUNDS = 200
_ACTIVE = 40  # eigenvalues with the largest real parts that a step looks at
_SMALLEST = 2e-9  # trust region at which a search ends, of the interval of gains
_GAINED = 1e-10  # relative gain of a step that is worth no further one
_GRID = 10


@dataclass(frozen=True)
class GainDesign:
    """Best γ-gains found, equal and per agent, with the resulting eigenvalues.

    Parameters
    ----------
    problem : GainProblem
        What was minimised.
    homogeneous, heterogeneous : ndarray, shape (2 n,)
        Gains (c1γ of each agent, then c2γ).
    rate_homogeneous, rate_heterogeneous : float
        Decay rates of the slowest mode, per time unit.
    eigenvalues_homogeneous, eigenvalues_heterogeneous : complex ndarray
        Spectra, largest real part first.
    starts : int
        Searches for the second.
    """

    problem: GainProblem
    homogeneous: FloatArray
    heterogeneous: FloatArray
    rate_homogeneous: float
    rate_heterogeneous: float
    eigenvalues_homogeneous: ComplexArray
    eigenvalues_heterogeneous: ComplexArray
    starts: int

    def __repr__(self) -> str:
        """Return a one-line text of the gain design, without its arrays."""
        rates = f"{self.rate_homogeneous:.4f} alike, {self.rate_heterogeneous:.4f} per agent"
        return f"<GainDesign of {self.problem.agents} agents: decay rates {rates}, ratio {self.ratio:.3f}>"

    @property
    def ratio(self) -> float:
        """Ratio of the decay rate with gains per agent to that with equal gains; a lower bound."""
        return self.rate_heterogeneous / self.rate_homogeneous

    def gains(self, base: Gains, *, heterogeneous: bool = True) -> Gains:
        """Gains of a law, with the designed c1γ and c2γ in place of those in `base`.

        Parameters
        ----------
        base : Gains
            The other gains.
        heterogeneous : bool
            One per agent, or one for all.
        """
        pull, drag = (self.heterogeneous if heterogeneous else self.homogeneous).reshape(2, -1)
        pair = (pull, drag) if heterogeneous else (float(pull[0]), float(drag[0]))
        return replace(base, c1_gamma=pair[0], c2_gamma=pair[1])


class _Search(TypedDict, total=False):
    """Keyword arguments of the gain search `design_gains`."""

    bounds: tuple[float, float] | None
    starts: int
    seed: int
    least: str | None


@overload
def design_gains(problem: GainProblem, asked: Specifications, **how: Unpack[_Search]) -> SpecifiedGains: ...
@overload
def design_gains(problem: GainProblem, asked: None = ..., **how: Unpack[_Search]) -> GainDesign: ...
def design_gains(
    problem: GainProblem,
    asked: Specifications | None = None,
    *,
    bounds: tuple[float, float] | None = None,
    starts: int = 6,
    seed: int = 0,
    least: str | None = None,
) -> GainDesign | SpecifiedGains:
    """Choose c1γ and c2γ within bounds: for the fastest decay, or to meet specifications.

    Without specifications the spectral abscissa is minimised, alike for all agents and one per agent. Alike, the two
    gains are searched on a grid and by Nelder and Mead's method. Per agent, sequential linear programs minimise the
    largest of the linearised real parts within a trust region, from the homogeneous optimum, near it and from random
    starts; the abscissa is not smooth where eigenvalues coalesce.

    With specifications the gains are alike for all agents, and the specification with the least room gets the most: it
    is the one that binds. The equilibrium is found anew for each choice. The grid is geometric. With ``least="effort"``
    (or "h2", "overshoot", "strain") that is made as small as the specifications allow, instead of leaving room.

    Either search is local: what it does not find or meet may be found elsewhere.

    Parameters
    ----------
    problem : GainProblem
        From `gain_problem`; with specifications, its form and rotation do not matter.
    asked : Specifications, optional
        What the flock must do.
    bounds : (float, float), optional
        Least and greatest gain, for c1γ and c2γ alike; (0, 5) by default, with specifications (0.1, 20).
    starts : int
        Random starts of gains per agent, half of them near the homogeneous optimum.
    seed : int
        Of the starts.
    least : {"effort", "strain", "h2", "overshoot"}, optional
        With specifications, what is to be as small as they allow.

    Returns
    -------
    GainDesign, or with specifications SpecifiedGains

    Examples
    --------
    A lone agent is best damped critically: √5 with c1γ <= 5.

    >>> from flockana import AlphaInteraction
    >>> from flockana.stability import gain_problem
    >>> alone = gain_problem([[0.0]], alpha=AlphaInteraction(), gains=Gains())
    >>> designs = design_gains(alone, starts=1)
    >>> round(designs.rate_homogeneous**2, 3), designs.homogeneous.round(2).tolist()
    (5.0, [5.0, 4.47])

    It must decay fast and yet bear a long sampling period; both bind:

    >>> found = design_gains(alone, Specifications(decay=1.0, period=0.1))
    >>> found.met, found.binding in ("decay", "period")
    (True, True)
    """
    ensure_kind("problem", problem, GainProblem, "what gain_problem(...) gives")
    if asked is not None:
        return _specified(problem, asked, bounds or (0.1, 20.0), least)
    if least is not None:
        raise ArgumentError(f"least = {least!r}: expected with Specifications(...), which it is to meet")
    low, high = _bounds(bounds or (0.0, 5.0), ensure_nonnegative)
    n, rng = problem.agents, np.random.default_rng(seed)
    equal_gains = np.repeat(_minimise2(lambda pair: problem.abscissa(np.repeat(pair, n)), low, high), n)
    trials = [equal_gains]
    for k in range(ensure_count("starts", starts)):
        nearby_gains = equal_gains + 0.1 * (high - low) * rng.standard_normal(2 * n)
        trials.append(np.clip(nearby_gains, low, high) if k % 2 == 0 else rng.uniform(low, high, 2 * n))
    designs = [_descend(problem, start, low, high) for start in trials]
    best_gains = min([equal_gains, *designs], key=problem.abscissa)
    spectra = problem.eigenvalues(equal_gains), problem.eigenvalues(best_gains)
    rates = [-float(values[0].real) for values in spectra]
    return GainDesign(problem, equal_gains, best_gains, rates[0], rates[1], spectra[0], spectra[1], starts)


def _specified(problem: GainProblem, asked: Specifications, bounds: Any, least: str | None) -> SpecifiedGains:
    """Search for gains with the largest slack in all specifications, or the least cost, over logarithms."""
    if not isinstance(asked, Specifications):
        raise ArgumentError(f"asked = {asked!r}: expected Specifications(decay=..., ...)")
    law, q = problem.law, problem.q
    if law is None or q is None:
        raise ArgumentError(
            "problem.law = None: expected a problem from gain_problem(...), which has the law and the positions"
        )
    if least is not None:
        ensure_known("least", least, AT_MOST)
    low, high = np.log(_bounds(bounds, ensure_positive)).tolist()

    def flock(logs: FloatArray) -> SpecifiedGains:
        return evaluated(law, q, asked, *np.exp(logs).tolist(), also=(least,) if least else ())

    def cost(logs: FloatArray) -> float:
        trial = flock(logs)
        margin = min(trial.room.values())
        if least is None or margin < 0.0:
            return -margin
        return -1.0 / (1.0 + trial.reached[least])  # below 0, where all is met, and rising with what it costs

    return flock(_minimise2(cost, low, high, count=6, tries=1, most=60, finest=2e-4))


def _bounds(bounds: Any, ensure: Callable[[str, Any], float]) -> tuple[float, float]:
    try:
        low, high = (ensure("bounds", x) for x in bounds)
    except TypeError:
        raise ArgumentError(f"bounds = {bounds!r}: expected (least, greatest) gain") from None
    if not low < high:
        raise ArgumentError(f"bounds = ({low:g}, {high:g}): expected least < greatest")
    return low, high


def _minimise2(
    worth: Callable[[FloatArray], float],
    low: float,
    high: float,
    *,
    count: int = _GRID,
    tries: int = 2,
    most: int = 200,
    finest: float = _SMALLEST,
) -> FloatArray:
    """Return the pair of numbers in [low, high] that minimises a function, by a grid and a simplex search."""
    from scipy.optimize import minimize

    axis, grid_step = np.linspace(low, high, count), (high - low) / count
    grid = sorted((worth(np.array(pair)), *pair) for pair in product(axis.tolist(), axis.tolist()))[:tries]
    best_point = grid[0]
    for value, a, b in grid:
        simplex = np.clip([[a, b], [a - 0.2 * grid_step, b], [a, b + 0.4 * grid_step]], low, high)
        search_options: Any = {"xatol": finest * (high - low), "fatol": _GAINED * abs(value)}
        options: Any = {"initial_simplex": simplex, "maxfev": most, **search_options}
        box = [(low, high)] * 2
        solution = minimize(worth, np.array([a, b]), method="Nelder-Mead", bounds=box, options=options)
        best_point = min(best_point, (float(solution.fun), *np.clip(solution.x, low, high).tolist()))
    return np.array(best_point[1:])


def _descend(problem: GainProblem, gains: FloatArray, low: float, high: float) -> FloatArray:
    """Minimise the largest real part of the eigenvalues over gains, by sequential linear programming."""
    from scipy.optimize import linprog

    radius, value = 0.2 * (high - low), problem.abscissa(gains)
    values, slopes = problem.slopes(gains)
    cost = np.append(np.zeros(gains.size), 1.0)
    for _ in range(_ROUNDS):
        active = np.argsort(-values.real)[:_ACTIVE]
        active = active[values.imag[active] >= 0.0]
        rows = np.column_stack([slopes[active], -np.ones(active.size)])
        box = np.column_stack([np.maximum(low, gains - radius), np.minimum(high, gains + radius)])
        plan = linprog(cost, rows, slopes[active] @ gains - values.real[active], bounds=[*box.tolist(), (None, None)])
        expected_gain = value - float(plan.x[-1]) if plan.x is not None else 0.0
        if plan.x is None or expected_gain <= _GAINED * abs(value):
            break
        trial = np.clip(plan.x[:-1], low, high)
        abscissa = problem.abscissa(trial)
        if abscissa < value - 0.1 * expected_gain:
            gains, value, radius = trial, abscissa, 1.5 * radius
            values, slopes = problem.slopes(gains)
        else:
            radius *= 0.4
        if radius < _SMALLEST * (high - low):
            break
    return gains
