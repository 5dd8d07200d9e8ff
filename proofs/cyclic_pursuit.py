"""Linear cyclic pursuit with an offset angle: eigenvalues in closed form, and the angle at which they turn."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication


def _eigenvalues() -> Iterator[Step]:
    j, n, place = sp.symbols("j n l", integer=True, positive=True)
    root = sp.exp(2 * sp.pi * sp.I * j / n)
    yield Step(
        "z = x + iy: z_l' = k e^{iθ}(z_{l+1} - z_l). v_l = ω^l, ω = e^{2πij/n}, is an eigenvector with ω - 1, and "
        "closes, ω^n = 1",
        sp.simplify(root ** (place + 1) - root**place - (root - 1) * root**place) == 0
        and sp.simplify(sp.exp(2 * sp.pi * sp.I * j)) == 1,
        r"\lambda_j = k e^{i\theta}(e^{2\pi i j/n} - 1)",
    )
    yield Step(
        "of two different j the eigenvectors are orthogonal: Σ_l ω^l = (ω^n - 1)/(ω - 1) = 0 for the ω of their "
        "difference; every start is the sum of its modes, and Σ|z - z_c|² = n Σ_{j>0} |c_j|² e^{2 Re λ_j t}",
        sp.simplify(sum(root**k for k in range(5)) * (root - 1) - (root**5 - 1)) == 0,
        r"\sum_l |z_l - z_c|^2 = n \sum_{j>0} |c_j|^2 e^{2\,\mathrm{Re}\,\lambda_j t}",
    )
    theta, half, gain = sp.symbols("theta psi k", real=True)
    whole = gain * sp.exp(sp.I * theta) * (sp.exp(2 * sp.I * half) - 1)
    yield Step(
        "Re λ_j = -2k sin(πj/n) sin(θ + πj/n), with ψ = πj/n",
        sp.simplify(sp.expand_trig(sp.re(whole.rewrite(sp.cos)) + 2 * gain * sp.sin(half) * sp.sin(theta + half))) == 0,
        r"\mathrm{Re}\,\lambda_j = -2k \sin\tfrac{\pi j}n \sin(\theta + \tfrac{\pi j}n)",
    )
    yield Step(
        "j = 0 is the centroid: λ_0 = 0; at θ = -ψ, where Re λ vanishes, λ = k e^{-iψ}(e^{2iψ} - 1) = 2ik sin ψ",
        sp.simplify((whole.subs(theta, -half) - 2 * sp.I * gain * sp.sin(half)).rewrite(sp.exp).expand()) == 0
        and whole.subs(half, 0) == 0,
        r"\lambda = \pm 2ik \sin\tfrac\pi n",
    )


def _angles() -> Iterator[Step]:
    x, j, n = z3.Reals("x j n")
    inside = (n >= 2, j >= 1, j <= n - 1)
    yield implication(
        "x = nθ/π, |x| < 1: 0 < x + j < n for all j = 1 … n - 1, so that both sines are positive and all modes decay",
        z3.And(x + j > 0, x + j < n),
        *(*inside, x > -1, x < 1),
    )
    yield implication(
        "x = 1: x + j = n for j = n - 1 alone, and less for all others, which decay; x = -1 is its mirror image",
        z3.And(x + j > 0, x + j <= n, (x + j == n) == (j == n - 1)),
        *(*inside, x == 1),
    )
    yield implication(
        "1 < x <= n: n < x + j < 2n for j = n - 1, so that the second sine is negative and this mode grows; "
        "x < -1 is its mirror image",
        z3.And(x + j > n, x + j < 2 * n),
        *(*inside, x > 1, x <= n, j == n - 1),
    )


def _steps() -> Iterator[Step]:
    yield from _eigenvalues()
    yield from _angles()


PROOF = Proof(
    id="cyclic-pursuit",
    title="Cyclic pursuit with an offset angle",
    statement=(
        "Under q_i' = k R(θ)(q_{i+1} - q_i) of n agents in a ring the poles are k e^{iθ}(e^{2πij/n} - 1) and their "
        "conjugates: all meet at the fixed centroid if |θ| < π/n, circle about it at 2k sin(π/n) if |θ| = π/n, and "
        "beyond leave it from every start with a part in a mode that grows."
    ),
    hypotheses="k > 0, n >= 2, |θ| <= π, in the plane",
    rigour="smt",
    theorems=("cyclic-pursuit",),
    steps=_steps,
    size=7,
)
