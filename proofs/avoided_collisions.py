"""Alignment with a repulsion times the spread of velocities: the functional that falls, and what it bounds."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication


def _steps() -> Iterator[Step]:
    k, far, r = sp.symbols("k delta r", positive=True)
    yield Step(
        "G(r) = kδ³/(r - δ²) has the slope -f at r = s²",
        sp.simplify(sp.diff(k * far**3 / (r - far**2), r) + k * far**3 / (r - far**2) ** 2) == 0,
    )
    p, q = sp.symbols("p_1:4"), sp.symbols("q_1:4")
    f = {pair: sp.Symbol(f"f_{pair[0]}{pair[1]}") for pair in ((0, 1), (0, 2), (1, 2))}
    push = [sum(f[min(i, j), max(i, j)] * (q[i] - q[j]) for j in range(3) if j != i) for i in range(3)]
    mean = sum(p) / 3
    power = sum((each - mean) * force for each, force in zip(p, push, strict=True))
    yield Step(
        "Σ (p_i - p̄) Σ_j f_ij (q_i - q_j) = ½ Σ_{i<j} f_ij d(s_ij²)/dt, component by component (checked: three agents)",
        sp.expand(power - sum(each * (p[i] - p[j]) * (q[i] - q[j]) for (i, j), each in f.items())) == 0,
        r"\sum_i \langle p_i - \bar p, u_i^f\rangle = \tfrac12 V\sum_{i<j} f_{ij}\,\tfrac{d}{dt}s_{ij}^2",
    )
    v, rate, drop, store = z3.Reals("V V' D S")
    falls = v * rate == -drop + v * store
    yield implication(
        "so VV' = -D + ½V Σ f d(s²)/dt, D = Σ_{i<j} a ‖p_j - p_i‖² >= 0, and E = V + ½ΣG has the rate -D/V <= 0 while "
        "V > 0; where V = 0 nothing acts, and it stays 0",
        rate - store <= 0,
        *(v > 0, drop >= 0, falls),
        latex=r"\dot E = -D/V",
    )
    square, least, level = z3.Reals("s2 delta E0")
    strength = z3.Real("k")
    yield implication(
        "each ½G(s²) <= E(0): s² >= δ² + kδ³/(2E(0)), which no pair leaves, as E is infinite at δ",
        square >= least * least + strength * least**3 / (2 * level),
        *(strength > 0, least > 0, level > 0, square > least * least),
        strength * least**3 <= 2 * level * (square - least * least),
    )
    spread_rate, phi, e_rate = z3.Reals("‖x‖' φ E'")
    yield implication(
        "D >= φV² with φ = na(√2 ‖x‖) (as for the law of Cucker and Smale), and ‖x‖' <= V: E + ∫φ up to ‖x‖ does not "
        "rise, so that ‖x‖ <= x_M; then ∫φ(x_M)V dt <= E(0), V' is bounded, and V -> 0 (Barbalat)",
        e_rate + phi * spread_rate <= 0,
        *(v > 0, phi > 0, drop >= phi * v * v, e_rate * v == -drop, spread_rate <= v),
    )


PROOF = Proof(
    id="avoided-collisions",
    title="Alignment with a repulsion times the spread of velocities",
    statement=(
        "Under the law of Cucker and Dong from distances above δ, E = V + ½ Σ kδ³/(s² - δ²) never rises, s² >= δ² + "
        "kδ³/(2E(0)), and if E(0) < n∫a(√2 s) ds from ‖x(0)‖ on, ‖x‖ <= x_M, velocities match and differences of "
        "places have limits."
    ),
    hypotheses="k, δ > 0; a falls with the distance",
    rigour="smt",
    theorems=("cucker-dong",),
    steps=_steps,
    size=5,
    cites=("Barbalat",),
)
