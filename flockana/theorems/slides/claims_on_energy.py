"""Claims about an energy that a source prints wrongly (E1, E2): by algebra, at an exact state, along a run."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.theorems.claims import exact, of_state
from flockana.theorems.rounding import energy_error
from flockana.theorems.second_run import corroborated
from flockana.theorems.theorem import Claim, Hypothesis

PROOF = "energy-identities"


def state_claim(state: Any) -> Claim:
    """The claim that the printed energy does not rise, at a rational state where its exact rate is known."""
    rate, true_rate = float(state.rate), float(state.true_rate)
    return exact(
        "printed-state",
        not state.rate.is_positive,
        computed=rate,
        stated="dH/dt <= 0 for the printed H",
        margin=-rate,
        error=0.0,
        witness={"q": [str(x) for x in state.q], "p": [str(x) for x in state.p]},
        proof=PROOF,
        detail=f"at an exact state of two agents the printed H has rate {rate:.4g}, the true one {true_rate:g}",
    )


def run_claim(run: Trajectory, excess: FloatArray, where: str, needs: Iterable[Hypothesis] = ()) -> Claim:
    """The claim that the printed energy, the true one plus an excess, never rises while the true one falls.

    It is refuted by a rise from any sample to a later one, by more than the balance of the true energy is off; samples
    at which it does not rise verify nothing.
    """
    true = run.energy()
    printed = true + excess
    above = printed - np.minimum.accumulate(printed)
    peak = int(np.argmax(above))
    rounding = float(energy_error(run.law, run.q, run.p, np.abs(true) + np.abs(excess)).max())
    error = 2.0 * (float(np.abs(run.energy_residual).max()) + rounding)
    rise, falls = float(above[peak]), float(np.diff(true).max(initial=-np.inf)) <= error
    course = f"the printed H rises by {rise:.4g} until t = {run.t[peak]:.3g}" if rise > 0.0 else "the printed H falls"
    claim = of_state(
        "printed-run",
        -rise if falls else 0.0,
        error,
        needs,
        computed=rise,
        stated="the printed H never rises",
        witness={"q(0)": run.q[0].tolist(), "p(0)": run.p[0].tolist(), "time": float(run.t[peak])},
        detail=f"along a run of {where} {course}; the true one {'falls throughout' if falls else 'rises too'}",
    )
    return replace(claim, margin=-rise)


def corroborated_run_claim(run: Trajectory, excess: Callable[[Trajectory], FloatArray], where: str) -> Claim:
    """`run_claim` of an erratum's own run, with the error that a tighter second run of it shows."""
    (claim,) = corroborated(
        [run_claim(run, excess(run), where)], run, lambda again: [run_claim(again, excess(again), where)]
    )
    return claim
