"""Erratum J7: the velocity bound (10), applied to the state in every step, is a drag below the desired speed."""

from math import tanh

import numpy as np

from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.sources.jond_2025.theorems.random_starts import runs_from_random_starts
from flockana.theorems.theorem_toolkit import Claim, Tolerances, always, erratum, lengths, mostly, of_map, spectral

_SAME, _ROUNDING = 1e-9, 1e-11  # relative: numbers that differ by less are the same; of a few hundred steps


def dragged_speed(dt: float) -> float:
    """Return the largest speed under full thrust and (10), a fixed point of v^max tanh((v + dt u^max)/v^max)."""
    from scipy.optimize import brentq

    return float(brentq(lambda v: 4.0 * tanh((v + dt * 2.0) / 4.0) - v, 1e-6, 4.0, xtol=1e-14))


def _late_speeds(law: ZoneFlocking) -> list[float]:
    """Return the mean speed of all agents over the second half of a run, by seed."""
    return [float(lengths(run.p[len(run.t) // 2 :]).mean()) for run in runs_from_random_starts(law)]


@erratum("J7", expected={"verified": "step clip", "refuted": "reachable speed"}, ours=("step",))
def theorem(tolerances: Tolerances) -> list[Claim]:
    """(10) passes the velocity through v^max tanh(|v|/v^max) in every step. That is a drag: 3 m/s become 2.54, and with
    |u| <= 2 no speed above 2.01 lasts, so that v^d = 3 is out of reach. The paper presumably means a plain clip.
    """
    law = ZoneFlocking(speed_bound="tanh")
    after = law.step(0.0, np.zeros((1, 2)), np.array([[3.0, 0.0]]), law.start(np.zeros((1, 2)), np.array([[3.0, 0.0]])))
    step, bound = float(after[1][0, 0]), dragged_speed(law.dt)
    off, shortfall = abs(step / (4.0 * tanh(0.75)) - 1.0), bound / law.desired_speed - 1.0
    printed = _late_speeds(ZoneFlocking.printed(own_velocity="measured"))
    clip = ZoneFlocking.printed(own_velocity="measured", order="synchronous", speed_bound="clip")
    clipped = _late_speeds(clip)
    near = 0.05 * law.desired_speed
    speed_text = "with (10) on the state the mean speed is about 3"
    return [
        of_map("step", _SAME - off, _ROUNDING, proof="speed-bound", computed=step, stated=4.0 * tanh(0.75)).described(
            witness="one agent at the desired speed, no input",
            detail=f"applied to the state, (10) makes a speed of 3 into {step:.4g} in every step: a drag",
        ),
        spectral("reachable", shortfall, _ROUNDING, disproof="speed-bound", computed=bound).described(
            stated=f"the desired speed {law.desired_speed:g} is below the bound 4, so it can be kept",
            witness={dt: dragged_speed(dt) for dt in (0.1, 0.05, 0.01, 0.001)},
            detail=f"with all inputs within u^max = 2 no speed above {bound:.4f} lasts (steps of 0.1 s); with "
            "finer steps the limit is lower",
        ),
        always(
            "speed", [abs(v - law.desired_speed) <= near for v in printed], speed_text, "mean speed about 3 m/s"
        ).described(witness={"mean speed over seeds": float(np.mean(printed))}),
        mostly(
            "clip",
            [abs(v - law.desired_speed) <= near for v in clipped],
            "with v min(1, v^max/|v|) the mean speed is about 3",
            "a plain clip lets the flock keep 3 m/s",
        ).described(witness={"mean speed over seeds": float(np.mean(clipped))}),
    ]
