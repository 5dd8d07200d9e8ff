"""Energies of n agents in m dimensions as sums over pairs and agents, for generic n and m."""

from __future__ import annotations

import sympy as sp

from flockana.base.argument_kinds import check_kinds
from flockana.symbolic.generic_pair import PSI
from flockana.symbolic.parameter_symbols import GAINS, GainSymbols
from flockana.symbolic.scalar_functions import HALF
from flockana.symbolic.sigma_norms import EPS

N = sp.Symbol("n", integer=True, positive=True)
M = sp.Symbol("m", integer=True, positive=True)
I_, J_, K_ = sp.symbols("i j k", integer=True, positive=True)
Q, P, X, V = (sp.IndexedBase(name, real=True) for name in ("q", "p", "x", "v"))
Z = sp.IndexedBase("z", nonnegative=True)
LAMBDA = sp.Symbol("lambda", nonnegative=True)


def sum_over(summand: sp.Expr, *limits: tuple[sp.Symbol, sp.Expr, sp.Expr]) -> sp.Expr:
    """Return a sum term by term, factors that do not depend on the indices in front."""
    indices = [index for index, _, _ in limits]
    terms = (term.as_independent(*indices) for term in sp.Add.make_args(summand))
    return sp.Add(*(factor * sp.Sum(rest, *limits) for factor, rest in terms if factor != 0))


@check_kinds
def write_out(generic: sp.Expr, n: int, m: int = 1) -> sp.Expr:
    """Return sums over n agents and m components written out term by term.

    sympy's own ``doit`` leaves the empty inner ranges of nested sums standing.

    Parameters
    ----------
    generic : sympy.Expr
        An expression with sums up to `N` and `M`.

    Examples
    --------
    >>> write_out(half_square(P), 2)
    p[1, 1]**2/2 + p[2, 1]**2/2
    """

    def terms(total: sp.Sum) -> sp.Expr:
        *inner, (index, low, high) = total.limits
        inner_sum = sp.Sum(total.function, *inner) if inner else total.function
        addends = (inner_sum.subs(index, value) for value in range(low, high + 1))
        return sp.Add(*(terms(term) if inner else term for term in addends))

    return generic.subs({N: n, M: m}).replace(lambda e: isinstance(e, sp.Sum), terms)


def indexed(*parts: tuple[sp.IndexedBase, sp.Matrix]) -> dict[sp.Symbol, sp.Indexed]:
    """Return one agent's vector components in the indexed form of sums."""
    return {symbol: base[I_, k] for base, vector in parts for k, symbol in enumerate(vector, start=1)}


def over_pairs(summand: sp.Expr) -> sp.Expr:
    """Return the sum over all unordered pairs i < j of an expression in i and j."""
    return sum_over(summand, (J_, I_ + 1, N), (I_, 1, N))


def over_agents(summand: sp.Expr) -> sp.Expr:
    """Return the sum over all agents of an expression in i."""
    return sum_over(summand, (I_, 1, N))


def sigma_distance(base: sp.IndexedBase = Q, m: sp.Expr = M) -> sp.Basic:
    """Return the definition of z_ij, the sigma-distance of agents i and j."""
    squared_value = sp.Sum((base[I_, K_] - base[J_, K_]) ** 2, (K_, 1, m))
    return sp.Eq(Z[I_, J_], (sp.sqrt(1 + EPS * squared_value) - 1) / EPS, evaluate=False)


def collective_potential(gains: GainSymbols = GAINS) -> sp.Expr:
    """Return V, c1_alpha psi_alpha(z_ij) summed over every pair once, non-neighbours included.

    Examples
    --------
    >>> write_out(collective_potential(GainSymbols(c1_alpha=1)), 2)
    psi_alpha(z[1, 2])
    """
    return gains.c1_alpha * over_pairs(PSI(Z[I_, J_]))


@check_kinds
def half_square(base: sp.IndexedBase, m: sp.Expr = M) -> sp.Expr:
    """Return half the sum of squares of agents' vectors: velocity mismatch K, or inertia J of positions.

    Parameters
    ----------
    base : sympy.IndexedBase
        `V` for K(v), `P` for the kinetic energy, `X` for J(x).

    Examples
    --------
    >>> write_out(half_square(V, 1), 2)
    v[1, 1]**2/2 + v[2, 1]**2/2
    """
    return HALF * sp.Sum(base[I_, K_] ** 2, (K_, 1, m), (I_, 1, N))


def hamiltonian(m: sp.Expr = M, *, gains: GainSymbols = GAINS, factor: sp.Expr = HALF) -> sp.Expr:
    """Return H(q, p) = V(q) + factor * sum |p_i|^2, in the given frame; E1: the slides print factor 1.

    Parameters
    ----------
    factor : sympy.Expr
        Of the kinetic energy: 1/2.

    Examples
    --------
    >>> write_out(hamiltonian(1, gains=GainSymbols(c1_alpha=1)), 1)
    p[1, 1]**2/2
    """
    return collective_potential(gains) + 2 * factor * half_square(P, m)


def structural_potential(m: sp.Expr = M, *, gains: GainSymbols = GAINS, lambda_: sp.Expr = LAMBDA) -> sp.Expr:
    """Return U_lambda(x) = V(x) + lambda J(x), in the moving frame.

    Parameters
    ----------
    lambda_ : sympy.Expr
        Weight of the inertia; Algorithm 2 has lambda = c1_gamma.

    Examples
    --------
    >>> write_out(structural_potential(1), 1)
    lambda*x[1, 1]**2/2
    """
    return collective_potential(gains) + lambda_ * half_square(X, m)


def structural_hamiltonian(m: sp.Expr = M, *, gains: GainSymbols = GAINS, lambda_: sp.Expr = LAMBDA) -> sp.Expr:
    """Return H_lambda(x, v) = U_lambda(x) + K(v), in the moving frame; lambda = 0 gives H(x, v).

    Parameters
    ----------
    lambda_ : sympy.Expr
        Weight of the inertia; Algorithm 2 has lambda = c1_gamma.

    Examples
    --------
    >>> write_out(structural_hamiltonian(1, lambda_=sp.Integer(0)), 1)
    v[1, 1]**2/2
    """
    return structural_potential(m, gains=gains, lambda_=lambda_) + half_square(V, m)
