"""Claims about an energy that a source prints wrongly (E1, E2): by algebra, at an exact state, along a run."""

from __future__ import annotations

from typing import Any

import numpy as np

from flockana.checks import FloatArray
from flockana.theorems.theorem import Claim
from flockana.trajectory import Trajectory

PROOF = "energy-identities"


def identity_claim(name: str, residual: Any, stated: str, detail: str) -> Claim:
    """An identity by its residual, as computed by sympy: verified if that is 0, refuted if not.

    Parameters
    ----------
    name : str
        Name of the claim.
    residual : sympy.Expr
        What is left of the identity.
    stated, detail : str
        As in `Claim`.
    """
    holds = bool(residual == 0)
    return Claim(
        name,
        "verified" if holds else "refuted",
        "symbolic",
        computed="residual 0" if holds else "a residual that is not 0",
        stated=stated,
        witness=str(residual),
        proof=PROOF,
        detail=detail,
    )


def state_claim(state: Any) -> Claim:
    """That the printed energy does not rise, at a rational state where its exact rate is known.

    Parameters
    ----------
    state : flockana.symbolic.RisingEnergy
        The state and the two rates.
    """
    rate, true_rate = float(state.rate), float(state.true_rate)
    return Claim(
        "printed-state",
        "refuted" if state.rate.is_positive else "verified",
        "symbolic",
        computed=rate,
        stated="dH/dt <= 0 for the printed H",
        margin=-rate,
        error=0.0,
        witness={"q": [str(x) for x in state.q], "p": [str(x) for x in state.p]},
        proof=PROOF,
        detail=f"at an exact state of two agents the printed H has rate {rate:.4g}, the true one {true_rate:g}",
    )


def run_claim(run: Trajectory, excess: FloatArray, where: str) -> Claim:
    """That the printed energy, the true one plus an excess, never rises along a run on which the true one falls.

    Parameters
    ----------
    run : Trajectory
        The run.
    excess : ndarray, shape (T,)
        What the source prints too much.
    where : str
        The run in words.
    """
    printed, true = run.energy() + excess, run.energy()
    peak = int(np.argmax(printed))
    rise, error = float(printed[peak] - printed[0]), float(np.abs(run.energy_residual).max())
    falls = float(np.diff(true).max()) <= error
    return Claim(
        "printed-run",
        "refuted" if rise > error and falls else "inconclusive",
        computed=rise,
        stated="the printed H never rises",
        margin=-rise,
        error=error,
        witness={"q(0)": run.q[0].tolist(), "p(0)": run.p[0].tolist(), "time": float(run.t[peak])},
        detail=f"along a run of {where} the printed H rises by {rise:.4g} until t = {run.t[peak]:.3g}; the true one "
        "falls throughout",
    )
