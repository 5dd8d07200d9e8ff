"""Wrapped laws in fixed steps, in the form stored in files."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_kind
from flockana.laws.wrapper_base import Wrapper
from flockana.solvers.euler_maruyama import EulerMaruyama
from flockana.solvers.fixed_steps import FixedSteps
from flockana.solvers.heun import Heun
from flockana.solvers.rk4 import RK4

_SOLVERS = {1: EulerMaruyama, 2: Heun, 4: RK4}


@dataclass(frozen=True)
class Stepped:
    """File form of `FixedSteps` of a wrapped law by order: 1 Euler-Maruyama, 2 Heun, 4 classical Runge-Kutta.

    Parameters
    ----------
    law : Wrapper
        A law that wraps one.
    dt : float
        Step.
    order : {1, 2, 4}
        Order.
    """

    law: Wrapper
    dt: float = 0.01
    order: int = 2

    def __new__(cls, law: Any, dt: float = 0.01, order: int = 2) -> Any:
        """Return the fixed-step map of a law, a `FixedSteps`."""
        ensure_kind("law", law, Wrapper, "a law that wraps one, such as Disturbed(law, ...)")
        if order not in _SOLVERS:
            raise ArgumentError(f"order = {order!r}: expected one of 1, 2, 4")
        return FixedSteps(law, _SOLVERS[order](dt))
