"""Past of a law in fixed steps: stored states, with Hermite interpolation between them."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import ceil
from typing import Any

from flockana.base.value_checks import FloatArray

Row = tuple[FloatArray, FloatArray, FloatArray, FloatArray]  # q, p, input that arrives there, input that departs
_WHOLE = 1e-9  # of a step: so near a step it is that step


@dataclass
class Past:
    """States of the last steps of length h, the present one last."""

    rows: deque[Any]
    h: float

    def begin(self, u: FloatArray, *, first: bool) -> None:
        """Store the input after the present state, and, except at the first step, also as that before."""
        q, p, arrival_input, _ = self.rows.pop()
        self.rows.append((q, p, arrival_input if first else u, u))

    def seen_at(self, t: float) -> Callable[[float], tuple[FloatArray, FloatArray]]:
        """Return the function that gives (q, p) at an earlier time, with present time t."""
        return partial(self._state, t)

    def _state(self, t: float, s: float) -> tuple[FloatArray, FloatArray]:
        steps_back, last_index = (t - s) / self.h, len(self.rows) - 1
        k = min(last_index, max(0, ceil(steps_back - _WHOLE)))
        share = k - steps_back  # of the interval that begins k steps ago
        q0, p0, _, u0 = self.rows[last_index - k]
        if abs(share) <= _WHOLE or k == 0:
            return q0, p0
        q1, p1, u1, _ = self.rows[last_index - k + 1]
        return _hermite(q0, p0, q1, p1, share, self.h), _hermite(p0, u0, p1, u1, share, self.h)


def _hermite(x0: Any, v0: Any, x1: Any, v1: Any, share: float, h: float) -> FloatArray:
    a, b = share * share * (3.0 - 2.0 * share), share * (1.0 - share)
    return x0 + a * (x1 - x0) + h * b * ((1.0 - share) * v0 - share * v1)
