"""What a law of motion is: a continuous feedback u(t, q, p) for q' = p, p' = u, or a map from step to step."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

from flockana.checks import FloatArray, ensure_finite_scalar, ensure_state
from flockana.errors import ArgumentError


class Law(ABC):
    """A continuous law; a subclass is a frozen dataclass with `flow` and, if it has an energy, `hamiltonian`.

    `flow` and `hamiltonian` are the unchecked inner loop of the integrators; `acceleration`, `energy` and
    `energy_rate` are the validated public face of the same functions.
    """

    references: ClassVar[tuple[str, ...]] = ()

    @abstractmethod
    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """Acceleration u of shape (n, m) and dH/dt in closed form (NaN for a law without energy), unchecked.

        Parameters
        ----------
        t : float
            Time.
        q, p : ndarray, shape (n, m)
            Finite positions and velocities.
        """

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:
        """The energy whose rate `flow` returns, unchecked; NaN for a law without one.

        Parameters
        ----------
        t : float
            Time.
        q, p : ndarray, shape (n, m)
            Finite positions and velocities.
        """
        return float("nan")

    def check_dimension(self, m: int) -> None:  # noqa: B027  # nothing to check unless a subclass says so
        """Raise if the law does not live in m dimensions; a law with vectors in its parameters overrides this.

        Parameters
        ----------
        m : int
            Dimension of the flock.
        """

    def check_start(self, q: FloatArray, p: FloatArray) -> None:  # noqa: B027  # as `check_dimension`
        """Raise if the law must not be started from this state; `simulate` asks before it integrates.

        Parameters
        ----------
        q, p : ndarray, shape (n, m)
            Initial positions and velocities.
        """

    def _checked(self, t: Any, q: Any, p: Any) -> tuple[float, FloatArray, FloatArray]:
        q, p = ensure_state(q, p)
        self.check_dimension(q.shape[1])
        return ensure_finite_scalar("t", t), q, p

    def acceleration(self, t: float, q: Any, p: Any) -> FloatArray:
        """Control input u(t, q, p).

        Parameters
        ----------
        t : float
            Time.
        q, p : array_like, shape (n, m)
            Positions and velocities, m = 1, 2 or 3.

        Returns
        -------
        ndarray, shape (n, m)

        Raises
        ------
        ArgumentError
            On wrong shapes, or values that are not finite.
        """
        return self.flow(*self._checked(t, q, p))[0]

    def energy(self, t: float, q: Any, p: Any) -> float:
        """The law's energy H (arguments and errors as `acceleration`).

        Parameters
        ----------
        t : float
            Time.
        q, p : array_like, shape (n, m)
            Positions and velocities.
        """
        return self.hamiltonian(*self._checked(t, q, p))

    def energy_rate(self, t: float, q: Any, p: Any) -> float:
        """Time derivative of `energy` along the law's flow, in closed form (arguments and errors as `acceleration`).

        Parameters
        ----------
        t : float
            Time.
        q, p : array_like, shape (n, m)
            Positions and velocities.
        """
        return self.flow(*self._checked(t, q, p))[1]


class DiscreteLaw(ABC):
    """A law that is a map from one step to the next, and not the time-discretisation of anything else.

    A subclass is a frozen dataclass with a step `dt` and `step`. Its state may carry more than (q, p): `memory` maps
    names to arrays, is passed along, and is recorded over time in `Trajectory.extra`.
    """

    references: ClassVar[tuple[str, ...]] = ()
    dt: float

    @abstractmethod
    def step(
        self, t: float, q: FloatArray, p: FloatArray, memory: Mapping[str, FloatArray]
    ) -> tuple[FloatArray, FloatArray, FloatArray, Mapping[str, FloatArray]]:
        """One step from t to t + dt: (next q, next p, the input u that was applied, next memory), unchecked.

        Parameters
        ----------
        t : float
            Time at the start of the step.
        q, p : ndarray, shape (n, m)
            Positions and velocities; not to be changed in place.
        memory : mapping of str to ndarray
            What else the law remembers.
        """

    def start(self, q: FloatArray, p: FloatArray) -> Mapping[str, FloatArray]:
        """The memory before the first step; empty by default.

        Parameters
        ----------
        q, p : ndarray, shape (n, m)
            Initial positions and velocities.
        """
        return {}

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:
        """NaN: a map has no energy unless the subclass says so.

        Parameters
        ----------
        t : float
            Time.
        q, p : ndarray, shape (n, m)
            Positions and velocities.
        """
        return float("nan")

    def check_dimension(self, m: int) -> None:  # noqa: B027  # nothing to check unless a subclass says so
        """Raise if the law does not live in m dimensions.

        Parameters
        ----------
        m : int
            Dimension of the flock.
        """

    def check_start(self, q: FloatArray, p: FloatArray) -> None:  # noqa: B027  # as `check_dimension`
        """Raise if the law must not be started from this state.

        Parameters
        ----------
        q, p : ndarray, shape (n, m)
            Initial positions and velocities.
        """


def ensure_law(law: Any) -> Law | DiscreteLaw:
    """Return `law` if it is one.

    Parameters
    ----------
    law : object
        What the caller gave.

    Raises
    ------
    ArgumentError
        If it is neither a `Law` nor a `DiscreteLaw`; a class instead of an instance is named as such.
    """
    if isinstance(law, Law | DiscreteLaw):
        return law
    hint = "; did you forget the parentheses?" if isinstance(law, type) else ""
    raise ArgumentError(f"law = {law!r}: expected a law such as Algorithm2(target=StaticTarget((0, 0))){hint}")
