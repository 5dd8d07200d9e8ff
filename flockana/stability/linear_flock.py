"""Linear dynamics of a flock near an equilibrium: matrices, eigenvalues, modes, python-control systems."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.short_repr import ShortRepr
from flockana.base.table_export import facts_html, facts_text
from flockana.base.value_checks import ComplexArray, FloatArray, ensure_fits, ensure_state
from flockana.laws import Law
from flockana.measures.metrics import pairs_at_one_place
from flockana.measures.nets import LinkArray
from flockana.stability.modes import Mode, SecondOrder
from flockana.stability.signal_names import structural_system, translational_system, whole_system

if TYPE_CHECKING:
    import control
    from scipy.sparse import csr_array

_FEW = 5  # modes that a table lists
_MOST_SHOWN = 900  # coordinates up to which all poles are found for a table


@dataclass(frozen=True, eq=False)
class LinearFlock(ShortRepr):
    """δq'' + D δq' + K δq = 0 near an equilibrium, in its moving frame.

    Parameters
    ----------
    q, p : ndarray, shape (n, m)
        Where it is linearised; every agent has the velocity of the frame.
    t : float
        When.
    residual : float
        How far the state is from an equilibrium, relative to the law's forces.
    links : int array, shape (M, 2)
        Links, whose lengths are outputs of `state_space`.
    A_sparse : scipy.sparse.csr_array, shape (2nm, 2nm)
        A of d(δq, δp)/dt = A (δq, δp), in the order ``(q.ravel(), p.ravel())``.
    zero : float
        What counts as a zero mode: a motion that K multiplies by less than this, relative to the row sums of the agents
        that move.

    Examples
    --------
    Two agents at their distance: a spring and a damper between them, and a plane to move in.

    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.stability import linearise
    >>> pair = linearise(Algorithm1(), [[0.0, 0.0], [7.0, 0.0]])
    >>> [mode.name for mode in pair.zero_modes], pair.drifting
    (['translation x', 'translation y', 'rotation'], ('translation x', 'translation y'))
    >>> [(mode.name, round(mode.decay_rate, 4)) for mode in pair.modes]
    [('breathing', 1.9637), ('rotation', 3.9275)]
    """

    law: Law
    q: FloatArray = field(repr=False)
    p: FloatArray = field(repr=False)
    t: float
    residual: float
    links: LinkArray = field(repr=False)
    A_sparse: csr_array = field(repr=False)
    zero: float

    def facts(self) -> dict[str, str]:
        """Return the rows of the printed summary of a linear flock: sizes, zero modes, poles and slowest modes."""
        rows = {
            "law": self.law.title,
            "agents": f"{self.q.shape[0]}, m = {self.q.shape[1]}, {len(self.links)} links",
            "residual": f"{self.residual:.2g} of the law's forces",
        }
        if self.q.size > _MOST_SHOWN:
            return {**rows, "poles": f"{2 * self.q.size}; slowest_modes(...) finds a few of them"}
        zero, modes = [mode.name for mode in self.zero_modes], self.modes
        rows |= {"zero modes": ", ".join(zero) if len(zero) <= _FEW else f"{len(zero)}", "poles": f"{2 * self.q.size}"}
        if (doubtful := self._dense.kernel.doubtful(self.zero)).size:
            rows["zero modes in doubt"] = f"{doubtful.size}, of stiffness {doubtful[0]:.2g} of their agents' own"
        rows |= {"stable": "yes" if self.stable else "no"}
        for k, mode in enumerate(modes[:_FEW], 1):
            swing = f" ± {mode.frequency:.4g}i" if mode.frequency else ""
            rows[f"mode {k}"] = f"{mode.name}: λ = {mode.eigenvalue.real:.4g}{swing}, ζ = {mode.damping_ratio:.3g}"
        return rows | ({"further modes": f"{len(modes) - _FEW}"} if len(modes) > _FEW else {})

    def __str__(self) -> str:
        return facts_text("Linearisation", self.facts())

    def _repr_html_(self) -> str:
        return facts_html("Linearisation", self.facts())

    @cached_property
    def A(self) -> FloatArray:  # noqa: N802  # what control engineers call it
        """State matrix as a dense array; raises if it would not fit in memory."""
        ensure_fits("A", self.A_sparse.shape, "use A_sparse and slowest_modes(...)")
        return self.A_sparse.toarray()

    @property
    def stiffness(self) -> csr_array:
        """Stiffness K = −∂u/∂q, sparse."""
        dimension = self.q.size
        return -self.A_sparse[dimension:, :dimension]

    @property
    def damping(self) -> csr_array:
        """Damping D = −∂u/∂p, sparse."""
        dimension = self.q.size
        return -self.A_sparse[dimension:, dimension:]

    @property
    def coincident_pairs(self) -> int:
        """Pairs of agents at the same position, with an undefined force direction."""
        return pairs_at_one_place(self.q)

    @cached_property
    def second_order(self) -> SecondOrder:
        """Quadratic eigenproblem (λ² + λ D + K) v = 0."""
        return SecondOrder(self.q, self.stiffness, self.damping, zero=self.zero)

    @property
    def _dense(self) -> SecondOrder:
        ensure_fits("A", self.A_sparse.shape, "use A_sparse and slowest_modes(...)")
        return self.second_order

    @property
    def eigenvalues(self) -> ComplexArray:
        """All 2nm eigenvalues of A, the largest real part first; zero modes are exact zeros."""
        return self._dense.eigenvalues

    @property
    def zero_modes(self) -> tuple[Mode, ...]:
        """Zero modes K v = 0: translations, rotations, then soft motions such as hinges and loose parts."""
        return self._dense.invariant.zero

    @property
    def drifting(self) -> tuple[str, ...]:
        """Names of the zero modes with a persistent velocity: no force, no damping, a Jordan block."""
        return self._dense.invariant.drifting

    @property
    def semisimple(self) -> bool:
        """Return whether the zero modes have no Jordan block, so that perturbations along them stay bounded."""
        return self._dense.invariant.chains == 0

    @property
    def modes(self) -> tuple[Mode, ...]:
        """Modes other than the zero modes, slowest first; one for each real eigenvalue or conjugate pair."""
        return self._dense.modes

    @property
    def decay_rate(self) -> float:
        """Slowest decay rate off the zero modes, per time unit; negative if something grows, NaN without modes."""
        return min((mode.decay_rate for mode in self.modes), default=float("nan"))

    @property
    def stable(self) -> bool:
        """Return whether every mode off the zero modes decays beyond rounding; True without such modes."""
        return all(mode.decays for mode in self.modes)

    @property
    def structural_modes(self) -> tuple[Mode, ...]:
        """Modes of the shape alone, without the centre of mass; raises if they do not separate."""
        self.ensure_split()
        centre = {id(mode) for mode in self._dense.invariant.translational}
        return tuple(mode for mode in self.modes if id(mode) not in centre)

    @property
    def structural_decay_rate(self) -> float:
        """Decay rate of the shape alone; raises if shape and centre do not separate."""
        return min((mode.decay_rate for mode in self.structural_modes), default=float("nan"))

    @property
    def spectral_abscissa(self) -> float:
        """Largest real part of the eigenvalues off the zero modes: minus `decay_rate`."""
        return -self.decay_rate

    def limit(self, dq: Any, dp: Any) -> FloatArray:
        """Return the limit of a small perturbation along the manifold of equilibria, to first order.

        The zero modes keep what their left eigenvectors measure, w·(D δq + δp); all else decays if `decay_rate` > 0.
        Under Algorithms 1 and 2 the manifold is the orbit of the equilibrium under its symmetries.

        Parameters
        ----------
        dq, dp : array_like, shape (n, m)
            Perturbation of positions and velocities.

        Returns
        -------
        ndarray, shape (n, m)

        Raises
        ------
        ArgumentError
            If a zero mode drifts, so that there is no limit, or on bad arrays.
        """
        dq, dp = ensure_state(dq, dp)
        if dq.shape != self.q.shape:
            raise ArgumentError(f"dq has shape {dq.shape}: expected {self.q.shape}, that of the equilibrium")
        if not self.semisimple:
            raise ArgumentError(
                f"zero modes drift ({', '.join(self.drifting) or 'combined'}): there is no limit in this frame; "
                "subtract the mean from dq and dp and look at `structural`"
            )
        zero = self._dense.invariant
        still = zero.cokernel.T @ (self.damping @ dq.ravel() + dp.ravel())  # constant in time
        return (zero.kernel @ np.linalg.solve(zero.cokernel.T @ (self.damping @ zero.kernel), still)).reshape(dq.shape)

    def ensure_split(self) -> None:
        """Raise unless the centre of mass and the shape move independently of each other, to first order.

        Raises
        ------
        ArgumentError
            With the leak from the one to the other.
        """
        split_system = self.second_order.split
        if not split_system.exact:
            raise ArgumentError(
                f"{self.law.title} does not split into shape and centre of mass here: {split_system.leak:.2g} of a "
                "translation goes into the shape or back (relative to the largest entry of K and D). Expected forces "
                "between agents that cancel, and one linear pull on all: no σ₁, no obstacles, no gains that differ; "
                "use modes and state_space"
            )

    @cached_property
    def state_space(self) -> control.StateSpace:
        """Python-control system of all agents.

        States q0_x, …, p0_x, …; inputs f0_x, … (a disturbance force on each agent) and qr_x, …, pr_x, … (the
        γ-agent, if there is one); outputs qc_x, … (centre of mass), x0_x, … (deviations from it), l0_1, … (lengths of
        links), all as differences from the equilibrium.
        """
        return whole_system(self)

    @cached_property
    def structural(self) -> control.StateSpace:
        """Python-control system of the shape; raises without an exact split.

        States x0_x, …, v0_x, … of all agents but the last, which is minus their sum; inputs f0_x, …; outputs x0_x, … of
        all agents, l0_1, ….
        """
        return structural_system(self)

    @cached_property
    def translational(self) -> control.StateSpace:
        """Python-control system of the centre; raises without an exact split.

        States qc_x, …, pc_x, …; inputs f0_x, …, qr_x, …, pr_x, …; outputs qc_x, ….
        """
        return translational_system(self)
