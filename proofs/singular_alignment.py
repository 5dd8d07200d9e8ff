"""Alignment with a weight s^-α: for α >= 1 no two agents meet, for α < 1 some do."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication


def _cluster() -> Iterator[Step]:
    a, b, c, d = z3.Reals("a b c d")
    yield implication(
        "the fastest agent is not sped up, ⟨v_i, v_j - v_i⟩ <= 0 where ‖v_j‖ <= ‖v_i‖: speeds stay below ‖v(0)‖_max "
        "(checked: in the plane), and all places are bounded up to any time",
        a * c + b * d - (a * a + b * b) <= 0,
        c * c + d * d <= a * a + b * b,
    )
    f, g, u, v, w = z3.Reals("psi_ik psi_jk v_i v_j v_k")
    yield implication(
        "suppose that some agents meet first at T, all of one group C at one place and the others at least δ away: of "
        "the others agents i and j of C feel forces that differ by at most |ψ_ik - ψ_jk| ‖v_k - v_i‖ + ψ_jk ‖v_j - v_i‖"
        " <= A s_ij + B ‖v_j - v_i‖, as ψ is Lipschitz beyond δ",
        f * (w - u) - g * (w - v) == (f - g) * (w - u) - g * (u - v),
        f > 0,
    )
    weight, at, size = z3.Reals("psi_ij psi R2")
    distance = z3.Real("s2")
    yield implication(
        "within C s_ij² <= 2R², R² = Σ‖q_i - q̄‖² over C, so ψ_ij >= ψ(√2 R) as ψ falls",
        weight >= at,
        *(distance <= 2 * size, size > 0, z3.Implies(distance <= 2 * size, weight >= at)),
    )


def _functional() -> Iterator[Step]:
    spread, rate, place, place_rate, count, psi, a, b = z3.Reals("V V' R R' c psi A B")
    falls = spread * rate <= -count * psi * spread * spread + spread * (a * place + b * spread)
    known = (spread > 0, place > 0, psi > 0, count >= 2, a >= 0, b >= 0, falls)
    yield implication(
        "V² = Σ‖p_i - p̄‖² over C, which has c agents, falls by 2 Σ_{i<j} ψ_ij ‖p_j - p_i‖² >= 2cψ(√2 R) V² (Cauchy "
        "and Schwarz for the rest): V' <= -cψ V + AR + BV",
        rate <= -count * psi * spread + a * place + b * spread,
        *known,
    )
    yield implication(
        "so V + c ∫_R ψ(√2 s) ds rises at most at AR + BV, as |R'| <= V: it stays bounded up to T",
        rate - count * psi * place_rate <= a * place + b * spread,
        *(*known, place_rate <= spread, -place_rate <= spread),
        latex=r"\tfrac{d}{dt}\bigl(V + c\int_R \psi(\sqrt2 s)\,ds\bigr) \le AR + BV",
    )
    s = sp.Symbol("s", positive=True)
    over = sp.Symbol("beta", positive=True)  # α = 1 + β
    yield Step(
        "but ∫_R^1 s^-α ds is -ln R for α = 1 and (R^-β - 1)/β for α = 1 + β, without bound as R -> 0: no group meets",
        sp.limit(-sp.log(s), s, 0, "+") == sp.oo
        and sp.diff(-sp.log(s), s) == -1 / s
        and sp.simplify(sp.diff((s**-over - 1) / over, s) + s ** (-1 - over)) == 0
        and sp.limit((s ** -sp.Rational(1, 8) - 1) * 8, s, 0, "+") == sp.oo,
        r"\int_R^1 s^{-\alpha}\,ds \to \infty",
    )


def _contact() -> Iterator[Step]:
    way, speed, others, start, x, left, w, integral = z3.Reals("Mt M G x_0 x cX w I")
    sum_at = w + left <= -speed + integral + 2 * others * way
    known = (speed > 0, others >= 0, start > 0, integral > 0, left >= 0, way >= 0, way <= 2 * start)
    yield implication(
        "α < 1, all on a line: two that are x_0 apart approach at M, the others rest at least δ + x_0 away. Nobody is "
        "faster than M/2, up to t = 2x_0/M none goes farther than x_0, and on w = x' the others act with at most "
        "2(n - 2)ψ(δ)M = 2GM: w + cX <= -M + I + 2GMt, X = x^(1-α), I = cX at first. For M >= 2(I + 4Gx_0) this leaves "
        "w <= -M/2",
        w <= -speed / 2,
        *(*known, sum_at, speed >= 2 * (integral + 4 * others * start)),
    )
    yield implication(
        "so x <= x_0 - Mt/2, which is 0 at t = 2x_0/M: they met by then",
        x <= 0,
        *(way == 2 * start, start > 0, x <= start - way / 2),
    )


def _steps() -> Iterator[Step]:
    yield from _cluster()
    yield from _functional()
    yield from _contact()


PROOF = Proof(
    id="singular-alignment",
    title="Alignment with a singular weight",
    statement=(
        "Under u_i = Σ_j K (ℓ/s_ij)^α (p_j - p_i) from distinct positions no two agents ever meet if α >= 1; if 0 < α "
        "< 1, two meet from some start of any n >= 2 agents."
    ),
    hypotheses="K, ℓ > 0, n >= 2; √Σ has one-sided slopes, bounded rates have limits at T (cited)",
    rigour="smt",
    theorems=("singular-alignment",),
    steps=_steps,
    size=8,
)
