"""The energy identities of Algorithms 1, 2 and 3, and the failure of the printed forms (errata E1 and E2)."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from flockana.symbolic import algorithm1_identity, e1_counterexample, e1_identity, structural_identity
from flockana.symbolic.algorithm3_energy import e2_counterexample, e2_identity, theorem6_identity
from flockana.symbolic.energy import EnergyIdentity, GenericPair
from flockana.symbolic.errata import RisingEnergy
from flockana.symbolic.generic_pair import ADJACENCY, vector
from flockana.symbolic.obstacles import KINDS, derive_braking, derive_envelope
from flockana.symbolic.parameter_symbols import GAINS
from flockana.symbolic.written_out_flock import ConcreteFlock
from proofs.evaluate import differs
from proofs.proof import Proof, Step

DIMENSIONS = (1, 2, 3)
LIFTING = r"""\begin{aligned}
\sum_i p_i \cdot \sum_{j \ne i} f_{ij} &= \sum_{i<j} (p_i \cdot f_{ij} + p_j \cdot f_{ji}), \qquad
V = \sum_{i<j} c_1^\alpha \psi_\alpha(z_{ij}) \\
\dot V + \sum_i p_i \cdot \sum_{j \ne i} f_{ij}
&= \sum_{i<j} \bigl(c_1^\alpha \dot\psi_\alpha(z_{ij}) + p_i \cdot f_{ij} + p_j \cdot f_{ji}\bigr)
= -c_2^\alpha \sum_{i<j} a_{ij}\,\|p_j - p_i\|^2
\end{aligned}"""


def _algorithms_1_and_2() -> Iterator[Step]:
    for m in DIMENSIONS:
        yield _identity(f"Algorithm 1, m = {m}: dH/dt + c2α pᵀL̂p = 0 for a generic pair", algorithm1_identity(m), m)
        yield _identity(
            f"Algorithm 2, m = {m}: dH_λ/dt + c2γ‖v‖² + c2α vᵀL̂v = 0 for a generic pair and agent",
            structural_identity(m),
            m,
        )
        pair = GenericPair(m)
        squares = sp.Add(*((x - y) ** 2 for x, y in zip(*pair.p, strict=True)))
        yield Step(
            f"m = {m}: the pair's share of pᵀL̂p is a_ij ‖p_j - p_i‖², nonnegative as a_ij is",
            sp.expand(pair.laplacian_form() - ADJACENCY(pair.z) * squares) == 0 and squares.is_nonnegative is True,
            r"p^\top \hat L p = \sum_{i<j} a_{ij}\,\|p_j - p_i\|^2 \ge 0",
        )
    yield Step(
        "the lifting: each ordered pair of the double sum is one end of one pair i < j; written out for n = 4, "
        "the sums of the identities are the sums over all pairs",
        all(_regroups(n) for n in (2, 3, 4)),
        LIFTING,
        "the regrouping holds for every n; the machine has compared n = 2, 3, 4",
    )
    for law in ("algorithm1", "algorithm2"):
        flock = ConcreteFlock(law, 3, 2)
        identity = (algorithm1_identity if law == "algorithm1" else structural_identity)(2)
        yield Step(
            f"{law}, n = 3, m = 2, nothing lifted: the whole energy differentiated, L̂ as a matrix, leaves nothing",
            flock.residual == 0 and sp.expand(flock.expand(identity.energy) - flock.energy) == 0,
            evidence="and its energy is the sum over generic pairs and agents, written out",
        )


def _regroups(n: int) -> bool:
    """Whether Σ_i p_i Σ_{j≠i} f_ij and its regrouping by pairs have the same terms."""
    p, f = sp.IndexedBase("p"), sp.IndexedBase("f")
    agents = range(n)
    double = sp.Add(*(p[i] * sp.Add(*(f[i, j] for j in agents if j != i)) for i in agents))
    return bool(sp.expand(double - sp.Add(*(p[i] * f[i, j] + p[j] * f[j, i] for j in agents for i in range(j)))) == 0)


def _algorithm_3() -> Iterator[Step]:
    for m in DIMENSIONS:
        fixed, moving = theorem6_identity(m), theorem6_identity(m, moving=True)
        yield _identity(f"Algorithm 3, m = {m}: the form of Theorem 6, at walls and spheres", fixed, m)
        yield Step(f"Algorithm 3, m = {m}: likewise with a moving γ-agent", moving.holds)
        drag = -GAINS.c2_gamma * vector("p_i", m).dot(vector("p_i", m))
        yield Step(f"m = {m}: a γ-agent at rest takes energy out, -c2γ ‖p_i‖² <= 0", drag.is_nonpositive is True)
    for kind in KINDS:
        for m in DIMENSIONS:
            envelope, braking = derive_envelope(kind, m), derive_braking(kind, m)
            yield Step(f"{kind}, m = {m}: the gradient of ψ_β needs no derivative of q̂", envelope.holds)
            yield Step(
                f"{kind}, m = {m}: ⟨p_i, p̂_ik - p_i⟩ is a sum of terms that are nonpositive outside",
                braking.holds,
                sp.latex(sp.Add(*braking.terms, evaluate=False)),
                "w = ⟨a, p⟩, T = ‖P p‖², μ = 1/(1 + τ)" if kind == "sphere" else "w = ⟨a, p⟩, μ = 1",
            )


def _printed() -> Iterator[Step]:
    for m in DIMENSIONS:
        for name, printed in (("E1", e1_identity(m)), ("E2", e2_identity(m))):
            what = "H" if name == "E1" else "V_α"
            left = sp.latex(printed.residual) if m == 1 else ""
            yield Step(f"{name}, m = {m}: the printed {what} leaves a residual, not 0", differs(printed.residual), left)
    for name, state in (("E1", e1_counterexample()), ("E2", e2_counterexample())):
        yield Step(
            f"{name}: at a rational state the printed energy rises, and the true one falls",
            state.rate.is_positive is True and state.true_rate.is_negative is True,
            rf"\dot H_{{\text{{printed}}}} = {sp.latex(state.rate)} > 0 > {sp.latex(state.true_rate)} = \dot H",
            _state(state),
        )


def _identity(text: str, identity: EnergyIdentity, m: int) -> Step:
    """An identity, with its derivation where the plane is enough to see it."""
    return Step(text, identity.holds, identity.latex() if m == 2 else "", f"residual {identity.residual}")


def _state(state: RisingEnergy) -> str:
    alpha = ", ".join(f"{name} = {getattr(state.alpha, name)}" for name in ("d", "r", "eps", "h", "a", "b"))
    rows = (f"{name} = ({', '.join(map(str, row))})" for name, row in (("q", state.q), ("p", state.p)))
    return f"{', '.join(rows)}; {alpha}, all gains 1; dH/dt = {sp.N(state.rate, 6)} against {state.true_rate}"


def _steps() -> Iterator[Step]:
    for part in (_algorithms_1_and_2, _algorithm_3, _printed):
        yield from part()


PROOF = Proof(
    id="energy-identities",
    title="Energy identities of Algorithms 1, 2 and 3",
    statement=(
        "dH/dt = -c2α pᵀL̂p under Algorithm 1, dH_λ/dt = -c2γ‖v‖² - c2α vᵀL̂v under Algorithm 2, and the form of "
        "Theorem 6 under Algorithm 3, for every n and m = 1, 2, 3, with the sign of each term. The printed H (E1) and "
        "V_α (E2) fail."
    ),
    hypotheses="dψ/dz = φ and a_ij, b_ik >= 0, otherwise arbitrary; gains >= 0; agents outside obstacles",
    rigour="symbolic",
    steps=_steps,
    size=41,
    theorems=("energy", "E1", "E2"),
)
