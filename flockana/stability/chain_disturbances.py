"""Disturbances in nets: amplification along a chain, transient growth, passivity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import log, nan

import numpy as np

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import FloatArray, Numbers, ensure_count, ensure_kind
from flockana.stability.cost_estimates import LIMIT, ensure_study
from flockana.stability.linear_flock import LinearFlock
from flockana.stability.norms import Balanced, largest_gain

_TOLERANCE = 1e-9  # relative, of a norm
_TIMES = 400  # at which growth is looked at
_ALIKE = 1e-9  # relative, of the K and D of followers
_SETTLED = 20.0  # time constants of the slowest mode, and two for each state of a chain: the last time


@dataclass(frozen=True, eq=False)
class StringGains:
    """Largest gains from the motion of one agent to the motions of all others.

    Parameters
    ----------
    first : int
        The agent that is moved.
    gains, peaks : ndarray, shape (n,)
        Largest |q_k/q_first| over all frequencies (over all directions of the plane or space), and where it is, in
        radians per time unit; 1 and 0 of the agent itself.
    """

    first: int
    gains: FloatArray
    peaks: FloatArray

    @property
    def amplifies(self) -> bool:
        """Whether some agent moves more than the first, so that disturbances may grow along a chain."""
        return bool(self.gains.max() > 1.0 + 10.0 * _TOLERANCE)


@check_kinds
def string_gains(flock: LinearFlock, first: int = 0, *, limit: float = LIMIT) -> StringGains:
    """Return the H∞ norms from the motion of one agent to those of its followers.

    Along a chain in which each hears the one before, the k-th gain is the k-th power of the first at one frequency: a
    first gain above 1 makes a chain string unstable, however well each follower is damped.

    Parameters
    ----------
    flock : Linearisation
        Stable while the first agent is held.
    first : int
        The agent that is moved.
    limit : float
        Seconds of estimated work from which on it is refused.

    Raises
    ------
    ArgumentError
        If the others are not stable while the first is held, there are none, or it would take longer than the limit.

    Examples
    --------
    x'' = −(x' − x₀') − (x − x₀) answers its leader with up to 1.47 times its motion, the next with 1.47² times:

    >>> from flockana import MinimalFlocking
    >>> from flockana.stability import linearise
    >>> row = linearise(MinimalFlocking(edges=((0, 1), (1, 2)), spacing=1.0, radius=3.0), [[0.0], [1.0], [2.0]])
    >>> found = string_gains(row)
    >>> found.gains.round(4).tolist(), found.amplifies
    ([1.0, 1.4679, 2.1547], True)
    """
    n, m = flock.q.shape
    first = ensure_count("first + 1", first + 1) - 1
    if not first < n or n < 2:
        raise ArgumentError(f"first = {first}: expected one of {n} agents, and others to follow it")
    ensure_study("the string gains", n * m, limit)
    is_first = np.arange(n * m) // m == first
    k, d = flock.stiffness.toarray(), flock.damping.toarray()
    inner, heard = np.ix_(~is_first, ~is_first), np.ix_(~is_first, is_first)
    size, unit = (n - 1) * m, flock.second_order.pace
    stiffness, damping, push, drag = k[inner] / unit**2, d[inner] / unit, k[heard] / unit**2, d[heard] / unit
    # with p = x' + D₀ u the velocity u' of the input does not appear
    a = np.block([[np.zeros((size, size)), np.eye(size)], [-stiffness, -damping]])
    system = Balanced(
        a, np.vstack([-drag, damping @ drag - push]), np.eye(m, 2 * size), np.zeros((m, m)), discrete=False
    )
    if not system.stable:
        raise ArgumentError(
            f"the others are not stable while agent {first} is held: expected each to be held by others"
        )
    gains, peaks = np.ones(n), np.zeros(n)
    for place, agent in enumerate(np.delete(np.arange(n), first).tolist()):
        seen_system = system._replace(c=np.eye(2 * size)[place * m : (place + 1) * m])
        gains[agent], peaks[agent] = largest_gain(seen_system, _TOLERANCE)
    return StringGains(first, gains, peaks * unit)


@dataclass(frozen=True, eq=False)
class StringStability:
    """Gains from the first to the last agent of chains of growing length.

    Parameters
    ----------
    sizes : tuple of int
        Numbers of agents.
    gains, peaks : ndarray, shape (len(sizes),)
        Largest |q_last/q_first| of each chain, and at which angular frequency.
    link : float
        Largest gain from each agent to the next, where all hear only the one before and answer alike; else NaN.
    """

    sizes: tuple[int, ...]
    gains: FloatArray
    peaks: FloatArray
    link: float

    @property
    def stable(self) -> bool | None:
        """Whether no disturbance grows along a chain of any length; None if the tested lengths do not decide."""
        return None if np.isnan(self.link) else bool(self.link <= 1.0 + 10.0 * _TOLERANCE)

    @property
    def why(self) -> str:
        """Reason for the decision on string stability, in a sentence with its numbers."""
        gains = ", ".join(f"{gain:.4g}" for gain in self.gains.tolist())
        if self.stable is None:
            trend_text = "grow" if (np.diff(self.gains) > _TOLERANCE).all() else "do not all grow"
            reason_text = "measured only, as agents do not all hear the one before alone and alike"
            return f"{reason_text}: gains {gains} of n = {self.sizes} {trend_text}"
        follow_text = "so no chain amplifies" if self.stable else f"so n agents by its power n − 1: {gains}"
        return f"each agent answers the one before with at most {self.link:.4g} times its motion, {follow_text}"


@check_kinds
def string_stability(chain: Callable[[int], LinearFlock], sizes: Numbers = (3, 5, 9, 17)) -> StringStability:
    """Return whether a disturbance of the first agent grows along the chain, from several chain lengths.

    Where each agent hears the one before alone, with equal K and D, the gain over k links is at most the k-th power of
    that over one, and reaches it where K and D have common axes: one link decides chains of every length. Other chains
    (both neighbours, the leader) are measured.

    Parameters
    ----------
    chain : callable
        The linearised chain of n agents, n at its argument, the first at index 0.
    sizes : sequence of int
        Numbers of agents, each at least 2, rising.

    Raises
    ------
    ArgumentError
        On other sizes, a chain with another number of agents, or one that is not stable while its first is held.

    Examples
    --------
    >>> from flockana import MinimalFlocking, linearise
    >>> def row(n):
    ...     edges = tuple((k, k + 1) for k in range(n - 1))
    ...     return linearise(MinimalFlocking(edges=edges, spacing=1.0, radius=2.0 * n), [[float(k)] for k in range(n)])
    >>> result = string_stability(row, (2, 3, 4))
    >>> result.stable, result.gains.round(4).tolist()
    (False, [1.4679, 2.1547, 3.1629])
    """
    if not callable(chain):
        raise ArgumentError(f"chain = {format_value(chain)}: expected a function of n that returns n linearised agents")
    counts = tuple(ensure_count("a number of agents", n) for n in sizes)
    if not counts or any(b <= a for a, b in pairwise((1, *counts))):
        raise ArgumentError(f"sizes = {tuple(sizes)}: expected rising numbers of agents, from 2 on")
    flocks = [chain(n) for n in counts]
    for n, flock in zip(counts, flocks, strict=True):
        ensure_kind(f"chain({n})", flock, LinearFlock, "what linearise(law, q) returns")
        if len(flock.q) != n:
            raise ArgumentError(f"chain({n}) has {len(flock.q)} agents: expected {n}")
    gains = [string_gains(flock) for flock in flocks]
    link = _link_gain(flocks[-1], float(gains[-1].gains[1]))
    return StringStability(
        counts, np.array([gain.gains[-1] for gain in gains]), np.array([gain.peaks[-1] for gain in gains]), link
    )


def _link_gain(flock: LinearFlock, gain: float) -> float:
    """Return the gain per link if it decides on uniform chains of every length, or NaN for other nets."""
    n, m = flock.q.shape
    parts = []
    for matrix in (flock.stiffness.toarray(), flock.damping.toarray()):
        blocks = matrix.reshape(n, m, n, m).transpose(0, 2, 1, 3)
        expected = np.zeros_like(blocks)
        expected[0] = blocks[0]  # it is moved, whatever it hears
        expected[np.arange(1, n), np.arange(1, n)] = blocks[1, 1]
        expected[np.arange(1, n), np.arange(n - 1)] = blocks[1, 0]
        if np.abs(blocks - expected).max() > _ALIKE * np.abs(blocks).max():
            return nan
        parts += [blocks[1, 1], blocks[1, 0]]
    if gain <= 1.0 + 10.0 * _TOLERANCE:
        return gain  # no product of such answers is larger
    # in one common eigenbasis the largest gain is that of one direction, and of its powers too
    commutator_norm = max(float(np.abs(a @ b.T - b.T @ a).max()) for a in parts for b in parts)
    return gain if commutator_norm <= _ALIKE * max(float(np.abs(a).max()) for a in parts) ** 2 else nan


@dataclass(frozen=True)
class TransientGrowth:
    """Largest growth of a small perturbation before its decay, and the time of the peak.

    Parameters
    ----------
    growth : float
        max ‖e^(At)‖ over t >= 0, off the neutral motions: 1 if nothing ever grows.
    time : float
        When, in time units.
    """

    growth: float
    time: float


@check_kinds
def transient_growth(flock: LinearFlock, *, limit: float = LIMIT) -> TransientGrowth:
    """Return the largest transient growth of a perturbation, which is large in nonnormal nets.

    A perturbation is measured by its positions times the rate of the fastest motion, and its velocities, from the
    nearest neutral motion. Times are searched on a grid from the fastest motion to the slowest mode and refined: what
    is returned is reached, and a narrow peak between two times may be higher.

    Parameters
    ----------
    flock : Linearisation
        A stable flock.
    limit : float
        Seconds of estimated work from which on it is refused.

    Raises
    ------
    ArgumentError
        If it is not stable, or would take longer than the limit.

    Examples
    --------
    >>> from flockana import NetConsensus
    >>> from flockana.stability import linearise
    >>> net = linearise(NetConsensus([[0, 1], [1, 0]]), [[0.0], [0.0]])
    >>> transient_growth(net).growth >= 1.0
    True
    """
    from scipy.linalg import expm
    from scipy.optimize import minimize_scalar

    ensure_study("the transient growth", flock.q.size, limit)
    if not flock.stable:
        raise ArgumentError(f"the flock is not stable: decay rate {flock.decay_rate:.3g}, expected one above 0")
    a = flock.second_order.quotient_at(flock.second_order.fastest_rate).A
    if not len(a):
        return TransientGrowth(1.0, 0.0)

    def size(exponent: float) -> float:
        return float(np.linalg.norm(expm(a * np.exp(exponent)), 2))

    grid = np.linspace(
        log(0.01 / flock.second_order.fastest_rate), log((_SETTLED + 2.0 * len(a)) / flock.decay_rate), _TIMES
    )
    norms = [size(x) for x in grid.tolist()]
    best_index = int(np.argmax(norms))
    bounds = float(grid[max(best_index - 1, 0)]), float(grid[min(best_index + 1, _TIMES - 1)])
    finer = minimize_scalar(lambda x: -size(x), bounds=bounds, method="bounded", options={"xatol": 1e-9})
    growth, exponent = max((norms[best_index], float(grid[best_index])), (-float(finer.fun), float(finer.x)))
    return TransientGrowth(growth, float(np.exp(exponent))) if growth > 1.0 else TransientGrowth(1.0, 0.0)


@dataclass(frozen=True)
class Passivity:
    """Passivity of a flock from forces on all agents to their velocities.

    Parameters
    ----------
    passive : bool
        K = Kᵀ >= 0 and D + Dᵀ >= 0, to rounding: exactly then, with all agents as channels.
    asymmetry : float
        Largest entry of K − Kᵀ, over the largest of K.
    stiffness, damping : float
        Least eigenvalues of (K + Kᵀ)/2 and (D + Dᵀ)/2, over the largest row sum of each.
    """

    passive: bool
    asymmetry: float
    stiffness: float
    damping: float


@check_kinds
def passivity(flock: LinearFlock) -> Passivity:
    """Return whether a linearised flock is passive from forces on all agents to their velocities.

    Parameters
    ----------
    flock : Linearisation
        From `linearise`.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.stability import linearise
    >>> passivity(linearise(Algorithm1(), [[0.0, 0.0], [7.0, 0.0]])).passive
    True
    """
    k, d = flock.stiffness.toarray(), flock.damping.toarray()
    zero = max(flock.zero, 1e-13)
    asymmetry = float(np.abs(k - k.T).max()) / (float(np.abs(k).max()) or 1.0)
    rows = [float(np.abs(x).sum(axis=1).max()) or 1.0 for x in (k, d)]
    stiffness, damping = (
        float(np.linalg.eigvalsh(0.5 * (x + x.T))[0]) / row for x, row in zip((k, d), rows, strict=True)
    )
    is_passive = asymmetry <= zero and stiffness >= -zero and damping >= -zero
    return Passivity(is_passive, asymmetry, stiffness, damping)
