"""The energy identities of Algorithms 1, 2 and 3, and the failure of the printed forms (errata E1 and E2)."""

from __future__ import annotations

from collections.abc import Iterator

from flockana.symbolic import algorithm1_identity, e1_counterexample, e1_identity, structural_identity
from flockana.symbolic.obstacles import derive_braking, derive_envelope
from flockana.symbolic.theorem6 import e2_counterexample, e2_identity, theorem6_identity
from proofs.proof import Proof, Step


def _theorem6(m: int, *, moving: bool) -> bool:
    return theorem6_identity(m, moving=moving).holds


def _steps() -> Iterator[Step]:
    for m in (1, 2, 3):
        yield Step(f"Algorithm 1, m = {m}: dH/dt + c2α pᵀL̂p = 0 for a generic pair", algorithm1_identity(m).holds)
        yield Step(f"Algorithm 2, m = {m}: dH_λ/dt + c2γ‖v‖² + c2α vᵀL̂v = 0", structural_identity(m).holds)
        yield Step(f"E1, m = {m}: the printed H leaves a residual", not e1_identity(m).holds)
        yield Step(f"Algorithm 3, m = {m}: the form of Theorem 6, at walls and spheres", _theorem6(m, moving=False))
        yield Step(f"Algorithm 3, m = {m}: likewise with a moving γ-agent", _theorem6(m, moving=True))
        yield Step(f"E2, m = {m}: the printed V_α leaves a residual", not e2_identity(m).holds)
    for kind in ("wall", "sphere"):
        for m in (2, 3):
            yield Step(f"{kind}, m = {m}: the gradient of ψ_β needs no derivative of q̂", derive_envelope(kind, m).holds)
            yield Step(f"{kind}, m = {m}: every braking term is nonpositive outside", derive_braking(kind, m).holds)
    for name, state in (("E1", e1_counterexample()), ("E2", e2_counterexample())):
        yield Step(f"{name}: at a rational state the printed energy rises", bool(state.rate.is_positive))
        yield Step(f"{name}: at that state the true one falls", bool(state.true_rate.is_negative))


PROOF = Proof(
    id="energy-identities",
    statement=(
        "dH/dt = -c2α pᵀL̂p under Algorithm 1, dH_λ/dt = -c2γ‖v‖² - c2α vᵀL̂v under Algorithm 2, and the form of "
        "Theorem 6 under Algorithm 3, for every n: V, K, J are sums over pairs and agents, so an identity for one "
        "generic pair, one generic agent and one generic obstacle is one for all. The printed H (E1) and V_α (E2) fail."
    ),
    hypotheses="dψ/dz = φ, with ψ, φ and the adjacency otherwise arbitrary; agents outside obstacles",
    rigour="symbolic",
    steps=_steps,
)
