"""The dead-zone Theorem 1: what is true of it, and exact counterexamples to what is not (errata L2 to L6, L8).

The force along the line from i to j is F(ρ) = f(ρ) ρ/√(1 + ηρ²) + k₁ρ within r, negative where it repels, 0 beyond;
f = -(2k_r/ρ² + k_δ) below d₁, 0 on [d₁, d₂], 2k_r/(r_d - ρ)² + k_δ above. A ramp beside the dead zone multiplies f by
a factor from 0 to 1, which is 1 below b = d₁ - ramp; without a ramp b = d₁. The energy is
H̄ = ½Σ|p_i - p̄|² + Σ_{i<j} ψ̄(ρ_ij), ψ̄(ρ) = ψ(ρ) + ½k₁ρ² with ψ' = fρ/√(1 + ηρ²), ψ = 0 on the dead zone, and ψ̄
constant from r on.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.dead_zone import (
    D_1,
    D_2,
    ETA,
    ETA_POSITIVE,
    K_1,
    K_2,
    K_DELTA,
    K_R,
    R_D,
    RHO,
    R,
    attraction,
    attractive_primitive,
    direction,
    jumps,
    potential,
    repulsion,
    repulsive_primitive,
)
from proofs.proof import Proof, Step
from proofs.smt import implication
from proofs.theorem5_counts import equidistant_gram

_ZERO = sp.Integer(0)
# the default parameters: r, δ = 4.5 and k_δ are the paper's, the rest ours
_DEFAULTS = {D_1: "7/2", D_2: "25/2", R: 15, R_D: 40, K_R: 200, K_DELTA: "13/10", ETA_POSITIVE: 1, K_1: "1/100"}


def _primitives() -> Iterator[Step]:
    for name, primitive, strength in (
        ("repulsion", repulsive_primitive, repulsion),
        ("attraction", attractive_primitive, attraction),
    ):
        for eta in (ETA_POSITIVE, _ZERO):
            difference = primitive(eta=eta).diff(RHO) - strength() * direction(eta=eta)
            yield Step(
                f"potential of the {name}, η {'> 0' if eta else '= 0'}: its closed form has that derivative",
                sp.simplify(difference) == 0,
                sp.latex(sp.Eq(sp.Symbol("P"), primitive(eta=eta))),
            )
    pieces = [value for value, _ in potential().args]
    ends = [pieces[1] - pieces[2], pieces[2] - pieces[3], pieces[3] - pieces[0]]
    yield Step(
        "ψ̄ is continuous at d₁, d₂ and r, and so is H̄ along every solution",
        all(sp.expand(step.subs(RHO, end)) == 0 for step, end in zip(ends, (D_1, D_2, R), strict=True)),
        r"\psi(\rho) = P_r(d_1) - P_r(\rho),\quad 0,\quad P_a(\rho) - P_a(d_2),\quad P_a(r) - P_a(d_2)",
    )
    s, w, kr, kd, pole, reach, slope = z3.Reals("ρ √(1+ηρ²) k_r k_δ r_d r ψ'")
    given = (s > 0, w > 0, kr > 0, kd >= 0)
    yield implication(
        "ψ falls below d₁, and so is positive there", slope < 0, *given, slope * w * s == -2 * kr - kd * s**2
    )
    yield implication(
        "ψ rises above d₂ if r_d > r, and so is positive there",
        slope > 0,
        *(*given, s < reach, reach < pole, slope * w * (pole - s) ** 2 == (2 * kr + kd * (pole - s) ** 2) * s),
    )
    yield Step(
        "r_d > r is needed: with r_d = r, ψ rises to infinity at r, as the factor s/√(1 + ηs²) does not fall",
        sp.limit(1 / (R - RHO), RHO, R, "-") == sp.oo
        and sp.simplify(direction().diff(RHO) - (direction() / RHO) ** 3) == 0,
        r"\int_{d_2}^\rho \frac{2k_r}{(r - s)^2} ds = \frac{2k_r}{r - \rho} - \frac{2k_r}{r - d_2} \to \infty",
    )


def pair_rate(m: int, *, damping: sp.Expr = K_2) -> sp.Expr:
    """What a pair in range adds to dH̄/dt, with damping·|p_j - p_i|² added, for any F = ψ̄': 0 if damping is k₂."""
    q, o, p, v = (sp.Matrix(sp.symbols(f"{name}_1:{m + 1}")) for name in "qopv")
    distance, force = sp.sqrt((o - q).dot(o - q)), sp.Symbol("F")
    control = force * (o - q) / distance + K_2 * (v - p)  # on the first agent; minus that on the second
    stored = force * sum(distance.diff(a) * b for a, b in zip([*q, *o], [*p, *v], strict=True))
    return sp.simplify(stored + control.dot(p) - control.dot(v) + damping * (v - p).dot(v - p))


def _energy() -> Iterator[Step]:
    for m in (1, 2, 3):
        yield Step(
            f"m = {m}: a pair in range adds -k₂|p_j - p_i|² to dH̄/dt, whatever F; one out of range adds nothing",
            pair_rate(m) == 0,
            r"\dot{\bar H} = -k_2\, p^\top (L \otimes I)\, p \le 0",
            "forces are opposite, so that p̄ is constant; while a pair stays on a jump its distance is constant, and so "
            "F does no work, whatever it is",
        )
    q = sp.symbols("q_1:6")
    pulls = [sum(other - own for other in q) + len(q) * (own - sum(q) / sp.Integer(len(q))) for own in q]
    yield Step(
        "with all pairs in range k₁ pulls to the centre",
        all(sp.expand(pull) == 0 for pull in pulls),
        r"\sum_j (q_j - q_i) = -n (q_i - \bar q)",
    )


def no_collision(text: str, *, factor: int = 2) -> Step:
    """The step from ψ̄(ρ) <= H̄(0) to asinh(1/√ηρ) <= H̄(0)/(factor·k_r) + asinh(1/√ηb), for ρ < b."""
    start, kr, near, end, rest = z3.Reals("H̄(0) k_r asinh(1/√ηρ) asinh(1/√ηb) rest")
    given = (kr > 0, start >= 0, rest >= 0, 2 * kr * (near - end) + rest <= start)
    return implication(text, factor * kr * (near - end) <= start, *given)


def _collisions() -> Iterator[Step]:
    end, y = sp.symbols("b y", positive=True)
    pole = 2 * K_R * (sp.asinh(1 / (sp.sqrt(ETA_POSITIVE) * RHO)) - sp.asinh(1 / (sp.sqrt(ETA_POSITIVE) * end)))
    roots = [sp.sqrt(1 + ETA_POSITIVE * s**2) for s in (end, RHO)]
    rise = repulsive_primitive(end) - repulsive_primitive(RHO)
    yield Step(
        "below b, η > 0: ψ(ρ) >= 2k_r[asinh(1/√ηρ) - asinh(1/√ηb)] and what k_δ adds, nothing negative",
        sp.expand(rise - pole - K_DELTA * (roots[0] - roots[1]) / ETA_POSITIVE) == 0,
        r"\int_\rho^b \frac{k_\delta s\, ds}{\sqrt{1 + \eta s^2}} = \frac{k_\delta}{\eta}"
        r"\left(\sqrt{1 + \eta b^2} - \sqrt{1 + \eta\rho^2}\right) \ge 0",
        "between b and d₁ a ramp adds nothing negative either, nor does k₁",
    )
    yield no_collision("so ψ̄(ρ_ij) <= H̄(t) <= H̄(0), all terms of H̄ being nonnegative, bounds asinh(1/√ηρ)")
    yield Step(
        "sinh undoes asinh and increases: ρ_ij(t) >= 1/(√η sinh(H̄(0)/2k_r + asinh(1/√ηb))) > 0 for all t",
        sp.sinh(sp.asinh(y)) == y and sp.sinh(y).diff(y) == sp.cosh(y) and sp.cosh(y).is_positive,
        r"\rho_{ij}(t) \ge \frac{1}{\sqrt\eta\, \sinh\left(\frac{\bar H(0)}{2k_r}"
        r" + \operatorname{asinh} \frac{1}{\sqrt\eta\, b}\right)}",
        "the bound is at most b, so that it holds of pairs farther apart than b as well",
    )
    yield Step(
        "L6: no better bound holds: with k_δ = k₁ = k₂ = 0, no ramp, two agents head-on turn where ψ(ρ) = H̄(0), at it",
        sp.expand((rise - pole).subs(K_DELTA, 0)) == 0 and pair_rate(2, damping=_ZERO).subs(K_2, 0) == 0,
    )
    rise = repulsive_primitive(end, eta=_ZERO) - repulsive_primitive(RHO, eta=_ZERO)
    yield Step(
        "η = 0: ψ(ρ) >= 2k_r ln(b/ρ) likewise, so that ρ_ij(t) >= b exp(-H̄(0)/2k_r) > 0",
        sp.expand(rise - 2 * K_R * (sp.log(end) - sp.log(RHO)) - K_DELTA * (end**2 - RHO**2) / 2) == 0,
    )
    scaled = sp.asinh(1 / (sp.sqrt(ETA_POSITIVE) * RHO))
    yield Step(
        "L3: at 0 the force f is unbounded, as 2k_r/ρ², and F as 2k_r/ρ; ψ only as -2k_r ln ρ",
        sp.limit(repulsion() * RHO**2, RHO, 0) == 2 * K_R
        and sp.limit(repulsion() * direction(eta=ETA_POSITIVE) * RHO, RHO, 0) == 2 * K_R
        and sp.limit(scaled + sp.log(RHO), RHO, 0) == sp.log(2) - sp.log(ETA_POSITIVE) / 2,
        r"\operatorname{asinh} \frac{1}{\sqrt\eta\, \rho} = -\ln\rho + \ln\frac{2}{\sqrt\eta} + o(1)",
    )


def _jumps() -> Iterator[Step]:
    positive = {symbol: sp.Symbol(symbol.name, positive=True) for symbol in (K_R, K_DELTA, K_1, ETA)}
    inner, outer = sp.symbols("r-d_2 r_d-r", positive=True)
    positive |= {R: D_2 + inner, R_D: D_2 + inner + outer}
    rises = {name: (above - below).subs(positive) for name, (below, above) in jumps().items()}
    yield Step(
        "F jumps up at d₁ and at d₂, and at r down to 0, if d₂ < r < r_d",
        bool(rises["d1"].is_positive and rises["d2"].is_positive and (-rises["r"]).is_positive),
        r"F(d_1^+) - F(d_1^-) = \frac{(2k_r/d_1^2 + k_\delta)\, d_1}{\sqrt{1 + \eta d_1^2}},\quad F(d_2^+) - F(d_2^-) ="
        r" \frac{(2k_r/(r_d - d_2)^2 + k_\delta)\, d_2}{\sqrt{1 + \eta d_2^2}},\quad F(r^-) = "
        r"\frac{(2k_r/(r_d - r)^2 + k_\delta)\, r}{\sqrt{1 + \eta r^2}} + k_1 r",
    )
    far = potential().args[0][0]
    value = far.subs(_DEFAULTS)
    yield Step(
        "L5: the H of neighbours alone is H̄ - ψ̄(r)·(pairs out of range): it rises by ψ̄(r) > 0 as a pair comes in",
        value.is_positive,
        rf"\bar\psi(r) = {sp.latex(far)}",
        f"two that approach at 12: from 36 to {36 + value.evalf(6)}, default parameters without a ramp",
    )


def _contacts() -> Iterator[Step]:
    s, w, end, w_end, kr, kd, k1 = z3.Reals("ρ √(1+ηρ²) d₁ √(1+ηd₁²) k_r k_δ k₁")
    yield implication(
        "L8: F = k₁ρ > 0 all over the dead zone, r_b included, and F < 0 all below d₁ if just below it, as by default: "
        "the one distance within r of two agents at rest is d₁ = r_b - δ, where F jumps through 0",
        -(2 * kr + kd * s**2) + k1 * s**2 * w < 0,
        *(s > 0, s <= end, w > 0, w <= w_end, kr > 0, kd >= 0, k1 > 0),
        -(2 * kr + kd * end**2) + k1 * end**2 * w_end < 0,
        latex=r"F(\rho) = \frac{-(2k_r + k_δ \rho^2) + k_1 \rho^2 \sqrt{1 + \eta\rho^2}}{\rho\sqrt{1 + \eta\rho^2}}",
    )
    yield Step(
        "L8: four agents of a plane are not all d apart, so that (1) has no solution for n > 3",
        equidistant_gram(3).det().is_positive,
        r"\det\left(\langle q_i - q_0, q_j - q_0\rangle\right)_{i,j=1,2,3} = \tfrac12 d^6 \ne 0 = "
        r"\det \text{ of any three vectors of the plane}",
    )


def _separate() -> Iterator[Step]:
    s, w, pull, theta, speed = z3.Reals("ρ √(1+ρ²) F θ ρ'")
    branch = pull * w * (40 - s) ** 2 == theta * (400 + z3.Q(13, 10) * (40 - s) ** 2) * s + s * w * (40 - s) ** 2 / 100
    yield implication(
        "L4: default parameters, ramp or none: two agents between 14 and r = 15 m apart attract with at most 2.1",
        pull <= z3.Q(21, 10),
        *(s >= 14, s < 15, theta >= 0, theta <= 1, w > s, w**2 == 1 + s**2, branch),
    )
    loss = z3.Real("loss")
    yield implication(
        "L4: while they part faster than 9 m/s, ρ' falls by less than 3 m/s per metre",
        loss < 3,
        *(speed >= 9, pull <= z3.Q(21, 10), loss * speed == 2 * pull + 2 * speed),
        latex=r"\ddot\rho = -2F(\rho) - 2k_2\dot\rho,\quad \frac{d\dot\rho}{d\rho} = -\frac{2F}{\dot\rho} - 2k_2 > -3",
    )
    start, way = z3.Reals("ρ'(0) way")
    yield implication(
        "L4: leaving each other at 12 m/s or more from 14 m they are faster than 9 m/s up to r, and keep that speed: "
        "they separate for ever, and neither distances nor velocities converge",
        speed >= 9,
        *(start >= 12, way >= 0, way <= 1, speed >= start - 3 * way),
        latex=r"\dot\rho(t) \ge 9 \text{ while } \rho < r,\quad \ddot\rho = 0 \text{ beyond}",
    )
    least, damping, reach, bound, speed0 = z3.Reals("least k₂ r-ρ(0) F_max ρ'(0)")
    drop = z3.Real("drop")
    yield implication(
        "L4: no parameters help: any pair in range separates if it leaves fast enough",
        speed0 - drop >= least,
        *(least > 0, damping >= 0, bound >= 0, reach > 0, drop * least <= (2 * bound + 2 * damping * least) * reach),
        speed0 * least == least**2 + (2 * bound + 2 * damping * least) * reach,
        latex=r"\dot\rho(0) = u + \left(\frac{2F_{\max}}{u} + 2k_2\right)(r - \rho(0)) \implies \dot\rho \ge u > 0",
    )


def _wrong_sign() -> Iterator[Step]:
    s, w, s0, w0, kr, kd, k1, pull = z3.Reals("ρ √(1+ηρ²) ρ(0) √(1+ηρ(0)²) k_r k_δ k₁ F")
    yield implication(
        "L2: with n_ij = q_i - q_j two agents closer than b attract, by no less than at the start as they approach",
        pull * s0 * w0 >= 2 * kr,
        *(s > 0, s <= s0, w > 0, w <= w0, kr > 0, kd >= 0, k1 >= 0),
        pull * s * w == 2 * kr + kd * s**2 + k1 * s**2 * w,
        latex=r"F(\rho) = +\frac{(2k_r/\rho^2 + k_δ)\rho}{\sqrt{1 + \eta\rho^2}} + k_1\rho \ge c = "
        r"\frac{2k_r}{\rho(0)\sqrt{1 + \eta\rho(0)^2}}",
    )
    t, floor, force = sp.symbols("t c F", positive=True)
    rho = sp.Function("rho")(t)
    rate = (rho.diff(t) + 2 * K_2 * rho + 2 * floor * t).diff(t)
    slower = rate.subs(rho.diff(t, 2), -2 * force - 2 * K_2 * rho.diff(t))
    yield Step(
        "L2: from rest ρ' + 2k₂ρ + 2ct does not rise, so that ρ(t) <= ρ(0) + 2k₂ρ(0)t - ct²",
        sp.expand(slower + 2 * (force - floor)) == 0,
        r"\frac{d}{dt}\left(\dot\rho + 2k_2\rho + 2ct\right) = -2(F - c) \le 0",
    )
    time, extra, c, k2 = z3.Reals("t extra c k₂")
    yield implication(
        "L2: which is negative in the end: two agents at rest closer than b collide within finite time",
        s0 + 2 * k2 * s0 * time - c * time**2 < 0,
        *(s0 > 0, k2 >= 0, c > 0, extra > 0, c * extra**2 > s0, c * time == 2 * k2 * s0 + c * extra),
    )


def _steps() -> Iterator[Step]:
    yield from _primitives()
    yield from _energy()
    yield from _collisions()
    yield from _jumps()
    yield from _separate()
    yield from _contacts()
    yield from _wrong_sign()


PROOF = Proof(
    id="dead-zone",
    title="Dead-zone flocking: Theorem 1, repaired and refuted",
    statement=(
        "The closed forms of ψ are potentials of the force, for η = 0 and η > 0. dH̄/dt = -k₂ pᵀL̂p for every n across "
        "all switches if r_d > r; hence no collision: ρ_ij(t) >= 1/(√η sinh(H̄(0)/2k_r + asinh(1/√ηb))), for η = 0 "
        "b exp(-H̄(0)/2k_r). The printed H jumps up by ψ̄(r) as a pair comes into range. Two agents 14 m apart that "
        "leave each other at 12 m/s separate for ever: neither cohesion nor equal velocities follow. With n_ij "
        "reversed, two agents at rest near each other collide. Two agents rest at r_b - δ, not at r_b, if k₁ > 0; and "
        "(1) has no solution for n > 3 in the plane."
    ),
    hypotheses=(
        "k_r > 0, k_δ, k₁, k₂, η >= 0, 0 < d₁ <= d₂, distinct starts; at jumps of F solutions in Filippov's sense. "
        "Not proved here: that velocities match within a component"
    ),
    rigour="smt",
    theorems=("dead-zone-1-printed", "dead-zone-1-corrected", "L2", "L3", "L4", "L5", "L6", "L7", "L8"),
    steps=_steps,
    size=29,
)
