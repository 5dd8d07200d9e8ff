"""Theorem 3(i) with its constant: the moving-frame energy of Algorithm 2 keeps the flock within an explicit radius."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.energy import structural_identity
from proofs.proof import Proof, Step
from proofs.signs_of_phi import potential_signs
from proofs.smt import implication

C1, C2, C2_ALPHA, H, H0, V, K = z3.Reals("c1_gamma c2_gamma c2_alpha H H_0 V K")
OWN, REST, N = z3.Reals("x_i_squared rest n")  # ‖x_i‖², Σ_{k≠i} ‖x_k‖², number of agents


def _energy() -> Iterator[Step]:
    for m in (1, 2, 3):
        identity = structural_identity(m)
        yield Step(
            f"m = {m}: dH_λ/dt = -c2γ‖v‖² - c2α vᵀL̂v, λ = c1γ",
            identity.holds,
            identity.latex() if m == 2 else "",
        )
    speed, consensus, a_ij, gap, rate = z3.Reals("speed_squared vLv a_ij gap rate")
    yield implication(
        "so H_λ never rises: ‖v‖² >= 0, and each pair adds a_ij ‖v_j - v_i‖² >= 0 to vᵀL̂v",
        z3.And(rate <= 0, a_ij * gap**2 >= 0),
        *(C2 >= 0, C2_ALPHA >= 0, speed >= 0, consensus >= 0, a_ij >= 0, rate == -C2 * speed - C2_ALPHA * consensus),
        latex=r"H_\lambda(t) \le H_\lambda(0)",
    )


def _radius() -> Iterator[Step]:
    known = (C1 > 0, V >= 0, K >= 0, OWN >= 0, REST >= 0, H == V + C1 * (OWN + REST) / 2 + K, H <= H0)
    yield implication(
        "V >= 0, K >= 0 and J = ½Σ‖x_k‖² leave ½ c1γ ‖x_i‖² <= H_λ(0) for each agent i",
        C1 * OWN <= 2 * H0,
        *known,
        latex=r"\tfrac12 c_1^\gamma\,\|x_i\|^2 \le \lambda J(x) \le H_\lambda(t) \le H_\lambda(0) \implies "
        r"R(t) \le \sqrt{2 H_\lambda(0)/c_1^\gamma}",
    )
    yield implication(
        "and K(v) <= H_λ(0): velocities stay bounded too, so that the solution exists for all t", K <= H0, *known
    )
    count, others = sp.symbols("n s")  # s: the others' mean position, one component
    spread = (count - 1) * others**2  # the least of Σ_{k≠i} x_k² for that mean, as squares of deviations are >= 0
    own = -(count - 1) * others  # Σ_k x_k = 0
    yield Step(
        "Σ_k x_k = 0: the others, n - 1 of them, have Σ_{k≠i} ‖x_k‖² >= ‖x_i‖²/(n - 1)",
        sp.simplify(spread - own**2 / (count - 1)) == 0,
        r"\sum_{k\ne i}\|x_k\|^2 = \sum_{k\ne i}\|x_k - s\|^2 + (n-1)\|s\|^2 \ge (n-1)\|s\|^2 = "
        r"\frac{\|x_i\|^2}{n-1}, \qquad s = \frac{1}{n-1}\sum_{k\ne i} x_k = -\frac{x_i}{n-1}",
    )
    yield implication(
        "which makes it sharper by √(1 - 1/n)",
        C1 * N * OWN <= 2 * (N - 1) * H0,
        *(*known, N >= 2, (N - 1) * REST >= OWN),
        latex=r"R(t) \le \sqrt{\Bigl(1 - \frac1n\Bigr)\frac{2 H_\lambda(0)}{c_1^\gamma}}",
    )


def _steps() -> Iterator[Step]:
    yield from _energy()
    yield from potential_signs()
    yield from _radius()


PROOF = Proof(
    id="cohesion",
    title="Theorem 3(i): cohesion, with its radius",
    statement=(
        "Under Algorithm 2, R(t) = max ‖q_i - q_c‖ <= √(2 H_λ(0)/c1γ) for all t >= 0, and indeed √(1 - 1/n) of it, for "
        "every n and m = 1, 2, 3."
    ),
    hypotheses="c1γ > 0, c2γ >= 0, c2α >= 0, c1α >= 0; 0 < a <= b, 0 < h < 1, 0 < d < r, ε > 0",
    rigour="smt",
    steps=_steps,
    size=16,
    theorems=("os-3",),
)
