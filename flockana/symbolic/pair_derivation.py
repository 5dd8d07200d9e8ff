"""Derivation of potential, force, weight and adjacency from a pair law's formula, step by step."""

import sympy as sp

from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.functions import adjacency, phi_alpha
from flockana.symbolic.pair_formula import EPS, PairFormula, S, Z


def pair_derivation(formula: PairFormula) -> Derivation:
    """Derive the consequences of a formula, with the residual of every equation that can be checked."""
    y = formula.distance
    psi, named = sp.Function("psi")(y), "s" if y == S else "z"
    derivative = formula.derivative
    weight = derivative / y if y == S else derivative / (1 + EPS * Z)
    potential = sp.Integral(formula.main, y) if formula.forces else formula.main
    square = sp.Symbol("x", positive=True)
    at = sp.sqrt(square) if y == S else (sp.sqrt(1 + EPS * square) - 1) / EPS
    residuals = () if formula.forces else (2 * sp.diff(formula.main.subs(y, at), square) - weight.subs(y, at),)
    steps = (
        Step(f"The potential of a pair, in ${named}$,", sp.Eq(psi, potential, evaluate=False)),
        Step("its derivative, negative where the pair repels,", sp.Eq(psi.diff(y), derivative, evaluate=False)),
        Step(r"the force on $i$ is $w\,(q_j - q_i)$ with", sp.Eq(sp.Symbol("w"), weight, evaluate=False)),
        Step("and velocities are averaged with", sp.Eq(sp.Symbol("a_ij"), formula.adjacency, evaluate=False)),
    )
    return Derivation("The pair law", steps, weight, tuple(sp.simplify(each) for each in residuals))


def alpha_steps() -> tuple[Step, ...]:
    """Return force and adjacency of Olfati-Saber's pair law, whose potential has no closed form."""
    return (
        Step("The pair law's derivative of the potential, in the sigma-norm,", phi_alpha(Z)),
        Step("and its adjacency", adjacency(Z)),
    )
