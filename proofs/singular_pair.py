"""Two agents on a line under a singular alignment weight: the invariant, contact, and the distance that is kept."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from proofs.proof import Proof, Step

X, K, L, E = sp.symbols("x K ell E", positive=True)
REST = sp.Symbol("rho", positive=True)  # 1 − α
W = sp.Symbol("w", real=True)
FACTOR = 2 * K * L ** (1 - REST) / REST


def _steps() -> Iterator[Step]:
    invariant = W + FACTOR * X**REST
    weight = K * (L / X) ** (1 - REST)
    rate = sp.diff(invariant, X) * W + sp.diff(invariant, W) * (-2 * weight * W)
    yield Step(
        "x' = w, w' = -2K (ℓ/x)^α w: w + 2K ℓ^α x^(1-α)/(1-α) never changes",
        sp.simplify(sp.powsimp(sp.expand_power_base(rate, force=True), force=True)) == 0,
        r"\tfrac{d}{dt}\bigl(w + \tfrac{2K\ell^\alpha}{1-\alpha}x^{1-\alpha}\bigr) = 0",
    )
    yield Step(
        "if it is -E <= 0, x falls at E + c x^(1-α) at least as fast as at c x^(1-α), which leads to 0 in the time "
        "x(0)^α/(cα): they meet",
        (E + X**REST - X**REST).is_positive
        and sp.simplify(sp.diff(X ** (1 - REST) / (1 - REST), X) - X ** (-REST)) == 0,
        r"\int_0^{x_0} \tfrac{ds}{E + c s^{1-\alpha}} \le \tfrac{x_0^\alpha}{c\,\alpha}",
    )
    at = (E / FACTOR) ** (1 / REST)
    yield Step(
        "if it is E > 0, w = 0 at x = (E/c)^(1/(1-α)) > 0, a place of rest of x' = E - c x^(1-α), which is smooth at "
        "x > 0: x never leaves the side on which it begins",
        at.is_positive and sp.simplify(E - FACTOR * at**REST) == 0,
        r"x_\infty = (E/c)^{1/(1-\alpha)}",
    )
    half = {REST: sp.Rational(1, 2), K: 1, L: 1}
    y = sp.Symbol("y", positive=True)
    spans = [sp.integrate(2 * y / (excess + 4 * y), (y, 0, 1)) for excess in (0, 1)]
    yield Step(
        "for α = ½, K = ℓ = x(0) = 1 they meet if w(0) <= -4: at t = ½ for -4, at ½ - ln(5)/8 = 0.298820 for -5",
        FACTOR.subs(half) == 4
        and spans[0] == sp.Rational(1, 2)
        and sp.simplify(spans[1] - (sp.Rational(1, 2) - sp.log(5) / 8)) == 0,
        r"T(-5) = \tfrac12 - \tfrac18\ln 5",
    )


PROOF = Proof(
    id="singular-pair",
    title="Two agents on a line under a singular alignment weight",
    statement=(
        "Under u_i = K (ℓ/s)^α (p_j - p_i), 0 < α < 1, two agents on a line meet, in a finite time, exactly if w(0) <= "
        "-2K ℓ^α x(0)^(1-α)/(1-α); else their distance stays between x(0) and a limit > 0."
    ),
    hypotheses="x(0) > 0, K, ℓ > 0; solutions are unique where they are smooth (cited)",
    rigour="symbolic",
    theorems=("singular-pair",),
    steps=_steps,
    size=4,
)
