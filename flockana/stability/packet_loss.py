"""Largest packet loss that a sampled flock bears in mean square: spectral radius of E[A ⊗ A] below 1."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from flockana.base.checks import FloatArray, ensure_known, ensure_positive
from flockana.base.errors import ArgumentError
from flockana.base.kinds import check_kinds
from flockana.stability.linearisation import Linearisation

LOST, ON_LOSS = ("all", "agent"), ("zero", "hold")
MOST = 40  # states: E[A ⊗ A] has as many rows as their square
_DENSE = 12  # states up to which it is formed
_LEVELS = 40  # losses at which growth is looked for


@dataclass(frozen=True)
class LossMargin:
    """Largest probability of a loss with which perturbations die out in mean square.

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
    """x⁺ = (lost + Σ θ_i heard_i) x, the θ_i independent, 1 with the probability 1 − loss and else 0."""

    lost: FloatArray
    heard: tuple[FloatArray, ...]

    def radius(self, loss: float) -> float:
        """Return the spectral radius of E[A ⊗ A]."""
        from scipy.sparse.linalg import LinearOperator, eigs

        mean, size = self.lost + (1.0 - loss) * sum(self.heard), len(self.lost)
        variance = loss * (1.0 - loss)
        if size <= _DENSE:
            whole = np.kron(mean, mean) + variance * sum(np.kron(x, x) for x in self.heard)
            return float(np.abs(np.linalg.eigvals(whole)).max())

        def apply(flat: FloatArray) -> FloatArray:
            x = flat.reshape(size, size)
            return (mean @ x @ mean.T + variance * sum(part @ x @ part.T for part in self.heard)).ravel()

        operator = LinearOperator((size * size, size * size), matvec=apply, dtype=np.float64)
        values = eigs(operator, k=1, v0=np.eye(size).ravel(), return_eigenvectors=False, tol=1e-10)
        return float(np.abs(values).max())


@check_kinds
def loss_margin(flock: Linearisation, period: float, *, lost: str = "agent", on_loss: str = "zero") -> LossMargin:
    """Return the largest packet loss that a flock bears in mean square, sampled with a period.

    Losses are independent from sample to sample, and from agent to agent if these lose their inputs one by one.

    Parameters
    ----------
    flock : Linearisation
        From `linearise`, of at most 40 states.
    period : float
        Sampling period.
    lost : {"agent", "all"}
        What is lost at once: one agent's input, or those of all.
    on_loss : {"zero", "hold"}
        What acts instead: nothing, or the last input that was received.

    Raises
    ------
    ArgumentError
        On a flock with more states, or what is no such choice.

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
    from scipy.optimize import brentq

    period = ensure_positive("period", period)
    ensure_known("what is lost", lost, LOST)
    ensure_known("what acts on a loss", on_loss, ON_LOSS)
    step = _step(flock, period, lost, on_loss)
    if not len(step.lost):
        return LossMargin(1.0, 0.0)
    start = step.radius(0.0)
    if start >= 1.0:
        return LossMargin(0.0, start)
    before = 0.0
    for loss in (*np.linspace(0.0, 1.0, _LEVELS + 1)[1:-1].tolist(), 1.0 - 1e-6):
        if step.radius(loss) >= 1.0:
            return LossMargin(float(brentq(lambda x: step.radius(x) - 1.0, before, loss, xtol=1e-10)), start)
        before = loss
    return LossMargin(1.0, start)


def _step(flock: Linearisation, period: float, lost: str, on_loss: str) -> _Step:
    """Return the steps of the flock off its neutral motions; with held inputs these are states too."""
    off, (n, m) = flock.second_order.quotient, flock.q.shape
    size, basis, pace = n * m, off.basis, off.pace
    states = basis.shape[1] + (size if on_loss == "hold" else 0)
    if states > MOST:
        raise ArgumentError(f"the flock has {states} states: expected at most {MOST}; take fewer agents")
    one = np.eye(size)
    free = basis.T @ np.block([[one, pace * period * one], [0.0 * one, one]]) @ basis
    push = basis.T @ np.vstack([0.5 * pace * period**2 * one, period * one])
    groups = [range(size)] if lost == "all" else [range(k * m, (k + 1) * m) for k in range(n)]
    picks = [np.diag([float(k in group) for k in range(size)]) for group in groups]
    if on_loss == "zero":
        return _Step(free, tuple(push @ pick @ off.force for pick in picks))
    zero = np.zeros((size, len(free)))
    kept = np.block([[free, push], [zero, one]])
    new = (np.vstack([push, one]) @ pick @ np.hstack([off.force, -one]) for pick in picks)
    return _Step(kept, tuple(new))
