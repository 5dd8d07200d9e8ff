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

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ComplexArray, FloatArray
from flockana.laws import Sampled
from flockana.stability.delay import kernels
from flockana.stability.delay_roots import LatePart
from flockana.stability.linear_flock import LinearFlock
from flockana.stability.map_linearisation import MapLinearisation
from flockana.stability.signal_names import labels
from flockana.stability.zero_modes import ZERO, complement

MOST = 3000  # states of a lifted map
_WHOLE = 1e-9  # of a period: a delay so short is none


def period_map(parts: Sequence[LatePart], period: float, clock: FloatArray) -> FloatArray:
    """Return the one-period map of q'' = u under delayed feedback that is sampled and held.

    Its state is (q, p, u, earlier u …) just after the last sample of a period, shape (N (2 + inputs),) twice.
    `clock` has when each coordinate is sampled, after the beginning of the period.
    """
    longest, events = max(delay_term.delay for delay_term in parts), np.unique(clock)
    event_count, past_periods = len(events), int(np.ceil(longest / period)) + 2
    times = np.concatenate([events + k * period for k in range(-past_periods, 1)])
    now = range(len(times) - event_count, len(times))
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
    """Return the matrix from one sample's state to the next sample's; `due` coordinates are sampled there.

    The inputs of the state began `ages` before the next sample.
    """
    due_count, inputs = len(due), len(ages)
    identity, full_matrix = np.eye(due_count), np.zeros((due_count * (2 + inputs),) * 2)
    first_age, starts = ages[0], np.concatenate([[0.0], ages])

    def forward(row: FloatArray) -> Any:
        """Return the block row of coefficients of q, p and the inputs, each times the identity matrix."""
        return np.kron(row, identity)

    q = forward(np.array([[1.0, first_age, 0.5 * first_age**2, *np.zeros(inputs - 1)]]))
    p = forward(np.array([[0.0, 1.0, first_age, *np.zeros(inputs - 1)]]))
    input_rows = np.zeros((due_count, len(full_matrix)))
    for delay, k, d in parts:
        edge = np.minimum(starts, delay if delay > _WHOLE * period else 0.0)
        far = 0.5 * ((delay - edge[:-1]) ** 2 - (delay - edge[1:]) ** 2)  # ∫ (τ − s) ds over each input's time
        delayed_positions = q - delay * p + forward(np.array([[0.0, 0.0, *far]]))
        back_p = p - forward(np.array([[0.0, 0.0, *np.diff(edge)]]))
        input_rows -= k @ delayed_positions + d @ back_p
    held_rows = np.eye(due_count, len(full_matrix), 2 * due_count)
    full_matrix[:due_count], full_matrix[due_count : 2 * due_count] = q, p
    full_matrix[2 * due_count : 3 * due_count] = np.where(due[:, None], input_rows, held_rows)
    full_matrix[3 * due_count :, 2 * due_count : -due_count] = np.eye(due_count * (inputs - 1))
    return full_matrix


def moving_multipliers(parts: Sequence[LatePart], period: float, clock: FloatArray, neutral: int) -> ComplexArray:
    """Return the multipliers of the one-period map off the neutral motions, the largest first."""
    period_matrix = period_map(parts, period, clock)
    moving_basis = _motions(parts, len(period_matrix))
    values: ComplexArray = np.linalg.eigvals(moving_basis.T @ period_matrix @ moving_basis).astype(np.complex128)
    left = neutral - (len(period_matrix) - moving_basis.shape[1])
    if left > 0:  # drifts with a deformation: what is left at 1
        values = np.delete(values, np.argsort(np.abs(values - 1.0), kind="stable")[:left])
    return values[np.lexsort((values.imag, -np.abs(values)))]


def _motions(parts: Sequence[LatePart], states: int) -> FloatArray:
    """Return an orthonormal basis of the complement of the neutral motions, resting or drifting."""
    stiffness, damping = (np.sum(item, axis=0) for item in zip(*(delay_term[1:] for delay_term in parts), strict=True))
    delayed_sum = np.sum([delay_term.delay * delay_term.stiffness for delay_term in parts], axis=0)
    kernel = kernels(stiffness)[0]
    if not kernel.shape[1]:
        return np.eye(states)
    drag = (damping - delayed_sum) @ kernel
    _, singular_values, rows = np.linalg.svd(drag, full_matrices=False)
    scale = float(np.abs(damping).max()) or 1.0
    drift = kernel @ rows[singular_values <= ZERO * scale].T
    rest_states, moving = np.zeros((states, kernel.shape[1])), np.zeros((states, drift.shape[1]))
    rest_states[: len(kernel)], moving[len(kernel) : 2 * len(kernel)] = kernel, drift
    return complement(np.hstack([rest_states, moving]))


def first_growth(radius: Callable[[float], float], trials: FloatArray) -> float:
    """Return the least argument at which a spectral radius exceeds 1; infinity without one among the trials."""
    from scipy.optimize import brentq

    last_trial = None
    for trial in trials.tolist():
        growth = radius(trial) - 1.0
        if growth > 0.0:
            if last_trial is None:
                return 0.0
            return float(brentq(lambda x: radius(x) - 1.0, last_trial, trial, xtol=1e-13 * trial, rtol=1e-12))
        last_trial = trial
    return inf


def lifted_map(law: Any, flow: LinearFlock, parts: Sequence[LatePart], hold: Sampled) -> MapLinearisation:
    """Return the one-period linearisation of a sampled law with delays, or with individual clocks."""
    (n, m), dimension = flow.q.shape, flow.q.size
    clock = np.repeat(np.zeros(n) if hold.offsets is None else np.array(hold.offsets), m)
    period_matrix = period_map(parts, hold.period, clock)
    kick = np.zeros((len(period_matrix), dimension))
    kick[dimension : 2 * dimension] = np.eye(dimension)
    past_count = len(period_matrix) // dimension - 2
    names = [*labels("q", n, m), *labels("p", n, m)]
    names += [name + (f"@-{k}" if k else "") for k in range(past_count) for name in labels("u", n, m)]
    inputs = tuple(labels("dp", n, m))  # a jump of velocities just after the last sample
    b = period_matrix @ kick
    return MapLinearisation(
        law, flow.q, flow.p, flow.t, flow.residual, period_matrix, b, tuple(names), inputs, None, step=hold.period
    )
