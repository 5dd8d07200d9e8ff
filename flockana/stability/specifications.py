"""Specifications of a flock (decay, delay, sampling period, noise, overshoot): how far each is met, which binds."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from math import exp, pi, sqrt
from typing import Any

from flockana.base.checks import ensure_positive
from flockana.base.errors import ArgumentError
from flockana.equilibria.solve import find_equilibrium
from flockana.interactions import Gains
from flockana.laws import Algorithm2
from flockana.stability.blocks import law_blocks
from flockana.stability.delay import delay_margin, delay_system
from flockana.stability.linearise import linearise
from flockana.stability.norms import disturbance_system, h2_norm
from flockana.stability.sampling import sampling_margin
from flockana.stability.translational import CentreOfMass


@dataclass(frozen=True)
class Specifications:
    """Requirements on a flock; None where nothing is required.

    Parameters
    ----------
    decay : float, optional
        Least decay rate of the slowest mode, per time unit.
    delay : float, optional
        Delay of everything that the flock must bear.
    period : float, optional
        Sampling period that it must bear (zero-order hold).
    h2 : float, optional
        Largest H₂ norm from forces on the agents to the shape.
    overshoot : float, optional
        Largest overshoot of the centre after a step of the γ-agent, as a share of the step.

    Examples
    --------
    >>> Specifications(decay=0.5, period=0.02).asked
    ('decay', 'period')
    """

    decay: float | None = None
    delay: float | None = None
    period: float | None = None
    h2: float | None = None
    overshoot: float | None = None

    def __post_init__(self) -> None:
        for name in self.asked:
            object.__setattr__(self, name, ensure_positive(name, getattr(self, name)))
        if not self.asked:
            raise ArgumentError("no specification is given: expected one of decay, delay, period, h2, overshoot")

    @property
    def asked(self) -> tuple[str, ...]:
        """Names of the required quantities."""
        return tuple(field.name for field in fields(self) if getattr(self, field.name) is not None)


@dataclass(frozen=True)
class SpecifiedGains:
    """Gains found for specifications.

    Parameters
    ----------
    gains : Gains
        With the c1γ and c2γ found.
    reached : mapping of str to float
        What the flock does with them, by specification.
    room : mapping of str to float
        Share by which each is met; negative where it is not.
    """

    gains: Gains
    reached: Mapping[str, float]
    room: Mapping[str, float]

    @property
    def met(self) -> bool:
        """Whether all specifications are met."""
        return min(self.room.values()) >= 0.0

    @property
    def binding(self) -> str:
        """Specification with the least room."""
        return min(self.room, key=lambda name: self.room[name])


def evaluated(law: Algorithm2, q: Any, asked: Specifications, c1: float, c2: float) -> SpecifiedGains:
    """Return the performance of a flock with these c1γ and c2γ, at the equilibrium near q that they give."""
    gains = replace(law.gains, c1_gamma=c1, c2_gamma=c2)
    trial = replace(law, gains=gains)
    rest = find_equilibrium(trial, q).q if len(q) > 1 else q
    reached = {name: _reached(name, trial, rest) for name in asked.asked}
    ratios = {name: reached[name] / float(getattr(asked, name)) for name in reached}
    least = ("decay", "delay", "period")
    room = {name: max(-1e3, ratio - 1.0 if name in least else 1.0 - ratio) for name, ratio in ratios.items()}
    return SpecifiedGains(gains, reached, room)


def _reached(name: str, law: Algorithm2, rest: Any) -> float:
    if name == "decay":
        return linearise(law, rest, allow_residual=True).decay_rate
    if name == "delay":
        return delay_margin(delay_system(law, rest, strict=False)).delay
    if name == "period":
        return sampling_margin(law, rest).period
    if name == "overshoot":
        ratio = CentreOfMass(law.gains).damping_ratio
        return exp(-pi * ratio / sqrt(1.0 - ratio * ratio)) if ratio < 1.0 else 0.0
    return h2_norm(disturbance_system(law_blocks(law, rest, strict=False)))
