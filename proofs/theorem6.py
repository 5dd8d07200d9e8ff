"""Theorem 6: all terms of dH/dt under Algorithm 3, the sign of each, and what its condition (76) is for."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.algorithm3_energy import condition_76_residual, e2_counterexample, e2_identity, theorem6_identity
from flockana.symbolic.obstacles import KINDS, derive_braking, derive_envelope, sphere_beta
from proofs.evaluate import differs
from proofs.proof import Proof, Step
from proofs.smt import implication

DIMENSIONS = (1, 2, 3)
BRAKING = {
    "wall": r"\langle p_i, \hat p_{ik} - p_i\rangle = -\langle a_k, p_i\rangle^2 \le 0",
    "sphere": r"\langle p_i, \hat p_{ik} - p_i\rangle = (\mu - 1)\|P p_i\|^2 - \langle a_k, p_i\rangle^2 \le 0, "
    r"\qquad \mu = R_k/\|q_i - y_k\| \le 1",
}


def obstacle_steps() -> Iterator[Step]:
    """β-agents of every kind of obstacle, in every dimension."""
    for kind in KINDS:
        for m in DIMENSIONS:
            envelope, braking = derive_envelope(kind, m), derive_braking(kind, m)
            yield Step(
                f"{kind}, m = {m}: the gradient of ψ_β(‖q̂ - q‖_σ) needs no derivative of q̂, and p̂ = dq̂/dt",
                envelope.holds,
                envelope.latex() if m == 2 else "",
                f"{len(envelope.residuals)} components",
            )
            yield Step(
                f"{kind}, m = {m}: ⟨p_i, p̂_ik - p_i⟩ <= 0, term by term, for agents outside",
                braking.holds,
                BRAKING[kind],
            )
    at, along, centre = sp.Matrix([1, 0]), sp.Matrix([0, 1]), sp.Matrix([0, 0])
    _, rate = sphere_beta(at, along, centre, sp.Integer(2))
    yield Step(
        "inside a sphere it can be positive: q = (1, 0), p = (0, 1), R = 2 about the origin gives 1",
        along.dot(rate - along) == 1,
        evidence="so the agents must be outside, which the theorem does not say",
    )


def _identity() -> Iterator[Step]:
    for m in DIMENSIONS:
        for kind in KINDS:
            yield Step(
                f"m = {m}, {kind}s: dH/dt of a generic pair, agent and obstacle is the stated one",
                theorem6_identity(m, kinds=(kind,)).holds,
            )
        both = theorem6_identity(m)
        yield Step(
            f"m = {m}, walls and spheres: likewise, and so summed over all pairs, agents and obstacles",
            both.holds,
            both.latex() if m == 2 else "",
            "with q_r fixed; p_r may be any constant",
        )
        moving = theorem6_identity(m, moving=True)
        yield Step(
            f"m = {m}: a moving γ-agent adds -c1γ Σ⟨σ₁(q_i - q_r), dq_r/dt⟩",
            moving.holds and differs(moving.rate - both.rate),
            r"-c_1^\gamma \sum_i \langle \sigma_1(q_i - q_r), \dot q_r\rangle",
        )
        yield Step(
            f"m = {m}: Σ⟨p_i, p_i - p_d⟩ = 2T - n⟨p_c, p_d⟩, twice the two sides of (76) apart",
            condition_76_residual(m) == 0,
            r"\sum_i \langle p_i, p_i - p_d\rangle = 2\Bigl(T - \frac n2 \langle p_c, p_d\rangle\Bigr), \quad "
            r"T = \tfrac12 \sum_i \|p_i\|^2",
        )


def _sign() -> Iterator[Step]:
    consensus, braking, kinetic, drift, rate = z3.Reals("consensus braking T drift rate")
    c2_alpha, c2_beta, c2_gamma = z3.Reals("c2_alpha c2_beta c2_gamma")
    stated = (
        *(c2_alpha >= 0, c2_beta >= 0, c2_gamma >= 0, consensus >= 0, braking <= 0),
        rate == -c2_alpha * consensus + c2_beta * braking - 2 * c2_gamma * (kinetic - drift),
    )
    a_ij, gap, b_ik, power = z3.Reals("a_ij gap b_ik power")
    yield implication(
        "pᵀL̂p >= 0, as each pair adds a_ij ‖p_j - p_i‖², and obstacles add b_ik⟨p_i, p̂_ik - p_i⟩ <= 0",
        z3.And(a_ij * gap**2 >= 0, b_ik * power <= 0),
        *(a_ij >= 0, b_ik >= 0, power <= 0),
        latex=r"p^\top \hat L p = \sum_{i<j} a_{ij}\,\|p_j - p_i\|^2 \ge 0",
    )
    yield implication(
        "dH/dt <= 0 wherever (76) holds: (n/2)⟨p_c, p_d⟩ <= T",
        rate <= 0,
        *(*stated, drift <= kinetic),
        latex=r"\dot H = -c_2^\alpha\,p^\top\hat L p + c_2^\beta \sum_{i,k} b_{ik}\langle p_i, "
        r"\hat p_{ik} - p_i\rangle - 2 c_2^\gamma \Bigl(T - \frac n2\langle p_c, p_d\rangle\Bigr) \le 0",
    )
    yield implication("with p_d = 0 the condition is trivial", drift <= kinetic, kinetic >= 0, drift == 0)
    p, p_d = z3.Reals("p p_d")
    yield implication(
        "without (76) H can rise: one agent, far from obstacles, with p = p_d/2 ≠ 0",
        rate > 0,
        *(p_d != 0, p == p_d / 2, kinetic == p**2 / 2, drift == p * p_d / 2, c2_gamma > 0),
        rate == -2 * c2_gamma * (kinetic - drift),
        latex=r"\dot H = \tfrac14 c_2^\gamma\,\|p_d\|^2 > 0",
    )


def _printed() -> Iterator[Step]:
    for m in DIMENSIONS:
        yield Step(f"E2, m = {m}: with the printed V_α a term dV_α/dt is left over", differs(e2_identity(m).residual))
    state = e2_counterexample()
    yield Step(
        "E2: at a rational state at which (76) holds the printed H rises, and the true one falls",
        state.rate.is_positive is True and state.true_rate.is_negative is True,
        evidence=f"q = {state.q}, p = {state.p}, p_d = 0: dH/dt = {sp.N(state.rate, 6)} against {state.true_rate}",
    )


def _steps() -> Iterator[Step]:
    for part in (obstacle_steps, _identity, _sign, _printed):
        yield from part()


PROOF = Proof(
    id="theorem6",
    title="Theorem 6: Algorithm 3 with a static γ-agent",
    statement=(
        "dH/dt = -c2α pᵀL̂p + c2β ΣΣ b_ik⟨p_i, p̂_ik - p_i⟩ - 2 c2γ (T - (n/2)⟨p_c, p_d⟩) for any number of walls and "
        "spheres, m = 1, 2, 3, every n, with H counting each pair once; it is <= 0 where (76) holds, (n/2)⟨p_c, p_d⟩ "
        "<= T. With the printed V_α (E2), inside a sphere, or without (76), it can be positive."
    ),
    hypotheses=(
        "(q_r, p_r) = (q_d, p_d) constant; all agents outside the obstacles; dψ/dz = φ, a_ij, b_ik >= 0, otherwise "
        "arbitrary; gains >= 0"
    ),
    rigour="smt",
    steps=_steps,
    size=36,
    theorems=("os-6",),
)
