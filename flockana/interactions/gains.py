"""Gains of the laws."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

from flockana.checks import ensure_finite_scalar
from flockana.errors import ArgumentError


@dataclass(frozen=True)
class Gains:
    """Gains of the α-, β- and γ-terms: c1 of positions, c2 of velocities, all >= 0.

    The paper prints none; the defaults keep c1γ small beside c1α, because a strong γ-agent squeezes the flock until
    agents coincide (erratum E11).

    Parameters
    ----------
    c1_alpha, c2_alpha : float
        Gradient and velocity consensus among agents.
    c1_beta, c2_beta : float
        Repulsion and damping at obstacles.
    c1_gamma, c2_gamma : float
        Navigational feedback to the γ-agent.

    Examples
    --------
    >>> Gains(c1_alpha=1.0).c1_alpha
    1.0
    """

    c1_alpha: float = 30.0
    c2_alpha: float = 2.0 * sqrt(30.0)
    c1_beta: float = 1500.0
    c2_beta: float = 2.0 * sqrt(1500.0)
    c1_gamma: float = 1.1
    c2_gamma: float = 2.0 * sqrt(1.1)

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            value = ensure_finite_scalar(name, getattr(self, name))
            if value < 0.0:
                raise ArgumentError(f"{name} = {value:g}: expected a gain >= 0; a negative one feeds energy in")
            object.__setattr__(self, name, value)
