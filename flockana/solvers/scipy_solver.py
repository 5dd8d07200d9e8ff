"""Adapter of scipy's solvers for all laws, with the coefficients of its Runge-Kutta pairs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from flockana.base.value_checks import ensure_choice
from flockana.solvers.solver import AdaptivePair, FloatArray, Limits, Rate, Solver, open_scipy
from flockana.solvers.tableau import Tableau, shared_rows

KINDS = ("DOP853", "RK45", "RK23", "Radau", "BDF", "LSODA")
_WITH_A_PAST = ("BDF", "LSODA")


@dataclass(frozen=True)
class Scipy(Solver):
    """One of scipy's solvers, stepped in Python for every law.

    Parameters
    ----------
    kind : {"DOP853", "RK45", "RK23", "Radau", "BDF", "LSODA"}
        Name of scipy's class.

    Examples
    --------
    >>> Scipy("Radau").name, Scipy("RK45").name, Scipy("BDF").one_step
    ('Radau', 'scipy-RK45', False)
    """

    kind: str

    def __post_init__(self) -> None:
        ensure_choice("kind", self.kind, KINDS)

    @property
    def name(self) -> str:
        """Scipy's name of the method, with a prefix if flockana compiles a method of that name."""
        return self.kind if self.kind in ("Radau", "BDF", "LSODA") else f"scipy-{self.kind}"

    @property
    def one_step(self) -> bool:  # type: ignore[override]  # by kind
        """Whether the method is a one-step method, whose next step depends on the present state alone."""
        return self.kind not in _WITH_A_PAST

    def open(self, rate: Rate, t: float, y: FloatArray, f: FloatArray, limits: Limits) -> Any:  # noqa: D102
        import scipy.integrate

        return open_scipy(getattr(scipy.integrate, self.kind), rate, t, y, limits, one_step=self.one_step)


class ScipyPair(AdaptivePair):
    """Runge-Kutta pair with the coefficients of scipy's class of the same name."""

    in_scipy = True

    @cached_property
    def tableau(self) -> Tableau:
        """Coefficients of the Runge-Kutta pair, for compiled steps."""
        scipy_class = self.scipy_class
        stages = scipy_class.n_stages
        a = np.zeros((stages + 1, stages + 1))
        a[:stages, : scipy_class.A.shape[1]], a[stages, :stages] = scipy_class.A, scipy_class.B
        estimates, interpolant = scipy_class.E[None].copy(), scipy_class.P.copy()
        rows, exponent = shared_rows(a, estimates, interpolant), -1.0 / (scipy_class.error_estimator_order + 1)
        return Tableau(a, np.append(scipy_class.C, 1.0), estimates, interpolant, rows, stages, exponent)
