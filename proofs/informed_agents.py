"""Few informed agents and a leader of varying velocity: the energy seen from the leader, and the centre of mass."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.energy_balances import BRAKE, MATCH, PULL, THRUST, given_frame_identity
from flockana.symbolic.generic_pair import vector
from proofs.proof import Proof, Step
from proofs.smt import implication

_N = 3


def _energy() -> Iterator[Step]:
    for m in (1, 2):
        for informed in range(_N + 1):
            identity = given_frame_identity(m, informed=informed)
            rate = identity.result.subs({THRUST: 0, BRAKE: 0})
            squares = sp.expand(rate + sum(_squares(m, informed)))
            yield Step(
                f"m = {m}, {informed} of 3 agents informed, in the leader's frame: Q' is minus a sum of squares with "
                "weights c a_ij >= 0 and c2 >= 0",
                identity.holds and squares == 0,
                r"Q' = -c \sum_{i<j} a_{ij} \|p_j - p_i\|^2 - c_2 \sum_{\text{informed}} \|p_i\|^2",
                "expanded: 0; every kind of pair and agent is among the three",
            )


def _squares(m: int, informed: int) -> Iterator[sp.Expr]:
    damping = sp.Symbol("c", real=True)
    p = [vector(f"p_{i}", m) for i in range(_N)]
    for i in range(_N):
        for j in range(i + 1, _N):
            slip = p[j] - p[i]
            yield damping * sp.Symbol(f"a_{i}{j}", nonnegative=True) * slip.dot(slip)
    yield from (MATCH * p[i].dot(p[i]) for i in range(informed))


def _distance() -> Iterator[Step]:
    c, square, rest, now, start = z3.Reals("c square rest now start")
    yield implication(
        "Q = ½ c1 ‖q_i − q_r‖² + rest with rest >= 0, and Q <= Q(0): ‖q_i − q_r‖² <= 2 Q(0)/c1",
        square <= 2 * start / c,
        c > 0,
        rest >= 0,
        now == c * square / 2 + rest,
        now <= start,
        latex=r"\|q_i - q_r\|^2 \le 2 Q(0) / c_1",
    )


def _centre() -> Iterator[Step]:
    for m in (1, 2):
        q, p = ([vector(f"{name}_{i}", m) for i in range(_N)] for name in ("q", "p"))
        q_r, p_r, a_r = (vector(name, m) for name in ("q_r", "p_r", "a_r"))
        push = {(i, j): vector(f"f_{i}{j}", m) for i in range(_N) for j in range(i + 1, _N)}
        total = sp.zeros(m, 1)
        for i in range(_N):
            between = sum((push[i, j] for j in range(i + 1, _N)), sp.zeros(m, 1))
            between -= sum((push[j, i] for j in range(i)), sp.zeros(m, 1))
            total += between + a_r - PULL * (q[i] - q_r) - MATCH * (p[i] - p_r)
        z, w = sum(q[1:], q[0]) / _N - q_r, sum(p[1:], p[0]) / _N - p_r
        residual = (total / _N - a_r + PULL * z + MATCH * w).applyfunc(sp.expand)
        yield Step(
            f"m = {m}: with the acceleration told to all, forces between agents drop out and z = q_c − q_r solves",
            residual == sp.zeros(m, 1),
            r"z'' = -c_1 z - c_2 z'",
            "expanded: 0, for opposite forces of each pair and otherwise free ones",
        )
    s, t = sp.symbols("s t")
    root = sp.symbols("r1 r2")
    claimed = sp.expand((s - root[0]) * (s - root[1]))
    z = sum(sp.Symbol(f"A{k}") * sp.exp(r * t) for k, r in enumerate(root))
    c1, c2 = claimed.coeff(s, 0), -sum(root)
    yield Step(
        "its solutions are sums of exponentials of the roots of s² + c2 s + c1",
        sp.expand(sp.diff(z, t, 2) + c2 * sp.diff(z, t) + c1 * z) == 0 and sp.expand(claimed.coeff(s, 1) - c2) == 0,
        r"z = A_1 e^{r_1 t} + A_2 e^{r_2 t}",
        "for different roots; equal ones are their limit",
    )
    x, y, one, two = z3.Reals("x y c1 c2")
    yield implication(
        "a root x + iy has x < 0 wherever c1, c2 > 0",
        x < 0,
        one > 0,
        two > 0,
        x * x - y * y + two * x + one == 0,
        2 * x * y + two * y == 0,
        latex=r"\operatorname{Re} s < 0",
    )


def _steps() -> Iterator[Step]:
    yield from _energy()
    yield from _distance()
    yield from _centre()


PROOF = Proof(
    id="informed-agents",
    title="Few informed agents, and a leader that tells its acceleration",
    statement=(
        "Seen from a leader of constant velocity, Q = V + ½ c1 Σ ‖q_i − q_r‖² of the informed + ½ Σ ‖p_i − p_r‖² never "
        "rises, and no informed agent goes farther than sqrt(2 Q(0)/c1) from it. With a leader of any path whose "
        "acceleration all agents are told, q_c − q_r dies out exponentially, if all feel it."
    ),
    hypotheses="c1, c2 > 0 of the informed, c2α >= 0, ψ >= 0 a function of the distance, a symmetric adjacency >= 0",
    rigour="smt",
    steps=_steps,
    size=13,
    theorems=("su-informed", "su-varying"),
)
