"""J17, confirmed: agents with shorter sight than the alien react late and lose distance."""

import numpy as np
import numpy.typing as npt

from flockana.sources.jond_2025.environment.zone_world import Alien, ZoneWorld
from flockana.sources.jond_2025.interactions.zones import ZoneRadii, ZoneWeights
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, of_map

_DETECTION, _PURSUIT, _SPEED, _AT = 9.0, 1.5, 3.0, 20.0
_SHORT, _STEPS = 6.0, 200
_ROUNDING = 1e-9  # relative: of a few hundred steps


def _meeting(s: float) -> tuple[float, float, float]:
    """Return the times of an alien's first move and an agent's first reaction head on, and the least distance."""
    world = ZoneWorld(aliens=(Alien((_AT, 0.0), detection=_DETECTION, speed=_PURSUIT),))
    law = ZoneFlocking(ZoneRadii(1.5, c=3.0, a=5.0, s=s), ZoneWeights(), world, u_max=1e6)
    q, p = np.array([[0.0, 0.0]]), np.array([[_SPEED, 0.0]])
    qs, ps, _, memory = law.iterate(0.0, q, p, law.start(q, p), _STEPS)
    gap = np.abs(memory["alien"][:, 0, 0] - qs[:, 0, 0])
    hunt_step = first_step(memory["alien"][:, 0, 0] != _AT)
    # the input of step k is that of the state after step k − 1
    reaction_step = first_step(ps[:, 0, 0] < _SPEED * (1.0 - _ROUNDING))
    return law.dt * hunt_step, law.dt * reaction_step, float(gap.min())


def first_step(happens: npt.NDArray[np.bool_]) -> float:
    """Return the index of the first step that satisfies a condition, or NaN."""
    return float(np.argmax(happens)) if happens.any() else float("nan")


@erratum("J17", expected={"verified": "delay none nearer"})
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Section 5.2: the shorter surveillance radius of the agents, 6 m against the alien's 9 m, causes a delayed
    reaction. True: by (9 - s)/(v + v_alien) head on, and the alien comes that much nearer.
    """
    (hunt_time, reaction_time, near), (second_hunt_time, prompt_step, far) = _meeting(_SHORT), _meeting(_DETECTION)
    delay, none = reaction_time - hunt_time, prompt_step - second_hunt_time
    predicted, step = (_DETECTION - _SHORT) / (_SPEED + _PURSUIT), 0.1
    return [
        of_map("delay", 1.75 * step - abs(delay - predicted), _ROUNDING, computed=delay, stated=predicted).described(
            witness={"s": _SHORT, "detection": _DETECTION, "approach": _SPEED + _PURSUIT},
            detail=f"head on, an agent that sees {_SHORT:g} m reacts {delay:.2g} s after it was detected: "
            f"(9 - s)/(v + v_alien) = {predicted:.2g} s, to a step of {step:g} s",
        ),
        of_map("none", 1.75 * step - abs(none), _ROUNDING, computed=none, stated=0.0).described(
            witness={"s": _DETECTION, "detection": _DETECTION},
            detail=f"with s = {_DETECTION:g}, the alien's range, agents react within {abs(none):.2g} s: the next step",
        ),
        of_map("nearer", (far - near) / _DETECTION, _ROUNDING).described(
            computed={"least distance, s = 6": near, "least distance, s = 9": far},
            stated="the delay costs distance",
            witness={"q(0)": (0.0, 0.0), "p(0)": (_SPEED, 0.0), "alien": (_AT, 0.0)},
            detail=f"the alien comes to {near:.3g} m of the agent that sees 6 m, to {far:.3g} m of the one that sees 9",
        ),
    ]
