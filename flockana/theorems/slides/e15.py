"""Erratum E15: what the MSN project lays the smaller circle of its case 4 to: the start, and the speed."""

from __future__ import annotations

from itertools import pairwise
from math import pi, sqrt
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.simulate import simulate
from flockana.environment.targets import CircleTarget, RescaledVelocity
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_patch
from flockana.laws.msn import MSNDiscretisation
from flockana.laws.olfati_saber import Algorithm2
from flockana.stability.tracking import response_ratio
from flockana.stability.translational import CentreOfMass, predicted_gain
from flockana.theorems.claims import equal, erratum, of_state
from flockana.theorems.theorem import Claim, Tolerances

_DT, _RADIUS, _CENTRE = 0.009, 100.0, (50.0, 50.0)  # the project's
_FREQUENCY = 0.025 / 5.0 / _DT
_ALPHA = AlphaInteraction(d=15.0, r=18.0, eps=0.1, h=0.1, a=3.0, b=3.0)
_GAINS = Gains(c1_alpha=100.0, c2_alpha=20.0, c1_gamma=70.0, c2_gamma=2.0 * sqrt(70.0))
_SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0)  # of the project's γ-agent
_AWAY = 3.0  # radii from the centre of the circle to where a flock outside starts
_PERIODS = 3.0  # at least: the fit takes the last whole ones of half a run
_LASTING = 4.5  # time units at least, after half of which what is left of the start is e^-19 of it

Ratio = tuple[float, float]


def circle_law(speed: float, factor: float) -> Algorithm2:
    """Algorithm 2 with the project's parameters behind its γ-agent at so many times its speed, p_r = factor dq_r/dt."""
    circle = CircleTarget(_CENTRE, _RADIUS, frequency=speed * _FREQUENCY)
    return Algorithm2(_ALPHA, _GAINS, RescaledVelocity(circle, factor))


def followed(law: Algorithm2 | MSNDiscretisation, *, away: float = 0.0) -> Ratio:
    """Ratio, and its error, of the circle of 19 agents that start so many radii from the circle's centre."""
    path: Any = law.target
    start: FloatArray = hexagonal_patch(2, _ALPHA.d) + np.array(_CENTRE) + (away * _RADIUS, 0.0)
    end = max(_PERIODS / path.target.frequency, _LASTING)
    if isinstance(law, MSNDiscretisation):
        end = law.dt * round(end / law.dt)
    return response_ratio(simulate(law, start, 0.0 * start, (0.0, end)))


def _condition() -> Any:
    """Numerator of d|G|²/dω² less what it is said to be, for every c1γ, c2γ, ω and factor of p_r."""
    import sympy as sp

    from flockana.symbolic.parameters import GAINS
    from flockana.symbolic.translational import falling_condition, gain_slope

    factor, w = sp.Symbol("k", real=True), sp.Symbol("w", nonnegative=True)
    c1, c2 = GAINS.c1_gamma, GAINS.c2_gamma
    told = -(c1**2) * falling_condition(factor) - 2 * c1**2 * w - factor**2 * c2**2 * w**2
    return sp.expand(gain_slope(factor, square=w) - told)


def _least_sure(margins: list[tuple[float, float]]) -> tuple[float, float]:
    """Of several (margin, error) that must all be positive the one that decides; NaN goes before all."""
    return margins[int(np.argmin([margin - error for margin, error in margins]))]


def _falls(name: str, ratios: list[Ratio], stated: str, text: str) -> Claim:
    """The claim that each ratio is below the one before; the margin is the drop that is least sure."""
    margin, error = _least_sure([(a - b, e + f) for (a, e), (b, f) in pairwise(ratios)])
    values = [ratio for ratio, _ in ratios]
    listed = ", ".join(f"{value:.3f}" for value in values)
    detail = f"at ¼, ½, 1, 2 and 4 times the γ-agent's speed {text} the ratio is {listed}"
    return of_state(name, margin, error, computed=values, stated=stated, detail=detail)


def _agree(ratios: list[Ratio], gains: list[float], tolerances: Tolerances) -> Claim:
    off = [(abs(ratio / gain - 1.0), error / gain) for (ratio, error), gain in zip(ratios, gains, strict=True)]
    margin, error = _least_sure([(tolerances.agreement - each, error) for each, error in off])
    worst = tolerances.agreement - margin
    return of_state(
        "predicted",
        margin,
        error,
        computed=[ratio for ratio, _ in ratios],
        stated="|G(jω)| of the centre of mass, whatever the start and the speed",
        detail=f"inside or outside, at each speed, with either p_r: off by {worst:.1g} at most",
    )


def _check(tolerances: Tolerances) -> list[Claim]:
    """19 agents behind the γ-agent, from inside and outside, at five speeds, with the printed p_r and the true."""
    ran, true = ([followed(circle_law(speed, factor)) for speed in _SPEEDS] for factor in (_DT, 1.0))
    mapped = [followed(MSNDiscretisation(circle_law(speed, _DT), _DT)) for speed in _SPEEDS]
    inside, outside = ran[_SPEEDS.index(1.0)], followed(circle_law(1.0, _DT), away=_AWAY)
    others = [ratio for speed, ratio in zip(_SPEEDS, ran, strict=True) if speed != 1.0]
    largest, error = others[int(np.argmax([ratio + error for ratio, error in others]))]
    gains = [
        predicted_gain(_GAINS, 2.0 * pi * _FREQUENCY * speed, factor=factor)
        for factor in (_DT, 1.0)
        for speed in _SPEEDS
    ]
    home = predicted_gain(_GAINS, 2.0 * pi * _FREQUENCY, factor=_DT)
    margin = CentreOfMass(_GAINS, _DT).falling
    return [
        of_state(
            "printed-start",
            outside[0] - 1.0,
            outside[1],
            computed=outside[0],
            stated="from outside the circle the flock's is not smaller",
            witness={"inside": inside[0], "outside": outside[0]},
            detail=f"from {_AWAY:g} radii away it describes {outside[0]:.4f} of the γ-agent's circle, from the centre "
            f"{inside[0]:.4f}: smaller wherever it starts",
        ),
        of_state(
            "printed-speed",
            largest - 1.0,
            error,
            computed=[ratio for ratio, _ in others],
            stated="at some other speed the flock's circle is not smaller",
            detail=f"with the project's p_r at ¼, ½, 2 and 4 times the speed it is {largest:.4f} of the γ-agent's at "
            "most: no speed is just great enough",
        ),
        _agree([*ran, *true, outside], [*gains, home], tolerances),
        _falls("faster", ran, "the faster the γ-agent, the smaller the circle", "and its p_r per iteration"),
        _falls("faster-as-run", mapped, "the same of the project's own map", "and the map, agent by agent in place,"),
        _falls("faster-true", true, "the same with the true p_r", "and its true p_r"),
        equal(
            "condition",
            _condition(),
            stated="|G(jω)| falls with every ω iff c2γ²(1 - k²) >= 2 c1γ, for p_r = k dq_r/dt",
            proof="tracking-gain",
            detail=f"so never with the true p_r; the project's gains and p_r meet it, {margin:.3g} times over",
        ),
    ]


THEOREM = erratum(
    "E15",
    title="Neither the start nor the speed makes the flock's circle smaller",
    statement=(
        "The MSN project lays the smaller circle of its case 4 to a flock that starts inside the γ-agent's and to a "
        "speed just great enough to follow, and finds: the faster, the smaller. The start is forgotten, and it is "
        "smaller at every speed. The faster the smaller holds of its p_r per iteration; with p_r = dq_r/dt the circle "
        "first grows with the speed, to 1.155 of the γ-agent's, whatever the gains, as long as c2γ = 2√c1γ."
    ),
    source="MSN project, conclusion, case 4",
    check=_check,
    references=("isola-2024", "olfati-saber-2006"),
    expected={
        "printed-start": "refuted",
        "printed-speed": "refuted",
        "predicted": "verified",
        "faster": "verified",
        "faster-as-run": "verified",
        "faster-true": "refuted",
        "condition": "verified",
    },
)
