"""Errata J7 to J9: a bound that drags, an estimate that drifts, an alien that nobody minds (bearing-distance paper)."""

from __future__ import annotations

from math import tanh

import numpy as np

from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.environment.zone_world import Alien, ZoneWorld
from flockana.interactions import ZoneRadii, ZoneWeights
from flockana.laws.bearing_distance import ZoneFlocking
from flockana.measures.nets import components, links
from flockana.theorems.shares import always, mostly, share, zone_start
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge

_SEEDS, _END = 20, 20.0
_SAME = 1e-9  # relative: numbers that differ by less are the same
_ROUNDING, _INTERVAL = 1e-11, 1e-9  # relative: of a few hundred steps of one agent; of the ends of an exact interval
_SOURCE = "Jond, bearing-distance flocking"
_REFERENCES = ("jond-2025",)
_WATCHFUL = ZoneRadii(1.5, c=3.0, a=5.0, s=6.0)
_STRONG = ZoneWeights(separation=20.0, cohesion_gain=0.5, alignment_gain=4.0)  # recommended for section 5.2


def _runs(law: ZoneFlocking) -> list[Trajectory]:
    return [simulate(law, *zone_start(seed), (0.0, _END)) for seed in range(_SEEDS)]


def _late_speed(run: Trajectory) -> float:
    return float(np.linalg.norm(run.p[len(run.t) // 2 :], axis=2).mean())


def dragged_speed(dt: float, *, u_max: float = 2.0, v_max: float = 4.0) -> float:
    """The largest speed that full thrust holds against (10): the fixed point of v -> v^max tanh((v + dt u^max)/v^max).

    Parameters
    ----------
    dt : float
        Step.
    u_max, v_max : float
        Bounds of input and speed.

    Examples
    --------
    >>> round(dragged_speed(0.1), 4), round(dragged_speed(0.001), 3)
    (2.0083, 0.457)
    """
    from scipy.optimize import brentq

    return float(brentq(lambda v: v_max * tanh((v + dt * u_max) / v_max) - v, 1e-6, v_max, xtol=1e-14))


def _j7(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    law = ZoneFlocking(speed_bound="tanh")
    after = law.step(0.0, np.zeros((1, 2)), np.array([[3.0, 0.0]]), law.start(np.zeros((1, 2)), np.array([[3.0, 0.0]])))
    step, bound = float(after[1][0, 0]), dragged_speed(law.dt)
    off, short = abs(step / (4.0 * tanh(0.75)) - 1.0), bound / law.desired_speed - 1.0
    letter = [_late_speed(run) for run in _runs(ZoneFlocking.printed(own_velocity="measured"))]
    clip = [
        _late_speed(run)
        for run in _runs(ZoneFlocking.printed(own_velocity="measured", order="synchronous", speed_bound="clip"))
    ]
    near = 0.05 * law.desired_speed
    return [], [
        Claim(
            "step",
            judge(_SAME - off, _ROUNDING, []),
            computed=step,
            stated=4.0 * tanh(0.75),
            margin=_SAME - off,
            error=_ROUNDING,
            witness="one agent at the desired speed, no input",
            detail=f"applied to the state, (10) makes a speed of 3 into {step:.4g} in every step: a drag",
        ),
        Claim(
            "reachable",
            judge(short, _ROUNDING, []),
            computed=bound,
            stated=f"the desired speed {law.desired_speed:g} is below the bound 4, so it can be kept",
            margin=short,
            error=_ROUNDING,
            witness={dt: dragged_speed(dt) for dt in (0.1, 0.05, 0.01, 0.001)},
            detail=f"with all inputs within u^max = 2 no speed above {bound:.4f} lasts (steps of 0.1 s); with "
            "finer steps less still",
        ),
        always(
            "speed",
            [abs(v - law.desired_speed) <= near for v in letter],
            "with (10) on the state the mean speed is about 3",
            "mean speed about 3 m/s",
            witness={"mean speed over seeds": float(np.mean(letter))},
        ),
        mostly(
            "clip",
            [abs(v - law.desired_speed) <= near for v in clip],
            "with v min(1, v^max/|v|) it is about 3",
            "a plain clip lets the flock keep 3 m/s",
            witness={"mean speed over seeds": float(np.mean(clip))},
        ),
    ]


def _forms(tolerances: Tolerances) -> Claim:
    """The same flock in both forms, each with its true velocity: equal to rounding."""
    worst = 0.0
    for seed in range(_SEEDS):
        q, p = zone_start(seed)
        a, b = (ZoneFlocking(form=form).behaviours(q, p) for form in ("position", "bearing"))
        largest = max(float(np.abs(term).max()) for term in a.values())
        worst = max(worst, *(float(np.abs(a[name] - b[name]).max()) / largest for name in a))
    return Claim(
        "forms",
        judge(_SAME - worst, _ROUNDING, []),
        computed=worst,
        stated="with the true velocity both forms of all six behaviours are equal",
        margin=_SAME - worst,
        error=_ROUNDING,
        witness={"starts": _SEEDS},
        detail=f"with the true velocity position and bearing form agree to {worst:.1g}: (12)-(15) are right",
    )


def _j8(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    estimated, measured = (_runs(ZoneFlocking(own_velocity=name)) for name in ("estimated", "measured"))
    drift = [float(np.linalg.norm(run.extra["estimate"][-1] - run.p[-1], axis=1).mean()) for run in estimated]
    parts = [int(components(run.n, links(run.q[-1], 5.0)).max()) + 1 for run in estimated]
    whole = [not components(run.n, links(run.q[-1], 5.0)).any() for run in measured]
    return [], [
        _forms(tolerances),
        always(
            "equivalent",
            [one < 0.1 for one in drift],
            "with (17) the estimate is within 0.1 m/s of the velocity after 20 s",
            "the estimate (17) makes the bearing form equivalent (Remark 3)",
            witness={"mean error of the estimate, by seed": drift},
        ),
        always(
            "holds-together",
            [one == 1 for one in parts],
            f"with (17) the flock is one component ({np.median(parts):g} in the median)",
            "the flock stays together with the estimate as well",
            witness={"components by seed": parts},
        ),
        mostly("measured", whole, "with its true velocity it is one component", "odometry mends it"),
    ]


def _nearest_alien(surveillance: str) -> tuple[float, list[float]]:
    """(least signed gap of an agent that runs head on at an alien at rest, least distances of ten agents, by seed)."""
    post = ZoneWorld((), None, (Alien((20.0, 0.0), detection=1e-3),))
    lone = ZoneFlocking(_WATCHFUL, ZoneWeights(), post, surveillance=surveillance)
    run = simulate(lone, [[0.0, 0.0]], [[3.0, 0.0]], (0.0, _END))
    hunter = ZoneWorld((), None, (Alien((16.0, 16.0)),))
    flock = ZoneFlocking(_WATCHFUL, _STRONG, hunter, surveillance=surveillance, u_max=10.0)
    gaps = [one.q[:, :, None] - one.extra["alien"][:, None] for one in _runs(flock)]
    nearest = [float(np.linalg.norm(gap, axis=3).min()) for gap in gaps]
    return float((20.0 - run.q[:, 0, 0]).min()), nearest


def _j9(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    (through, annulus), (gap, disc) = (_nearest_alien(name) for name in ("annulus", "disc"))
    stand_off = 6.0 - 3.0 * 5.0 / 5.0  # s − v^d w^ga/w^ss
    clear = sum(d > a for d, a in zip(disc, annulus, strict=True))
    _, size, interval = share([one > 1.5 for one in annulus])
    return [], [
        Claim(
            "printed",
            judge(through / stand_off, _ROUNDING, []),
            computed=through,
            stated="an agent keeps clear of an alien that it sees",
            margin=through / stand_off,
            error=_ROUNDING,
            witness={"alien": (20.0, 0.0), "q(0)": (0.0, 0.0), "p(0)": (3.0, 0.0)},
            detail="N_i^s ends at a_i: nearer than 5 m the alien exerts no force: an agent runs straight through it",
        ),
        Claim(
            "corrected",
            judge(1e-3 - abs(gap / stand_off - 1.0), _ROUNDING, []),
            computed=gap,
            stated=stand_off,
            margin=1e-3 - abs(gap / stand_off - 1.0),
            error=_ROUNDING,
            witness="the same agent and alien, 0 < d <= s_i",
            detail=f"with 0 < d <= s_i it stops at {gap:.4f} m, where s - v^d w^ga/w^ss = {stand_off:g}",
        ),
        Claim(
            "flock",
            "refuted" if interval[1] < 1.0 - _INTERVAL else "inconclusive",
            computed={"median, printed": float(np.median(annulus)), "median, corrected": float(np.median(disc))},
            stated="the flock keeps more than 1.5 m from an alien that hunts it (share 1)",
            margin=interval[1] - 1.0,
            error=_INTERVAL,
            witness={"printed": annulus, "corrected": disc},
            detail=f"least distance of ten agents from a hunting alien over {size} seeds: {np.median(annulus):.2f} m "
            f"in the median as printed, {np.median(disc):.2f} m as corrected (larger in {clear} of {size})",
        ),
    ]


THEOREM = (
    Theorem(
        id="J7",
        title="The velocity bound is a drag",
        statement=(
            "(10) passes the velocity through v^max tanh(|v|/v^max) in every step. That is a drag: 3 m/s become 2.54, "
            "and with |u| <= 2 no speed above 2.01 lasts, so that v^d = 3 is out of reach. A plain clip is meant."
        ),
        source=f"{_SOURCE}, (10)",
        kind="fixed",
        check=_j7,
        references=_REFERENCES,
        expected={
            "J7": "refuted",
            "J7:step": "verified",
            "J7:reachable": "refuted",
            "J7:speed": "refuted",
            "J7:clip": "verified",
        },
    ),
    Theorem(
        id="J8",
        title="The velocity estimate drifts",
        statement=(
            "Remark 3 holds the bearing form with the estimate (17) for equivalent. (17) leaves out the global speed "
            "term and both bounds: estimates drift away from the velocities, and the flock disperses."
        ),
        source=f"{_SOURCE}, (17) and Remark 3",
        kind="fixed",
        check=_j8,
        references=_REFERENCES,
        expected={
            "J8": "refuted",
            "J8:forms": "verified",
            "J8:equivalent": "refuted",
            "J8:holds-together": "refuted",
            "J8:measured": "verified",
        },
    ),
    Theorem(
        id="J9",
        title="An alien nearer than a_i is not minded",
        statement=(
            "N_i^s holds the aliens at a_i < d <= s_i: one that comes closer exerts no force and walks through the "
            "flock. With 0 < d <= s_i an agent stands off at s - v^d w^ga/w^ss."
        ),
        source=f"{_SOURCE}, definition of N_i^s",
        kind="fixed",
        check=_j9,
        references=_REFERENCES,
        expected={"J9": "refuted", "J9:printed": "refuted", "J9:corrected": "verified", "J9:flock": "refuted"},
    ),
)
