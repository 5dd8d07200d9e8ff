"""Theorem 3(i) with its constant: the moving-frame energy of Algorithm 2 keeps the flock within an explicit radius."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.energy import structural_identity
from flockana.symbolic.generic_pair import PSI
from flockana.symbolic.parameter_symbols import GAINS
from flockana.symbolic.sums_over_pairs import V as VELOCITY
from flockana.symbolic.sums_over_pairs import X, Z, structural_hamiltonian, write_out
from proofs.proof import Proof, Step
from proofs.signs_of_phi import PAIR, potential_lemma, potential_signs
from proofs.smt import Lemma, implication, lemma, real

C1, C1_ALPHA, C2, C2_ALPHA, H, H0 = z3.Reals("c1_gamma c1_alpha c2_gamma c2_alpha H H_0")
OWN, REST, N = z3.Reals("x_i_squared rest n")  # ‖x_i‖², Σ_{k≠i} ‖x_k‖², number of agents
OWN_SPEED, OTHER_SPEEDS = z3.Reals("v_i_squared others_v_squared")


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


def hamiltonian() -> z3.ArithRef:
    """H_λ as the library has it, of two agents on a line: the second stands for all others, the pair for all pairs."""
    squares = {X[1, 1] ** 2: OWN, X[2, 1] ** 2: REST}
    speeds = {VELOCITY[1, 1] ** 2: OWN_SPEED, VELOCITY[2, 1] ** 2: OTHER_SPEEDS}
    names = {**squares, **speeds, GAINS.c1_gamma: C1, GAINS.c1_alpha: C1_ALPHA, PSI(Z[1, 2]): PAIR}
    return real(write_out(structural_hamiltonian(1, lambda_=GAINS.c1_gamma), 2), names)


def others_lemma() -> Lemma:
    """What the others' squares are at least, as all positions add up to 0."""
    spread, mean = z3.Reals("spread mean_squared")
    return lemma(
        "Σ_k x_k = 0: the others, n - 1 of them about their mean s = -x_i/(n - 1), have Σ_{k≠i} ‖x_k‖² >= "
        "‖x_i‖²/(n - 1)",
        (N - 1) * REST >= OWN,
        *(N >= 2, spread >= 0, mean >= 0, spread + (N - 1) * mean == REST, (N - 1) ** 2 * mean == OWN),
        latex=r"\sum_{k\ne i}\|x_k\|^2 = \sum_{k\ne i}\|x_k - s\|^2 + (n-1)\|s\|^2 \ge (n-1)\|s\|^2 = "
        r"\frac{\|x_i\|^2}{n-1}, \qquad s = \frac{1}{n-1}\sum_{k\ne i} x_k = -\frac{x_i}{n-1}",
    )


def _radius() -> Iterator[Step]:
    speeds = (OWN_SPEED >= 0, OTHER_SPEEDS >= 0)
    places = (C1 > 0, C1_ALPHA >= 0, potential_lemma().then(), OWN >= 0, REST >= 0)
    known = (*places, *speeds, hamiltonian() == H, H <= H0)
    yield implication(
        "V >= 0, K >= 0 and J = ½Σ‖x_k‖² leave ½ c1γ ‖x_i‖² <= H_λ(0) for each agent i",
        C1 * OWN <= 2 * H0,
        *known,
        latex=r"\tfrac12 c_1^\gamma\,\|x_i\|^2 \le \lambda J(x) \le H_\lambda(t) \le H_\lambda(0) \implies "
        r"R(t) \le \sqrt{2 H_\lambda(0)/c_1^\gamma}",
    )
    yield implication(
        "and ½‖v‖² <= H_λ(0): velocities stay bounded too, so that the solution exists for all t",
        OWN_SPEED + OTHER_SPEEDS <= 2 * H0,
        *known,
    )
    count, own = sp.symbols("n x")
    yield Step(
        "the mean of the others is -x_i/(n - 1), and squares about a mean add up with it",
        sp.simplify((count - 1) ** 2 * (-own / (count - 1)) ** 2 - own**2) == 0,
        r"\|x_i\|^2 = (n-1)^2\,\|s\|^2",
    )
    others = others_lemma()
    yield others.step
    yield implication(
        "which makes it sharper by √(1 - 1/n)",
        C1 * N * OWN <= 2 * (N - 1) * H0,
        *(*known, N >= 2, others.then()),
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
    size=18,
    theorems=("os-3",),
)
