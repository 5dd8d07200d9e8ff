"""The algebra behind ultimate bounds: what a disturbance adds to the strict Lyapunov function of a certified basin."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from proofs.proof import Proof, Step

EPS, LAM, RATE, PUSH, GAIN, START = sp.symbols("epsilon lambda alpha W c y_0", positive=True)
V, W, T = sp.symbols("v w t", nonnegative=True)  # ‖v‖, ‖w‖ and time


def _steps() -> Iterator[Step]:
    room = (1 + EPS**2 / LAM) * (V**2 + LAM * W**2) - (V + EPS * W) ** 2
    yield Step(
        "(‖v‖ + ε‖w‖)² <= (1 + e²)(‖v‖² + λ‖w‖²), e² = ε²/λ: what is left is a square",
        sp.simplify(room - (EPS * V - LAM * W) ** 2 / LAM) == 0,
        r"(v + \varepsilon w)^2 = (1 + \varepsilon^2/\lambda)(v^2 + \lambda w^2)"
        r" - (\varepsilon v - \lambda w)^2/\lambda",
    )
    energy, share = sp.symbols("E e", positive=True)
    gain = sp.sqrt(2 * (1 + share**2) / (1 - share))
    yield Step(
        "with ‖v‖² + λ‖w‖² <= 2E and E <= F/(1 - e) it is at most c√F, c² = 2(1 + e²)/(1 - e)",
        sp.simplify(gain**2 * (1 - share) * energy - 2 * (1 + share**2) * energy) == 0,
    )
    y = START * sp.exp(-RATE * T / 2) + PUSH * GAIN / RATE * (1 - sp.exp(-RATE * T / 2))
    yield Step(
        "y = √F obeys 2y' <= -αy + Wc, whose solution with equality is a mean of y(0) and Wc/α, which it tends to",
        sp.simplify(2 * sp.diff(y, T) + RATE * y - PUSH * GAIN) == 0 and sp.limit(y, T, sp.oo) == PUSH * GAIN / RATE,
        r"y(t) = y_0 e^{-\alpha t/2} + \tfrac{Wc}{\alpha}(1 - e^{-\alpha t/2})",
    )


PROOF = Proof(
    id="disturbed-basins",
    title="Why a bounded disturbance leaves a flock near its certified equilibrium",
    statement=(
        "If in a certified basin F = E + ε⟨w, v⟩ falls at least at the rate α without a disturbance, and "
        "(1 - e)E <= F, then under a disturbance of size W at most √F <= max(√F(0), Wc/α), and limsup √F <= Wc/α, "
        "as long as that is less than √((1 - e)ΔH)."
    ),
    hypotheses=(
        "A certified basin; the disturbance of the accelerations with its mean taken off. Prose: d adds ⟨v + εw, d⟩ to "
        "dF/dt; the comparison of y with the solution of the equation; a flock that left would have to pass U* + ΔH, "
        "where E < ΔH"
    ),
    rigour="symbolic",
    steps=_steps,
    size=3,
    theorems=("disturbed-basin",),
)
