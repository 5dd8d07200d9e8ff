"""Generic pair: potential, forces, and the chain rule along the flow.

The potential psi_alpha, its derivative phi_alpha and the weight a_ij are undefined functions of the sigma-
distance here: what is derived from them holds for every interaction with psi' = phi.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp
from sympy.core.function import UndefinedFunction

from flockana.base.argument_kinds import check_kinds
from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.parameter_symbols import GAINS, GainSymbols
from flockana.symbolic.sigma_norms import sigma_norm, sigma_norm_gradient


def with_derivative(name: str, derivative: Any) -> Any:
    """Return an undefined function of one variable with a given derivative."""
    return UndefinedFunction(name, real=True, __dict__={"fdiff": lambda self, argindex=1: derivative(self.args[0])})


PHI = sp.Function("phi_alpha", real=True)
ADJACENCY = sp.Function("a", real=True)
PSI = with_derivative("psi_alpha", PHI)


def vector(name: str, m: int) -> sp.Matrix:
    """Return a column vector of m real symbols with a given name."""
    return sp.ImmutableMatrix([sp.Symbol(f"{name}{k}", real=True) for k in range(1, m + 1)])


@check_kinds
def pair_potential(q_i: sp.Matrix, q_j: sp.Matrix, *, gains: GainSymbols = GAINS) -> sp.Expr:
    """Return c1_alpha psi_alpha of the pair's sigma-distance.

    Parameters
    ----------
    q_i, q_j : sympy.Matrix, shape (m, 1)
        Positions.

    Examples
    --------
    >>> pair_potential(sp.Matrix([0]), sp.Matrix([0]))
    c_1^alpha*psi_alpha(0)
    """
    return gains.c1_alpha * PSI(sigma_norm(q_j - q_i))


@check_kinds
def pair_force(
    q_i: sp.Matrix, p_i: sp.Matrix, q_j: sp.Matrix, p_j: sp.Matrix, *, gains: GainSymbols = GAINS
) -> sp.Matrix:
    """Return the force of agent j on agent i: c1_alpha phi_alpha n_ij + c2_alpha a_ij (p_j - p_i).

    Parameters
    ----------
    q_i, p_i, q_j, p_j : sympy.Matrix, shape (m, 1)
        Positions and velocities.

    Examples
    --------
    >>> zero = sp.Matrix([0])
    >>> pair_force(zero, zero, zero, sp.Matrix([1]))
    Matrix([[c_2^alpha*a(0)]])
    """
    z = sigma_norm(q_j - q_i)
    n_ij = sigma_norm_gradient(q_j - q_i)
    return gains.c1_alpha * PHI(z) * n_ij + gains.c2_alpha * ADJACENCY(z) * (p_j - p_i)


def own_force(
    q_i: sp.Matrix, p_i: sp.Matrix, q_r: sp.Matrix, p_r: sp.Matrix, *, gains: GainSymbols = GAINS
) -> sp.Matrix:
    """Return the navigational feedback of Algorithm 2: -c1_gamma (q_i - q_r) - c2_gamma (p_i - p_r)."""
    return -gains.c1_gamma * (q_i - q_r) - gains.c2_gamma * (p_i - p_r)


def along_flow(energy: sp.Expr, q: Sequence[sp.Symbol], p: Sequence[sp.Symbol], u: Sequence[sp.Expr]) -> sp.Expr:
    """Return the time derivative of an energy(q, p) along q' = p, p' = u, by the chain rule."""
    return sp.Add(*(sp.diff(energy, qk) * pk + sp.diff(energy, pk) * uk for qk, pk, uk in zip(q, p, u, strict=True)))


def energy_balance(
    title: str, energy: sp.Expr, rate: sp.Expr, *flow: Sequence[sp.Matrix], of: str = "The energy"
) -> Derivation:
    """Derive that an energy of columns q and p changes at a stated rate along the flow (q, p, u)."""
    derived_rate = along_flow(energy, *([entry for column in columns for entry in column] for columns in flow))
    return Derivation(title, (Step(of, energy), Step("changes at", rate)), rate, (sp.expand(derived_rate - rate),))
