"""The energy identities that the theorems rest on, checked along a run."""

from __future__ import annotations

import numpy as np

from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge
from flockana.trajectory import Trajectory


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    applies = type(run.law) in (Algorithm1, Algorithm2)
    law = Hypothesis("Algorithm 1 or 2 is applied", "met" if applies else "unmet", detail=type(run.law).__name__)
    if not applies:
        return [law], [Claim(name, "vacuous", detail="no energy is known for this law") for name in ("rate", "balance")]
    rate = run.energy_rate()
    worst = int(np.argmax(rate))
    # a sum of terms of one sign: rounding cannot change the sign, so no error is allowed for
    sign = Claim(
        "rate",
        "verified" if rate[worst] <= 0.0 else "refuted",
        computed=float(rate[worst]),
        stated="dH/dt <= 0",
        margin=-float(rate[worst]),
        error=0.0,
        witness={"time": float(run.t[worst])},
        detail=f"the closed-form rate is at most {rate[worst]:.3g} over the run",
    )
    energy, residual = run.energy(), run.energy_residual
    size = float(np.abs(energy).max()) or 1.0
    worst = int(np.argmax(np.abs(residual)))
    share, rounding = abs(float(residual[worst])) / size, 1e-14
    margin = tolerances.energy - share
    balance = Claim(
        "balance",
        judge(margin, rounding, [law]),
        computed=share,
        stated=f"H(t) - H(0) = integral of dH/dt, to {tolerances.energy:g} of the largest |H|",
        margin=margin,
        error=rounding,
        witness={"time": float(run.t[worst]), "residual": float(residual[worst])},
        detail=f"H falls from {energy[0]:.6g} to {energy[-1]:.6g}; the balance is off by {share:.2g} of it at most",
    )
    return [law], [sign, balance]


THEOREM = Theorem(
    id="energy",
    title="Energy identities of Algorithms 1 and 2",
    statement=(
        "dH/dt = -c2α pᵀL̂p under Algorithm 1, and dH_λ/dt = -c2γ‖v‖² - c2α vᵀL̂v in the moving frame under "
        "Algorithm 2: the closed form agrees with the energy of the integrated run, and is never positive."
    ),
    source="Olfati-Saber 2006, proofs of Theorems 1 and 3",
    kind="trajectory",
    check=_check,
)
