"""A law whose agents act on the past."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from flockana.base.checks import FloatArray, ensure_choice, real_array
from flockana.base.errors import ArgumentError, format_value
from flockana.base.units import Powers
from flockana.laws.law import Law
from flockana.laws.wrapped import Step, View, Wrapper, ensure_hears, ensure_wrappable, input_of

LATE = ("all", "pairs", "neighbours")


@dataclass(frozen=True)
class Delayed(Wrapper):
    """Agents act on what is `delay` old; before the start the flock moved with its initial velocities.

    Late is everything, an agent's own state and the γ-agent's included (``"all"``); or the terms between agents, their
    own state in them included (``"pairs"``); or what they hear of other agents, their own state being known at once
    (``"neighbours"``: then action is no longer reaction, and the centre of mass is pushed).

    Parameters
    ----------
    law : Law
        The law that acts late.
    delay : float or array_like, shape (n, n)
        τ >= 0; or, of ``"neighbours"``, how late agent i hears agent j.
    late : {"all", "pairs", "neighbours"}
        What is late, as in `flockana.stability.delay_system`.

    Raises
    ------
    ArgumentError
        On a delay below 0, or a law without a pair term if not everything is late.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> Delayed(Algorithm1(), 0.1, late="pairs").delay
    0.1
    """

    law: Law
    delay: Any
    late: str = "all"

    units: ClassVar[Mapping[str, Powers]] = {"delay": (0, 1)}

    def __post_init__(self) -> None:
        ensure_wrappable(self.law)
        ensure_choice("late", self.late, LATE)
        try:
            lag = real_array(self.delay)
        except (TypeError, ValueError):
            lag = np.array(np.nan)
        if lag.ndim not in (0, 2) or not lag.size or not (np.isfinite(lag) & (lag >= 0.0)).all():
            raise ArgumentError(
                f"delay = {format_value(self.delay)}: expected a number >= 0, or one for each pair, (n, n)"
            )
        if lag.ndim == 2 and self.late != "neighbours":
            raise ArgumentError('delay is one for each pair: expected late="neighbours"')
        if self.late != "all":
            ensure_hears(self.law)
        object.__setattr__(self, "delay", float(lag) if lag.ndim == 0 else tuple(map(tuple, lag.tolist())))

    @property
    def memory(self) -> float:  # noqa: D102
        return float(np.max(self.delay))

    @property
    def clocks(self) -> tuple[float, ...]:
        """The positive delay common to all agents, at whose multiples the solution has kinks; else empty."""
        return (self.delay,) if isinstance(self.delay, float) and self.delay > 0.0 else ()

    def check_agents(self, n: int) -> None:  # noqa: D102
        super().check_agents(n)
        if np.ndim(self.delay) == 2 and np.shape(self.delay) != (n, n):
            raise ArgumentError(f"delay has shape {np.shape(self.delay)}: expected ({n}, {n}), a delay for each pair")

    def input(self, step: Step, view: View) -> FloatArray:  # noqa: D102
        if isinstance(self.delay, float):
            q, p = step.past(view.t - self.delay)
            if self.late == "all":
                return input_of(self.law, step, View(view.t - self.delay, q, p))
            heard: tuple[FloatArray, FloatArray] = q[None], p[None]
        else:
            times = np.unique(self.delay)
            states = [step.past(view.t - float(lag)) for lag in times]
            which, own = np.searchsorted(times, self.delay), np.arange(len(view.q))
            heard = tuple(np.stack(parts)[which, own] for parts in zip(*states, strict=True))
        return input_of(self.law, step, view._replace(heard=heard, both=self.late == "pairs"))
