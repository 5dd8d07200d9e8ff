"""The laws of Tanner, Jadbabaie and Pappas: energy, distances it keeps, connectedness, and no sliding of one pair."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.energy_balances import matching_identity
from proofs.proof import Proof, Step
from proofs.smt import implication


def _energy() -> Iterator[Step]:
    yield Step(
        "H falls by k₂ times the sum over links of ‖p_j - p_i‖²: an identity in pairs, shown for three agents",
        matching_identity(2).holds,
        r"\dot H = -k_2 \sum_{i\sim j}\|p_j - p_i\|^2",
        "residual 0; across a switch at R H is continuous, V being so",
    )
    s, d, k = sp.symbols("s d k", positive=True)
    potential = k * (d**2 / s**2 - 1 + sp.log(s**2 / d**2))
    yield Step(
        "V falls below d and rises above, so d is its one minimum, where it is 0",
        sp.simplify(sp.diff(potential, s) - 2 * k * (s - d) * (s + d) / s**3) == 0 and potential.subs(s, d) == 0,
        sp.latex(potential),
    )
    yield Step(
        "and it is unbounded at contact: as no other term is negative, V_ij <= H(0) keeps linked agents apart",
        sp.limit((1 / s**2 - 1 + sp.log(s**2)), s, 0, "+") == sp.oo,
    )


def _net() -> Iterator[Step]:
    n, a = z3.Reals("n a")
    yield implication(
        "a cut into parts of a and n - a agents leaves n - 1 pairs beyond R at least, which cost (n - 1) V(R)",
        a * (n - a) >= n - 1,
        a >= 1,
        a <= n - 1,
    )
    inside, outside, slope, others = z3.Reals("s''_in s''_out V'(R) others")
    yield implication(
        "at a distance R that neither grows nor shrinks, where consensus along the pair is 0: what drives it in from "
        "outside drives it in from inside, so that no pair slides by itself",
        inside < 0,
        outside == others,
        inside == others - 2 * slope,
        slope > 0,
        outside < 0,
    )


def _steps() -> Iterator[Step]:
    yield from _energy()
    yield from _net()


PROOF = Proof(
    id="tanner",
    title="Potentials and consensus on a net: the energy falls, linked agents stay apart",
    statement=(
        "H falls at k₂ Σ‖p_j - p_i‖² over links; linked agents stay as far apart as V = H(0) says; a net of proximity "
        "with H(0) < (n - 1) V(R) stays connected; no pair slides at R by itself. That velocities then match is "
        "LaSalle's principle, on the compact level sets of H modulo translations, which no machine checks here."
    ),
    hypotheses="V = k(d²/s² - 1 + log(s²/d²)), k, k₂ > 0, R > d, any n and m",
    rigour="smt",
    steps=_steps,
    size=5,
    theorems=("tanner-fixed", "tanner-switching"),
)
