"""Reynolds' rules in Algorithm 1, and erratum E14: the slides lose the term -S_i q_i."""

import sympy as sp

from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.sums import sum_over

FRIENDS, NEGATIVE = sp.symbols("k l", integer=True, positive=True)  # |F+| and |F-|
_J = sp.Symbol("j", integer=True, positive=True)
STRESS, PLACE, SHIFT = sp.IndexedBase("s", real=True), sp.IndexedBase("q", real=True), sp.Symbol("w", real=True)
OWN = sp.Symbol("q_i", real=True)
_PARTS = ((_J, 1, FRIENDS), (_J, FRIENDS + 1, FRIENDS + NEGATIVE))  # F+, then F-; what has no stress adds nothing


def gradient_part(shift: sp.Expr = sp.S.Zero) -> sp.Expr:
    """Return a component of u_i^g, the sum of s_ij (q_j - q_i) over the friends of agent i."""
    pull = sp.expand(STRESS[_J] * ((PLACE[_J] + shift) - (OWN + shift)))
    return sp.expand(sp.Add(*(sum_over(pull, part) for part in _PARTS)))


def friends_form(*, printed: bool, shift: sp.Expr = sp.S.Zero) -> sp.Expr:
    """Return S+ (<q>+ - q_i) + S- (<q>- - q_i), or what the slides print, S+ <q>+ + S- <q>-."""
    # S+ and S- are the sums of the stresses of positive and of negative friends, <q>+ and <q>- their stress-weighted
    # means.
    total = sp.S.Zero
    for part in _PARTS:
        stress = sum_over(STRESS[_J], part)
        mean = sum_over(sp.expand(STRESS[_J] * (PLACE[_J] + shift)), part) / stress
        total += stress * (mean if printed else mean - (OWN + shift))
    return sp.expand(total)


def reynolds_form(*, printed: bool = False) -> Derivation:
    """Derive the friends' form of u_i^g; as printed, -S_i q_i is left over, which depends on where the origin is."""
    true, stated = gradient_part(), friends_form(printed=printed)
    moved = friends_form(printed=printed, shift=SHIFT)
    steps = (
        Step(r"Part the neighbours of agent $i$ into $F^+$, $F^-$ and $F^0$ by the sign of $s_{ij}$:", true),
        Step("What is stated in the stress-weighted means of both:", stated),
        Step(r"Move all agents by $w$; it becomes", moved),
    )
    residuals = (sp.expand(true - stated), sp.expand(moved - stated))
    return Derivation(r"Flock centring and collision avoidance, $u_i^g$", steps, stated, residuals)
