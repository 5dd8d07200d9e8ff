"""Linearised dynamics of a law of first order near a rest: its matrix and its n·m poles."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.checks import ComplexArray, FloatArray, ensure_fits, ensure_flag, ensure_positive
from flockana.base.errors import ArgumentError
from flockana.base.tables import facts_html, facts_text
from flockana.laws.velocity import VelocityLaw
from flockana.stability.linearisation import Linearisation
from flockana.stability.rounding import eigenvalues

if TYPE_CHECKING:
    import control
    from scipy.sparse import csr_array

_ZERO = 1e-9  # of the largest row sum of A: what counts as a zero mode
_OFF = 1e-11  # share of its size by which A by differences may be off


@dataclass(frozen=True, eq=False)
class VelocityLinearisation:
    """δq' = A δq near a rest of a law of first order.

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
                    "order here; eigenvalues, decay_rate, stable, A and state_space are there"
                )
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)

    @cached_property
    def A(self) -> FloatArray:  # noqa: N802  # what control engineers call it
        """The matrix as a dense array."""
        ensure_fits("A", self.A_sparse.shape, "use A_sparse")
        return self.A_sparse.toarray()

    @cached_property
    def _poles(self) -> tuple[ComplexArray, FloatArray, Any]:
        """Eigenvalues, their errors, and which are zero modes."""
        values, errors = eigenvalues(self.A, _OFF)
        order = np.lexsort((values.imag, -values.real))
        size = float(np.abs(self.A).sum(axis=1).max(initial=0.0))
        return values[order], errors[order], np.abs(values[order]) <= np.maximum(_ZERO * size, errors[order])

    @property
    def eigenvalues(self) -> ComplexArray:
        """All n·m poles, the largest real part first; zero modes come out as exact zeros."""
        values, _, zero = self._poles
        return np.where(zero, 0.0, values)

    @property
    def zero_modes(self) -> int:
        """Number of zero modes."""
        return int(self._poles[2].sum())

    @property
    def decay_rate(self) -> float:
        """Slowest decay rate off the zero modes; negative if something grows, NaN without others."""
        values, _, zero = self._poles
        return float(min(-values[~zero].real, default=np.nan))

    @property
    def stable(self) -> bool:
        """Return whether every mode off the zero modes decays beyond rounding."""
        values, errors, zero = self._poles
        return bool((values.real + errors < 0.0)[~zero].all())

    @cached_property
    def state_space(self) -> control.StateSpace:
        """Python-control system: states and outputs q0_x, …, inputs v0_x, … (a velocity added to each agent)."""
        import control

        (n, m), eye = self.q.shape, np.eye(self.q.size)
        names = [f"{i}_{axis}" for i in range(n) for axis in "xyz"[:m]]
        places, pushes = ([f"{letter}{name}" for name in names] for letter in "qv")
        return control.ss(self.A, eye, eye, 0.0 * eye, states=places, outputs=places, inputs=pushes)

    def facts(self) -> dict[str, str]:
        """Return what a table shows: sizes, poles, zero modes and stability."""
        (n, m), values = self.q.shape, self.eigenvalues
        known = {"law": f"{self.law.title}, of first order", "agents": f"{n}, m = {m}", "poles": f"{values.size}"}
        known |= {"zero modes": f"{self.zero_modes}", "stable": "yes" if self.stable else "no"}
        return known | {"decay rate": f"{self.decay_rate:.4g}"}

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
    size = float(np.abs(q - q.mean(axis=0)).max()) or float(np.abs(q).max()) or 1.0
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
