"""Errata E12 and E15: when the circle or sine of the centre of mass is larger than the γ-agent's, and when smaller."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import sympy as sp
import z3
from flint import arb, ctx

from flockana.certified.balls import ball
from flockana.certified.decimal_rounding import interval
from flockana.symbolic.parameter_symbols import GAINS
from flockana.symbolic.translational_dynamics import S, falling_condition, frequency_gain, gain_slope, transfer_function
from proofs.proof import Proof, Step
from proofs.smt import impossible

DIGITS = 30
FACTOR = sp.Symbol("kappa", real=True)  # p_r = κ dq_r/dt
OMEGA, W = sp.Symbol("omega", positive=True), sp.Symbol("w", nonnegative=True)
C1, C2 = GAINS.c1_gamma, GAINS.c2_gamma
PULL, STEP, TURN = 70, Fraction(9, 1000), Fraction(25, 1000) / 5  # the MSN project's c1γ and dt, and turns a step
STATED = {"handed over": "0.852", "true": "1.109", "largest": "1.155"}


def excess(scale: sp.Expr) -> sp.Expr:
    """|numerator|² - |denominator|² of G(jω) as the library derives it."""
    above, below = sp.fraction(transfer_function(scale))
    moduli = (sp.expand(part.subs(S, sp.I * OMEGA) * part.subs(S, -sp.I * OMEGA)) for part in (above, below))
    return next(moduli) - next(moduli)


def msn_gain(scale: Fraction) -> arb:
    """|G| at the project's gains and frequency, c2γ = 2√c1γ, as a ball."""
    omega = 2 * arb.pi() * ball(TURN / STEP)
    c1, c2 = arb(PULL), 2 * arb(PULL).sqrt()
    square = omega * omega
    return ((c1 * c1 + (ball(scale) * c2) ** 2 * square) / ((c1 - square) ** 2 + c2 * c2 * square)).sqrt()


def rounded(value: arb) -> str:
    """To three decimals, if the ball leaves no doubt."""
    thousandths = (1000 * value + arb(1) / 2).floor().unique_fmpz()
    return "in doubt" if thousandths is None else f"{int(thousandths) / 1000:.3f}"


def _steps() -> Iterator[Step]:
    c1, c2, x, y = z3.Reals("c1 c2 x y")
    yield impossible(
        "the start is forgotten: all roots of s² + c2γ s + c1γ are on the left",
        *(c1 > 0, c2 > 0, x >= 0, x * x - y * y + c2 * x + c1 == 0, 2 * x * y + c2 * y == 0),
    )
    told = OMEGA**2 * (2 * C1 - OMEGA**2 - C2**2 * (1 - FACTOR**2))
    yield Step(
        "|G(jω)| > 1 exactly where ω² < 2c1γ - c2γ²(1 - κ²), for p_r = κ dq_r/dt",
        sp.expand(excess(FACTOR) - told) == 0,
        r"|N|^2 - |D|^2 = \omega^2\bigl(2c_1^\gamma - \omega^2 - (c_2^\gamma)^2(1 - \kappa^2)\bigr)",
    )
    yield Step(
        "with the true p_r (κ = 1) exactly where ω² < 2c1γ: a γ-agent that turns slowly is overshot, whatever the drag",
        sp.expand(excess(sp.S.One) - OMEGA**2 * (2 * C1 - OMEGA**2)) == 0,
    )
    slope = -(C1**2) * falling_condition(FACTOR) - 2 * C1**2 * W - FACTOR**2 * C2**2 * W**2
    yield Step(
        "|G(jω)| falls with every ω if c2γ²(1 - κ²) >= 2c1γ; else it first rises, so never falls with the true p_r",
        sp.expand(gain_slope(FACTOR, square=W) - slope) == 0,
        r"\tfrac{d|G|^2}{d\omega^2} \propto -(c_1^\gamma)^2\bigl((c_2^\gamma)^2(1-\kappa^2) - 2c_1^\gamma\bigr) "
        r"- 2(c_1^\gamma)^2\omega^2 - \kappa^2(c_2^\gamma)^2\omega^4",
    )
    critical = {C2: 2 * sp.sqrt(C1)}
    (best,) = (
        root for root in sp.solve(gain_slope(square=W).subs(critical), W) if root.subs(C1, 1).is_positive is True
    )
    highest = sp.simplify(frequency_gain(omega=sp.sqrt(best)).subs(critical))
    with ctx.workdps(DIGITS):
        largest, scales = 2 / arb(3).sqrt(), {"handed over": STEP, "true": Fraction(1)}
        yield Step(
            "with c2γ = 2√c1γ and the true p_r it is largest at ω² = ½c1γ, where it is 2/√3, whatever c1γ",
            sp.simplify(best - C1 / 2) == 0 and sp.simplify(highest - 2 / sp.sqrt(3)) == 0,
            evidence=interval(largest),
            found={"largest": rounded(largest)},
        )
        for name, scale in scales.items():
            gain = msn_gain(scale)
            yield Step(
                f"the MSN project's gains and frequency, p_r = {float(scale):g} dq_r/dt",
                bool(gain < 1) if scale < 1 else bool(gain > 1),
                evidence=f"|G| in {interval(gain)}",
                found={name: rounded(gain)},
            )


PROOF = Proof(
    id="tracking-gain",
    title="What decides the size of the flock's circle",
    statement=(
        "Behind a γ-agent on a circle or sine, p_r = κ dq_r/dt, the centre of mass ends on one |G(jω)| times as large, "
        "larger than the γ-agent's exactly where ω² < 2c1γ - c2γ²(1 - κ²): with the true p_r where ω² < 2c1γ. It is "
        "the smaller, the faster the γ-agent, iff c2γ²(1 - κ²) >= 2c1γ: never with the true p_r, where it is at most "
        f"{STATED['largest']} if c2γ = 2√c1γ. The MSN project's p_r gives {STATED['handed over']}, the true one "
        f"{STATED['true']}."
    ),
    hypotheses="Algorithm 2, c1γ, c2γ > 0, one gain for all; ω > 0",
    rigour="interval",
    steps=_steps,
    size=7,
    theorems=("E12", "E15"),
    values=STATED,
)
