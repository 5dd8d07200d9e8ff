"""Erratum E12: why the MSN project's flock describes a smaller circle and sine than its γ-agent."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np

from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.environment.targets import CircleTarget, SineTarget
from flockana.laws.olfati_saber import Algorithm2
from flockana.stability.centre_path import centre_path, motion, path_and_factor
from flockana.stability.tracking import response_ratio, whole_period
from flockana.stability.translational import predicted_gain
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge

_NAMES = ("predicted", "consistent", "printed")


def _hypotheses(run: Trajectory) -> list[Hypothesis]:
    applies = type(run.law) is Algorithm2 and not run.law.gains.per_agent
    detail = f"{type(run.law).__name__}{', gains per agent' if not applies and type(run.law) is Algorithm2 else ''}"
    law = Hypothesis("Algorithm 2 is applied, one gain for all", "met" if applies else "unmet", detail=detail)
    path, factor = path_and_factor(run.law.target) if applies else (None, 1.0)
    swings = isinstance(path, SineTarget | CircleTarget) and whole_period(run, path)
    detail = f"p_r = {factor:.6g} dq_r/dt" if swings else "no circle or sine, or less than a period"
    target = Hypothesis("the γ-agent moves on a circle or a sine", "met" if swings else "unmet", detail=detail)
    wrong = Hypothesis("its p_r is not dq_r/dt", "met" if factor != 1.0 else "unmet", detail=detail)
    drag = float(run.law.gains.c2_gamma) if applies else 0.0
    damped = Hypothesis("c2γ > 0: the start is forgotten", "met" if drag > 0.0 else "unmet", drag)
    return [law, target, wrong, damped]


def _agrees(name: str, found: tuple[float, float], gain: float, tolerances: Tolerances, detail: str) -> Claim:
    """Relative to the predicted gain; where that is 0, which is told no velocity and feels no pull, to the γ-agent."""
    scale = gain or 1.0
    margin, error = tolerances.agreement - abs(found[0] - gain) / scale, found[1] / scale
    return Claim(
        name,
        judge(margin, error, []),
        computed=found[0],
        stated=gain,
        margin=margin,
        error=error,
        detail=f"{detail}: measured ratio {found[0]:.4f}, transfer function {gain:.4f}",
    )


def _consistent(run: Trajectory, path: SineTarget | CircleTarget) -> tuple[float, float]:
    """The ratio of the same flock behind the γ-agent with its true p_r, and its error, that of integration included."""
    law = replace(run.law, target=path)
    again = simulate(law, run.q[0], run.p[0], (float(run.t[0]), float(run.t[-1])))
    ratio, error = response_ratio(again)
    if law.gains.c1_gamma == 0.0:
        return ratio, error
    size = float(np.linalg.norm(motion(path).swing))
    centre = again.q.mean(axis=1)
    exact = centre_path(law.gains, path, again.t, centre[0], again.p[0].mean(axis=0))
    return ratio, error + float(np.abs(centre - exact).max()) / size


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    hypotheses = _hypotheses(run)
    if any(h.status == "unmet" for h in hypotheses):
        return hypotheses, [Claim(name, "vacuous", detail="no γ-agent with a wrong p_r to follow") for name in _NAMES]
    law = run.law
    path, factor = path_and_factor(law.target)
    assert isinstance(path, SineTarget | CircleTarget)
    omega = 2.0 * pi * path.frequency
    handed, true = response_ratio(run), _consistent(run, path)
    predicted = predicted_gain(law.gains, omega, factor=factor)
    margin = 1.0 - true[0]
    return hypotheses, [
        _agrees("predicted", handed, predicted, tolerances, f"with the p_r that was handed over, {factor:g} dq_r/dt"),
        _agrees("consistent", true, predicted_gain(law.gains, omega), tolerances, "with p_r = dq_r/dt"),
        Claim(
            "printed",
            judge(margin, true[1], []),
            computed=true[0],
            stated="the ratio is below 1 because the γ-agent turns",
            margin=margin,
            error=true[1],
            witness={"handed p_r": handed[0], "true p_r": true[0]},
            detail=f"the same turning γ-agent with its true p_r is followed at {true[0]:.4f} of its size, not less "
            f"than 1: it is the wrong p_r that makes the ratio {handed[0]:.4f}",
        ),
    ]


THEOREM = Theorem(
    id="E12",
    title="The flock's path is smaller than the γ-agent's because p_r is wrong",
    statement=(
        "The MSN project finds the flock's circle and sine smaller than the γ-agent's and blames the reversal of its "
        "velocity. The centre of mass is a linear filter of (q_r, p_r), and the project's p_r is per iteration, 0.009 "
        "of dq_r/dt: at its gains the ratio is then 0.852, and 1.109 with the true p_r."
    ),
    source="MSN project, conclusion, cases 3 and 4",
    kind="trajectory",
    check=_check,
    references=("isola-2024", "olfati-saber-2006"),
)
