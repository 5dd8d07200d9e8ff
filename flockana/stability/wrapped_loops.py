"""Linear feedback of a wrapped law: immediate part, delayed parts, and hold period."""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.laws import Delayed, Disturbed, Law, Lossy, Measured, PairTerm, Sampled, Saturated
from flockana.laws.wrapper_base import Step, View, Wrapper, WrappingLaw, input_of
from flockana.stability.delay import late_part
from flockana.stability.delay_roots import LatePart

State = tuple[float, FloatArray, FloatArray]
_LOOPS = (Delayed, Sampled, Measured)


class _Heard(NamedTuple):
    """Delays with which neighbours are heard, common or per pair, and whether own states are delayed too."""

    delay: Any
    both: bool


def instant_law(law: Law) -> Law:
    """Return a law without its delays, holds, noise and losses, which has the same rest states."""
    if not isinstance(law, Wrapper):
        return law
    inner_law = instant_law(law.law)
    if isinstance(law, Disturbed):
        is_pushed = law.force is not None or law.swing is not None or law.times is not None
        return replace(law, law=inner_law, intensity=0.0) if is_pushed else inner_law
    if isinstance(law, Lossy):
        return _MeanLoss(inner_law, law.loss)
    if isinstance(law, _LOOPS):
        return inner_law
    if law.stepped:
        raise ArgumentError(
            f"{type(law).__name__} has no input at an instant: expected Delayed, Sampled, Measured, Lossy, Disturbed "
            "or Saturated around a law, or a map that steps it"
        )
    wrapped_law: Any = law  # a dataclass, as every wrapper is
    return law if inner_law is law.law else replace(wrapped_law, law=inner_law)


@dataclass(frozen=True)
class _MeanLoss(WrappingLaw):
    """Law with mean message loss: pair terms scaled by the share of received messages."""

    law: Law
    loss: float

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        lone_view = View(t, q, p, linked=np.zeros((len(q),) * 2, dtype=bool))
        input_kept = input_of(self.law, Step(0, 1.0, lambda _: (q, p)), lone_view)
        return (1.0 - self.loss) * self.law.flow(t, q, p)[0] + self.loss * input_kept, float("nan")


def hold_of(law: Law) -> Sampled | None:
    """Return the zero-order hold among the wrappers of a law; None without one."""
    holds = [wrapper for wrapper in law.wrappers if isinstance(wrapper, Sampled)] if isinstance(law, Wrapper) else []
    if len(holds) > 1:
        raise ArgumentError(f"the law has {len(holds)} holds, Sampled within Sampled: expected one")
    return holds[0] if holds else None


def is_late(law: Law) -> bool:
    """Return whether a wrapped law has a positive delay."""
    wrappers = law.wrappers if isinstance(law, Wrapper) else ()
    return any(isinstance(wrapper, Delayed) and wrapper.memory > 0.0 for wrapper in wrappers)


def late_parts(law: Law, state: State) -> list[LatePart]:
    """Return the delayed parts of K and D of a wrapped law at a steady state (t, q, p), by rising delay.

    As in a run, what is heard enters the pair terms. Of lost messages the mean remains: these terms, times the share
    that arrives.
    """
    from scipy.linalg import block_diag

    core = law.core if isinstance(law, Wrapper) else law
    slopes: Any = core.derivatives(*state)
    by_position, by_velocity = (-part.toarray() for part in slopes)
    parts: dict[float, LatePart] = {}

    def add(delay: float, stiffness: FloatArray, damping: FloatArray) -> None:
        _, k, d = parts.get(delay, LatePart(delay, np.zeros_like(stiffness), np.zeros_like(damping)))
        parts[delay] = LatePart(delay, k + stiffness, d + damping)

    share, slope_matrix, shift, heard = 1.0, np.eye(state[1].size), 0.0, None
    for item in law.wrappers if isinstance(law, Wrapper) else ():
        if isinstance(item, Lossy):
            share *= 1.0 - item.loss
        elif isinstance(item, Saturated):
            slope_matrix = slope_matrix @ block_diag(*item.slopes(instant_law(item.law).flow(*state)[0]))
        elif isinstance(item, Delayed) and item.late == "all":
            shift, heard = shift + float(item.delay), None
        elif isinstance(item, Delayed):
            heard = _Heard(shift + np.asarray(item.delay), item.late == "pairs")
    m = state[1].shape[1]
    pairs = _pair_terms(core, state)
    add(shift, slope_matrix @ (by_position - pairs[0]), slope_matrix @ (by_velocity - pairs[1]))
    pairs = [share * slope_matrix @ part for part in pairs]
    if heard is None:
        add(shift, *pairs)
    elif heard.both:
        add(float(heard.delay), *pairs)
    else:
        _ensure_at_rest(state[2], heard)
        late_matrices = [late_part(part, m, "neighbours") for part in pairs]
        add(shift, pairs[0] - late_matrices[0], pairs[1] - late_matrices[1])
        lags = np.broadcast_to(heard.delay, (len(state[1]),) * 2)
        lags = np.kron(lags, np.ones((m, m)))
        for delay in np.unique(lags).tolist():
            add(delay, *(np.where(lags == delay, part, 0.0) for part in late_matrices))
    used_parts = [part for part in parts.values() if part.stiffness.any() or part.damping.any() or part.delay == 0.0]
    return sorted(used_parts, key=lambda part: part.delay)


def _pair_terms(core: Law, state: State) -> list[FloatArray]:
    """Return K and D of the pair terms of a law; of all terms for other laws."""
    if not any(isinstance(term, PairTerm) for term in core.terms):
        full_blocks: Any = core.derivatives(*state)
        return [-block.toarray() for block in full_blocks]
    dimension = state[1].size
    total = [np.zeros((dimension, dimension)), np.zeros((dimension, dimension))]
    for term in core.terms:
        if isinstance(term, PairTerm):
            slopes: Any = term.derivatives(*state)
            total = [block - slope.toarray() for block, slope in zip(total, slopes, strict=True)]
    return total


def _ensure_at_rest(p: FloatArray, heard: _Heard) -> None:
    """Raise if agents move while they hear delayed positions, as that is no rest of the law."""
    if np.any(p != 0.0) and np.any(np.asarray(heard.delay) > 0.0):
        raise ArgumentError(
            "agents that move hear where their neighbours were, which is no rest of the law: expected p = 0, or "
            'late="pairs" or "all", in which all of a pair is late'
        )
