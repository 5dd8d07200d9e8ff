"""Alignment by powers of differences: the spread of velocities ends by a time that the eigenvalue λ₂ bounds."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication

A = sp.Symbol("alpha", positive=True)
B, D, V = sp.symbols("b d v", positive=True)


def _rate() -> Iterator[Step]:
    p = sp.symbols("p_1:4")
    pulls = {
        pair: sp.Symbol(f"f_{pair[0]}{pair[1]}") for pair in ((0, 1), (0, 2), (1, 2))
    }  # of j on i; odd, so −f on j
    u = [sum(f * ((i == k) - (j == k)) for (i, j), f in pulls.items()) for k in range(3)]
    mean = sum(p) / 3
    power = sum((each - mean) * pull for each, pull in zip(p, u, strict=True))
    yield Step(
        "sig is odd: Σ u_i = 0, p̄ stays, and vv' = Σ (p_i - p̄) u_i is minus the sum over links of b |p_j - p_i|^(1+α) "
        "(checked: three agents, pulls f_ij of any size)",
        sp.expand(sum(u)) == 0 and sp.expand(power + sum(f * (p[j] - p[i]) for (i, j), f in pulls.items())) == 0,
        r"v\dot v = -\sum b\,|p_j - p_i|^{1+\alpha}",
    )
    s, log, share, other = z3.Reals("s log_x x y")
    yield implication(
        "for 0 < x <= 1 and s = (1+α)/2 <= 1 the exponent of x^(s-1) = exp((s-1) ln x) is not negative: x^s >= x",
        (s - 1) * log >= 0,
        *(s > 0, s <= 1, log <= 0),
    )
    yield implication(
        "so x^s + y^s >= x + y = 1 for shares of a sum: a sum of powers is at least the power of the sum, for links "
        "and components together",
        s + log >= 1,
        *(share >= 0, other >= 0, share + other == 1, s >= share, log >= other),
    )
    yield Step(
        "and b|d|^(1+α) is (b^(2/(1+α)) d²)^((1+α)/2): vv' <= -(Σ b^(2/(1+α)) d²)^((1+α)/2) <= -(λ₂v²)^((1+α)/2), as "
        "λ₂ is the least quotient off agreement (Courant)",
        sp.simplify(sp.powdenest((B ** (2 / (1 + A)) * D**2) ** ((1 + A) / 2), force=True) - B * D ** (1 + A)) == 0,
        r"v\dot v \le -(\lambda_2 v^2)^{(1+\alpha)/2}",
    )


def _times() -> Iterator[Step]:
    kappa = sp.Symbol("kappa", positive=True)
    slope = sp.diff(V ** (1 - A), V) * (-kappa * V**A)
    yield Step(
        "so v' <= -κ v^α, by which v^(1-α) falls at κ(1-α): it is 0 from v(0)^(1-α)/(κ(1-α)) on",
        sp.simplify(sp.expand(slope + kappa * (1 - A))) == 0,
        r"\tfrac{d}{dt}v^{1-\alpha} \le -\kappa(1-\alpha)",
    )
    start = sp.Symbol("w", positive=True)
    bound = (start / sp.sqrt(2)) ** (1 - A) / ((2 * B ** (2 / (1 + A))) ** ((1 + A) / 2) * (1 - A))
    exact = start ** (1 - A) / (2 * B * (1 - A))
    yield Step(
        "two agents on a line, w' = -2bw^α, agree at w(0)^(1-α)/(2b(1-α)), which is that bound: λ₂ = 2b^(2/(1+α))",
        sp.simplify(sp.expand_log(sp.log(bound / exact), force=True)) == 0
        and sp.simplify(sp.diff(start ** (1 - A) / (2 * B * (1 - A)), start) * 2 * B * start**A - 1) == 0,
        r"T = \tfrac{w_0^{1-\alpha}}{2b(1-\alpha)}",
    )
    t, most = sp.symbols("t lambda", positive=True)
    yield Step(
        "for α = 1 an eigenvector decays as exp(-λt), never to 0; two groups without a link, each of one velocity, are "
        "not pulled, sig(0) = 0, and keep both",
        sp.exp(-most * t).is_positive and sp.Integer(0) ** A == 0,
    )


def _steps() -> Iterator[Step]:
    yield from _rate()
    yield from _times()


PROOF = Proof(
    id="finite-time",
    title="Alignment by powers of differences",
    statement=(
        "Under u_i = b Σ_j sig(p_j - p_i)^α, 0 < α < 1, over a connected undirected net the spread of velocities v = "
        "√Σ‖p_i - p̄‖² ends by v(0)^(1-α)/(κ(1-α)), κ = λ₂^((1+α)/2); for α = 1 or two parts some start never agrees."
    ),
    hypotheses="b > 0, one for all links; Courant's characterisation of λ₂ (cited)",
    rigour="smt",
    theorems=("finite-time",),
    steps=_steps,
    size=7,
)
