"""Laws that are sums of terms: force, power, energy and derivatives are summed term by term."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.override_checks import overrides_consistently
from flockana.base.value_checks import FloatArray, ensure_points
from flockana.laws.law import Law
from flockana.laws.law_matrices import assembled
from flockana.laws.terms.term import Compiled, Derivatives, Term, TermKernel
from flockana.measures.centre_frame import moving_frame

if TYPE_CHECKING:
    from flockana.symbolic.energy import EnergyIdentity


class SumOfTerms(Law):
    """u = Σ u^T over `terms`, with the energy H = Σ U^T + ½ Σ‖p_i‖² (½ Σ‖v_i‖² in the moving frame if a term asks).

    A subclass is a frozen dataclass of validated parameters with `terms`, a cached property.
    """

    @property
    @abstractmethod
    def terms(self) -> tuple[Term, ...]:
        """Terms of the law, in the order of summation."""

    @property
    def moving(self) -> bool:
        """Whether the energy is measured in the frame of the centre of mass."""
        return any(term.moving for term in self.terms)

    @property
    def conservative(self) -> bool:  # noqa: D102
        return all(term.conservative for term in self.terms)

    @property
    def centre_decouples(self) -> bool:  # noqa: D102
        return all(term.centre_decouples for term in self.terms)

    def check_dimension(self, m: int) -> None:  # noqa: D102
        for term in self.terms:
            term.check_dimension(m)

    def check_agents(self, n: int) -> None:  # noqa: D102
        for term in self.terms:
            term.check_agents(n)

    def check_start(self, q: FloatArray, p: FloatArray) -> None:  # noqa: D102
        super().check_start(q, p)
        for term in self.terms:
            term.check_start(q)

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        u, rate = np.zeros(q.shape), 0.0
        for term in self.terms:
            rate += term.act(t, q, p, u)
        return u, rate

    def compiled(self, m: int) -> Compiled | None:
        """Return the law's terms in compiled form; None if a term has none."""
        if not overrides_consistently(type(self), "compiled", ("flow", "hamiltonian", "potential_energy")):
            return None
        kernels: list[TermKernel] = []
        for term in self.terms:
            code = term.compiled(m) if overrides_consistently(type(term), "compiled", ("act", "energy")) else None
            if code is None:
                return None
            kernels += [code] if isinstance(code, TermKernel) else code
        form = Compiled(tuple(kernels), self.moving)
        return None if form.reach and any(kernel.numbered for kernel in kernels) else form

    def potential_energy(self, t: float, q: FloatArray) -> float:
        """Potential energy Σ U^T over the law's terms, unchecked."""
        return float(sum(term.energy(t, q) for term in self.terms))

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:  # noqa: D102
        v = moving_frame(p) if self.moving else p
        return self.potential_energy(t, q) + 0.5 * float(np.sum(v * v))

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Derivatives:  # noqa: D102
        by_position, by_velocity = zip(*(term.derivatives(t, q, p) for term in self.terms), strict=True)
        return assembled(by_position), assembled(by_velocity)

    def derivation(self, m: int = 2) -> EnergyIdentity:
        """Return potential, force, energy and dH/dt in closed form, for every number of agents, with LaTeX output.

        Parameters
        ----------
        m : int
            Dimension, 1, 2 or 3.

        Raises
        ------
        ArgumentError
            If the law is no sum of a pair law with a formula and a linear pull common to all agents.
        """
        from flockana.laws.energy_derivation import law_derivation

        return law_derivation(self, m)

    def stiffness(self, q: Any, t: float = 0.0) -> Any:
        """Hessian of the potential energy, in the order of ``q.ravel()``, sparse.

        Parameters
        ----------
        t : float
            When: a γ-agent may move.
        """
        q = ensure_points("q", q)
        self.check_dimension(q.shape[1])
        self.check_agents(len(q))
        return assembled([term.hessian(t, q) for term in self.terms])
