"""Theorems 1 and 3 for every pair potential with the properties that their proofs use.

The properties: ψ is C¹ on (0, r] and constant from r on, L <= ψ for some number L, and a_ij >= 0; for Algorithm 1 also
a_ij > 0 below r. The paper's ψ_α has them with L = 0. All is said of E = H - c1α L n(n - 1)/2, the energy above the
least that all pairs together can have. Where the force has no limit at contact, solutions are Filippov's.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.energy import algorithm1_identity, structural_identity
from flockana.symbolic.generic_pair import PSI
from flockana.symbolic.parameter_symbols import GAINS
from flockana.symbolic.sums_over_pairs import V as VELOCITY
from flockana.symbolic.sums_over_pairs import X, Z, structural_hamiltonian, write_out
from proofs.proof import Proof, Step
from proofs.smt import implication, real

C1, C1_ALPHA, C2, C2_ALPHA, H, H0, FLOOR = z3.Reals("c1_gamma c1_alpha c2_gamma c2_alpha H H_0 floor")
OWN, REST, OWN_SPEED, OTHER_SPEEDS = z3.Reals("x_i_squared rest v_i_squared others_v_squared")
V = z3.Real("V")  # Σ ψ over all pairs
SIZES = tuple(one >= 0 for one in (OWN, REST, OWN_SPEED, OTHER_SPEEDS))
LOW = C1_ALPHA * V >= FLOOR  # as every pair has L at least


def hamiltonian() -> z3.ArithRef:
    """H_λ as the library has it, of two agents on a line: the second stands for all others, the pair for all pairs."""
    squares = {X[1, 1] ** 2: OWN, X[2, 1] ** 2: REST, VELOCITY[1, 1] ** 2: OWN_SPEED, VELOCITY[2, 1] ** 2: OTHER_SPEEDS}
    names = {**squares, GAINS.c1_gamma: C1, GAINS.c1_alpha: C1_ALPHA, PSI(Z[1, 2]): V}
    return real(write_out(structural_hamiltonian(1, lambda_=GAINS.c1_gamma), 2), names)


def energy_falls() -> Iterator[Step]:
    """dH/dt of both algorithms, for undefined ψ and a, and its sign."""
    for m in (1, 2, 3):
        one, two = algorithm1_identity(m).holds, structural_identity(m).holds
        yield Step(
            f"m = {m}, any ψ and a: dH/dt = -c2α pᵀL̂p under Algorithm 1, dH_λ/dt = -c2γ‖v‖² - c2α vᵀL̂v under 2",
            one and two,
        )
    rate, squared, consensus = z3.Reals("rate v_squared vLv")
    yield implication(
        "a_ij >= 0 leaves vᵀL̂v >= 0: the energy never rises, and under Algorithm 2 it falls at c2γ‖v‖² at least",
        z3.And(rate <= 0, -rate >= C2 * squared),
        *(rate == -C2 * squared - C2_ALPHA * consensus, C2 >= 0, C2_ALPHA >= 0, consensus >= 0, squared >= 0),
    )
    work, force, gap = z3.Reals("work force gap")
    yield implication(
        "two agents that stay at one place have v_j = v_i almost always: whatever force acts there does no work",
        work == 0,
        *(work == force * gap, gap == 0),
    )


def _floor() -> Iterator[Step]:
    total, pairs, least = z3.Reals("total pairs L")
    yield implication(
        "ψ >= L for each of n(n - 1)/2 pairs: c1α V >= c1α L n(n - 1)/2",
        C1_ALPHA * total >= C1_ALPHA * least * pairs,
        *(C1_ALPHA >= 0, pairs >= 0, total >= least * pairs),
    )
    yield implication("so E = H - floor >= 0", H >= FLOOR, LOW, C1 >= 0, *SIZES, hamiltonian() == H)


def cohesive(factor: int) -> Step:
    """Cohesion under Algorithm 2 with its bound: 2 E(0)/c1γ is right, less is not."""
    return implication(
        f"c1γ‖x_i‖² <= {factor} E(0) at all times: R <= √({factor} E(0)/c1γ)",
        factor * (H0 - FLOOR) >= C1 * OWN,
        *(C1 > 0, LOW, *SIZES, hamiltonian() == H, H <= H0),
        latex=r"R(t) \le \sqrt{2\,(H_\lambda(0) - c_1^\alpha L\, n(n-1)/2)\,/\,c_1^\gamma}",
    )


def _speeds() -> Iterator[Step]:
    yield implication(
        "‖v‖² <= 2 E(0)",
        OWN_SPEED + OTHER_SPEEDS <= 2 * (H0 - FLOOR),
        *(C1 >= 0, LOW, *SIZES, hamiltonian() == H, H <= H0),
    )


def cut(less: int) -> Step:
    """A cut of n agents leaves n less so many pairs out of range."""
    n, k = z3.Reals("n k")
    return implication(
        f"a cut leaves k(n - k) >= n - {less} pairs out of range",
        k * (n - k) >= n - less,
        *(k >= 1, n - k >= 1),
        latex=r"k(n-k) - (n-1) = (k-1)(n-k-1) \ge 0",
    )


def connected() -> Iterator[Step]:
    """A flock that has too little energy to part stays one, and bounded."""
    yield cut(1)
    n, pairs, out, far, near, least, total = z3.Reals("n pairs out psi_far psi_near L V")
    above = C1_ALPHA * (total - least * pairs)
    yield implication(
        "so a disconnected state has E >= (n - 1) c1α(ψ(r) - L), and no solution from below it is ever disconnected",
        above >= (n - 1) * C1_ALPHA * (far - least),
        *(C1_ALPHA > 0, far >= least, out >= n - 1, out <= pairs, total >= out * far + (pairs - out) * least),
    )
    yield implication(
        "E(0) strictly below it is also below (n - 1) c1α(ψ(s) - L) for some s < r, as ψ is continuous: pairs nearer "
        "than s join all agents, in the limit too",
        (n - 1) * C1_ALPHA * (near - least) > H0 - FLOOR,
        *(n >= 2, C1_ALPHA > 0, (n - 1) * C1_ALPHA * (far - least) > H0 - FLOOR),
        2 * (n - 1) * C1_ALPHA * (far - near) == (n - 1) * C1_ALPHA * (far - least) - (H0 - FLOOR),
    )
    agents = sp.Symbol("n", positive=True, integer=True)
    step = sp.Symbol("k", integer=True, nonnegative=True)
    yield Step(
        "connected flocks stay bounded: ‖x_i‖ is at most the mean of the distances from i, below (0 + ... + n - 1) r/n",
        sp.simplify(sp.summation(step, (step, 0, agents - 1)) / agents - (agents - 1) / 2) == 0,
        r"R \le \tfrac{n-1}{2}\, r",
    )


def _collisions() -> Iterator[Step]:
    count, top, least, others = z3.Reals("N psi_0 L others")
    alone = C1_ALPHA * (top - least)  # c*
    yield implication(
        "N coincident pairs have N c*, c* = c1α(ψ(0) - L): at most ⌊E/c*⌋ pairs coincide at one time",
        count * alone <= H0 - FLOOR,
        *(count >= 0, others >= 0, count * alone + others <= H - FLOOR, H <= H0),
    )
    yield implication(
        "with E(0) < c*, and so with ψ(0) = ∞, none ever do",
        count < 1,
        *(count >= 0, others >= 0, count * alone + others <= H - FLOOR, H <= H0, H >= FLOOR, alone > H0 - FLOOR),
    )


def _steps() -> Iterator[Step]:
    yield from energy_falls()
    yield from _floor()
    yield cohesive(2)
    for part in (_speeds, connected, _collisions):
        yield from part()


PROOF = Proof(
    id="any-potential",
    title="Theorems 1 and 3 for every pair potential: cohesion and collisions",
    statement=(
        "Let E be the energy above the least that all pairs can have. Under Algorithm 2 R <= √(2 E(0)/c1γ). Under "
        "Algorithm 1 a flock with E(0) < (n - 1) c1α(ψ(r) - L) stays connected. At most ⌊E/c*⌋ pairs coincide at one "
        "time, c* = c1α(ψ(0) - L); none ever do if E(0) < c*. For every n and m = 1, 2, 3."
    ),
    hypotheses=(
        "ψ is C¹ on (0, r], constant from r on, ψ >= L; a_ij >= 0; c1α, c2α >= 0, c1γ > 0, c2γ >= 0 under Algorithm 2; "
        "c1α > 0 for the rest"
    ),
    rigour="smt",
    steps=_steps,
    size=15,
    theorems=("os-1", "os-3", "any-potential", "E4"),
)
