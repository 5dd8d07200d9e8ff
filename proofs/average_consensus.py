"""Consensus of the first order on a digraph: agreement, the average, its rate, and steps that agree."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication


def _steps() -> Iterator[Step]:
    degree, re, im = z3.Reals("d x y")
    yield implication(
        "every μ lies in the disc about the sum of a row with that sum as radius (Gershgorin): Re μ >= 0, and > 0 but "
        "for μ = 0, which is simple exactly if one agent is heard by all (cited); then e^(-Lt) -> 1wᵀ, wᵀL = 0, Σw = 1",
        z3.Or(re > 0, z3.And(re == 0, im == 0)),
        *(degree >= 0, (re - degree) ** 2 + im * im <= degree * degree),
    )
    weights = sp.Matrix(3, 3, lambda i, j: 0 if i == j else sp.Symbol(f"a_{i}{j}"))
    laplacian = sp.diag(*(sum(weights[i, :]) for i in range(3))) - weights
    columns = sp.ones(1, 3) * laplacian
    heard = sp.Matrix(1, 3, lambda _, j: sum(weights[j, :]) - sum(weights[:, j]))
    yield Step(
        "1ᵀL holds what each agent hears less what it is heard (checked: n = 3): w = 1/n, and the average stays, "
        "exactly on a balanced net",
        (columns - heard).applyfunc(sp.expand) == sp.zeros(1, 3),
        r"\mathbf 1^T L = 0",
    )
    x = sp.Matrix(sp.symbols("x_0:3"))
    size, rate = (x.T * x)[0], -(x.T * (laplacian + laplacian.T) * x)[0]
    along = sum(sp.diff(size, x[i]) * (-laplacian * x)[i] for i in range(3))
    yield Step(
        "with δ = q - q̄, d/dt ‖δ‖² = -δᵀ(L + Lᵀ)δ (checked: n = 3) <= -2λ₂‖δ‖² on a balanced net, as (L + Lᵀ)1 = 0 and "
        "δ ⟂ 1; where such nets are switched the least λ₂ holds, as ‖δ‖² is one for all",
        sp.expand(along - rate) == 0,
        r"\tfrac{d}{dt}\|\delta\|^2 \le -2\lambda_2\|\delta\|^2",
    )
    eps, d, a, b = z3.Reals("eps Delta x y")
    yield implication(
        "|1 - εμ|² = 1 - 2ε Re μ + ε²|μ|² < 1 exactly for 0 < ε < 2 Re μ/|μ|²",
        ((1 - eps * a) * (1 - eps * a) + eps * eps * b * b < 1) == (eps * (a * a + b * b) < 2 * a),
        *(eps > 0, a > 0),
    )
    yield implication(
        "by Gershgorin's disc |μ|² <= 2Δ Re μ, so that ε <= 1/Δ is below that for all μ (the edge of the disc apart)",
        eps * (a * a + b * b) <= 2 * a,
        *(eps > 0, d > 0, eps * d <= 1, (a - d) * (a - d) + b * b <= d * d),
    )


PROOF = Proof(
    id="average-consensus",
    title="Consensus of the first order on a digraph",
    statement=(
        "Let q' = -Lq and one agent be heard by all. All agree from every start, on its average exactly if the net is "
        "balanced; then ‖q - q̄‖ falls at λ₂ of (L + Lᵀ)/2 or faster. Steps I - εL agree exactly for 0 < ε < min 2 Re "
        "μ/|μ|² over μ ≠ 0, which is at least 1/Δ."
    ),
    hypotheses="weights a_ij >= 0; the eigenvalue 0 of L is simple exactly if the net has a root (cited)",
    rigour="smt",
    theorems=("average-consensus", "average-switching"),
    steps=_steps,
    size=5,
)
