"""The Cucker-Smale law: the Lyapunov functional of Ha and Liu, and the invariant of two agents on a line."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.energy_balances import matching_identity
from proofs.proof import Proof, Step
from proofs.smt import implication


def _functional() -> Iterator[Step]:
    yield Step(
        "Σ‖p_i - p̄‖² falls by twice the sum over pairs of a_ij ‖p_j - p_i‖²: shown for three agents",
        matching_identity(2, potential=False).holds,
        r"\tfrac{d}{dt}\tfrac12\|v\|^2 = -\tfrac{\lambda}{n}\sum_{i<j}\psi_{ij}\|p_j - p_i\|^2",
        "residual 0",
    )
    n, own, cross = sp.symbols("n s c")
    pairs = (n - 1) * own - 2 * cross  # Σ_{i<j} ‖p_j − p_i‖², s = Σ‖p_i‖², c = Σ_{i<j} p_i·p_j; each p_i in n − 1 pairs
    yield Step(
        "Σ_{i<j} ‖p_j - p_i‖² = n Σ‖p_i‖² - ‖Σp_i‖², by counting products: n‖v‖² for p̄ = 0",
        sp.expand(pairs - (n * own - (own + 2 * cross))) == 0,
        r"\sum_{i<j}\|p_j - p_i\|^2 = n\|v\|^2",
    )
    a, b, rest = z3.Reals("x_i x_j rest")
    yield implication(
        "‖x_j - x_i‖² <= 2‖x‖², component by component, so ψ_ij >= ψ(√2 ‖x‖) >= ψ(2‖x‖)",
        (b - a) ** 2 <= 2 * (a**2 + b**2 + rest),
        rest >= 0,
    )
    s, beta = sp.symbols("s beta", positive=True)
    slope = sp.diff((1 + s**2) ** -beta, s)
    yield Step("for ψ falls with the distance", sp.simplify(slope).is_negative, sp.latex(slope))
    v, v_rate, x_rate, phi, phi_m = z3.Reals("‖v‖ ‖v‖' ‖x‖' φ φ(x_M)")
    falls = v_rate <= -phi * v
    yield implication("so ‖v‖' <= -φ(‖x‖)‖v‖", falls, v > 0, v * v_rate <= -phi * v**2)
    yield implication(
        "and ‖v‖ + ∫φ up to ‖x‖ does not rise, for ‖x‖' <= ‖v‖ (Cauchy and Schwarz): hence ‖x‖ <= x_M",
        v_rate + phi * x_rate <= 0,
        falls,
        x_rate <= v,
        phi >= 0,
        latex=r"\tfrac{d}{dt}\left(\|v\| + \int^{\|x\|}\!\varphi\right) \le 0",
    )
    yield implication(
        "and as φ falls, ‖v‖' <= -φ(x_M)‖v‖: exponentially (Gronwall)",
        v_rate <= -phi_m * v,
        falls,
        v >= 0,
        phi >= phi_m,
    )


def _integrals() -> Iterator[Step]:
    y = z3.Real("y")
    yield implication(
        "1 + y² <= (1 + y)² for y >= 0, so (1 + y²)^-β >= 1/(1 + y) for β <= ½", 1 + y**2 <= (1 + y) ** 2, y >= 0
    )
    end = sp.Symbol("Y", positive=True)
    yield Step(
        "whose integral is log(1 + Y), without a bound: for β <= ½ every start meets the condition",
        sp.limit(sp.integrate(1 / (1 + end), end), end, sp.oo) == sp.oo,
    )


def _in_steps() -> Iterator[Step]:
    """The same functional in steps of time h, with hλ <= 1."""
    yield shrinks(z3.RealVal(1))
    v, after, x, moved, phi, h, passed = z3.Reals("‖v‖ ‖v'‖ ‖x‖ ‖x'‖ φ(‖x‖) h ∫φ")
    yield implication(
        "positions move by h‖v‖ at most, with p, p' or their mean, and φ falls: ‖v‖ + ∫φ up to ‖x‖ does not rise",
        after + passed <= v,
        *(v >= 0, h > 0, phi >= 0, after >= 0, after <= (1 - h * phi) * v, moved <= x + h * v),
        z3.If(moved >= x, passed <= phi * (moved - x), passed <= 0),
    )
    mean = z3.Real("‖(v + v')/2‖")
    yield implication("for a mean is no longer than the longer of two", mean <= v, 2 * mean <= v + after, after <= v)


def shrinks(most: z3.ArithRef) -> Step:
    """A component of v along an eigenvector of the Laplacian in a step, hλ at most so much: 1 is enough, 3 is not."""
    mu, h, phi, strength = z3.Reals("μ h φ λ")
    return implication(
        "in a step v' = (I - hL)v, where L has eigenvalues from φ(‖x‖) to λ off the mean: each component shrinks by "
        "1 - hφ",
        z3.And(1 - h * mu <= 1 - h * phi, 1 - h * mu >= -(1 - h * phi)),
        *(h > 0, phi >= 0, phi <= mu, mu <= strength, h * strength <= most),
        latex=r"\|v_{k+1}\| \le (1 - h\varphi(\|x_k\|))\,\|v_k\|",
    )


def _pair() -> Iterator[Step]:
    time, strength = sp.symbols("t K", positive=True)
    x, weight, at = sp.Function("x")(time), sp.Function("psi"), sp.Symbol("s", real=True)
    w = sp.diff(x, time)
    kept = w + strength * sp.Integral(weight(at), (at, sp.Symbol("x_0"), x))
    change = sp.diff(kept, time).subs(sp.diff(w, time), -strength * weight(x) * w)
    yield Step(
        "of two agents on a line w' = -Kψ(x)w, so that w + K∫ψ up to x never changes",
        sp.simplify(change) == 0,
        r"\tfrac{d}{dt}\left(w + K\int^{x}\!\psi\right) = 0",
    )
    speed, start, passed, whole = z3.Reals("w w(0) ∫ ∫_all")
    yield implication(
        "if w(0) exceeds the whole integral, w >= w(0) - ∫ > 0 for ever: they part",
        z3.And(speed >= start - whole, speed > 0),
        speed == start - passed,
        passed <= whole,
        start > whole,
    )
    s = sp.Symbol("s", positive=True)
    yield Step(
        "for K = ℓ = β = 1, x(0) = 1 the threshold is π/4", sp.integrate(1 / (1 + s**2), (s, 1, sp.oo)) == sp.pi / 4
    )


def _steps() -> Iterator[Step]:
    yield from _functional()
    yield from _integrals()
    yield from _in_steps()
    yield from _pair()


PROOF = Proof(
    id="cucker-smale",
    title="The Cucker-Smale law: a functional bounds the flock, and an invariant parts two agents",
    statement=(
        "If ‖v(0)‖ < ∫φ from ‖x(0)‖ on, φ(s) = λψ(2s) or λψ(√2 s), then ‖x‖ <= x_M and ‖v‖ falls exponentially; for "
        "β <= ½ that is so from every start, and in steps h with hλ <= 1 too; two agents on a line match or part as "
        "their speed is below or above ∫λψ."
    ),
    hypotheses="ψ(s) = (1 + s²/ℓ²)^-β, β >= 0, λ > 0, any n and m; two agents on a line for the last",
    rigour="smt",
    steps=_steps,
    size=15,
    theorems=("cucker-smale", "cucker-smale-steps", "ha-liu", "ha-liu-sharp", "cucker-smale-pair"),
)
