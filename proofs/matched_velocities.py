"""Velocities match in the limit: an energy that falls by what moves, forces that are bounded, and Barbalat's lemma.

One argument serves Algorithm 2, Algorithm 1 below the energy of a disconnected state, a minority of informed agents,
and potentials along a connected net. Barbalat's lemma itself is cited: a function with a finite integral over all later
times whose slope is bounded tends to 0. All that it is applied to is checked here.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.energy import algorithm1_identity, structural_identity
from flockana.symbolic.matching import matching_identity
from proofs.cohesion import hamiltonian
from proofs.proof import Proof, Step
from proofs.signs_of_phi import potential_lemma
from proofs.smt import implication

H, H0, RATE, TOTAL, C = z3.Reals("H H_0 rate integral c")


def _integral() -> Iterator[Step]:
    yield implication(
        "an energy H >= 0 that falls at c y² at least, c > 0, leaves ∫ y² dt <= H(0)/c, however long the time",
        C * TOTAL <= H0,
        *(H >= 0, C > 0, H <= H0 - C * TOTAL),
        latex=r"0 \le H(t) \le H(0) - c\int_0^t y^2\,ds \implies \int_0^\infty y^2\,ds \le H(0)/c",
    )
    slope, speed, push, fast, hard = z3.Reals("slope speed push speed_max push_max")
    yield implication(
        "and y² = ‖v‖² has a bounded slope where speeds and accelerations are bounded: |d‖v‖²/dt| <= 2 ‖v‖ ‖v'‖",
        slope <= 2 * fast * hard,
        *(speed >= 0, speed <= fast, push >= 0, push <= hard, slope <= 2 * speed * push),
        latex=r"\Bigl|\tfrac{d}{dt}\|v\|^2\Bigr| \le 2\|v\|\,\|\dot v\| \le 2 S A \implies \|v\|^2 \to 0",
    )


def _algorithm_2() -> Iterator[Step]:
    squared, consensus, c2, c2_alpha = z3.Reals("v_squared vLv c2_gamma c2_alpha")
    for m in (1, 2, 3):
        yield Step(f"Algorithm 2, m = {m}: dH_λ/dt = -c2γ‖v‖² - c2α vᵀL̂v", structural_identity(m).holds)
    yield implication(
        "so H_λ falls at c2γ‖v‖² at least",
        -c2 * squared >= RATE,
        *(-c2 * squared - c2_alpha * consensus == RATE, c2_alpha >= 0, consensus >= 0, squared >= 0),
    )
    c1, c1_alpha = z3.Reals("c1_gamma c1_alpha")
    parts = (c1 > 0, c1_alpha >= 0, potential_lemma().then())
    own, rest, mine, others = z3.Reals("x_i_squared rest v_i_squared others_v_squared")
    sizes = (own >= 0, rest >= 0, mine >= 0, others >= 0)
    yield implication("and H_λ >= 0", H >= 0, *parts, *sizes, hamiltonian() == H)
    yield implication(
        "‖x_i‖² <= 2H_λ(0)/c1γ and ‖v‖² <= 2H_λ(0) at all times",
        z3.And(c1 * own <= 2 * H0, mine + others <= 2 * H0),
        *(*parts, *sizes, hamiltonian() == H, H <= H0),
    )
    n, force, pull, gap, x, v, u, far, fast = z3.Reals("n force c1 gap x v u x_max v_max")
    yield implication(
        "a pair's force is below F and its adjacency at most 1, so ‖v_i'‖ <= (n-1)(c1α F + 2 c2α S) + c1γ R + c2γ S",
        u <= (n - 1) * (c1_alpha * force + 2 * c2_alpha * fast) + pull * far + c2 * fast,
        *(n >= 1, force >= 0, c1_alpha >= 0, c2_alpha >= 0, pull >= 0, c2 >= 0),
        *(gap >= 0, gap <= 2 * fast, x >= 0, x <= far, v >= 0, v <= fast),
        u <= (n - 1) * (c1_alpha * force + c2_alpha * gap) + pull * x + c2 * v,
    )


def _paths() -> Iterator[Step]:
    """A connected net ties all velocities together: what differs anywhere differs along a link."""
    yield from (over_links(count, count) for count in (1, 2, 3, 4, 5))
    total, along, spread, n = z3.Reals("total along spread n")
    yield implication(
        "so on a connected net of n agents each ‖v_i - v_j‖² <= (n - 1) Σ over links, and n‖v‖² = Σ_i<j <= n(n-1)²/2 Σ",
        2 * spread <= (n - 1) * (n - 1) * along,
        *(n >= 2, along >= 0, 2 * n * spread <= n * (n - 1) * total, total <= (n - 1) * along),
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


def over_links(count: int, factor: int) -> Step:
    """Cauchy's inequality along a path of links, for a factor."""
    steps = sp.symbols(f"d_1:{count + 1}", real=True)
    squares = sp.Add(*((a - b) ** 2 for k, a in enumerate(steps) for b in steps[:k]))
    left = factor * sp.Add(*(d**2 for d in steps)) - sp.Add(*steps) ** 2
    return Step(
        f"over {count} links (Σ d_k)² = {factor} Σ d_k² - Σ_k<l (d_k - d_l)² <= {factor} Σ d_k²",
        sp.expand(left - squares) == 0,
    )


def _algorithm_1() -> Iterator[Step]:
    for m in (1, 2, 3):
        yield Step(f"Algorithm 1, m = {m}: dH/dt = -c2α pᵀL̂p", algorithm1_identity(m).holds)
    n, psi, energy, c1 = z3.Reals("n psi_far H c1_alpha")
    yield cut(1)
    pairs = z3.Real("pairs")
    yield implication(
        "so a disconnected state has H >= (n - 1) c1α ψ_α(r_α): below it no solution from there is ever disconnected",
        energy >= (n - 1) * c1 * psi,
        *(n >= 2, pairs >= n - 1, psi > 0, c1 > 0, energy >= pairs * c1 * psi),
    )
    least, near = z3.Reals("psi_near H_0")
    yield implication(
        "with H(0) < (n - 1) c1α ψ_α(r_α) strictly, also below (n - 1) c1α ψ_α(z) for some z < r_α, as ψ_α is "
        "continuous: the net of pairs nearer than that stays connected, and there a_ij >= ρ_h(z/r_α) > 0",
        near < (n - 1) * c1 * (psi - least),
        *(n >= 2, c1 > 0, psi > 0, least > 0, near < (n - 1) * c1 * psi),
        *(2 * (n - 1) * c1 * least == (n - 1) * c1 * psi - near,),
    )


def _nets() -> Iterator[Step]:
    for m in (1, 2, 3):
        identity = matching_identity(m, potential=True)
        yield Step(f"potentials along links, m = {m}: dH/dt = -k₂ Σ over links ‖p_j - p_i‖²", identity.holds)
    s = sp.Symbol("s", positive=True)
    well = 1 / s**2 - 1 + sp.log(s**2)
    yield Step(
        "V/k = d²/s² - 1 + log(s²/d²) is unbounded at contact and at infinity: H(0) keeps links away from both",
        sp.limit(well, s, 0, "+") == sp.oo and sp.limit(well, s, sp.oo) == sp.oo,
        r"V(s)/k = d^2/s^2 - 1 + \log(s^2/d^2)",
    )
    slope = sp.diff(well, s)
    yield Step(
        "on every closed interval of such lengths V is smooth: forces are bounded, also those that a range cuts "
        "off; so are their rates on a fixed net",
        sp.simplify(slope - 2 * (s**2 - 1) / s**3) == 0,
        sp.latex(sp.factor(slope)),
    )
    total, one, other, force, gap = z3.Reals("sum u_i u_j force gap")
    yield implication(
        "once velocities match and Barbalat is applied to them again, accelerations of linked agents agree; their sum "
        "is 0, so each is 0, and with it each force of the potentials",
        z3.And(one == 0, other == 0, force == 0),
        *(one == other, one + other == total, total == 0, gap == 0, one == force + gap),
    )


def _steps() -> Iterator[Step]:
    for part in (_integral, _algorithm_2, _paths, _algorithm_1, _nets):
        yield from part()


PROOF = Proof(
    id="matched-velocities",
    title="Velocities match in the limit (Theorems 1(ii), 3(iii), Tanner's fixed net, Su's informed agents)",
    statement=(
        "Under Algorithm 2 all velocities tend to that of the centre of mass, from every start, for every n and m = 1, "
        "2, 3. So they do under Algorithm 1 if H(0) < (n - 1) c1α ψ_α(r_α), which also keeps every solution from there "
        "connected; along a net of proximity that stays connected, whose forces may jump; and along a fixed "
        "connected net, where all forces tend to 0 as well, both with Tanner's potentials. "
        "Informed agents take on a steady leader's velocity: they are the agents whose ‖p_i‖² the energy falls by."
    ),
    hypotheses=(
        "c1γ, c2γ > 0 under Algorithm 2, c1α, c2α > 0 under Algorithm 1, k, k₂ > 0 along a net; 0 < a <= b, 0 < h < 1, "
        "0 < d < r, ε > 0. Barbalat's lemma is cited"
    ),
    rigour="smt",
    steps=_steps,
    size=27,
    theorems=("os-1", "os-3", "su-informed", "tanner-fixed", "tanner-switching"),
    cites=("Barbalat",),
)
