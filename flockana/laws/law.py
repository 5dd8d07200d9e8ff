"""What a law of motion is: a continuous feedback u(t, q, p) for q' = p, p' = u, or a map from step to step."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from flockana.base.checks import FloatArray, ensure_finite_scalar, ensure_fits, ensure_state
from flockana.base.errors import ArgumentError
from flockana.base.scales import Scales
from flockana.base.units import Powers
from flockana.interactions.pair import pair_interaction

if TYPE_CHECKING:
    from scipy.sparse import csr_array, sparray


def block_diagonal(blocks: FloatArray) -> csr_array:
    """One block for each agent down the diagonal of a sparse matrix.

    Parameters
    ----------
    blocks : ndarray, shape (n, m, m)
        What each agent feels of itself.

    Examples
    --------
    >>> block_diagonal(np.array([[[2.0]], [[3.0]]])).toarray().tolist()
    [[2.0, 0.0], [0.0, 3.0]]
    """
    from scipy.sparse import bsr_array

    n, m = blocks.shape[:2]
    return bsr_array((blocks, np.arange(n), np.arange(n + 1)), shape=(n * m, n * m)).tocsr()


class Law(ABC):
    """A continuous law; a subclass is a frozen dataclass with `flow` and, if it has an energy, `hamiltonian`.

    `flow` and `hamiltonian` are the unchecked inner loop of the integrators; `acceleration`, `energy` and
    `energy_rate` are the validated public face of the same functions.
    """

    references: ClassVar[tuple[str, ...]] = ()

    @property
    def scales(self) -> Scales | None:
        """The natural length and time of the law, which thresholds are multiples of; None if it has none of its own."""
        return None

    @property
    def surfaces(self) -> tuple[float | tuple[float, ...], ...]:
        """Distances between agents at which a force begins, ends or jumps, each one number or one for every agent.

        Those of the law's pair interaction of finite range, if it has one. An integrator must not step over the region
        within one unseen (`flockana.dynamics.encounters`).
        """
        pair = pair_interaction(self)
        return () if pair is None else pair.surfaces

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

    def check_agents(self, n: int) -> None:  # noqa: B027  # as `check_dimension`
        """Raise if the law is not for n agents; a law with a parameter per agent overrides this.

        Parameters
        ----------
        n : int
            Number of agents.
        """

    def check_start(self, q: FloatArray, p: FloatArray) -> None:
        """Raise if the law must not be started from this state; `simulate` asks before it integrates.

        Parameters
        ----------
        q, p : ndarray, shape (n, m)
            Initial positions and velocities.
        """
        self.check_agents(len(q))

    def measures(
        self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Mapping[str, FloatArray]
    ) -> Mapping[str, tuple[str, FloatArray]]:
        """What is worth measuring of a run of this law, beside what is of any flock: `Trajectory.metrics` shows it.

        Parameters
        ----------
        t : ndarray, shape (T,)
            Sample times.
        q, p : ndarray, shape (T, n, m)
            Positions and velocities at the samples.
        extra : mapping of str to ndarray
            Further series of the run.

        Returns
        -------
        mapping of str to (str, ndarray of shape (T,))
            By name, what it is in words and its values.
        """
        return {}

    def _checked(self, t: Any, q: Any, p: Any) -> tuple[float, FloatArray, FloatArray]:
        q, p = ensure_state(q, p)
        self.check_dimension(q.shape[1])
        self.check_agents(q.shape[0])
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

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> tuple[sparray, sparray]:
        """(∂u/∂q, ∂u/∂p), sparse, in the order of ``q.ravel()``, unchecked; a law that has them overrides this.

        Parameters
        ----------
        t : float
            Time.
        q, p : ndarray, shape (n, m)
            Finite positions and velocities.

        Raises
        ------
        ArgumentError
            If the law has none.
        """
        name = type(self).__name__
        raise ArgumentError(f"{name} gives no derivatives: expected a law that implements `derivatives` to linearise")

    def jacobian(self, t: float, q: Any, p: Any, *, sparse: bool = False) -> FloatArray | csr_array:
        """Derivative of (p, u) in the state, ordered ``(q.ravel(), p.ravel())``: [[0, I], [∂u/∂q, ∂u/∂p]].

        Parameters
        ----------
        t : float
            Time.
        q, p : array_like, shape (n, m)
            Positions and velocities, an equilibrium or not.
        sparse : bool
            Return a scipy.sparse.csr_array.

        Returns
        -------
        ndarray or csr_array, shape (2nm, 2nm)

        Raises
        ------
        ArgumentError
            On bad arrays, a law without derivatives, or a dense matrix that would not fit in memory.

        Examples
        --------
        >>> from flockana.laws.olfati_saber import Algorithm1
        >>> A = Algorithm1().jacobian(0.0, [[0.0], [7.0]], [[0.0], [0.0]])
        >>> A[:2, 2:].tolist(), bool(A[2, 0] == -A[2, 1])
        ([[1.0, 0.0], [0.0, 1.0]], True)
        """
        from scipy.sparse import block_array, csr_array, eye_array

        t, q, p = self._checked(t, q, p)
        if not sparse:
            ensure_fits("the Jacobian", (2 * q.size, 2 * q.size), "ask for sparse=True")
        by_position, by_velocity = self.derivatives(t, q, p)
        whole: Any = csr_array(block_array([[None, eye_array(q.size)], [by_position, by_velocity]], format="csr"))
        matrix: FloatArray | csr_array = whole if sparse else whole.toarray()
        return matrix


class DiscreteLaw(ABC):
    """A law that is a map from one step to the next, and not the time-discretisation of anything else.

    A subclass is a frozen dataclass with a step `dt` and `step`. Its state may carry more than (q, p): `memory` maps
    names to arrays, is passed along, and is recorded over time in `Trajectory.extra`. A run holds the state at
    t0 + k dt and the input that brought it there; between its steps a map has no state. `extra_units` tells the powers
    of length and time of what is remembered, where it is no pure number.
    """

    references: ClassVar[tuple[str, ...]] = ()
    dt: float
    steps_at_once: ClassVar[int] = 1
    extra_units: ClassVar[Mapping[str, Powers]] = {}

    @property
    def scales(self) -> Scales | None:
        """The natural length and time of the law, which thresholds are multiples of; None if it has none of its own."""
        return None

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

    def iterate(
        self, t: float, q: FloatArray, p: FloatArray, memory: Mapping[str, FloatArray], steps: int
    ) -> tuple[FloatArray, FloatArray, FloatArray, Mapping[str, FloatArray]]:
        """`steps` steps at once: what `step` returns after each of them, stacked along a first axis, unchecked.

        `simulate` asks for `steps_at_once` steps at a time. A law whose step costs less than a call from Python
        overrides both; it must give what `step` gives, to the bit.

        Parameters
        ----------
        t : float
            Time at the start of the first step.
        q, p : ndarray, shape (n, m)
            Positions and velocities; not to be changed in place.
        memory : mapping of str to ndarray
            What else the law remembers.
        steps : int
            How many, at least 1.
        """
        states, memories = [], []
        for k in range(steps):
            q, p, u, memory = self.step(t + k * self.dt, q, p, memory)
            states.append((q, p, u))
            memories.append({name: np.array(value) for name, value in memory.items()})
        stacked = [np.stack(series) for series in zip(*states, strict=True)]
        series = {name: np.stack([each[name] for each in memories]) for name in memory}
        return stacked[0], stacked[1], stacked[2], series

    def start(self, q: FloatArray, p: FloatArray) -> Mapping[str, FloatArray]:
        """The memory before the first step; empty by default.

        Parameters
        ----------
        q, p : ndarray, shape (n, m)
            Initial positions and velocities.
        """
        return {}

    def measures(
        self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Mapping[str, FloatArray]
    ) -> Mapping[str, tuple[str, FloatArray]]:
        """What is worth measuring of a run of this law, beside what is of any flock: `Trajectory.metrics` shows it.

        Parameters
        ----------
        t : ndarray, shape (T,)
            Sample times.
        q, p : ndarray, shape (T, n, m)
            Positions and velocities at the samples.
        extra : mapping of str to ndarray
            Further series of the run.

        Returns
        -------
        mapping of str to (str, ndarray of shape (T,))
            By name, what it is in words and its values.
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
