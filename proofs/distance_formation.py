"""Formations by distances: descent, the line, and a neighbourhood from which all lengths are reached."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication


def _identities() -> Iterator[Step]:
    k = sp.symbols("k", positive=True)
    q = sp.Matrix(3, 2, sp.symbols("x0 y0 x1 y1 x2 y2", real=True))
    ends, d = [(0, 1), (1, 2), (0, 2)], sp.symbols("d0:3", positive=True)
    z = [q.row(j) - q.row(i) for i, j in ends]
    e = sp.Matrix([one.dot(one) - length**2 for one, length in zip(z, d, strict=True)])
    slopes = e.jacobian(list(q)) / 2
    v = -k * slopes.T * e
    law = sp.zeros(3, 2)
    for (i, j), one, error in zip(ends, z, e, strict=True):
        law[i, :] += k * error * one
        law[j, :] -= k * error * one
    energy = k * e.dot(e) / 4
    yield Step(
        "q' = -k Rᵀe is minus the gradient of k/4 ‖e‖², with R half the slopes of e (checked: a triangle; a sum over "
        "links): the energy falls at ‖q'‖², links are bounded, so that q' -> 0 (Barbalat)",
        (sp.Matrix(list(law)) - v).expand() == sp.zeros(6, 1)
        and all(sp.expand(energy.diff(x) + one) == 0 for x, one in zip(list(q), v, strict=True)),
        r"\dot q = -k R^\top e",
    )
    yield Step(
        "what a link adds to its two ends cancels: the centroid stays",
        all(sp.expand(sum(law[:, c])) == 0 for c in range(2)),
        r"\sum_i \dot q_i = 0",
    )
    flat = {q[i, 1]: 0 for i in range(3)}
    yield Step(
        "velocities lie along differences of agents: on a line they lie along it, and by uniqueness no agent leaves it",
        all(law[i, 1].subs(flat) == 0 for i in range(3)),
    )


def _neighbourhood() -> Iterator[Step]:
    k, size, push, sigma = z3.Reals("k E w sigma")
    yield implication(
        "‖e‖' = -2k ‖Rᵀe‖²/‖e‖ (e' = 2Rq'); while ‖Rᵀe‖ >= σ ‖e‖ it is at most -2σ ‖q'‖ and at most -2kσ² ‖e‖",
        z3.And(2 * k * push * push >= 2 * sigma * k * push * size, push * push >= sigma * sigma * size * size),
        *(k > 0, size > 0, sigma > 0, push >= sigma * size),
        latex=r"\tfrac{d}{dt}\|e\| \le -2\sigma\|\dot q\|",
    )
    a, b = z3.Reals("a b")
    yield implication(
        "R is linear, a link has δ_j - δ_i in two places, 2 (a - b)² <= 4 (a² + b²) of each coordinate, and an agent "
        "has at most Δ links: ‖R(q + δ) - R(q)‖ <= 2 √Δ ‖δ‖",
        2 * (a - b) * (a - b) <= 4 * (a * a + b * b),
        latex=r"\|R(q + \delta) - R(q)\| \le 2\sqrt\Delta\,\|\delta\|",
    )
    start, root, way = z3.Reals("sigma0 s L")
    yield implication(
        "4 √Δ ‖e‖ < σ² at the start: while σ stays above half of that, the way is at most ‖e‖/σ; then σ loses less "
        "than half, so that it stays so for ever, and ‖e‖ falls at 2k (σ/2)² = kσ²/2",
        2 * root * way < start / 2,
        *(root > 0, start > 0, size >= 0, way >= 0, 4 * root * size < start * start, way * start <= size),
        latex=r"4\sqrt\Delta\,\|e\| < \sigma^2 \Rightarrow 2\sqrt\Delta\,\|e\|/\sigma < \sigma/2",
    )


def _steps() -> Iterator[Step]:
    yield from _identities()
    yield from _neighbourhood()


PROOF = Proof(
    id="distance-formation",
    title="Formations by distances",
    statement=(
        "Under q' = -k Rᵀe the centroid stays, velocities tend to 0 and agents on a line stay on it; if the rows of R "
        "are independent and σ²/2 > 2 √Δ ‖e‖ at the start, e tends to 0 at the rate kσ²/2 and no agent moves farther "
        "than ‖e‖/σ."
    ),
    hypotheses="k > 0; e the errors of squared lengths, R half their slopes, Δ the largest number of links of an agent",
    rigour="smt",
    theorems=("distance-formation",),
    steps=_steps,
    size=6,
    cites=("Barbalat",),
)
