"""Erratum E15: two stated causes of the smaller circle in the MSN project's case 4, start and speed."""

from itertools import pairwise, product
from math import pi, sqrt
from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.environment.targets import CircleTarget, RescaledVelocity
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm2
from flockana.sources.isola_2024.laws import MSNDiscretisation
from flockana.sources.isola_2024.theorems.e12_smaller_circle import measured_ratio
from flockana.stability.centre_transfer import CentreOfMass, predicted_gain
from flockana.theorems.theorem_toolkit import Claim, Enclosure, Tolerances, equal, erratum, judged, observed, stacked

_DT, _RADIUS, _CENTRE = 0.009, 100.0, (50.0, 50.0)  # the project's
_FREQUENCY = 0.025 / 5.0 / _DT
_ALPHA = AlphaInteraction(d=15.0, r=18.0, eps=0.1, h=0.1, a=3.0, b=3.0)
_GAINS = Gains(c1_alpha=100.0, c2_alpha=20.0, c1_gamma=70.0, c2_gamma=2.0 * sqrt(70.0))
_SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0)  # of the project's γ-agent
_PROOF = "tracking-gain"
_AWAY = 3.0  # radii from the centre of the circle to where a flock outside starts
_PERIODS = 3.0  # at least: the fit takes the last whole ones of half a run
_LASTING = 4.5  # time units at least; after half of them the start has decayed to e^-19


def circle_law(speed: float, factor: float) -> Algorithm2:
    """Return Algorithm 2 with the project's parameters, its γ-agent `speed` times as fast, and p_r = factor dq_r/dt."""
    circle = CircleTarget(_CENTRE, _RADIUS, frequency=speed * _FREQUENCY)
    return Algorithm2(_ALPHA, _GAINS, RescaledVelocity(circle, factor))


def followed(law: Algorithm2 | MSNDiscretisation, *, away: float = 0.0) -> Enclosure:
    """Return the ratio of the flock's circle to the γ-agent's, for 19 agents starting `away` radii off centre."""
    path: Any = law.target
    start: FloatArray = hexagonal_patch(2, _ALPHA.d) + np.array(_CENTRE) + (away * _RADIUS, 0.0)
    end = max(_PERIODS / path.target.frequency, _LASTING)
    if isinstance(law, MSNDiscretisation):
        end = law.dt * round(end / law.dt)
    return measured_ratio(observed(law, start, 0.0 * start, (0.0, end)))


def _condition() -> Any:
    """Return the difference between the numerator of d|G|²/dω² and its stated form, for all parameters."""
    import sympy as sp

    from flockana.symbolic.parameter_symbols import GAINS
    from flockana.symbolic.translational_dynamics import falling_condition, gain_slope

    factor, w = sp.Symbol("k", real=True), sp.Symbol("w", nonnegative=True)
    c1, c2 = GAINS.c1_gamma, GAINS.c2_gamma
    expected = -(c1**2) * falling_condition(factor) - 2 * c1**2 * w - factor**2 * c2**2 * w**2
    return sp.expand(gain_slope(factor, square=w) - expected)


def _falls(name: str, ratios: list[Enclosure], stated: str, text: str, **proof: Any) -> Claim:
    """Return the claim that the amplitude ratio decreases as the γ-agent's speed grows."""
    values, listing = _values(ratios), ", ".join(f"{ratio.mid:.3f}" for ratio in ratios)
    detail = f"at ¼, ½, 1, 2 and 4 times the γ-agent's speed {text} the ratio is {listing}"
    drops = stacked([a - b for a, b in pairwise(ratios)])
    return judged(name, drops, computed=values, stated=stated, detail=detail, **proof)


def _first_grows(ratios: list[Enclosure]) -> Claim:
    """Return the claim that the amplitude ratio rises between some two successive speeds of the γ-agent."""
    listing = ", ".join(f"{ratio.mid:.3f}" for ratio in ratios)
    return judged("first-grows", stacked([b - a for a, b in pairwise(ratios)]).max(), proof=_PROOF).described(
        computed=_values(ratios),
        stated="with the true p_r the circle first grows with the speed",
        detail=f"at ¼, ½, 1, 2 and 4 times the γ-agent's speed and its true p_r the ratio is {listing}",
    )


def _values(ratios: list[Enclosure]) -> list[float]:
    return [float(ratio.mid) for ratio in ratios]


def _agree(ratios: list[Enclosure], gains: list[float], tolerances: Tolerances) -> Claim:
    deviation = stacked([abs(ratio / gain - 1.0) for ratio, gain in zip(ratios, gains, strict=True)])
    return judged("predicted", tolerances.agreement - deviation, computed=_values(ratios)).described(
        stated="|G(jω)| of the centre of mass, whatever the start and the speed",
        detail="the ratio, inside or outside, at each speed, with either p_r, is off the predicted one by "
        f"{deviation.mid.max():.1g} at most",
    )


def _printed(inside: Enclosure, outside: Enclosure, others: list[Enclosure]) -> list[Claim]:
    """Return the project's claim that an outside start, or another speed, keeps the circle from shrinking."""
    largest = stacked(others).max()
    return [
        judged("printed-start", outside - 1.0, about="all", disproof=_PROOF, computed=float(outside.mid)).described(
            stated="from outside the circle the flock's is not smaller",
            witness={"inside": float(inside.mid), "outside": float(outside.mid)},
            detail=f"the flock describes {outside.mid:.4f} of the γ-agent's circle from {_AWAY:g} radii away, "
            f"{inside.mid:.4f} from its centre: smaller from both starts",
        ),
        judged("printed-speed", largest - 1.0, about="all", disproof=_PROOF, computed=_values(others)).described(
            stated="at some other speed the flock's circle is not smaller",
            detail=f"with the project's p_r at ¼, ½, 2 and 4 times the speed the circle is "
            f"{largest.mid:.4f} of the γ-agent's at most: smaller at each speed",
        ),
    ]


@erratum(
    "E15",
    corrected=(),
    expected={
        "refuted": "printed-start printed-speed",
        "verified": "predicted faster faster-as-run first-grows condition",
    },
    ours=("predicted", "first-grows", "condition"),
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The MSN project finds that the flock's circle is smaller if the γ-agent is faster, which is true of its program,
    with its p_r per iteration. It explains the smaller circle of case 4 'most likely' by a start inside the γ-agent's
    circle and a speed just great enough to follow. But the start is forgotten, and the circle is smaller at every
    speed. With p_r = dq_r/dt it first grows with the speed, to 1.155 of the γ-agent's, whatever the gains, as long as
    c2γ = 2√c1γ.
    """
    # 19 agents behind the γ-agent, from inside and outside, at five speeds, with the printed p_r and the true.
    ran, true = ([followed(circle_law(speed, factor)) for speed in _SPEEDS] for factor in (_DT, 1.0))
    mapped = [followed(MSNDiscretisation(circle_law(speed, _DT), _DT)) for speed in _SPEEDS]
    inside, outside = ran[_SPEEDS.index(1.0)], followed(circle_law(1.0, _DT), away=_AWAY)
    others = [ratio for speed, ratio in zip(_SPEEDS, ran, strict=True) if speed != 1.0]
    cases = [*product((_DT, 1.0), _SPEEDS), (_DT, 1.0)]
    gains = [predicted_gain(_GAINS, 2.0 * pi * _FREQUENCY * speed, factor=factor) for factor, speed in cases]
    margin = CentreOfMass(_GAINS, _DT).falling
    faster = "the faster the γ-agent, the smaller the circle"
    return [
        *_printed(inside, outside, others),
        _agree([*ran, *true, outside], gains, tolerances),
        _falls("faster", ran, faster, "and its p_r per iteration", proof=_PROOF),
        _falls("faster-as-run", mapped, "the same for the project's own map", "and the map, agent by agent in place,"),
        _first_grows(true),
        equal("condition", _condition(), proof=_PROOF).described(
            stated="|G(jω)| falls with every ω iff c2γ²(1 - k²) >= 2 c1γ, for p_r = k dq_r/dt",
            detail=f"the condition never holds for the true p_r; for the project's the left side is {margin:.3g} times "
            "the right",
        ),
    ]
