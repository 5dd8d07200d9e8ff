"""Theorems 1(iii) and 3(iv): what energy says of collisions, at one instant; over time it says less (`distinct_pairs`).

Of the pair potential only the signs of φ_α are used, so that what is proved holds for all its parameters; of time, only
that the energy does not rise. A sum over pairs is N coincident ones and the rest of them.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.energy import algorithm1_identity, structural_identity
from flockana.symbolic.generic_pair import PSI
from flockana.symbolic.parameter_symbols import GAINS
from flockana.symbolic.sums_over_pairs import LAMBDA as WEIGHT
from flockana.symbolic.sums_over_pairs import V as VELOCITY
from flockana.symbolic.sums_over_pairs import X, Z, structural_hamiltonian, write_out
from proofs.proof import Proof, Step
from proofs.signs_of_phi import potential_signs
from proofs.smt import implication, real

C1, C_STAR, LAMBDA, H, H0 = z3.Reals("c1_alpha c_star lambda H H_0")
TOGETHER, REST = z3.Reals("N rest")  # coincident pairs, what the other pairs add to V
SQUARES = z3.Reals("x_1_squared x_2_squared v_1_squared v_2_squared")
# all that is known at time t: V is c* for each coincident pair and at least 0 for each other one
STATE = (C1 > 0, C_STAR > 0, LAMBDA >= 0, TOGETHER >= 0, REST >= 0, *(one >= 0 for one in SQUARES))


def hamiltonian() -> z3.ArithRef:
    """H_λ as the library has it, of two agents on a line, the pair's ψ standing for that of all pairs."""
    symbols = (X[1, 1], X[2, 1], VELOCITY[1, 1], VELOCITY[2, 1])
    squares = {symbol**2: one for symbol, one in zip(symbols, SQUARES, strict=True)}
    pairs = {PSI(Z[1, 2]): TOGETHER * C_STAR + REST}
    return real(write_out(structural_hamiltonian(1), 2), {**squares, **pairs, GAINS.c1_alpha: C1, WEIGHT: LAMBDA})


ENERGY = (hamiltonian() == H, H <= H0)


def _energy_falls() -> Iterator[Step]:
    rate, speed, consensus, c2_gamma, c2_alpha = z3.Reals("rate speed_squared vLv c2_gamma c2_alpha")
    for m in (1, 2, 3):
        yield Step(
            f"m = {m}: dH/dt = -c2α vᵀL̂v under Algorithm 1, dH_λ/dt = -c2γ‖v‖² - c2α vᵀL̂v under Algorithm 2",
            algorithm1_identity(m).holds and structural_identity(m).holds,
            evidence="lifted from one pair to all in the proof energy-identities",
        )
    yield implication(
        "neither energy rises: H(t) <= H(0) as long as the solution lasts",
        rate <= 0,
        *(c2_gamma >= 0, c2_alpha >= 0, speed >= 0, consensus >= 0, rate == -c2_gamma * speed - c2_alpha * consensus),
    )
    yield implication(
        "which is for ever: velocities stay bounded, K(v) <= H(0), and the right-hand side is Lipschitz where they are",
        SQUARES[2] + SQUARES[3] <= 2 * H0,
        *(*STATE, *ENERGY),
    )


def at_most(k: z3.ArithRef, text: str, *, budget: z3.ArithRef) -> Step:
    """The step that fewer than k + 1 pairs coincide while H(0) is below `budget`; of whole numbers, at most k."""
    fewer, below = z3.Not(k + 1 <= TOGETHER), z3.Not(budget <= H0)
    return implication(
        text,
        fewer,
        *(*STATE, *ENERGY, k >= 0, below),
        latex=r"N(t)\,c_1^\alpha c^* \le c_1^\alpha V + \lambda J + K = H_\lambda(t) \le H_\lambda(0) < (k+1)\,"
        r"c_1^\alpha c^* \implies N(t) \le k",
    )


def _instant() -> Iterator[Step]:
    k = z3.Real("k")
    yield at_most(
        k,
        "H(0) < (k + 1) c1α c* leaves N < k + 1 coincident pairs at each time: at most k of them",
        budget=(k + 1) * C1 * C_STAR,
    )
    yield implication(
        "k = 0: N < 1 and N is a whole number, so that no two agents ever coincide (Theorem 1(iii), with λ = 0)",
        TOGETHER < 1,
        *(*STATE, *ENERGY, H0 < C1 * C_STAR),
        latex=r"H(0) < c_1^\alpha c^* \implies q_i(t) \ne q_j(t) \quad \forall\, i \ne j,\ t \ge 0",
    )
    yield implication(
        "and at time t it is H(t) that counts: at most ⌊H(t)/(c1α c*)⌋ pairs coincide then",
        TOGETHER * C1 * C_STAR <= H,
        *(*STATE, *ENERGY),
    )


def _clusters() -> Step:
    size = sp.Symbol("j", integer=True, positive=True)
    pair = sp.Symbol("i", integer=True, positive=True)
    return Step(
        "j agents in one place are j(j - 1)/2 coincident pairs: they need that many c1α c*",
        sp.simplify(sp.summation(pair - 1, (pair, 1, size)) - size * (size - 1) / 2) == 0,
        r"\tbinom{j}{2}\, c_1^\alpha c^* \le H(0)",
    )


def _steps() -> Iterator[Step]:
    yield from _energy_falls()
    yield from potential_signs()  # so that c* = ψ_α(0) > 0, and no pair adds less than 0
    yield from _instant()
    yield _clusters()


PROOF = Proof(
    id="collisions",
    title="Theorems 1(iii), 3(iv): collisions at one instant",
    statement=(
        "Under Algorithms 1 and 2, while H(0) < (k + 1) c1α c* (H_λ under Algorithm 2), at most k pairs of agents "
        "coincide at any one time, indeed at most H(t)/(c1α c*) at time t; with k = 0 no two agents ever do. For every "
        "n, and m = 1, 2, 3."
    ),
    hypotheses="c1α > 0, other gains >= 0 and common to all agents; 0 < a <= b, 0 < h < 1, 0 < d < r, ε > 0",
    rigour="smt",
    steps=_steps,
    size=18,
    theorems=("os-1", "os-3", "E4", "E13"),
)
