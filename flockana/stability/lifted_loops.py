"""Sampled loops with delays and individual clocks, as maps over one period (lifting).

Under a held input the state a delay ago is a linear function of the present one and of the inputs since, exactly: with
these as further states one period is a matrix. Its neutral motions are known beforehand and divided out before its
eigenvalues are computed.
"""

from collections.abc import Callable, Sequence
from functools import reduce
from math import inf
from typing import Any

import numpy as np

from flockana.base.checks import ComplexArray, FloatArray
from flockana.base.errors import ArgumentError
from flockana.laws import Sampled
from flockana.stability.delay import kernels
from flockana.stability.delay_roots import LatePart
from flockana.stability.linear_flock import LinearFlock
from flockana.stability.map_linearisation import MapLinearisation
from flockana.stability.signals import labels
from flockana.stability.zero_modes import ZERO, complement

MOST = 3000  # states of a lifted map
_WHOLE = 1e-9  # of a period: a delay so short is none


def period_map(parts: Sequence[LatePart], period: float, clock: FloatArray) -> FloatArray:
    """Return one period of q'' = u, u held, u = −Σ (K_k q(t − τ_k) + D_k q'(t − τ_k)) at each sample.

    Its state is (q, p, u, earlier u …) just after the last sample of a period, shape (N (2 + inputs),) twice.
    `clock` has when each coordinate is sampled, after the beginning of the period.
    """
    longest, events = max(part.delay for part in parts), np.unique(clock)
    each, behind = len(events), int(np.ceil(longest / period)) + 2
    times = np.concatenate([events + k * period for k in range(-behind, 1)])
    now = range(len(times) - each, len(times))
    inputs = max(int(np.sum((times < times[j]) & (times > times[j] - longest - 2.0 * period))) for j in now)
    size = len(clock) * (2 + inputs)
    if size > MOST:
        raise ArgumentError(
            f"the lifted map has {size} states: expected at most {MOST}; a period so short beside the delay is nearly "
            "none: ask without it"
        )
    steps: Any = (_event(parts, times[j] - times[j - 1 :: -1][:inputs], clock == times[j], period) for j in now)
    return reduce(lambda before, step: step @ before, steps)


def _event(parts: Sequence[LatePart], ages: FloatArray, due: Any, period: float) -> FloatArray:
    """Return the matrix from one sample's state to the next one's; `due` coordinates are sampled.

    The inputs of the state began `ages` before the next sample.
    """
    size, inputs = len(due), len(ages)
    one, whole = np.eye(size), np.zeros((size * (2 + inputs),) * 2)
    since, starts = ages[0], np.concatenate([[0.0], ages])

    def forward(row: FloatArray) -> Any:
        """Return rows of the next sample's q, p and inputs, from weighted inputs."""
        return np.kron(row, one)

    q = forward(np.array([[1.0, since, 0.5 * since**2, *np.zeros(inputs - 1)]]))
    p = forward(np.array([[0.0, 1.0, since, *np.zeros(inputs - 1)]]))
    heard = np.zeros((size, len(whole)))
    for delay, k, d in parts:
        edge = np.minimum(starts, delay if delay > _WHOLE * period else 0.0)
        far = 0.5 * ((delay - edge[:-1]) ** 2 - (delay - edge[1:]) ** 2)  # ∫ (τ − s) ds over each input's time
        back_q = q - delay * p + forward(np.array([[0.0, 0.0, *far]]))
        back_p = p - forward(np.array([[0.0, 0.0, *np.diff(edge)]]))
        heard -= k @ back_q + d @ back_p
    held_rows = np.eye(size, len(whole), 2 * size)
    whole[:size], whole[size : 2 * size] = q, p
    whole[2 * size : 3 * size] = np.where(due[:, None], heard, held_rows)
    whole[3 * size :, 2 * size : -size] = np.eye(size * (inputs - 1))
    return whole


def moving_multipliers(parts: Sequence[LatePart], period: float, clock: FloatArray, neutral: int) -> ComplexArray:
    """Return the multipliers of `period_map` off the neutral motions, the largest first."""
    whole = period_map(parts, period, clock)
    rest = _motions(parts, len(whole))
    values: ComplexArray = np.linalg.eigvals(rest.T @ whole @ rest).astype(np.complex128)
    left = neutral - (len(whole) - rest.shape[1])
    if left > 0:  # drifts with a deformation: what is left at 1
        values = np.delete(values, np.argsort(np.abs(values - 1.0), kind="stable")[:left])
    return values[np.lexsort((values.imag, -np.abs(values)))]


def _motions(parts: Sequence[LatePart], states: int) -> FloatArray:
    """Return an orthonormal basis of the complement of the neutral motions, resting or drifting."""
    stiffness, damping = (np.sum(each, axis=0) for each in zip(*(part[1:] for part in parts), strict=True))
    late = np.sum([part.delay * part.stiffness for part in parts], axis=0)
    kernel = kernels(stiffness)[0]
    if not kernel.shape[1]:
        return np.eye(states)
    drag = (damping - late) @ kernel
    _, sizes, rows = np.linalg.svd(drag, full_matrices=False)
    scale = float(np.abs(damping).max()) or 1.0
    drift = kernel @ rows[sizes <= ZERO * scale].T
    still, moving = np.zeros((states, kernel.shape[1])), np.zeros((states, drift.shape[1]))
    still[: len(kernel)], moving[len(kernel) : 2 * len(kernel)] = kernel, drift
    return complement(np.hstack([still, moving]))


def first_growth(radius: Callable[[float], float], trials: FloatArray) -> float:
    """Return the least argument at which a radius exceeds 1, by trials and halving; infinity without one."""
    from scipy.optimize import brentq

    before = None
    for trial in trials.tolist():
        growth = radius(trial) - 1.0
        if growth > 0.0:
            if before is None:
                return 0.0
            return float(brentq(lambda x: radius(x) - 1.0, before, trial, xtol=1e-13 * trial, rtol=1e-12))
        before = trial
    return inf


def lifted_map(law: Any, flow: LinearFlock, parts: Sequence[LatePart], hold: Sampled) -> MapLinearisation:
    """Return the one-period linearisation of a sampled law with delays, or with individual clocks."""
    (n, m), size = flow.q.shape, flow.q.size
    clock = np.repeat(np.zeros(n) if hold.offsets is None else np.array(hold.offsets), m)
    whole = period_map(parts, hold.period, clock)
    kick = np.zeros((len(whole), size))
    kick[size : 2 * size] = np.eye(size)
    past = len(whole) // size - 2
    names = [*labels("q", n, m), *labels("p", n, m)]
    names += [name + (f"@-{k}" if k else "") for k in range(past) for name in labels("u", n, m)]
    inputs = tuple(labels("dp", n, m))  # a jump of velocities just after the last sample
    b = whole @ kick
    return MapLinearisation(
        law, flow.q, flow.p, flow.t, flow.residual, whole, b, tuple(names), inputs, None, step=hold.period
    )
