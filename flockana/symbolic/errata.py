"""Errata of the slides: E1 and E14.

E1: they print H = V + sum |p_i|^2; the kinetic energy needs the factor 1/2. E14: in Reynolds' rules in Algorithm 1 they
lose the term -S_i q_i.
"""

from dataclasses import dataclass, replace

import sympy as sp

from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.energy import EnergyIdentity, algorithm1_identity
from flockana.symbolic.generic_pair import ADJACENCY, PHI
from flockana.symbolic.parameter_symbols import AlphaSymbols, GainSymbols
from flockana.symbolic.scalar_functions import HALF, adjacency, phi_alpha
from flockana.symbolic.sigma_norms import EPS
from flockana.symbolic.sums_over_pairs import sum_over
from flockana.symbolic.written_out_flock import ConcreteFlock

FRIENDS, NEGATIVE = sp.symbols("k l", integer=True, positive=True)  # |F+| and |F-|
_J = sp.Symbol("j", integer=True, positive=True)
STRESS, PLACE, SHIFT = sp.IndexedBase("s", real=True), sp.IndexedBase("q", real=True), sp.Symbol("w", real=True)
OWN = sp.Symbol("q_i", real=True)
_PARTS = ((_J, 1, FRIENDS), (_J, FRIENDS + 1, FRIENDS + NEGATIVE))  # F+, then F-; what has no stress adds nothing


def e1_identity(m: int = 2) -> EnergyIdentity:
    """Derive dH/dt of the energy H as printed in the slides (erratum E1), with its indefinite residual.

    Examples
    --------
    >>> e1_identity(1).holds
    False
    """
    printed = algorithm1_identity(m, kinetic_factor=sp.S.One)
    text = r"The difference, $-\dot V - c_2^\alpha\, p^T \hat L p$, is not 0, and $\dot V$ has no sign:"
    left = Step(text, printed.residual)
    return replace(printed, name=r"E1: the printed $H = V + \sum_i \|p_i\|^2$", steps=(*printed.steps, left))


@dataclass(frozen=True)
class RisingEnergy:
    """State at which the energy H as printed rises while the true H falls.

    Parameters
    ----------
    q, p : tuple of sympy.Rational
        Positions and velocities of the agents, m = 1.
    rate : sympy.Expr
        Exact dH/dt of the printed H along Algorithm 1: positive.
    true_rate : sympy.Expr
        Exact dH/dt with the factor 1/2: not positive.

    Examples
    --------
    >>> e1_counterexample().rate.is_positive
    True
    """

    alpha: AlphaSymbols
    gains: GainSymbols
    q: tuple[sp.Rational, ...]
    p: tuple[sp.Rational, ...]
    rate: sp.Expr
    true_rate: sp.Expr


def with_pair_law(expression: sp.Expr, alpha: AlphaSymbols) -> sp.Expr:
    """Return an expression with the paper's functions for phi_alpha and a_ij."""
    concrete_form = expression.replace(PHI, lambda z: phi_alpha(z, alpha=alpha))
    return sp.expand(concrete_form.replace(ADJACENCY, lambda z: adjacency(z, alpha=alpha)))


def e1_counterexample() -> RisingEnergy:
    """Return two close separating agents on a line, for which the energy H as printed in E1 rises.

    Examples
    --------
    >>> e1_counterexample().rate.evalf(6), e1_counterexample().true_rate
    (1.60489, -1/25)
    """
    alpha = AlphaSymbols(eps=0.1, h=0.2, a=5, b=5, d=7, r=8.4)
    gains = GainSymbols(c1_alpha=1, c2_alpha=1)
    q, p = (sp.Integer(0), sp.Integer(2)), (sp.Integer(0), sp.Rational(1, 5))

    def rate(factor: sp.Expr) -> sp.Expr:
        flock = ConcreteFlock("algorithm1", 2, 1, gains, factor)
        values = {row[0]: x for part, state in ((flock.q, q), (flock.p, p)) for row, x in zip(part, state, strict=True)}
        return with_pair_law(flock.rate.subs({**values, EPS: alpha.eps}), alpha)

    return RisingEnergy(alpha, gains, q, p, rate(sp.S.One), rate(HALF))


def gradient_part(shift: sp.Expr = sp.S.Zero) -> sp.Expr:
    """Return a component of u_i^g, the sum of s_ij (q_j - q_i) over the friends of agent i."""
    pull = sp.expand(STRESS[_J] * ((PLACE[_J] + shift) - (OWN + shift)))
    return sp.expand(sp.Add(*(sum_over(pull, part) for part in _PARTS)))


def friends_form(*, printed: bool, shift: sp.Expr = sp.S.Zero) -> sp.Expr:
    """Return S+ (<q>+ - q_i) + S- (<q>- - q_i), or the slides' form S+ <q>+ + S- <q>-."""
    # S+ and S- are the sums of the stresses of positive and of negative friends, <q>+ and <q>- their stress-weighted
    # means.
    total = sp.S.Zero
    for part in _PARTS:
        stress = sum_over(STRESS[_J], part)
        mean = sum_over(sp.expand(STRESS[_J] * (PLACE[_J] + shift)), part) / stress
        total += stress * (mean if printed else mean - (OWN + shift))
    return sp.expand(total)


def reynolds_form(*, printed: bool = False) -> Derivation:
    """Derive the friends' form of u_i^g; the printed form loses -S_i q_i and depends on the origin."""
    true_form, stated_form = gradient_part(), friends_form(printed=printed)
    moved_form = friends_form(printed=printed, shift=SHIFT)
    steps = (
        Step(r"Part the neighbours of agent $i$ into $F^+$, $F^-$ and $F^0$ by the sign of $s_{ij}$:", true_form),
        Step("What is stated in the stress-weighted means of both:", stated_form),
        Step(r"Move all agents by $w$; it becomes", moved_form),
    )
    residuals = (sp.expand(true_form - stated_form), sp.expand(moved_form - stated_form))
    return Derivation(r"Flock centring and collision avoidance, $u_i^g$", steps, stated_form, residuals)
