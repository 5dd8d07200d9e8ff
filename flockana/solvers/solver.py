"""Interface of solvers: frozen objects for `simulate(..., method=)`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.solvers.tableau import Tableau, tableau_of_pair

FloatArray = npt.NDArray[np.float64]
Rate = Callable[[float, FloatArray], FloatArray]
Rows = Sequence[Sequence[float]]


class Limits(NamedTuple):
    """Limits of an interpreted run: end time, tolerances, longest step, and optional first step."""

    until: float
    rtol: float
    atol: FloatArray
    longest: float
    first: float | None


@dataclass(frozen=True)
class Solver(ABC):
    """Integration method of a law.

    Attributes
    ----------
    order : int
        Order of its steps.
    dt : float or None
        Step of a method of fixed steps.
    one_step : bool
        Whether the next step hangs on the state alone, and not on earlier steps.
    takes_noise : bool
        Whether it can step a law that draws random numbers.
    """

    order: ClassVar[int]
    one_step: ClassVar[bool] = True
    takes_noise: ClassVar[bool] = False
    dt: ClassVar[float | None] = None

    @property
    def name(self) -> str:
        """Name of the solver for `simulate(..., method=)`."""
        return type(self).__name__

    @property
    def tableau(self) -> Tableau | None:
        """Coefficients of the method for compiled steps; None for solvers that run in Python only."""
        return None

    @abstractmethod
    def open(self, rate: Rate, t: float, y: FloatArray, f: FloatArray, limits: Limits) -> Any:
        """Return an interpreted stepper with the interface of `scipy.integrate.OdeSolver`.

        Parameters
        ----------
        rate : callable
            Right-hand side, (t, y) -> dy/dt.
        t, y, f
            Time, state, and its rate.
        limits : Limits
            Where it ends, and what its steps are bounded by.
        """


class AdaptivePair(Solver):
    """Explicit Runge-Kutta pair with step length controlled by its error estimate.

    A subclass gives coefficients. Stage s is the rate at y + h Σ_j a_sj K_j and t + h Σ_j a_sj, the step ends at
    y + h Σ_j b_j K_j, and h Σ_j error_j K_j estimates its error, the last K being the rate at the end.

    Attributes
    ----------
    a, b : sequences of floats
        Weights of the stages, a row each, and of the step.
    error : sequence of floats
        Weights of the error estimate, one more than there are stages.
    error_order : int
        Order of the estimate.
    interpolant : sequence of sequences, optional
        P in y(θ) = y + h Σ_jk P_jk θᵏ⁺¹ K_j; by default the cubic through both ends and their rates.
    in_scipy : bool
        Whether its coefficients are those of scipy's class of this name.
    """

    a: ClassVar[Rows]
    b: ClassVar[Sequence[float]]
    error: ClassVar[Sequence[float]]
    error_order: ClassVar[int]
    interpolant: ClassVar[Rows | None] = None
    in_scipy: ClassVar[bool] = False

    @cached_property
    def tableau(self) -> Tableau:
        """Coefficients of the Runge-Kutta pair, for compiled steps."""
        return tableau_of_pair(self.a, self.b, self.error, self.error_order, self.interpolant)

    @property
    def scipy_class(self) -> Any:
        """Solver class of scipy that makes the same steps as the pair, in Python."""
        import scipy.integrate

        if self.in_scipy:
            return getattr(scipy.integrate, self.name)
        tableau, stages = self.tableau, self.tableau.stages
        facts = {"order": self.order, "error_estimator_order": self.error_order, "n_stages": stages}
        arrays = {"A": tableau.a[:stages, :stages], "B": tableau.a[stages, :stages], "C": tableau.c[:stages]}
        arrays |= {"E": tableau.estimates[0], "P": tableau.interpolant}
        return type(self.name, (scipy.integrate.RK45,), facts | arrays)

    def open(self, rate: Rate, t: float, y: FloatArray, f: FloatArray, limits: Limits) -> Any:  # noqa: D102
        return open_scipy(self.scipy_class, rate, t, y, limits, one_step=True)


def open_scipy(kind: Any, rate: Rate, t: float, y: FloatArray, limits: Limits, *, one_step: bool) -> Any:
    """Return one of scipy's steppers, with a given first step for one-step methods."""
    options: dict[str, Any] = {"rtol": limits.rtol, "atol": limits.atol, "max_step": limits.longest}
    if limits.first is not None and one_step:
        options["first_step"] = min(limits.first, limits.until - t, limits.longest)
    return kind(rate, t, y, limits.until, **options)
