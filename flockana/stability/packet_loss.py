"""Largest mean-square stable packet loss of a sampled flock: spectral radius of E[A ⊗ A] below 1."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, ensure_known, ensure_positive
from flockana.stability.delay import late_part
from flockana.stability.lifted_loops import first_growth
from flockana.stability.linear_flock import LinearFlock

LOST, ON_LOSS = ("all", "agent", "link"), ("zero", "hold")
MOST = 40  # states: E[A ⊗ A] has as many rows as their square
_DENSE = 12  # states up to which it is formed
_LEVELS = 40  # losses at which growth is looked for
_UNHELD = 1e-6  # relative: what a link's force may do along motions that cost nothing


@dataclass(frozen=True)
class LossMargin:
    """Largest loss probability with mean-square decay of perturbations.

    Parameters
    ----------
    loss : float
        Below it, at the losses looked at, none grows; 0 if they grow without any, 1 if no loss below 1 harms.
    radius : float
        Spectral radius of E[A ⊗ A] without loss, off the neutral motions.
    """

    loss: float
    radius: float


class _Step(NamedTuple):
    """Random step x⁺ = (A₀ + Σ θ_i A_i) x, independent θ_i = 1 with probability 1 − loss, else 0."""

    lost: FloatArray
    heard: tuple[FloatArray, ...]

    def radius(self, loss: float) -> float:
        """Return the spectral radius of E[A ⊗ A] of a random step x⁺ = A x, for a loss probability."""
        from scipy.sparse.linalg import LinearOperator, eigs

        mean, dimension = self.lost + (1.0 - loss) * sum(self.heard), len(self.lost)
        variance = loss * (1.0 - loss)
        if dimension <= _DENSE:
            full_matrix = np.kron(mean, mean) + variance * sum(np.kron(x, x) for x in self.heard)
            return float(np.abs(np.linalg.eigvals(full_matrix)).max())

        def apply(flat: FloatArray) -> FloatArray:
            x = flat.reshape(dimension, dimension)
            return (mean @ x @ mean.T + variance * sum(matrix @ x @ matrix.T for matrix in self.heard)).ravel()

        operator = LinearOperator((dimension * dimension, dimension * dimension), matvec=apply, dtype=np.float64)
        values = eigs(operator, k=1, v0=np.eye(dimension).ravel(), return_eigenvectors=False, tol=1e-10)
        return float(np.abs(values).max())


@check_kinds
def loss_margin(flock: LinearFlock, period: float, *, lost: str = "agent", on_loss: str = "zero") -> LossMargin:
    """Return the largest mean-square stable packet loss of a flock, for a sampling period.

    Losses are independent from sample to sample, and from agent to agent or link to link where these are lost singly.

    Parameters
    ----------
    flock : Linearisation
        From `linearise`, of at most 40 states.
    period : float
        Sampling period.
    lost : {"agent", "all", "link"}
        What is lost at once: one agent's input, those of all, or what one agent hears of one other (its place and
        velocity relative to its own).
    on_loss : {"zero", "hold"}
        What acts instead: nothing, or the last input that was received.

    Raises
    ------
    ArgumentError
        On a flock with more states, a link that carries a force at the equilibrium, or what is no such choice.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> from flockana.interactions import Gains
    >>> from flockana.laws.olfati_saber import Algorithm2
    >>> from flockana.stability import linearise
    >>> law = Algorithm2(gains=Gains(c1_gamma=0.0, c2_gamma=1.0), target=StaticTarget((0.0,)))
    >>> loss_margin(linearise(law, [[0.0]]), 1.0).loss  # v⁺ = θ·0 + (1 − θ) v: any loss below 1
    1.0
    """
    period = ensure_positive("period", period)
    ensure_known("what is lost", lost, LOST)
    ensure_known("what acts on a loss", on_loss, ON_LOSS)
    step = _step(flock, period, lost, on_loss)
    if not len(step.lost):
        return LossMargin(1.0, 0.0)
    start = step.radius(0.0)
    if start >= 1.0:
        return LossMargin(0.0, start)
    trials = np.append(np.linspace(0.0, 1.0, _LEVELS + 1)[:-1], 1.0 - 1e-6)
    return LossMargin(min(1.0, first_growth(step.radius, trials)), start)


def _step(flock: LinearFlock, period: float, lost: str, on_loss: str) -> _Step:
    """Return the random sampled step of a flock off its neutral motions, for a sampling period."""
    off, (n, m) = flock.second_order.quotient, flock.q.shape
    dimension, basis, pace = n * m, off.basis, off.pace
    one = np.eye(dimension)
    free = basis.T @ np.block([[one, pace * period * one], [0.0 * one, one]]) @ basis
    push = basis.T @ np.vstack([0.5 * pace * period**2 * one, period * one])
    if lost == "link":
        channels = _links(flock)
        free = free + push @ (off.force - sum((force for _, force in channels), np.zeros_like(off.force)))
    else:
        groups = np.arange(dimension).reshape(1 if lost == "all" else n, -1)
        channels = [(rows, one[:, rows] @ off.force[rows]) for rows in groups]
    states = len(free) + (sum(rows.size for rows, _ in channels) if on_loss == "hold" else 0)
    if states > MOST:
        raise ArgumentError(f"the flock has {states} states: expected at most {MOST}; take fewer agents")
    if on_loss == "zero":
        return _Step(free, tuple(push @ force for _, force in channels))
    acts = np.hstack([push[:, rows] for rows, _ in channels] or [np.zeros((len(free), 0))])
    held_rows = np.eye(acts.shape[1])
    kept_rows, new, offset = np.block([[free, acts], [np.zeros((len(held_rows), len(free))), held_rows]]), [], 0
    for rows, force in channels:
        own_held = held_rows[:, offset : offset + rows.size]
        new.append(np.vstack([push[:, rows], own_held]) @ np.hstack([force[rows], -own_held.T]))
        offset += rows.size
    return _Step(kept_rows, tuple(new))


def _links(flock: LinearFlock) -> list[tuple[Any, FloatArray]]:
    """Return for each directed link the rows of the hearing agent, and the coupling off neutral motions."""
    quotient, (n, m) = flock.second_order.quotient, flock.q.shape
    k, d, channels = flock.stiffness.toarray(), flock.damping.toarray(), []
    is_linked = (np.abs(k) + np.abs(d)).reshape(n, m, n, m).any(axis=(1, 3)) & ~np.eye(n, dtype=bool)
    for i, j in np.argwhere(is_linked).tolist():
        parts = (late_part(matrix, m, "pairs", [(i, j)]) for matrix in (k, d))
        full_matrix = -np.hstack(list(parts)) / np.repeat([quotient.pace, 1.0], n * m)
        force = full_matrix @ quotient.basis
        if np.abs(full_matrix - force @ quotient.basis.T).max() > _UNHELD * np.abs(full_matrix).max():
            raise ArgumentError(
                f"the link from agent {j} to {i} carries a force at this equilibrium: without it the flock moves away, "
                'which no linear step tells; expected links at rest, or lost="agent" or "all"'
            )
        channels.append((np.arange(i * m, (i + 1) * m), force))
    return channels
