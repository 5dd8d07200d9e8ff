"""A law whose input is computed at sampling instants and held between them."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_numbers, ensure_positive, normalise
from flockana.laws.first_order_law import VelocityLaw
from flockana.laws.law import Law
from flockana.laws.wrapper_base import Step, View, Wrapper, input_of


@dataclass(frozen=True)
class Sampled(Wrapper):
    """Zero-order hold: agents compute their input every `period` and keep it until the next time.

    Without disturbance, noise and delay, and with one clock, that is the map `TaylorStep(law, period)`; of a law of
    first order q + period · velocity.

    Parameters
    ----------
    period : float
        Time between two samples.
    offsets : array_like, shape (n,), optional
        How long after the start each agent samples first, 0 <= offset < period; until then it has no input. By default
        all at once.

    Raises
    ------
    ArgumentError
        If the period is not positive, or an offset is not within it.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> Sampled(Algorithm1(), 0.1, offsets=(0.0, 0.05)).clocks
    (0.1, 0.05)
    """

    law: Law | VelocityLaw
    period: float
    offsets: Any = None

    takes_first_order = True
    units: ClassVar[Mapping[str, Powers]] = {"period": (0, 1), "offsets": (0, 1)}

    def __post_init__(self) -> None:
        super().__post_init__()
        normalise(self, ensure_positive, "period")
        if self.offsets is None:
            return
        expectation = f"one for each agent, 0 <= offset < {self.period:g}"
        offsets = ensure_numbers("offsets", self.offsets, expectation)
        if offsets.ndim != 1 or not offsets.size or not ((offsets >= 0.0) & (offsets < self.period)).all():
            raise ArgumentError(f"offsets = {format_value(self.offsets)}: expected {expectation}")
        object.__setattr__(self, "offsets", tuple(offsets.tolist()))

    @property
    def clocks(self) -> tuple[float, ...]:  # noqa: D102
        return (self.period, *sorted({x for x in self.offsets or () if x > 0.0}))

    def check_agents(self, n: int) -> None:  # noqa: D102
        super().check_agents(n)
        if self.offsets is not None and len(self.offsets) != n:
            raise ArgumentError(f"there are {len(self.offsets)} offsets and {n} agents: expected one each")

    def input(self, step: Step, view: View) -> FloatArray:  # noqa: D102
        key = sum(1 for _ in self.wrappers)  # its place among the wrappers, from within
        if not step.begins:
            return step.held[key]
        stride = round(self.period / step.h)
        first_steps = 0 if self.offsets is None else np.rint(np.array(self.offsets) / step.h)
        is_due = np.broadcast_to((step.number - first_steps) % stride == 0, len(view.q))
        if is_due.any() or key not in step.held:
            previous_interval, step.interval = step.interval, self.period
            u = input_of(self.law, step, view)
            step.interval = previous_interval
            step.held[key] = np.where(is_due[:, None], u, step.held.get(key, np.zeros_like(u)))
        return step.held[key]
