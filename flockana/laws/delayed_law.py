"""A law whose agents act on delayed states."""

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_choice, ensure_numbers, ensure_series
from flockana.laws.first_order_law import VelocityLaw, first_order
from flockana.laws.law import Law
from flockana.laws.wrapper_base import Step, View, Wrapper, ensure_hears, input_of

LATE = ("all", "pairs", "neighbours")
_ROUNDED = 1e-9  # relative: a history that is as long as the delay but for rounding is as long


@dataclass(frozen=True)
class Delayed(Wrapper):
    """Law on states that are `delay` old; before the start, `history` or uniform motion.

    Without a history, agents under a law of first order rested before the start.

    Late is everything, an agent's own state and the γ-agent's included (``"all"``); or the terms between agents, their
    own state in them included (``"pairs"``); or what they hear of other agents, their own state being known at once
    (``"neighbours"``: then action is no longer reaction, and the centre of mass is pushed; of a law without pair terms
    the input of each agent is evaluated by itself).

    Parameters
    ----------
    delay : float or array_like, shape (n, n)
        τ >= 0; or, of ``"neighbours"``, how late agent i hears agent j.
    late : {"all", "pairs", "neighbours"}
        What is late, as in `flockana.stability.delay_system`.
    history_t, history_q : array_like, shapes (K,) and (K, n, m)
        Rising times before the start of the run, all below 0, and the positions then; velocities are those of the cubic
        spline through them and the start.

    Raises
    ------
    ArgumentError
        On a delay below 0 or longer than the history, or a law without a pair term of which pairs are late.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> Delayed(Algorithm1(), 0.1, late="pairs").delay
    0.1
    """

    law: Law | VelocityLaw
    delay: Any
    late: str = "all"
    _: KW_ONLY
    history_t: Any = None
    history_q: Any = None

    takes_first_order = True
    units: ClassVar[Mapping[str, Powers]] = {"delay": (0, 1), "history_t": (0, 1), "history_q": (1, 0)}

    def __post_init__(self) -> None:
        super().__post_init__()
        ensure_choice("late", self.late, LATE)
        expectation = "a number >= 0, or one for each pair, (n, n)"
        lag = ensure_numbers("delay", self.delay, expectation)
        if lag.ndim not in (0, 2) or not lag.size or not (np.isfinite(lag) & (lag >= 0.0)).all():
            raise ArgumentError(f"delay = {format_value(self.delay)}: expected {expectation}")
        if lag.ndim == 2 and self.late != "neighbours":
            raise ArgumentError('delay is one for each pair: expected late="neighbours"')
        if self.late == "pairs" or (self.late != "all" and first_order(self.law) is not None):
            ensure_hears(self.law)
        object.__setattr__(self, "delay", float(lag) if lag.ndim == 0 else tuple(map(tuple, lag.tolist())))
        if self.history_t is not None or self.history_q is not None:
            self._check_history()

    def _check_history(self) -> None:
        """Raise unless the history is valid and covers the delay; store it as tuples."""
        t = ensure_series("history_t", self.history_t)
        expectation = f"finite positions ({len(t)}, n, m), one row for each time"
        q = ensure_numbers("history_q", self.history_q, expectation)
        if q.ndim != 3 or len(q) != len(t) or not np.isfinite(q).all():
            raise ArgumentError(f"history_q has shape {q.shape}: expected {expectation}")
        if not (np.diff(t) > 0.0).all() or t[-1] >= 0.0:
            raise ArgumentError(f"history_t = {format_value(self.history_t)}: expected rising times below 0, the start")
        object.__setattr__(self, "history_t", tuple(t.tolist()))
        object.__setattr__(self, "history_q", tuple(tuple(map(tuple, row)) for row in q.tolist()))
        self._ensure_remembered(self.memory)

    def _ensure_remembered(self, longest: float) -> None:
        """Raise if a delay, or the sum of nested delays, is longer than the given history."""
        if self.history_t is not None and longest > -self.history_t[0] * (1.0 + _ROUNDED):
            raise ArgumentError(
                f"delay = {longest:g}: the history given goes back {-self.history_t[0]:g}, expected one as long as the "
                "delay, or none (before the start the flock then moved with its initial velocities)"
            )

    def _past(self, back: FloatArray, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return positions, velocities and accelerations, (K, n, m), at times before the start."""
        if self.history_t is None:
            zero_array = np.zeros((len(back), *q.shape))
            return q + back[:, None, None] * p, zero_array + p, zero_array
        from scipy.interpolate import CubicSpline

        t, positions = np.append(self.history_t, 0.0), np.append(self.history_q, q[None], axis=0)
        end: Any = (1, p) if first_order(self.law) is None else "not-a-knot"  # whose velocity may jump at the start
        path: Any = CubicSpline(t, positions, bc_type=((2, np.zeros_like(q)), end))
        at = np.maximum(back, t[0])
        return path(at), path(at, 1), path(at, 2)

    @property
    def memory(self) -> float:  # noqa: D102
        return float(np.max(self.delay))

    @property
    def clocks(self) -> tuple[float, ...]:
        """Positive delay common to all agents, the interval of the solution's kinks; else empty."""
        return (self.delay,) if isinstance(self.delay, float) and self.delay > 0.0 else ()

    def check_dimension(self, m: int) -> None:  # noqa: D102
        super().check_dimension(m)
        if self.history_q is not None and np.shape(self.history_q)[2] != m:
            raise ArgumentError(
                f"history_q has shape {np.shape(self.history_q)}: expected {m} components, as agents have"
            )

    def check_agents(self, n: int) -> None:  # noqa: D102
        super().check_agents(n)
        if self.history_q is not None and np.shape(self.history_q)[1] != n:
            raise ArgumentError(f"history_q has shape {np.shape(self.history_q)}: expected positions of {n} agents")
        if np.ndim(self.delay) == 2 and np.shape(self.delay) != (n, n):
            raise ArgumentError(f"delay has shape {np.shape(self.delay)}: expected ({n}, {n}), a delay for each pair")

    def input(self, step: Step, view: View) -> FloatArray:  # noqa: D102
        if isinstance(self.delay, float):
            q, p = step.past(view.t - self.delay) if self.delay else (view.q, view.p)
            if self.late == "all":
                return input_of(self.law, step, View(view.t - self.delay, q, p))
            heard_states: tuple[FloatArray, FloatArray] = q[None], p[None]
        else:
            times = np.unique(self.delay)
            states = [step.past(view.t - float(lag)) if lag else (view.q, view.p) for lag in times]
            delay_indices, own_delay = np.searchsorted(times, self.delay), np.arange(len(view.q))
            heard_states = tuple(np.stack(parts)[delay_indices, own_delay] for parts in zip(*states, strict=True))
        return input_of(self.law, step, view._replace(heard=heard_states, both=self.late == "pairs"))
