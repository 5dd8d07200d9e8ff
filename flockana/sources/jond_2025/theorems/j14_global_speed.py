"""J14, confirmed: a new global speed emerges; the desired one as soon as one agent is informed."""

import numpy as np

from flockana.sources.jond_2025.interactions.zones import ZoneRadii, ZoneWeights
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.sources.jond_2025.theorems.random_starts import separated_start
from flockana.theorems.theorem_toolkit import Claim, FloatArray, Tolerances, erratum, lengths, mostly, observed, of_map

_SAME, _ROUNDING = 1e-9, 1e-11  # relative: speeds that differ by less are the same; of a few hundred steps
_RADII = ZoneRadii(1.5, c=3.0, a=5.0)
_UNBOUNDED = 1e6  # an input bound that never acts
_APART, _STEPS = 4.0, 1000  # m, in the zone of attraction; steps of 0.1 s
_GAIN, _DRIVE, _DESIRED = 2.0, 1.0, 3.0
_AGENTS, _SEEDS, _DURATION = 10, 12, 60.0
_NEAR = 0.05  # a mean speed this close, relative, is "about" the desired one


def _pair(informed: int, speeds: tuple[float, float]) -> tuple[FloatArray, FloatArray]:
    """Return speeds over time of two agents side by side, some of them informed: simulated, and by x' = M x."""
    drive_gains = tuple(_DRIVE if k < informed else 0.0 for k in range(2))
    weights = ZoneWeights(speed=drive_gains, cohesion_gain=0.0, alignment_gain=_GAIN)
    law = ZoneFlocking(_RADII, weights, u_max=_UNBOUNDED, v_max=_UNBOUNDED, desired_speed=_DESIRED)
    q, p = np.array([[0.0, 0.0], [0.0, _APART]]), np.column_stack([speeds, [0.0, 0.0]])
    run = law.iterate(0.0, q, p, law.start(q, p), _STEPS)[1][:, :, 0]
    matrix = np.array([[-_GAIN - drive_gains[0], _GAIN], [_GAIN, -_GAIN - drive_gains[1]]])
    predictions, x = [], np.array(speeds)
    for _ in range(_STEPS):
        x = x + law.dt * (matrix @ x + _DESIRED * np.array(drive_gains))
        predictions.append(x)
    return run, np.array(predictions)


def _informed_or_not() -> list[Claim]:
    informed_speeds, predicted_speed = _pair(1, (1.0, 1.0))
    deviation = float(np.abs(informed_speeds - predicted_speed).max()) / _DESIRED
    left = float(np.abs(informed_speeds[-1] - _DESIRED).max()) / _DESIRED
    alone, _ = _pair(0, (1.0, 2.0))
    spread = float(np.abs(alone[-1] - 1.5).max()) / 1.5
    return [
        of_map("one-informed", _SAME - float(np.maximum(deviation, left)), _ROUNDING).described(
            computed=informed_speeds[-1].tolist(),
            stated=_DESIRED,
            witness={"informed": "one of two", "p(0)": (1.0, 1.0)},
            detail=f"of two agents at 1 m/s one is informed of v^d = {_DESIRED:g}: both reach it as x' = M x predicts, "
            f"whose polynomial λ² + (2g + w) λ + g w is Hurwitz (off by {deviation:.1g})",
        ),
        of_map("none-informed", _SAME - spread, _ROUNDING, computed=alone[-1].tolist(), stated=1.5).described(
            witness={"informed": "none", "p(0)": (1.0, 2.0)},
            detail="two uninformed agents at 1 and 2 m/s agree on 1.5 m/s: alignment alone preserves the mean",
        ),
    ]


def _speeds(informed: int) -> list[float]:
    """Return mean speeds, by seed, over the second half of runs of ten agents, some of them informed."""
    weights = ZoneWeights(speed=tuple([5.0] * informed + [0.0] * (_AGENTS - informed)))
    runs = (observed(ZoneFlocking(_RADII, weights), *separated_start(k), (0.0, _DURATION)).run for k in range(_SEEDS))
    return [float(lengths(run.p[len(run.t) // 2 :]).mean()) for run in runs]


@erratum(
    "J14",
    expected={"verified": "one-informed none-informed two-of-ten none-of-ten"},
    ours=("none-informed", "none-of-ten"),
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """When some agents alter their speeds their neighbours follow, and a new global speed results; w^ga = 0 for agents
    that are not informed of v^d. True: all agents that alignment reaches adopt v^d from a single informed agent. If
    none is informed, the flock agrees on a mean of its own velocities, and not on v^d.
    """
    two_informed_speeds, speeds_without = _speeds(2), _speeds(0)
    return [
        *_informed_or_not(),
        mostly(
            "two-of-ten",
            [abs(v / _DESIRED - 1.0) <= _NEAR for v in two_informed_speeds],
            "with two informed agents of ten the mean speed is about v^d",
            "the flock adopts the speed of the informed agents",
        ).described(witness={"mean speed by seed": two_informed_speeds}),
        mostly(
            "none-of-ten",
            [abs(v / _DESIRED - 1.0) > _NEAR for v in speeds_without],
            f"with none informed the mean speed is not about v^d ({np.median(speeds_without):.2f} in the median)",
            "a flock without informed agents does not fly at the desired speed",
        ).described(witness={"mean speed by seed": speeds_without}),
    ]
