"""Erratum E12: why the MSN project's flock describes a smaller circle and sine than its γ-agent."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np

from flockana.checks import FloatArray
from flockana.environment.targets import CircleTarget, RescaledVelocity, SineTarget, Target
from flockana.errors import ArgumentError
from flockana.interactions import Gains
from flockana.laws.olfati_saber import Algorithm2
from flockana.simulate import simulate
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge
from flockana.trajectory import Trajectory

_NAMES = ("predicted", "consistent", "printed")


def _path(target: Target | None) -> tuple[Target | None, float]:
    """(the γ-agent's path, the factor of its p_r), unwrapped."""
    if isinstance(target, RescaledVelocity):
        return target.target, target.factor
    return target, 1.0


def predicted_gain(gains: Gains, omega: float, *, factor: float = 1.0) -> float:
    """|G(jω)| from q_r to q_c: G(s) = (factor c2γ s + c1γ)/(s² + c2γ s + c1γ).

    Parameters
    ----------
    gains : Gains
        c1γ and c2γ are used.
    omega : float
        Angular frequency, in radians per time unit.
    factor : float
        p_r over dq_r/dt.

    Examples
    --------
    >>> round(predicted_gain(Gains(c1_gamma=4.0, c2_gamma=3.0), 2.0, factor=0.0), 6)
    0.666667
    """
    s = 1j * omega
    c1, c2 = gains.c1_gamma, gains.c2_gamma
    return float(abs((factor * c2 * s + c1) / (s * s + c2 * s + c1)))


def _amplitude(t: FloatArray, x: FloatArray, omega: float) -> tuple[float, float]:
    """(amplitude at ω, its error): least squares of A cos ωt + B sin ωt + C + D t on each coordinate of x (T, m)."""
    basis = np.column_stack([np.cos(omega * t), np.sin(omega * t), np.ones_like(t), t])
    fit = np.linalg.lstsq(basis, x, rcond=None)[0]
    residual = x - basis @ fit
    return float(np.linalg.norm(fit[:2])), float(np.sqrt(np.mean(np.sum(residual**2, axis=1))))


def response_ratio(run: Trajectory) -> tuple[float, float]:
    """Ratio of the centre of mass's circle or sine to the γ-agent's, over the last whole periods, and its error.

    At most half of the run is used, but at least one period: what precedes is transient. The error is the root mean
    square of what the fit leaves over, relative to the γ-agent's amplitude.

    Parameters
    ----------
    run : Trajectory
        A run whose law has a sine or circle as its target.

    Raises
    ------
    ArgumentError
        If the law has no such target, or the run is shorter than one period.

    Examples
    --------
    >>> law = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=4.0), target=CircleTarget((0.0, 0.0), 1.0, 0.25))
    >>> ratio, error = response_ratio(simulate(law, [[1.0, 0.0]], [[0.0, 0.0]], (0.0, 30.0)))
    >>> bool(abs(ratio - predicted_gain(law.gains, 0.5 * pi)) < 1e-6)
    True
    """
    path, _ = _path(getattr(run.law, "target", None))
    if not isinstance(path, SineTarget | CircleTarget):
        raise ArgumentError(f"target = {path!r}: expected a SineTarget or a CircleTarget")
    period, length = 1.0 / path.frequency, float(run.t[-1] - run.t[0])
    if length < period:
        raise ArgumentError(f"the run lasts {length:g}: expected at least one period, {period:g}")
    window = run.window(run.t[-1] - period * max(1, int(0.5 * length / period)), run.t[-1])
    omega = 2.0 * pi * path.frequency
    flock, error = _amplitude(window.t, window.q.mean(axis=1), omega)
    agent, _ = _amplitude(window.t, np.array([path.position(t) for t in window.t]), omega)
    return flock / agent, error / agent


def _hypotheses(run: Trajectory) -> list[Hypothesis]:
    applies = type(run.law) is Algorithm2
    law = Hypothesis("Algorithm 2 is applied", "met" if applies else "unmet", detail=type(run.law).__name__)
    path, factor = _path(run.law.target) if applies else (None, 1.0)
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
    path, factor = _path(law.target)
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
