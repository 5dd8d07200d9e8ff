"""Linearised dynamics of a first-order law near a rest: its matrix and its n·m poles."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.table_export import facts_html, facts_text
from flockana.base.value_checks import ComplexArray, FloatArray, ensure_fits, ensure_flag, ensure_positive
from flockana.laws.first_order_law import VelocityLaw
from flockana.stability.cost_estimates import LIMIT
from flockana.stability.linearisation import Linearisation
from flockana.stability.modes import Mode
from flockana.stability.zero_modes import extent

if TYPE_CHECKING:
    import control
    from control import FrequencyResponseData
    from scipy.sparse import csr_array

    from flockana.stability.chain_disturbances import TransientGrowth
    from flockana.stability.damp_table import DampTable
    from flockana.stability.delay import DelayMargin
    from flockana.stability.robustness import RobustnessMargins
    from flockana.stability.sampling import SamplingMargin

_ZERO = 1e-9  # of the row sums of A: what counts as a zero mode
_OFF = 1e-11  # share of its size by which A by differences may be off


@dataclass(frozen=True, eq=False)
class VelocityLinearisation:
    """δq' = A δq near a rest of a first-order law, with the margins of v' = A v for its velocity.

    Parameters
    ----------
    law : VelocityLaw
        The law.
    q : ndarray, shape (n, m)
        Where it rests.
    t : float
        When.
    residual : float
        Largest speed left there, over the largest row sum of A times the size of the flock.
    A_sparse : scipy.sparse.csr_array, shape (nm, nm)
        A, in the order of ``q.ravel()``.
    """

    law: VelocityLaw
    q: FloatArray = field(repr=False)
    t: float
    residual: float
    A_sparse: csr_array = field(repr=False)

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            if not name.startswith("_") and hasattr(Linearisation, name):
                raise ArgumentError(
                    f"{self.law.title} is of first order, its linearisation has no {name!r}: expected a law of second "
                    "order here; poles, modes, margins, A and state_space are there"
                )
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)

    @cached_property
    def A(self) -> FloatArray:  # noqa: N802  # what control engineers call it
        """State matrix A of the linearised first-order law, as a dense array."""
        ensure_fits("A", self.A_sparse.shape, "use A_sparse")
        return self.A_sparse.toarray()

    @cached_property
    def _velocities(self) -> Linearisation:
        """Flock of velocities without stiffness, q'' = A q', with the same margins."""
        from scipy.sparse import block_array, csr_array, eye_array

        size = self.q.size
        whole: Any = block_array([[None, eye_array(size)], [csr_array((size, size)), self.A_sparse]], format="csr")
        law, links = cast("Any", self.law), np.zeros((0, 2), dtype=np.int32)
        return Linearisation(law, self.q, np.zeros_like(self.q), self.t, self.residual, links, csr_array(whole), _ZERO)

    @property
    def modes(self) -> tuple[Mode, ...]:
        """Modes other than the zero modes, slowest first; one for each real pole or conjugate pair."""
        return self._velocities.modes

    @property
    def eigenvalues(self) -> ComplexArray:
        """All n·m poles, the largest real part first; zero modes are exact zeros."""
        poles = [s for mode in self.modes for s in {mode.eigenvalue, np.conj(mode.eigenvalue)}]
        values = np.array([*poles, *[0j] * (self.q.size - len(poles))])
        return values[np.lexsort((values.imag, -values.real))]

    @property
    def zero_modes(self) -> int:
        """Number of zero modes."""
        return self.q.size - sum(1 + bool(mode.eigenvalue.imag) for mode in self.modes)

    @property
    def decay_rate(self) -> float:
        """Slowest decay rate off the zero modes; negative if something grows, NaN without others."""
        return self._velocities.decay_rate

    @property
    def stable(self) -> bool:
        """Return whether every mode off the zero modes decays, beyond rounding and difference errors."""
        rate_error = _OFF * self._velocities.second_order.damping_scale
        return all(mode.decay_rate > mode.error + rate_error for mode in self.modes)

    def damp(self, *, settled: float = 0.02) -> DampTable:
        """Return a table of all poles: see `Linearisation.damp`.

        Parameters
        ----------
        settled : float
            Share of a deviation at which it counts as settled.
        """
        from flockana.stability.damp_table import damp_table

        names = {
            complex(value): mode.name for mode in self.modes for value in (mode.eigenvalue, np.conj(mode.eigenvalue))
        }
        return damp_table([(names.get(s, "zero"), s) for s in self.eigenvalues.tolist()], settled=settled)

    def delay_margin(
        self, *, delayed: str = "all", links: Any = None, sampled: float | None = None, limit: float = LIMIT
    ) -> DelayMargin:
        """Return the longest stable delay of positions: see `Linearisation.delay_margin`.

        Parameters
        ----------
        delayed, links
            What is late: see `flockana.stability.delay_system`.
        sampled : float, optional
            Period for which the velocity is held.
        limit : float
            Seconds of estimated work from which on it is refused.
        """
        return self._velocities.delay_margin(delayed=delayed, links=links, sampled=sampled, limit=limit)

    def sampling_margin(self, *, limit: float = LIMIT) -> SamplingMargin:
        """Return the longest stable hold period of velocities: 1 + hλ stays in the unit disc.

        Parameters
        ----------
        limit : float
            Seconds of estimated work from which on it is refused.
        """
        return self._velocities.sampling_margin(limit=limit)

    def robustness(self, *, limit: float = LIMIT) -> RobustnessMargins:
        """Return gain, phase and disk margins of the loops broken at each agent's velocity.

        Parameters
        ----------
        limit : float
            Seconds of estimated work from which on it is refused.
        """
        return self._velocities.robustness(limit=limit)

    def transient_growth(self, *, limit: float = LIMIT) -> TransientGrowth:
        """Return the largest transient growth of a position perturbation, off the zero modes.

        Parameters
        ----------
        limit : float
            Seconds of estimated work from which on it is refused.
        """
        return self._velocities.transient_growth(limit=limit)

    def response(self, input: str, output: str, omega: Any = None) -> FrequencyResponseData:
        """Return the frequency response from one named input to one named output of `state_space`.

        Parameters
        ----------
        input, output : str
            Such as "v0_x", a velocity added to agent 0, and "q2_x", the place of agent 2.
        omega : array_like, shape (F,), optional
            Angular frequencies; by default around the poles.
        """
        return Linearisation.response(cast("Any", self), input, output, omega)

    @cached_property
    def state_space(self) -> control.StateSpace:
        """Python-control system: states and outputs q0_x, …, inputs v0_x, … (a velocity added to each agent)."""
        import control

        (n, m), eye = self.q.shape, np.eye(self.q.size)
        names = [f"{i}_{axis}" for i in range(n) for axis in "xyz"[:m]]
        state_names, pushes = ([f"{letter}{name}" for name in names] for letter in "qv")
        return control.ss(self.A, eye, eye, 0.0 * eye, states=state_names, outputs=state_names, inputs=pushes)

    def facts(self) -> dict[str, str]:
        """Return the rows of the printed summary of a first-order law: sizes, poles, zero modes and stability."""
        (n, m), values = self.q.shape, self.eigenvalues
        rows = {"law": f"{self.law.title}, of first order", "agents": f"{n}, m = {m}", "poles": f"{values.size}"}
        rows |= {"zero modes": f"{self.zero_modes}", "stable": "yes" if self.stable else "no"}
        return rows | {"decay rate": f"{self.decay_rate:.4g}"}

    def __str__(self) -> str:
        return facts_text("Linearisation", self.facts())

    def _repr_html_(self) -> str:
        return facts_html("Linearisation", self.facts())


def linearise_velocity(
    law: VelocityLaw, at: tuple[float, FloatArray, Any], force_tolerance: Any, allow_residual: Any
) -> VelocityLinearisation:
    """Return the linearisation of a law of first order at a rest."""
    t, (q, v) = at[0], law.start(*at)
    matrix: Any = law.jacobian(t, q, sparse=True)
    size = extent(q)
    row, speed = float(abs(matrix).sum(axis=1).max()), float(np.linalg.norm(v, axis=1).max())
    residual = speed / (row * size) if row else np.inf if speed else 0.0
    if not residual <= ensure_positive("force_tolerance", force_tolerance) and not ensure_flag(
        "allow_residual", allow_residual
    ):
        raise ArgumentError(
            f"the state is no rest of {law.title}: its residual is {residual:.3g}, expected at most "
            f"{force_tolerance:g}; give positions at which its velocities are 0, or ask for allow_residual=True"
        )
    q = q.copy()
    q.flags.writeable = False
    return VelocityLinearisation(law, q, t, residual, matrix)
