"""Erratum E1: the Hamiltonian needs the factor ½ before Σ‖p_i‖²."""

from __future__ import annotations

import numpy as np

from flockana.laws.olfati_saber import Algorithm1
from flockana.simulate import simulate
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances


def _identity(name: str, identity: object, stated: str, detail: str) -> Claim:
    residual = identity.residual  # type: ignore[attr-defined]
    return Claim(
        name,
        "verified" if residual == 0 else "refuted",
        "symbolic",
        computed="residual 0" if residual == 0 else "a residual that is not 0",
        stated=stated,
        witness=str(residual),
        proof="energy-identities",
        detail=detail,
    )


def _rising_run() -> Claim:
    """Two agents at rest, 8 apart: they fall towards each other, and the printed energy climbs."""
    run = simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 2.0))
    kinetic = 0.5 * np.sum(run.p**2, axis=(1, 2))
    printed, true = run.energy() + kinetic, run.energy()
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
        witness={"q(0)": [0.0, 8.0], "p(0)": [0.0, 0.0], "time": float(run.t[peak])},
        detail=f"along a run of two agents the printed H rises by {rise:.4g} until t = {run.t[peak]:.3g}; the true one "
        f"falls throughout",
    )


def _check(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    from flockana.symbolic import algorithm1_identity, e1_counterexample, e1_identity

    state = e1_counterexample()
    rate, true_rate = float(state.rate), float(state.true_rate)
    return [], [
        _identity(
            "printed",
            e1_identity(m=2),
            "d/dt (V + Σ‖p_i‖²) = -c2α pᵀL̂p",
            "with the printed H a term -dV/dt is left over, and it has no sign",
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
            algorithm1_identity(m=2),
            "d/dt (V + ½ Σ‖p_i‖²) = -c2α pᵀL̂p",
            "with ½ the identity is exact, for every n",
        ),
    ]


THEOREM = Theorem(
    id="E1",
    title="The Hamiltonian is V + ½ Σ‖p_i‖²",
    statement="The slides print H = V + Σ‖p_i‖² and take its derivative to be -pᵀL̂p; that needs the factor ½.",
    source="slides, collective dynamics",
    kind="fixed",
    check=_check,
    references=("geschwender-2016", "olfati-saber-2006"),
    expected={
        "E1": "refuted",
        "E1:printed": "refuted",
        "E1:printed-state": "refuted",
        "E1:printed-run": "refuted",
        "E1:corrected": "verified",
    },
)
