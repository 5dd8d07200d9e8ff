"""Jadbabaie, Lin and Morse's averages of headings: the span, its contraction, and when a net stays for ever."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication

_MOST = 4  # agents up to which products of nets are counted out


def _span() -> Iterator[Step]:
    low, high, mean, next_one, size = z3.Reals("low high mean next size")
    yield implication(
        "a mean of k numbers in [m, M] lies there, and with one number more it does again (induction over neighbours)",
        z3.And((size * mean + next_one) >= low * (size + 1), (size * mean + next_one) <= high * (size + 1)),
        *(size >= 1, low <= mean, mean <= high, low <= next_one, next_one <= high),
        latex=r"m \le \theta_i(t+1) \le M",
    )


def _contraction() -> Iterator[Step]:
    low, high, start, share, one, other = z3.Reals("low high start share one other")
    inside = (low <= start, start <= high, share > 0, share <= 1)
    means = [
        z3.And(x >= share * start + (1 - share) * low, x <= share * start + (1 - share) * high) for x in (one, other)
    ]
    yield implication(
        "if after some steps every agent weighs one agent's heading by ε or more, and the rest lies in [m, M], two "
        "headings differ by (1 - ε)(M - m) at most",
        one - other <= (1 - share) * (high - low),
        *(*inside, *means),
        latex=r"\max\theta' - \min\theta' \le (1 - \varepsilon)(\max\theta - \min\theta)",
    )
    weight, own, kept = z3.Reals("weight own kept")
    yield implication(
        "a weight once positive stays so, and in each step loses a factor n at most: agents weigh themselves, and each "
        "neighbour, by 1/n or more",
        own * weight >= kept * weight,
        *(weight > 0, kept > 0, own >= kept),
    )
    yield Step(
        f"n - 1 jointly connected windows make every weight positive: the agents that heard of one are more after each "
        f"window, for a link leads out of any set that is not all (counted out for n = 2 to {_MOST}: every connected "
        "union, whatever it starts from)",
        all(_spreads(n) for n in range(2, _MOST + 1)),
    )


def _spreads(n: int) -> bool:
    """Whether every connected net has a link out of every proper subset of the agents."""
    pairs = list(combinations(range(n), 2))
    for chosen in product((False, True), repeat=len(pairs)):
        net = [pair for pair, taken in zip(pairs, chosen, strict=True) if taken]
        if not _connected(n, net):
            continue
        for size in range(1, n):
            for group in combinations(range(n), size):
                if not any((i in group) != (j in group) for i, j in net):
                    return False
    return True


def _connected(n: int, net: list[tuple[int, int]]) -> bool:
    """By the paths from agent 0: powers of the net's matrix, in whole numbers."""
    matrix = sp.eye(n) + sum((_unit(n, i, j) for i, j in net), sp.zeros(n))
    return all(entry > 0 for entry in (matrix ** (n - 1)).row(0))


def _unit(n: int, i: int, j: int) -> sp.Matrix:
    matrix = sp.zeros(n)
    matrix[i, j] = matrix[j, i] = 1
    return matrix


def _for_ever() -> Iterator[Step]:
    angle = sp.Symbol("angle", real=True)
    difference = sp.Abs(sp.exp(sp.I * angle) - 1) ** 2
    yield Step(
        "two agents' velocities differ by 2v |sin(δ/2)| if their headings do by δ, at most v |δ|",
        sp.simplify(sp.expand(difference.rewrite(sp.cos), complex=True) - 4 * sp.sin(angle / 2) ** 2) == 0,
        r"|e^{i\theta_i} - e^{i\theta_j}| = 2|\sin\tfrac12(\theta_i - \theta_j)| \le |\theta_i - \theta_j|",
    )
    weights = sp.symbols("w1:4", positive=True)
    links = sp.symbols("l1:4", nonnegative=True)
    net = sp.Matrix([[1, links[0], links[1]], [links[0], 1, links[2]], [links[1], links[2], 1]])
    half = sp.diag(*[sp.sqrt(w) for w in weights])
    similar = half * (sp.diag(*[1 / w for w in weights]) * net) * half.inv()
    yield Step(
        "M = W⁻¹(I + A) is similar to the symmetric W^(-½)(I + A)W^(-½), so that √w (θ - θ∞) shrinks by ρ in each step "
        "(three agents with any links; the entries of more are alike)",
        sp.simplify(similar - similar.T) == sp.zeros(3),
        r"\|\sqrt w(\theta - \theta_\infty)\|(t+1) \le \rho\,\|\sqrt w(\theta - \theta_\infty)\|(t)",
    )
    one, other = sp.symbols("w_i w_j", positive=True)
    y = sp.symbols("y_i y_j", real=True)
    left = (y[0] ** 2 + y[1] ** 2) * (1 / one + 1 / other) - (y[0] / sp.sqrt(one) - y[1] / sp.sqrt(other)) ** 2
    yield Step(
        "two headings differ by √(1/w_i + 1/w_j) ‖√w (θ - θ∞)‖ at most (Cauchy and Schwarz: what is left is a square)",
        sp.simplify(left - (y[0] / sp.sqrt(other) + y[1] / sp.sqrt(one)) ** 2) == 0,
        r"|\theta_i - \theta_j| \le \sqrt{1/w_i + 1/w_j}\,\|\sqrt w(\theta - \theta_\infty)\|",
    )
    rho, k = sp.symbols("rho k", positive=True)
    partial = (1 - rho ** (k + 1)) / (1 - rho)
    yield Step(
        "so all changes to come add up to the first one over 1 - ρ at most (the partial sums: by induction)",
        sp.simplify(partial + rho ** (k + 1) - partial.subs(k, k + 1)) == 0,
        r"\sum_{s \ge 0} \rho^s = \frac1{1 - \rho}",
    )
    room, drift, before, distance, radius = z3.Reals("room drift before distance radius")
    yield implication(
        "a distance that is farther from r than all its changes to come stays on its side of r: the net stays, and by "
        "induction over the steps the changes are those of an unchanged net",
        z3.And(z3.Implies(before < radius, distance < radius), z3.Implies(before > radius, distance > radius)),
        *(
            z3.Or(before - radius >= room, radius - before >= room),
            drift < room,
            z3.And(distance - before <= drift, before - distance <= drift),
            room > 0,
        ),
    )


def _parted() -> Iterator[Step]:
    ahead, slow, fast, step, radius = z3.Reals("ahead slow fast step radius")
    yield implication(
        "a group more than r ahead in one direction, each of whose headings advances there at least as fast as each of "
        "the others, is so after the next step too; headings keep to their side's span meanwhile",
        ahead + step * (slow - fast) > radius,
        *(ahead > radius, slow >= fast, step > 0),
    )


def _steps() -> Iterator[Step]:
    yield from _span()
    yield from _contraction()
    yield from _for_ever()
    yield from _parted()


PROOF = Proof(
    id="headings",
    title="Averaged headings: their span never grows, shrinks under joint connectivity, and certificates for ever",
    statement=(
        "No heading leaves the span of those before. Over n - 1 jointly connected windows the span shrinks by a factor "
        "below 1 that the nets give. A connected net whose distances are farther from r than what averaging can still "
        "change stays for ever, and all headings tend to one; a group that is more than r ahead and faster never meets "
        "the others."
    ),
    hypotheses="θ_i becomes the mean over agent i and its neighbours, as numbers, without noise; one speed for all",
    rigour="smt",
    steps=_steps,
    size=10,
    theorems=("jlm-headings",),
)
