"""Erratum E1: the Hamiltonian needs the factor ½ before Σ‖p_i‖²."""

from __future__ import annotations

import numpy as np

from flockana.dynamics.simulate import simulate
from flockana.laws.olfati_saber import Algorithm1
from flockana.theorems.slides.claims_on_energy import corroborated_run_claim, identity_claim, state_claim
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances


def _rising_run() -> Claim:
    """Two agents at rest, 8 apart: they fall towards each other, and the printed energy climbs."""
    run = simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 2.0))
    return corroborated_run_claim(run, lambda one: 0.5 * np.sum(one.p**2, axis=(1, 2)), "two agents")


def _check(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    from flockana.symbolic import algorithm1_identity, e1_counterexample, e1_identity

    return [], [
        identity_claim(
            "printed",
            e1_identity(m=2).residual,
            "d/dt (V + Σ‖p_i‖²) = -c2α pᵀL̂p",
            "with the printed H a term -dV/dt is left over, and it has no sign",
        ),
        state_claim(e1_counterexample()),
        _rising_run(),
        identity_claim(
            "corrected",
            algorithm1_identity(m=2).residual,
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
