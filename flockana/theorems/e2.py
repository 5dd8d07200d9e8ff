"""Erratum E2: the potential V_α of Algorithm 3 counts every pair once."""

from __future__ import annotations

import numpy as np

from flockana.environment.obstacles import Sphere
from flockana.environment.targets import StaticTarget
from flockana.laws.algorithm3 import Algorithm3
from flockana.simulate import simulate
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances

_PROOF = "energy-identities"


def _identity(name: str, residual: object, stated: str, detail: str) -> Claim:
    return Claim(
        name,
        "verified" if residual == 0 else "refuted",
        "symbolic",
        computed=f"residual {residual}",
        stated=stated,
        witness=str(residual),
        proof=_PROOF,
        detail=detail,
    )


def _rising_run() -> Claim:
    """Two agents too close that approach further, a sphere beside them, the γ-agent at rest between them."""
    law = Algorithm3(target=StaticTarget((2.0, 0.0)), obstacles=(Sphere((2.0, 5.8), 2.0),))
    q0, p0 = [[0.0, 0.0], [4.0, 0.0]], [[5.0, 0.0], [-5.0, 0.0]]
    run = simulate(law, q0, p0, (0.0, 1.0))
    pairs = np.array([law.gains.c1_alpha * law.alpha.potential_energy(q) for q in run.q])
    printed, true = run.energy() + pairs, run.energy()
    peak = int(np.argmax(printed))
    rise, error = float(printed[peak] - printed[0]), float(np.abs(run.energy_residual).max())
    fall = float(np.diff(true).max())
    return Claim(
        "printed-run",
        "refuted" if rise > error and fall <= error else "inconclusive",
        computed=rise,
        stated="the printed H never rises",
        margin=-rise,
        error=error,
        witness={"q(0)": q0, "p(0)": p0, "time": float(run.t[peak])},
        detail=f"along a run of two agents beside a sphere the printed H rises by {rise:.4g} until "
        f"t = {run.t[peak]:.3g}; the true one falls throughout",
    )


def _check(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    from flockana.symbolic.theorem6 import e2_counterexample, e2_identity, theorem6_identity

    state = e2_counterexample()
    rate, true_rate = float(state.rate), float(state.true_rate)
    stated = "dH/dt = -c2α pᵀL̂p + c2β ΣΣ b ⟨p, p̂ - p⟩ - c2γ Σ⟨p, p - p_r⟩"
    return [], [
        _identity(
            "printed",
            e2_identity(m=2).residual,
            f"{stated} for V_α = Σ_i Σ_(j≠i) ψ_α",
            "the printed V_α has twice the gradient that u^α uses: dV_α/dt is left over, and it has no sign",
        ),
        Claim(
            "printed-state",
            "refuted" if state.rate.is_positive else "verified",
            "symbolic",
            computed=rate,
            stated="dH/dt <= 0 for the printed H",
            margin=-rate,
            error=0.0,
            witness={"q": [str(x) for x in state.q], "p": [str(x) for x in state.p]},
            detail=f"at an exact state of two agents the printed H has rate {rate:.4g}, the true one {true_rate:g}",
        ),
        _rising_run(),
        _identity(
            "corrected",
            theorem6_identity(m=2).residual,
            f"{stated} for V_α = ½ Σ_i Σ_(j≠i) ψ_α",
            "with every pair once the identity is exact, for every n and any walls and spheres",
        ),
    ]


THEOREM = Theorem(
    id="E2",
    title="V_α of Algorithm 3 counts every pair once",
    statement="The slides print V_α = Σ_i Σ_(j≠i) ψ_α for Algorithm 3; its gradient is twice u^α. The factor is ½.",
    source="slides, Algorithm 3",
    kind="fixed",
    check=_check,
    references=("geschwender-2016", "olfati-saber-2006"),
    expected={
        "E2": "refuted",
        "E2:printed": "refuted",
        "E2:printed-state": "refuted",
        "E2:printed-run": "refuted",
        "E2:corrected": "verified",
    },
)
