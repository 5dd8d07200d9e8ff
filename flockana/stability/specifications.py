"""Specifications of a flock (decay, delay, period, noise, overshoot, strain, effort) and their fulfilment."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from math import exp, pi, sqrt
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_positive
from flockana.base.vector_norms import lengths
from flockana.equilibria.solve import find_equilibrium
from flockana.interactions import Gains
from flockana.laws import Algorithm2
from flockana.measures.nets import links
from flockana.stability.centre_transfer import CentreOfMass
from flockana.stability.delay import delay_margin
from flockana.stability.law_studies import delay_system, law_blocks, sampling_margin
from flockana.stability.linearise import linearise
from flockana.stability.norms import disturbance_system, h2_norm
from flockana.stability.second_order_blocks import Blocks

AT_LEAST = ("decay", "delay", "period")  # what is asked to be at least as large; the rest at most
AT_MOST = ("h2", "overshoot", "strain", "effort")
MEASURES = AT_LEAST + AT_MOST


@dataclass(frozen=True)
class Specifications:
    """Performance requirements on a flock; None for a quantity without requirement.

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
    strain : float, optional
        Largest strain of a link at rest, |‖q_ij‖/d − 1|: the pull to the γ-agent squeezes the flock.
    effort : float, optional
        Largest H₂ norm from forces on the agents to the γ-feedback −c1γ q − c2γ p, of all agents together.

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
    strain: float | None = None
    effort: float | None = None

    def __post_init__(self) -> None:
        for name in self.asked:
            object.__setattr__(self, name, ensure_positive(name, getattr(self, name)))
        if not self.asked:
            raise ArgumentError(f"no specification is given: expected one of {', '.join(MEASURES)}")

    @property
    def asked(self) -> tuple[str, ...]:
        """Names of the quantities for which a specification is given."""
        return tuple(field.name for field in fields(self) if getattr(self, field.name) is not None)


@dataclass(frozen=True)
class SpecifiedGains:
    """Designed gains for given specifications.

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
        """Specification with the least slack."""
        return min(self.room, key=lambda name: self.room[name])


def evaluated(
    law: Algorithm2, q: Any, asked: Specifications, c1: float, c2: float, *, also: tuple[str, ...] = ()
) -> SpecifiedGains:
    """Return the performance of a flock with given c1γ and c2γ, at the equilibrium near q."""
    gains = replace(law.gains, c1_gamma=c1, c2_gamma=c2)
    trial = replace(law, gains=gains)
    equilibrium = find_equilibrium(trial, q).q if len(q) > 1 else q
    values = {name: _reached(name, trial, equilibrium) for name in dict.fromkeys((*asked.asked, *also))}
    ratios = {name: values[name] / float(getattr(asked, name)) for name in asked.asked}
    margins = {name: max(-1e3, ratio - 1.0 if name in AT_LEAST else 1.0 - ratio) for name, ratio in ratios.items()}
    return SpecifiedGains(gains, values, margins)


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
    if name == "strain":
        pairs = links(rest, law.alpha.range)
        return float(np.abs(lengths(rest[pairs[:, 0]] - rest[pairs[:, 1]]) / law.alpha.length - 1.0).max(initial=0.0))
    flock = law_blocks(law, rest, strict=False)
    return h2_norm(_feedback_system(flock, law.gains) if name == "effort" else disturbance_system(flock))


def _feedback_system(flock: Blocks, gains: Gains) -> Any:
    """Return a `control.StateSpace` from a force on each agent to all γ-feedback, without rigid motions."""
    import control

    a, b, positions, velocities = flock.quotient()
    c = -np.hstack([gains.c1_gamma * positions, gains.c2_gamma * velocities])
    return control.StateSpace(a, b, c, np.zeros((len(c), b.shape[1])), remove_useless_states=False)
