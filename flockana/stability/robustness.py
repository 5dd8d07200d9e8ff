"""Robustness margins of the loop broken at each agent's input.

The loop is broken at one component of one agent's input, all others closed: with A of the closed flock and f its row
of that input, the open loop is L(s) = −f (s − A₀)⁻¹ b, where A₀ is A without that row and b the unit vector of the
input. Its sensitivity S = 1/(1 + L) = 1 + f (s − A)⁻¹ b is that of the closed, stable flock, off its zero modes. All
margins are read off S(jω): |S| peaks at the sensitivity peak; the disk margin is 1/max |S − ½|; |L| = 1 where
Re S = ½, and the phase there is 2 arctan(1/|2 Im S|); a gain k brings a root onto the axis where S = k/(k − 1), hence
real. Frequencies where Re S or Im S is given are eigenvalues of a matrix, of s² = −ω²: none is missed between the
points of a grid. The peaks are H∞ norms.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import atan2, degrees, inf
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import FloatArray
from flockana.stability.cost_estimates import LIMIT, ensure_study
from flockana.stability.linear_flock import LinearFlock
from flockana.stability.modes import SecondOrder
from flockana.stability.norms import Balanced, largest_gain

if TYPE_CHECKING:
    from control import StateSpace

SEARCHED = 1e-6, 1e6  # factors of an input between which growth is looked for where nothing is proved
_TOLERANCE = 1e-9  # relative: of peaks, and of a crossing
_NEAR_AXIS = 1e-3  # |Im s²|/|s²| of what may be a crossing, to the rounding of a double one
_STEPS = 20  # of Newton's method
_BESIDE, _FREQUENCIES = 30.0, 300  # times the fastest and a thirtieth of the slowest pole: where peaks are looked for


@dataclass(frozen=True)
class LoopMargins:
    """Margins of the loop broken at one component of one agent's input."""

    agent: int  # agent, axis: Where it is broken
    axis: int
    # Factors of the input between which the flock stays stable. 0 and infinity only where K and D of its strongly
    # connected component are symmetric and definite, so that a gain is a mass; else at most what was searched
    gain: tuple[float, float]
    phase: float  # Phase margin in degrees; infinite without a crossover
    disk: float  # Disk margin (balanced): gain and phase may vary together within it
    sensitivity: float  # Peak of the sensitivity 1/|1 + L(jω)|


@dataclass(frozen=True)
class RobustnessMargins(ShortRepr):
    """Margins of all loops of a flock, and the worst of each kind.

    Parameters
    ----------
    loops : tuple of LoopMargins
        By agent and axis.
    searched : (float, float)
        Factors of an input between which growth was looked for: a gain margin that ends there is only known so far.
        (0, infinity) where that is proved for all loops.
    """

    loops: tuple[LoopMargins, ...]
    searched: tuple[float, float] = (0.0, inf)

    @property
    def gain(self) -> tuple[float, float]:
        """Narrowest gain margin of any one input: (least, greatest) factor, within `searched`."""
        return max(loop.gain[0] for loop in self.loops), min(loop.gain[1] for loop in self.loops)

    @property
    def phase(self) -> float:
        """Least phase margin of all loops, in degrees."""
        return min(loop.phase for loop in self.loops)

    @property
    def disk(self) -> float:
        """Least disk margin of all loops."""
        return min(loop.disk for loop in self.loops)

    @property
    def sensitivity(self) -> float:
        """Largest sensitivity peak of all loops."""
        return max(loop.sensitivity for loop in self.loops)

    @property
    def table(self) -> dict[str, dict[str, float]]:
        """Table of gain, phase and disk margins and sensitivity peaks by loop, for `flockana.plots.bars`."""
        return {
            f"agent {loop.agent}, {'xyz'[loop.axis]}": {
                "least gain": loop.gain[0],
                "greatest gain": loop.gain[1],
                "phase (degrees)": loop.phase,
                "disk margin": loop.disk,
                "sensitivity peak": loop.sensitivity,
            }
            for loop in self.loops
        }

    @property
    def weakest(self) -> LoopMargins:
        """Loop with the least disk margin."""
        return min(self.loops, key=lambda one: one.disk)


@check_kinds
def open_loop(flock: LinearFlock, agent: int, axis: int = 0) -> StateSpace:
    """Return the loop broken at one component of an agent's input, as a `control.StateSpace`.

    Parameters
    ----------
    flock : Linearisation
        From `linearise`.
    agent, axis : int
        Where it is broken.

    Examples
    --------
    One agent at its γ-agent: L(s) = (c2γ s + c1γ)/s².

    >>> from flockana.environment.targets import StaticTarget
    >>> from flockana.interactions import Gains
    >>> from flockana.laws.olfati_saber import Algorithm2
    >>> from flockana.stability import linearise
    >>> law = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=3.0), target=StaticTarget((0.0,)))
    >>> loop = open_loop(linearise(law, [[0.0]]), 0)
    >>> complex(loop(2.0))
    (2.5+0j)
    """
    import control

    n, m = flock.q.shape
    if not 0 <= agent < n or not 0 <= axis < m:
        raise ArgumentError(f"agent = {agent}, axis = {axis}: expected one of {n} agents and {m} axes")
    row = n * m + agent * m + axis
    opened_matrix, unit = flock.A.copy(), np.zeros((2 * n * m, 1))
    feedback = opened_matrix[row : row + 1].copy()
    opened_matrix[row], unit[row] = 0.0, 1.0
    return control.ss(opened_matrix, unit, -feedback, 0.0)


def loop_margins(flock: LinearFlock, limit: float = LIMIT) -> RobustnessMargins:
    """Return the margins of the loops of a linearised flock, each broken at one agent's input."""
    ensure_study("the margins of all loops", flock.q.size, limit)
    if not flock.stable:
        raise ArgumentError(f"the flock is not stable: decay rate {flock.decay_rate:.3g}, expected one above 0")
    problem = flock.second_order
    proved, m, peaks = np.zeros(flock.q.size, dtype=bool), flock.q.shape[1], _peaks(problem)
    for k, component in enumerate(problem.parts or (problem,)):  # a loop closes within its strongly connected component
        proved[problem.net.indices[k] if problem.net else slice(None)] = _gains_are_masses(component)
    widest = [(0.0, inf) if item else SEARCHED for item in proved.tolist()]
    loops = tuple(_margins(problem, k, m, widest[k], peaks[:, k]) for k in range(flock.q.size))
    return RobustnessMargins(loops, max(widest))


def _peaks(problem: SecondOrder) -> FloatArray:
    """Return frequencies near the peaks of |S| and of |S − ½| of each loop, shape (2, n m): on a grid, refined."""
    # Of a peak little above 1 = S(∞) the norm's matrix is nearly singular: it is left to confirm what is found here.
    from scipy.optimize import minimize_scalar

    flock, dimension = problem.quotient, problem.q.size
    rates = np.abs(problem.eigenvalues[problem.eigenvalues != 0.0])
    if not rates.size:
        return np.zeros((2, dimension))
    turns = np.abs(problem.eigenvalues.imag)
    spread = np.geomspace(rates.min() / _BESIDE, rates.max() * _BESIDE, _FREQUENCIES)
    grid = np.unique(np.concatenate([spread, rates, turns[turns > 0.0]]))
    identity, inputs = np.eye(len(flock.A)), flock.basis[dimension:].T
    response_matrices = (np.linalg.solve(1j * w * identity - flock.A, inputs) for w in grid.tolist())
    s = 1.0 + np.array([np.einsum("ij,ji->i", flock.force, x) for x in response_matrices])  # (grid, n m)
    peaks = np.empty((2, dimension))
    for row, shift in enumerate((0.0, 0.5)):
        for k, top in enumerate(np.abs(s - shift).argmax(axis=0).tolist()):
            log_bracket = np.log(grid[[max(top - 1, 0), min(top + 1, len(grid) - 1)]])
            b, f = inputs[:, k], flock.force[k]

            def lack(x: float, b: FloatArray = b, f: FloatArray = f, shift: float = shift) -> float:
                return -abs(1.0 - shift + complex(f @ np.linalg.solve(1j * np.exp(x) * identity - flock.A, b)))

            peaks[row, k] = np.exp(minimize_scalar(lack, bounds=tuple(log_bracket), method="bounded").x)
    return peaks


def _gains_are_masses(problem: SecondOrder) -> bool:
    """Return whether K and D are symmetric, K >= 0, and D > 0 off common kernels."""
    if not problem.symmetric:
        return False
    k, d = (0.5 * (x + x.T) for x in (problem.stiffness.toarray(), problem.damping.toarray()))
    stiffness_values = np.linalg.eigvalsh(k)
    drag, axes = np.linalg.eigh(d)
    undamped = axes[:, drag <= problem.zero * float(np.abs(drag).max(initial=0.0))]
    rest = np.linalg.norm(k @ undamped, axis=0) if undamped.size else np.zeros(1)
    return bool(stiffness_values[0] >= -problem.zero * problem.scale and rest.max() <= problem.zero * problem.scale)


def _margins(problem: SecondOrder, index: int, m: int, widest: tuple[float, float], peaks: FloatArray) -> LoopMargins:
    """Return the margins of the loop broken at one coordinate's input."""
    flock, dimension = problem.quotient, problem.q.size
    a, b, f = flock.A, flock.basis[dimension + index], flock.force[index]
    loop = Balanced(a, b[:, None], f[None, :], np.ones((1, 1)), discrete=False)
    peak = largest_gain(loop, _TOLERANCE, peaks[:1].tolist())[0]
    disk = 1.0 / largest_gain(loop._replace(d=np.full((1, 1), 0.5)), _TOLERANCE, peaks[1:].tolist())[0]
    phase = min((2.0 * degrees(atan2(0.5, abs(s.imag))) for s in _where_real_part_is_half(a, b, f)), default=inf)
    factors = [s.real / (s.real - 1.0) for s in _where_real(a, b, f) if s.real != 1.0]
    low = max((k for k in factors if widest[0] < k < 1.0 and k > SEARCHED[0]), default=widest[0])
    high = min((k for k in factors if 1.0 < k < min(widest[1], SEARCHED[1])), default=widest[1])
    return LoopMargins(index // m, index % m, (low, high), phase, disk, max(1.0, peak))


def _where_real_part_is_half(a: FloatArray, b: FloatArray, f: FloatArray) -> list[complex]:
    """Return the values S(jω) with Re S = ½, from eigenvalues s² of a rational equation."""
    squares = np.linalg.eigvals(a @ a - 2.0 * np.outer(b, f @ a))
    return _on_the_axis(a, b, f, squares, lambda s: s.real - 0.5, lambda slope: slope.real)


def _where_real(a: FloatArray, b: FloatArray, f: FloatArray) -> list[complex]:
    """Return the values S(jω) with Im S = 0, from zeros s² of 2 s f (s² − A²)⁻¹ b, and at s = 0."""
    from scipy.linalg import eigvals

    rest_value = 1.0 - complex(f @ np.linalg.solve(a, b)) if len(a) else 1.0 + 0.0j
    squared_matrix = a @ a
    full_matrix = np.block([[squared_matrix, b[:, None]], [f[None, :], np.zeros((1, 1))]])
    mass = np.eye(len(full_matrix))
    mass[-1, -1] = 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        zeros = eigvals(full_matrix, mass)
    zeros = zeros[np.isfinite(zeros)]
    return [rest_value, *_on_the_axis(a, b, f, zeros, lambda s: s.imag, lambda slope: slope.imag)]


def _on_the_axis(
    a: FloatArray, b: FloatArray, f: FloatArray, squares: Any, value: Callable[[complex], float], slope: Any
) -> list[complex]:
    """Return the values S(jω) at the roots ω > 0 of a real function of S, by Newton's method."""
    near_axis = (squares.real < 0.0) & (np.abs(squares.imag) <= _NEAR_AXIS * np.abs(squares))
    identity, frequencies = np.eye(len(a)), []
    for omega in np.sqrt(-squares.real[near_axis]).tolist():
        for _ in range(_STEPS):
            shifted_matrix = 1j * omega * identity - a
            answer = np.linalg.solve(shifted_matrix, b)
            s, loop_slope = 1.0 + complex(f @ answer), -1j * complex(f @ np.linalg.solve(shifted_matrix, answer))
            step = value(s) / slope(loop_slope) if slope(loop_slope) else inf
            if abs(value(s)) <= _TOLERANCE * min(1.0, abs(s)) and abs(step) <= _TOLERANCE * omega:
                frequencies.append(s)
                break
            if not 0.0 < omega - step < inf:
                break
            omega -= step
    return frequencies
