"""Laws of first order: dq/dt = velocity(t, q), without inertia."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.finite_differences import differences
from flockana.base.override_checks import ensure_consistent, overrides_consistently
from flockana.base.value_checks import (
    FloatArray,
    ensure_finite_scalar,
    ensure_fits,
    ensure_points,
    ensure_returned_array,
    ensure_state,
)
from flockana.laws.discrete import DiscreteLaw, ensure_law
from flockana.laws.law import Law, LawOfMotion

if TYPE_CHECKING:
    from scipy.sparse import csr_array

_WEIGHTS = (2.0 / 3.0, -1.0 / 12.0)  # of f(kh) − f(−kh), k = 1, 2
_SHARE = 1e-3  # of the flock's own time: width of the differences along its motion
_SMOOTH = 1e-6  # relative: how far slopes by differences of several widths may be apart
_SAME = 1e-9  # of the largest speed: how far given velocities may be from the law's
_SECOND_ORDER = frozenset(name for name in vars(Law) if not name.startswith("_"))


class _NoSecondOrderError(ArgumentError, AttributeError):
    """Error for an attribute that laws of first order lack, seen by `hasattr`."""


class VelocityLaw(LawOfMotion):
    """Law of first order, dq/dt = velocity(t, q); a subclass is a frozen dataclass with `velocity`.

    Of its runs `Trajectory.p` is that velocity and `Trajectory.u` its rate along the motion, d²q/dt². It has no energy,
    no mass and no input. It is simulated, saved, verified, linearised, and run late or sampled (`Delayed`, `Sampled`);
    what takes laws of second order alone, such as `FixedSteps`, `certify` or `enclose`, refuses it by name.

    Examples
    --------
    >>> import flockana as fl
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class Home(fl.VelocityLaw):
    ...     rate: float = 1.0
    ...     functions = ()  # it reads no distance between agents
    ...     def velocity(self, t, q):
    ...         return -self.rate * q
    >>> run = fl.simulate(Home(2.0), [[1.0]], None, (0.0, 1.0))
    >>> bool(abs(run.q[-1, 0, 0] - np.exp(-2.0)) < 1e-8), float(run.p[0, 0, 0]), round(float(run.u[0, 0, 0]), 9)
    (True, -2.0, 4.0)
    """

    derived_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {"slopes": ("jacobian",)}

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            if name in _SECOND_ORDER:
                raise _NoSecondOrderError(
                    f"{type(self).__name__} is a law of first order, dq/dt = velocity(t, q), and has no {name!r}: "
                    "expected a law of second order here, such as Algorithm1()"
                )
            return super().__getattr__(name)

    @abstractmethod
    def velocity(self, t: float, q: FloatArray) -> FloatArray:
        """Return dq/dt of shape (n, m), unchecked."""

    def slopes(self, t: float, q: FloatArray) -> Any:
        """Return ∂velocity/∂q, sparse, in the order of ``q.ravel()``, unchecked; by differences unless overridden."""
        from scipy.sparse import csr_array

        length_scale = self.scales.length if self.scales else float(np.abs(q - q[0]).max()) or 1.0
        rates = differences(lambda x: self.velocity(t, x), q, length_scale)
        if rates.spread > _SMOOTH:
            raise ArgumentError(
                f"{type(self).__name__} has a kink or a jump at this state (slopes differ by {rates.spread:.2g} of the "
                "largest): expected a state around which it is smooth, or a law that implements `slopes`"
            )
        return csr_array(rates.matrix)

    def acceleration(self, t: float, q: FloatArray) -> FloatArray:
        """Return d²q/dt² along the motion, unchecked; by differences of order 4 unless overridden."""
        v = self.velocity(t, q)
        if self.scales is not None:
            time = self.scales.time
        else:
            extent, speed = (float(np.abs(x - x.mean(axis=0)).max()) for x in (q, v))
            time = extent / speed if extent and speed else 1.0
        h = _SHARE * time
        apart = (self.velocity(t + k * h, q + k * h * v) - self.velocity(t - k * h, q - k * h * v) for k in (1, 2))
        return np.asarray(sum(w * x for w, x in zip(_WEIGHTS, apart, strict=True)) / h)

    def jacobian(self, t: float, q: Any, *, sparse: bool = False) -> FloatArray | csr_array:
        """Derivative of the velocities in the positions, in the order of ``q.ravel()``.

        Parameters
        ----------
        t : float
            When.
        q : array_like, shape (n, m)
            Positions.
        sparse : bool
            Return a scipy.sparse.csr_array.

        Returns
        -------
        ndarray or csr_array, shape (nm, nm)

        Raises
        ------
        ArgumentError
            On bad arrays, a kink or a jump at this state, or a dense matrix that would not fit in memory.
        """
        q = self._checked(q)
        if not sparse:
            ensure_fits("the Jacobian", (q.size, q.size), "ask for sparse=True")
        is_own = overrides_consistently(type(self), "slopes", ("velocity",))  # else they are another law's
        matrix: Any = (type(self) if is_own else VelocityLaw).slopes(self, ensure_finite_scalar("t", t), q)
        return matrix if sparse else matrix.toarray()

    def _checked(self, q: Any) -> FloatArray:
        q = ensure_points("q", q)
        self.check_dimension(q.shape[1])
        self.check_agents(len(q))
        return q

    def start(self, t: float, q: Any, p: Any = None) -> tuple[FloatArray, FloatArray]:
        """Return checked initial positions and velocities of a first-order law, the latter from the law.

        Parameters
        ----------
        t : float
            When.
        q, p : array_like, shape (n, m)
            Positions; velocities, if given those of the law.

        Returns
        -------
        (ndarray, ndarray)

        Raises
        ------
        ArgumentError
            On velocities that are not the law's, or not finite there.
        """
        q = self._checked(q)
        v, at = self.velocity(t, q), f"at the start, t = {t:g}"
        ensure_returned_array(f"{self.title} gives a velocity", v, q.shape, at)
        if not (is_finite := np.isfinite(v).all(axis=1)).all():
            i = int(np.argmin(is_finite))
            raise ArgumentError(f"{self.title} gives velocity[{i}] = {v[i]} {at}: expected finite velocities there")
        v = np.asarray(v, dtype=np.float64)
        if p is None:
            return q, v
        q, p = ensure_state(q, p)
        deviation = np.abs(p - v).max(axis=1)
        largest = max(float(np.abs(v).max()), self.scales.speed if self.scales else 0.0)
        if (deviation > _SAME * largest).any():
            i = int(deviation.argmax())
            raise ArgumentError(
                f"p0[{i}] = {p[i]}: {self.title} is of first order and has the velocity {v[i]} there; expected "
                "p0 = None, or the law's velocities"
            )
        return q, v


def first_order(law: Any) -> VelocityLaw | None:
    """Return the law of first order behind a law, wrapper or map; None for a law of second order."""
    while law is not None and not isinstance(law, VelocityLaw):
        law = getattr(law, "__dict__", {}).get("law")
    return law


def start_velocities(law: Any, t: float, q: Any, p: Any) -> Any:
    """Return default start velocities: those of a law of first order, else 0."""
    if p is not None:
        return p
    core = first_order(law)
    return np.zeros(np.shape(q)) if core is None else core.start(t, q)[1]


def ensure_any_law(law: Any) -> Law | DiscreteLaw | VelocityLaw:
    """Return `law` if it is a law of any order or a map; raise otherwise, as `ensure_law` does."""
    if not isinstance(law, VelocityLaw):
        return ensure_law(law)
    ensure_consistent(law)
    return law
