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
from flint import ctx

from flockana.certified.decimal_rounding import interval
from flockana.sources.li_dead_zone.symbolic import (
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
    force,
    jumps,
    repulsion,
    repulsive_primitive,
    saturated_energy_identity,
)
from proofs.dead_zone_pairs import (
    DIGITS,
    RESTS_AT,
    STIFF,
    balls,
    defaults,
    potential_steps,
    rest_steps,
    saturated,
    zones,
)
from proofs.dead_zone_parting import FROM, LEAVING, separation_steps
from proofs.evaluate import enclosed
from proofs.proof import Proof, Step
from proofs.smt import implication, real
from proofs.theorem5_counts import equidistant_gram

_ZERO = sp.Integer(0)


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


def _energy() -> Iterator[Step]:
    for m in (1, 2, 3):
        yield Step(
            f"m = {m}: a pair in range adds -k₂|p_j - p_i|² to dH̄/dt, whatever F; one out of range adds nothing",
            saturated_energy_identity(m).holds,
            r"\dot{\bar H} = -k_2\, p^\top (L \otimes I)\, p \le 0",
            "forces are opposite, so that p̄ is constant; while a pair stays on a jump its distance is constant, "
            "and so "
            "F does no work, whatever it is",
        )
    q = sp.symbols("q_1:6")
    pulls = [sum(other - own for other in q) + len(q) * (own - sum(q) / sp.Integer(len(q))) for own in q]
    yield Step(
        "with all pairs in range k₁ pulls to the centre",
        all(sp.expand(pull) == 0 for pull in pulls),
        r"\sum_j (q_j - q_i) = -n (q_i - \bar q)",
    )


def pole(end: sp.Expr) -> sp.Expr:
    """2k_r[asinh(1/√ηρ) - asinh(1/√ηb)], what ψ(ρ) is at least for ρ < b, with k_δ and k₁ left out."""
    far, near = (repulsive_primitive(at).subs(K_DELTA, 0) for at in (end, RHO))
    return far - near


def no_collision(text: str, *, factor: int = 2) -> Step:
    """The step from ψ̄(ρ) <= H̄(0) to asinh(1/√ηρ) <= H̄(0)/(factor·k_r) + asinh(1/√ηb), for ρ < b."""
    start, kr, near, end, rest = z3.Reals("H̄(0) k_r asinh(1/√ηρ) asinh(1/√ηb) rest")
    b = sp.Symbol("b", positive=True)
    names = {K_R: kr, **{sp.asinh(1 / (sp.sqrt(ETA_POSITIVE) * at)): z for at, z in ((RHO, near), (b, end))}}
    given = (kr > 0, start >= 0, rest >= 0, real(pole(b), names) + rest <= start)
    return implication(text, factor * kr * (near - end) <= start, *given)


def _collisions() -> Iterator[Step]:
    end, y = sp.symbols("b y", positive=True)
    least = pole(end)
    roots = [sp.sqrt(1 + ETA_POSITIVE * s**2) for s in (end, RHO)]
    rise = repulsive_primitive(end) - repulsive_primitive(RHO)
    yield Step(
        "below b, η > 0: ψ(ρ) >= 2k_r[asinh(1/√ηρ) - asinh(1/√ηb)] and what k_δ adds, nothing negative",
        sp.expand(rise - least - K_DELTA * (roots[0] - roots[1]) / ETA_POSITIVE) == 0,
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
        sp.expand((rise - least).subs(K_DELTA, 0)) == 0 and saturated_energy_identity(2).result.subs(K_2, 0) == 0,
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
    yield Step(
        "with d₂ >= r it jumps at r down to 0 all the same, from k₁r",
        sp.limit(force().subs(zones(wide=True)["on the dead zone"], simultaneous=True).doit(), RHO, R) == K_1 * R,
        r"F(r^-) = k_1 r",
    )
    yield from _printed_energy()


def _printed_energy() -> Iterator[Step]:
    far, wide = (saturated(wide=wide, eta=ETA_POSITIVE).args[0][0] for wide in (False, True))
    yield Step(
        "L5: the H of neighbours alone is H̄ - ψ̄(r)·(pairs out of range): it rises by ψ̄(r) as a pair comes in, "
        "which is "
        "positive: with d₂ < r, ψ rises to r and ½k₁r² is added; with d₂ >= r, ½k₁r² is left, positive if k₁ > 0",
        sp.expand(far - K_1 * R**2 / 2 - (attractive_primitive(R) - attractive_primitive(D_2))) == 0
        and sp.expand(wide - K_1 * R**2 / 2) == 0,
        rf"\bar\psi(r) = {sp.latex(far)}",
    )
    with ctx.workdps(DIGITS):
        value = enclosed(far, balls(defaults())).real
        yield Step(
            "L5: by default, no ramp, two that approach at 12 m/s come from H = 36 to 36 + ψ̄(r)",
            bool(value > 0),
            evidence=f"36 + ψ̄(r) in {interval(36 + value)}",
        )


def _contacts() -> Iterator[Step]:
    yield Step(
        "L8: four agents of a plane are not all d apart, so that (1) has no solution for n > 3",
        equidistant_gram(3).det().is_positive,
        r"\det\left(\langle q_i - q_0, q_j - q_0\rangle\right)_{i,j=1,2,3} = \tfrac12 d^6 \ne 0 = "
        r"\det \text{ of any three vectors of the plane}",
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
    yield from potential_steps()
    yield from _energy()
    yield from _collisions()
    yield from _jumps()
    yield from separation_steps()
    yield from rest_steps()
    yield from _contacts()
    yield from _wrong_sign()


PROOF = Proof(
    id="dead-zone",
    title="Dead-zone flocking: Theorem 1, repaired and refuted",
    statement=(
        "ψ̄ is a potential of the force in every zone, continuous between them, for η = 0 and η > 0, with d₂ < r and "
        "with d₂ >= r. dH̄/dt = -k₂ pᵀL̂p for every n across all switches if r_d > r; hence no collision: ρ_ij(t) >= "
        "1/(√η sinh(H̄(0)/2k_r + asinh(1/√ηb))), for η = 0 b exp(-H̄(0)/2k_r). The printed H jumps up by ψ̄(r) "
        "as a pair "
        "comes into range, unless d₂ >= r and k₁ = 0. Two agents within r that leave each other at u + (2F_max/u + "
        "2k₂)(r - ρ(0)), u > 0, or faster separate for ever, F_max being F just below r if d₂ < r: by default, "
        f"{FROM} m apart, at {LEAVING} m/s; neither cohesion nor equal velocities follow. With n_ij reversed, two "
        "agents at rest near each other collide. If k₁ > 0, two agents within r rest at one distance, never at r_b: "
        "without a ramp at d₁ = r_b - δ if k₁d₁²√(1 + ηd₁²) <= 2k_r + k_δd₁², as by default, and else below d₁ (k₁ = "
        f"{STIFF}: at {RESTS_AT}…), with a ramp always below d₁. (1) has no solution for n > 3 in the plane."
    ),
    hypotheses=(
        "k_r > 0, k_δ, k₁, k₂, η >= 0, 0 < d₁ < r < r_d, d₁ <= d₂, distinct starts; at jumps of F solutions in "
        "Filippov's sense. Not proved here: that velocities match within a component"
    ),
    rigour="smt",
    theorems=("dead-zone-1-printed", "dead-zone-1-corrected", "L2", "L3", "L4", "L5", "L6", "L8"),
    steps=_steps,
    size=58,
    values={"rests at": RESTS_AT},
)
