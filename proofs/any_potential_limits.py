"""Theorems 1(ii) and 3(iii) for every pair potential: velocities match, and forces tend to 0.

What is asked of the potential, and E, the energy above the least of all pairs, are as in `any_potential`.
Two theorems are cited: Barbalat's lemma, that a function with a finite integral over all later times whose slope is
bounded tends to 0; and LaSalle's principle. What they are applied to is checked here.
"""

from __future__ import annotations

from collections.abc import Iterator

import z3

from proofs.any_potential import C1, C1_ALPHA, C2, C2_ALPHA, FLOOR, H0, connected, energy_falls
from proofs.proof import Proof, Step
from proofs.smt import implication


def _apart() -> Iterator[Step]:
    one, others, least, near = z3.Reals("psi_ij others L psi_near")
    yield implication(
        "a pair has c1α(ψ - L) <= E(0): if one at s₁ and nearer has more, none comes so near, and F is the largest "
        "force on [s₁, r]",
        one < near,
        *(C1_ALPHA > 0, C1_ALPHA * (one - least) + others <= H0 - FLOOR, others >= 0),
        C1_ALPHA * (near - least) > H0 - FLOOR,
    )


def bounded_push() -> Step:
    """The bound of an agent's acceleration from bounds of forces, weights, distances and speeds."""
    n, force, weight, x, v, u, far, fast, gap = z3.Reals("n F A x v u R S gap")
    return implication(
        "forces are at most F and weights at most A, so ‖v_i'‖ <= (n-1)(c1α F + 2 c2α A S) + c1γ R + c2γ S",
        u <= (n - 1) * (C1_ALPHA * force + 2 * C2_ALPHA * weight * fast) + C1 * far + C2 * fast,
        *(n >= 1, force >= 0, weight >= 0, C1_ALPHA >= 0, C2_ALPHA >= 0, C1 >= 0, C2 >= 0),
        *(gap >= 0, gap <= 2 * fast, x >= 0, x <= far, v >= 0, v <= fast),
        u <= (n - 1) * (C1_ALPHA * force + C2_ALPHA * weight * gap) + C1 * x + C2 * v,
    )


def integral() -> Iterator[Step]:
    """What Barbalat's lemma is applied to: ∫‖v‖² is finite, and ‖v‖² has a bounded slope."""
    energy, start, c, total = z3.Reals("E E_0 c integral")
    yield implication(
        "an energy E >= 0 that falls at c y² at least, c > 0, leaves ∫ y² dt <= E(0)/c, however long the time",
        c * total <= start,
        *(energy >= 0, c > 0, energy <= start - c * total),
        latex=r"0 \le E(t) \le E(0) - c\int_0^t y^2\,ds \implies \int_0^\infty y^2\,ds \le E(0)/c",
    )
    slope, speed, push, fast, hard = z3.Reals("slope speed push speed_max push_max")
    yield implication(
        "and y² = ‖v‖² has a bounded slope where speeds and accelerations are bounded: |d‖v‖²/dt| <= 2 ‖v‖ ‖v'‖",
        slope <= 2 * fast * hard,
        *(speed >= 0, speed <= fast, push >= 0, push <= hard, slope <= 2 * speed * push),
        latex=r"\Bigl|\tfrac{d}{dt}\|v\|^2\Bigr| \le 2\|v\|\,\|\dot v\| \le 2 S A \implies \|v\|^2 \to 0",
    )


def _invariant() -> Iterator[Step]:
    a, square, rest = z3.Reals("a_ij square rest")
    yield implication(
        "LaSalle: H has one value on the limit set, which is compact and invariant; there vᵀL̂v = 0, so a_ij > 0 along "
        "a link leaves ‖v_j - v_i‖² = 0, as being at one place does. Its states are flocks: by the energy, or by the "
        "hypothesis on all solutions from Ω_c, which is closed and holds them",
        square == 0,
        *(a > 0, square >= 0, rest >= 0, a * square + rest == 0),
    )
    n, common, total = z3.Reals("n v sum")
    yield implication(
        "links join all agents, so that one velocity is everybody's; their sum is 0, and so is each",
        common == 0,
        *(n >= 1, total == n * common, total == 0),
    )


def _critical() -> Iterator[Step]:
    slope, push, drag = z3.Reals("grad_U v_prime drag")
    yield implication(
        "Barbalat again: v' = -∇U - D v, where D v -> 0 and ∇U is uniformly continuous along the solution, so v' -> 0; "
        "in the limit no force is left",
        slope == 0,
        *(push == -slope - drag, push == 0, drag == 0),
        latex=r"v \to 0,\ \dot v \to 0 \implies \nabla U(x) \to 0",
    )


def _steps() -> Iterator[Step]:
    yield from energy_falls()
    yield from _apart()
    yield bounded_push()
    for part in (integral, connected, _invariant, _critical):
        yield from part()


PROOF = Proof(
    id="any-potential-limits",
    title="Theorems 1(ii) and 3(iii) for every pair potential: velocities match, forces tend to 0",
    statement=(
        "Under Algorithm 2 all velocities tend to that of the centre of mass, from every start. Under Algorithm 1 they "
        "do so if every solution from Ω_c is a cohesive flock, as printed; and of each solution with E(0) < "
        "(n - 1) c1α(ψ(r) - L), which makes it stay one. Where forces are continuous they tend to 0 as well. For "
        "every n and m = 1, 2, 3."
    ),
    hypotheses=(
        "ψ is C¹ on (0, r], constant from r on, ψ >= L; a_ij >= 0, and a_ij > 0 below r for Algorithm 1; E(0) < c*, or "
        "force and weight bounded at contact. c1α, c2α >= 0, c1γ, c2γ > 0 under Algorithm 2; c1α, c2α > 0 under "
        "Algorithm 1. Barbalat's lemma and LaSalle's principle are cited"
    ),
    rigour="smt",
    steps=_steps,
    size=16,
    theorems=("os-1", "os-3", "any-potential"),
    cites=("Barbalat", "LaSalle"),
)
