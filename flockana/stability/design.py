"""Gains that make the slowest mode decay fastest: one c1γ and c2γ for all agents, or one of each per agent.

The question is that of Montanari, Barioni, Duan and Motter ("Optimal flock formation induced by agent heterogeneity"):
minimise the largest real part among the eigenvalues of [[0, I], [−diag(c1γ) − c1α∇²V, −diag(c2γ) − c2α L̂]] at a given
quasi-lattice, gains between bounds. Their simplified form drops ∇²V.

Which modes are set apart. Translation is no zero mode here: c1γ holds it, and how fast it dies is what the γ-agent is
for; it counts. Rotation about the γ-agent is neutral at every equilibrium of the law, for any gains, because the stress
in the pressed links cancels what c1γ seems to hold. At a lattice that is no equilibrium of the law, an unstressed one
above all, the printed matrix does hold it, which no flock at rest does. So rotation="counted" reads the matrix as
printed; rotation="neutral" divides the angle of the rotation about the centre out, as `blocks.Blocks.quotient` does,
so that the speed of turning is still to die out, as it is in a flock at rest; and rotation="apart" projects out angle
and speed alike: what is rated is the flock's shape and its centre, and nothing of how it turns.

What was found for thirty agents is in docs/gain-design.md.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from math import sqrt
from typing import Any, TypedDict, Unpack, overload

import numpy as np
import numpy.typing as npt

from flockana.base.checks import (
    FloatArray,
    ensure_count,
    ensure_kind,
    ensure_known,
    ensure_nonnegative,
    ensure_points,
    ensure_positive,
)
from flockana.base.errors import ArgumentError
from flockana.environment.targets import StaticTarget
from flockana.equilibria.terminal import rigid_motions
from flockana.interactions import Gains
from flockana.interactions.alpha import AlphaInteraction
from flockana.laws.olfati_saber import Algorithm2
from flockana.stability.blocks import complement, reduced
from flockana.stability.specifications import Specifications, SpecifiedGains, evaluated

ComplexArray = npt.NDArray[np.complex128]

FORMS = ("full", "simplified")
ROTATIONS = ("apart", "neutral", "counted")
_ROUNDS = 200
_ACTIVE = 40  # eigenvalues with the largest real parts that a step looks at
_SMALLEST = 2e-9  # trust region at which a search ends, of the interval of gains
_GAINED = 1e-10  # relative gain of a step that is worth no further one
_GRID = 10


@dataclass(frozen=True)
class GainProblem:
    """State matrix of the gain design problem, and its eigenvalues as functions of the gains.

    Examples
    --------
    One agent, c1γ = 2 and c2γ = 3, has the roots −1 and −2:

    >>> alone = GainProblem(np.zeros((1, 1)), np.zeros((1, 1)), np.zeros((1, 0)), 1)
    >>> round(alone.abscissa(np.array([2.0, 3.0])), 12)
    -1.0
    """

    stiffness: FloatArray  # shape (N, N): c1α ∇²V, or zero in the simplified form
    damping: FloatArray  # shape (N, N): c2α L̂
    apart: FloatArray  # shape (N, k): orthonormal motions that are projected out
    agents: int  # n; each has N/n coordinates
    speeds: bool = True  # whether their velocities are projected out too, or their positions alone
    law: Algorithm2 | None = None  # law and configuration (n, m) that the matrices are of
    q: FloatArray | None = None

    @property
    def _kept(self) -> tuple[FloatArray, FloatArray]:
        """Bases of the positions and of the velocities that are left."""
        kept = complement(self.apart)
        return kept, kept if self.speeds else np.eye(len(self.stiffness))

    def matrix(self, gains: FloatArray) -> FloatArray:
        """Return the state matrix for gains (c1γ_1 … c1γ_n, c2γ_1 … c2γ_n), projected motions removed."""
        each = len(self.stiffness) // self.agents
        pull, drag = np.repeat(gains, each).reshape(2, -1)
        return reduced(self.stiffness + np.diag(pull), self.damping + np.diag(drag), *self._kept)

    def eigenvalues(self, gains: FloatArray) -> ComplexArray:
        """Return the eigenvalues of `matrix`, largest real part first."""
        values: ComplexArray = np.linalg.eigvals(self.matrix(gains)).astype(np.complex128)
        return values[np.lexsort((values.imag, -values.real))]

    def abscissa(self, gains: FloatArray) -> float:
        """Return the largest real part, minus the decay rate of the slowest mode."""
        return float(np.linalg.eigvals(self.matrix(gains)).real.max())

    def slopes(self, gains: FloatArray) -> tuple[ComplexArray, FloatArray]:
        """Return eigenvalues and the derivatives of their real parts by the gains, shapes (M,) and (M, 2 n).

        dλ = y* dA x/(y* x) with left and right eigenvectors y, x; meaningless where eigenvalues coalesce.
        """
        from scipy.linalg import eig

        values, left, right = eig(self.matrix(gains), left=True, right=True)  # type: ignore[misc]
        positions, velocities = self._kept
        k = positions.shape[1]
        force = velocities @ left[k:].conj()
        scale = np.einsum("ij,ij->j", left.conj(), right)
        scale = np.where(np.abs(scale) > 1e-14, scale, 1e-14)
        moved = np.vstack([positions @ right[:k], velocities @ right[k:]]).reshape(2, self.agents, -1, values.size)
        slope = -np.einsum("aim,gaim->gam", force.reshape(self.agents, -1, values.size), moved)
        return values, (slope.reshape(2 * self.agents, -1) / scale).real.T


@dataclass(frozen=True)
class GainDesign:
    """Best gains found, equal and per agent, with their eigenvalues.

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
        """Return one line without the arrays."""
        rates = f"{self.rate_homogeneous:.4f} alike, {self.rate_heterogeneous:.4f} per agent"
        return f"<GainDesign of {self.problem.agents} agents: decay rates {rates}, ratio {self.ratio:.3f}>"

    @property
    def ratio(self) -> float:
        """Ratio of decay rates, heterogeneous over equal gains; a lower bound."""
        return self.rate_heterogeneous / self.rate_homogeneous

    def gains(self, base: Gains, *, heterogeneous: bool = True) -> Gains:
        """Gains `base` with the designed c1γ and c2γ.

        Parameters
        ----------
        base : Gains
            The other gains.
        heterogeneous : bool
            One per agent, or one for all.
        """
        from dataclasses import replace

        chosen = self.heterogeneous if heterogeneous else self.homogeneous
        pull, drag = chosen.reshape(2, -1)
        if heterogeneous:
            return replace(base, c1_gamma=pull, c2_gamma=drag)
        return replace(base, c1_gamma=float(pull[0]), c2_gamma=float(drag[0]))


def gain_problem(
    q: Any, *, alpha: AlphaInteraction, gains: Gains, form: str = "full", rotation: str = "apart"
) -> GainProblem:
    """Return the gain design problem at a configuration.

    Parameters
    ----------
    gains : Gains
        c1α and c2α are used.
    form : {"full", "simplified"}
        With c1α ∇²V or without. Without it coordinates decouple into m copies of one problem of n, and nothing knows
        of rotations.
    rotation : {"apart", "neutral", "counted"}
        Whether the rotation about the centre is projected out, angle and speed; or its angle alone, as where it is
        neutral; or neither. No matter in the simplified form.

    Raises
    ------
    UnknownNameError
        On another form or rotation.

    Examples
    --------
    >>> problem = gain_problem([[0.0, 0.0], [7.0, 0.0]], alpha=AlphaInteraction(), gains=Gains(), form="simplified")
    >>> problem.damping.shape, problem.apart.shape
    ((2, 2), (2, 0))
    """
    q = ensure_points("q", q)
    n, m = q.shape
    for name, value, known in (("form", form, FORMS), ("rotation", rotation, ROTATIONS)):
        ensure_known(name, value, known)
    damping = gains.c2_alpha * alpha.laplacian(q).toarray()
    of = {"law": Algorithm2(alpha, gains, StaticTarget(q.mean(axis=0))), "q": q}
    if form == "simplified":
        return GainProblem(np.zeros((n, n)), damping[::m, ::m], np.zeros((n, 0)), n, **of)
    rigid = rigid_motions(q)
    translations = np.tile(np.eye(m), (n, 1)) / sqrt(n)
    inside = rigid - translations @ (translations.T @ rigid)
    basis, sizes, _ = np.linalg.svd(inside, full_matrices=False)
    turns = basis[:, sizes > 0.5] if rotation != "counted" else np.zeros((q.size, 0))
    return GainProblem(gains.c1_alpha * alpha.hessian(q).toarray(), damping, turns, n, rotation == "apart", **of)


class _Search(TypedDict, total=False):
    """Keyword arguments of `design_gains`."""

    bounds: tuple[float, float] | None
    starts: int
    polish: int
    seed: int


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
    polish: int = 0,
    seed: int = 0,
) -> GainDesign | SpecifiedGains:
    """Choose c1γ and c2γ within bounds: for the fastest decay, or to meet specifications.

    Without specifications the spectral abscissa is minimised, alike for all agents and one per agent. Alike, the two
    gains are searched on a grid and by Nelder and Mead's method. Per agent, sequential linear programs minimise the
    largest of the linearised real parts within a trust region, from the homogeneous optimum, near it and from random
    starts; the abscissa is not smooth where eigenvalues coalesce, which `polish` generations of CMA-ES may get over.

    With specifications the gains are alike for all agents, and the specification with the least room gets the most: it
    is the one that binds. The equilibrium is found anew for each choice. The grid is geometric.

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
    polish : int
        Generations of CMA-ES, of gains per agent.
    seed : int
        Of the starts and of CMA-ES.

    Returns
    -------
    GainDesign, or with specifications SpecifiedGains

    Raises
    ------
    ArgumentError
        On bounds that are no interval of gains >= 0 (with specifications > 0), or a problem without its law.

    Examples
    --------
    A lone agent is best damped critically: √5 with c1γ <= 5.

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
        return _specified(problem, asked, bounds or (0.1, 20.0))
    low, high = _bounds(bounds or (0.0, 5.0), ensure_nonnegative)
    n, rng = problem.agents, np.random.default_rng(seed)
    alike = np.repeat(_alike(lambda pair: problem.abscissa(np.repeat(pair, n)), low, high), n)
    trials = [alike]
    for k in range(ensure_count("starts", starts)):
        near = alike + 0.1 * (high - low) * rng.standard_normal(2 * n)
        trials.append(np.clip(near, low, high) if k % 2 == 0 else rng.uniform(low, high, 2 * n))
    designs = [_descend(problem, start, low, high) for start in trials]
    best = min([alike, *designs], key=problem.abscissa)
    if polish:
        best = min([best, _evolve(problem, best, low, high, polish, seed)], key=problem.abscissa)
    spectra = problem.eigenvalues(alike), problem.eigenvalues(best)
    rates = [-float(values[0].real) for values in spectra]
    return GainDesign(problem, alike, best, rates[0], rates[1], spectra[0], spectra[1], starts)


def _specified(problem: GainProblem, asked: Specifications, bounds: Any) -> SpecifiedGains:
    """Search gains, by their logarithms, that leave the most room."""
    if not isinstance(asked, Specifications):
        raise ArgumentError(f"asked = {asked!r}: expected Specifications(decay=..., ...)")
    law, q = problem.law, problem.q
    if law is None or q is None:
        raise ArgumentError("problem.law = None: expected what gain_problem(...) gives, which knows law and places")
    low, high = np.log(_bounds(bounds, ensure_positive)).tolist()

    def found(logs: FloatArray) -> SpecifiedGains:
        return evaluated(law, q, asked, *np.exp(logs).tolist())

    best = _alike(lambda logs: -min(found(logs).room.values()), low, high, count=6, tries=1, most=60, finest=2e-4)
    return found(best)


def _bounds(bounds: Any, ensure: Callable[[str, Any], float]) -> tuple[float, float]:
    try:
        low, high = (ensure("bounds", x) for x in bounds)
    except TypeError:
        raise ArgumentError(f"bounds = {bounds!r}: expected (least, greatest) gain") from None
    if not low < high:
        raise ArgumentError(f"bounds = ({low:g}, {high:g}): expected least < greatest")
    return low, high


def _alike(
    worth: Callable[[FloatArray], float],
    low: float,
    high: float,
    *,
    count: int = _GRID,
    tries: int = 2,
    most: int = 200,
    finest: float = _SMALLEST,
) -> FloatArray:
    """Return the pair of numbers between bounds whose worth is least, by a grid and a simplex search."""
    from scipy.optimize import minimize

    axis, wide = np.linspace(low, high, count), (high - low) / count
    grid = sorted((worth(np.array(pair)), *pair) for pair in product(axis.tolist(), axis.tolist()))[:tries]
    best = grid[0]
    for value, a, b in grid:
        simplex = np.clip([[a, b], [a - 0.2 * wide, b], [a, b + 0.4 * wide]], low, high)
        fine: Any = {"xatol": finest * (high - low), "fatol": _GAINED * abs(value)}
        options: Any = {"initial_simplex": simplex, "maxfev": most, **fine}
        box = [(low, high)] * 2
        polished = minimize(worth, np.array([a, b]), method="Nelder-Mead", bounds=box, options=options)
        best = min(best, (float(polished.fun), *np.clip(polished.x, low, high).tolist()))
    return np.array(best[1:])


def _descend(problem: GainProblem, gains: FloatArray, low: float, high: float) -> FloatArray:
    """Sequential linear programming: min t such that each linearised real part is at most t, in a trust region."""
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
        promised = value - float(plan.x[-1]) if plan.x is not None else 0.0
        if plan.x is None or promised <= _GAINED * abs(value):
            break
        trial = np.clip(plan.x[:-1], low, high)
        reached = problem.abscissa(trial)
        if reached < value - 0.1 * promised:
            gains, value, radius = trial, reached, 1.5 * radius
            values, slopes = problem.slopes(gains)
        else:
            radius *= 0.4
        if radius < _SMALLEST * (high - low):
            break
    return gains


def _evolve(
    problem: GainProblem, gains: FloatArray, low: float, high: float, generations: int, seed: int
) -> FloatArray:
    """Search by CMA-ES about a point where slopes mislead."""
    from cmaes import SepCMA

    box = np.tile([low, high], (gains.size, 1))
    search = SepCMA(mean=gains.copy(), sigma=0.02 * (high - low), bounds=box, seed=seed)
    best, least = gains, problem.abscissa(gains)
    for _ in range(generations):
        tried = [search.ask() for _ in range(search.population_size)]
        rated = [(x, problem.abscissa(x)) for x in tried]
        search.tell(rated)
        x, value = min(rated, key=lambda pair: pair[1])
        if value < least:
            best, least = x, value
    return best
