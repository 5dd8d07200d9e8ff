"""Its proof, step by step: every step is an identity or an inequality that sympy settles."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from proofs.proof import Proof, Step


def steps() -> Iterator[Step]:
    """One generic pair, in one, two and three dimensions, and what follows for the sum over pairs."""
    for m in (1, 2, 3):
        v, w = (sp.Matrix(sp.symbols(f"{name}1:{m + 1}", real=True)) for name in "vw")
        a = sp.Symbol("a", positive=True)
        power = a * v.dot(w - v) + a * w.dot(v - w)
        yield Step(
            f"m = {m}: the two forces of a pair work at −a‖w − v‖²",
            sp.expand(power + a * (w - v).dot(w - v)) == 0,
            latex=r"\langle v, a(w-v)\rangle + \langle w, a(v-w)\rangle = -a\|w-v\|^2",
        )
        # summed over all ordered pairs, with Σ v_i = 0, the first two terms give 2nΣ‖v_i‖² and the last one nothing
        yield Step(
            f"m = {m}: ‖v − w‖² = ‖v‖² + ‖w‖² − 2⟨v, w⟩, whence Σ_i Σ_j ‖v_i − v_j‖² = 2nΣ‖v_i‖² = 4nK",
            sp.expand((v - w).dot(v - w) - v.dot(v) - w.dot(w) + 2 * v.dot(w)) == 0,
        )
    g, B, x = (sp.Symbol(name, positive=True) for name in ("g", "B", "x"))
    beta = sp.Symbol("beta", positive=True)
    slope = sp.diff((1 + x) ** -beta, x)
    yield Step("(1 + x)^−β falls, so a_ij ≥ (g/n)(1 + B²)^−β for every pair within B", bool(slope.is_negative))
    t, K0 = sp.Symbol("t", nonnegative=True), sp.Symbol("K0", positive=True)
    rate = 2 * g * (1 + B**2) ** -beta
    bound = K0 * sp.exp(-rate * t)
    yield Step(
        "dK/dt ≤ −½ (g/n)(1 + B²)^−β · 4nK, and the bound solves the equation (Grönwall)",
        sp.simplify(sp.diff(bound, t) + rate * bound) == 0 and bound.subs(t, 0) == K0,
        latex=r"\dot K \le -2 g (1+B^2)^{-\beta} K",
    )


PROOF = Proof(
    id="cucker-smale",
    statement="K(t) ≤ K(0) exp(−2 g (1 + B²)^−β t) while no pair is farther apart than B",
    hypotheses="g, β > 0; the law of Cucker and Smale",
    rigour="symbolic",
    steps=steps,
)
