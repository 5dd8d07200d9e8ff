"""Theorem 1(iii) and beyond: what energy two coincident agents among n cost at least; E4's count with whole numbers."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import z3
from flint import ctx

from flockana.certified.balls import AlphaParameters, ball
from flockana.certified.decimal_rounding import interval
from flockana.certified.scalar_functions_in_balls import c_star, far_potential
from flockana.equilibria.energy_barrier import turan_pairs
from flockana.laws.olfati_saber import Algorithm1
from flockana.symbolic.energy import algorithm1_identity
from proofs.n_max import SPACE, shortest_bound
from proofs.point_ratios import DIMENSIONS, cited, largest_clique, radon_points
from proofs.proof import Proof, Step
from proofs.signs_of_phi import PAIR, potential_lemma, potential_signs
from proofs.smt import implication, lemma

DIGITS = 30
MOST = 60  # agents for which the count is compared with the library's
CLIQUES = range(1, 7)
STATED = {"agents": str(MOST)}


@cache
def unbound(n: int, clique: int) -> int:
    """Pairs not bound among n agents, at least, no more than `clique` being pairwise bound: by the induction."""
    if n <= 1:
        return 0
    return min((n - s) + unbound(n - s, clique) for s in range(1, min(n, clique) + 1))


def counts_agree(most: int, clique: int) -> bool:
    """Whether the induction gives the library's count, all pairs but Turán's, up to so many agents."""
    return all(unbound(n, clique) == n * (n - 1) // 2 - turan_pairs(n, clique) for n in range(1, most + 1))


def _away() -> Iterator[Step]:
    total, own, others, floor, gain, energy, start, kinetic = z3.Reals("V own others floor c1_alpha H H_0 K")
    star = z3.Real("c_star")
    positive = potential_lemma()
    sums = lemma(
        "one pair more does not lower a sum of ψ_α: what agent i adds with all agents but j is at least 0 (induction)",
        own + PAIR >= 0,
        *(own >= 0, positive.then()),
    )
    yield sums.step
    apart = lemma(
        "two coincident agents i, j: V is c* for their pair, at least 0 for i with all others, and at least the "
        "least V "
        "of n - 1 agents for the rest, j among them",
        total >= star + floor,
        *(total == star + (own + PAIR) + others, sums.then(), others >= floor),
        latex=r"V(q) \ge c^* + \min V_{n-1}",
    )
    yield apart.step
    for m in (1, 2, 3):
        yield Step(f"m = {m}: dH/dt = -c2α pᵀL̂p under Algorithm 1", algorithm1_identity(m).holds)
    yield implication(
        "so H(0) < c1α(c* + min V of n - 1 agents) leaves no two agents coincident: H does not rise, and K >= 0",
        z3.Not(total >= star + floor),
        *(gain > 0, kinetic >= 0, energy == gain * total + kinetic, energy <= start, start < gain * (star + floor)),
    )


def _count() -> Iterator[Step]:
    for clique in CLIQUES:
        yield Step(
            f"no more than {clique} pairwise bound: the induction (s in a largest clique, each other agent not "
            "bound to "
            f"one of them) gives the library's count of pairs that are not bound, n = 1 to {MOST}",
            counts_agree(MOST, clique),
            r"u(n) = \min_{1 \le s \le r} \bigl(n - s + u(n-s)\bigr) = \tbinom n2 - t_r(n)",
            f"{unbound(MOST, clique)} pairs of {MOST} agents",
            {"agents": str(MOST)} if clique == CLIQUES[-1] else {},
        )
    par = AlphaParameters.of(Algorithm1().alpha)
    with ctx.workdps(DIGITS):
        ratio = ball(par.r) / ball(shortest_bound(par))
        for m in DIMENSIONS:
            clique = largest_clique(ratio, m)
            yield Step(
                f"by default {SPACE[m]} no more than {clique} agents are pairwise bound, so that two coincident ones "
                f"among n cost more than c* + ψ_α(r_α) u(n - 1){'' if clique is None else cited(clique, m)}",
                None if clique is None else clique == m + 1,
                evidence=f"c* in {interval(c_star(par))}, ψ_α(r_α) in {interval(far_potential(par))}",
            )


def _steps() -> Iterator[Step]:
    yield from potential_signs()
    yield from _away()
    for m in DIMENSIONS:
        yield from radon_points(m)
    yield from _count()


PROOF = Proof(
    id="barrier",
    title="No collision below the barrier c* + the least V of n - 1 agents",
    statement=(
        "Under Algorithm 1, if H(0) < c1α(c* + the least V of n - 1 agents), no two agents ever coincide, for every n "
        "and m = 1, 2, 3. With the default parameters that least V is at least ψ_α(r_α) times the count "
        f"of pairs that cannot be bound, which is the library's for n up to {STATED['agents']}."
    ),
    hypotheses="c1α > 0, c2α >= 0; 0 < a <= b, 0 < h < 1, 0 < d < r, ε > 0; bound: ψ_α below ψ_α(r_α)",
    rigour="interval",
    steps=_steps,
    size=33,
    theorems=("os-1",),
    values=STATED,
)
