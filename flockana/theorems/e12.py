"""Erratum E12: why the MSN project's flock describes a smaller circle and sine than its γ-agent."""

from __future__ import annotations

from dataclasses import replace
from math import pi

from flockana.environment.targets import CircleTarget, SineTarget
from flockana.laws.olfati_saber import Algorithm2
from flockana.simulate import simulate
from flockana.stability.tracking import path_and_factor, response_ratio
from flockana.stability.translational import predicted_gain
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge
from flockana.trajectory import Trajectory

_NAMES = ("predicted", "consistent", "printed")


def _hypotheses(run: Trajectory) -> list[Hypothesis]:
    applies = type(run.law) is Algorithm2 and not run.law.gains.per_agent
    detail = f"{type(run.law).__name__}{', gains per agent' if not applies and type(run.law) is Algorithm2 else ''}"
    law = Hypothesis("Algorithm 2 is applied, one gain for all", "met" if applies else "unmet", detail=detail)
    path, factor = path_and_factor(run.law.target) if applies else (None, 1.0)
    swings = isinstance(path, SineTarget | CircleTarget) and run.t[-1] - run.t[0] >= 1.0 / path.frequency
    detail = f"p_r = {factor:.6g} dq_r/dt" if swings else "no circle or sine, or less than a period"
    target = Hypothesis("the γ-agent moves on a circle or a sine", "met" if swings else "unmet", detail=detail)
    wrong = Hypothesis("its p_r is not dq_r/dt", "met" if factor != 1.0 else "unmet", detail=detail)
    return [law, target, wrong]


def _agrees(name: str, found: tuple[float, float], gain: float, tolerances: Tolerances, detail: str) -> Claim:
    margin = tolerances.agreement - abs(found[0] / gain - 1.0)
    return Claim(
        name,
        judge(margin, found[1], []),
        computed=found[0],
        stated=gain,
        margin=margin,
        error=found[1],
        detail=f"{detail}: measured ratio {found[0]:.4f}, transfer function {gain:.4f}",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    hypotheses = _hypotheses(run)
    if any(h.status == "unmet" for h in hypotheses):
        return hypotheses, [Claim(name, "vacuous", detail="no γ-agent with a wrong p_r to follow") for name in _NAMES]
    law = run.law
    path, factor = path_and_factor(law.target)
    assert isinstance(path, SineTarget | CircleTarget)
    omega = 2.0 * pi * path.frequency
    consistent = simulate(replace(law, target=path), run.q[0], run.p[0], (float(run.t[0]), float(run.t[-1])))
    handed, true = response_ratio(run), response_ratio(consistent)
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
