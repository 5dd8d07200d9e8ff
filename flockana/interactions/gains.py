"""Gains of the laws."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property, partial
from math import sqrt
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.base.short_repr import ShortRepr
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_finite_scalar, normalise, per_agent

PER_AGENT = ("c1_gamma", "c2_gamma")


def weighted(gain: Any, values: FloatArray) -> float:
    """Return Σ_i gain_i values_i, for one gain or one per agent."""
    return float(np.dot(gain, values)) if isinstance(gain, tuple) else float(gain * float(np.sum(values)))


@dataclass(frozen=True)
class Gains(ShortRepr):
    """Gains of the α-, β- and γ-terms: c1 of positions, c2 of velocities, all >= 0.

    The paper prints none; the defaults keep c1γ small beside c1α, because a strong γ-agent squeezes the flock until
    agents coincide (erratum E11).

    Parameters
    ----------
    c1_alpha, c2_alpha : float
        Gradient and velocity consensus among agents.
    c1_beta, c2_beta : float
        Repulsion and damping at obstacles.
    c1_gamma, c2_gamma : float or array_like, shape (n,)
        Navigational feedback to the γ-agent, one gain for all or one per agent; arrays are kept as tuples.

    Raises
    ------
    ArgumentError
        On a gain that is negative or no number, or an array of gains where one is expected.

    Examples
    --------
    >>> Gains(c1_alpha=1.0).c1_alpha
    1.0
    >>> Gains(c1_gamma=[1, 2]).c1_gamma
    (1.0, 2.0)
    """

    c1_alpha: float = 30.0
    c2_alpha: float = 2.0 * sqrt(30.0)
    c1_beta: float = 1500.0
    c2_beta: float = 2.0 * sqrt(1500.0)
    c1_gamma: Any = 1.1
    c2_gamma: Any = 2.0 * sqrt(1.1)

    units: ClassVar[Mapping[str, Powers]] = {
        f"c{k}_{name}": (0, k - 3) for name in ("alpha", "beta", "gamma") for k in (1, 2)
    }

    def __post_init__(self) -> None:
        normalise(self, ensure_gain, *(field.name for field in fields(self) if field.name not in PER_AGENT))
        normalise(self, partial(per_agent, ensure=ensure_gain), *PER_AGENT)

    @cached_property
    def per_agent(self) -> bool:
        """Whether c1γ or c2γ is given agent by agent."""
        return any(isinstance(getattr(self, name), tuple) for name in PER_AGENT)

    @cached_property
    def pull(self) -> Any:
        """Gain c1γ in the shape that multiplies (n, m): a number, or a column of n."""
        return _column(self.c1_gamma)

    @cached_property
    def drag(self) -> Any:
        """Gain c2γ in the shape that multiplies (n, m): a number, or a column of n."""
        return _column(self.c2_gamma)

    def check_agents(self, n: int) -> None:
        """Raise unless the number of per-agent gains equals the number of agents."""
        for name in PER_AGENT:
            gain = getattr(self, name)
            if isinstance(gain, tuple) and len(gain) != n:
                raise ArgumentError(f"{name} has {len(gain)} gains but there are {n} agents: expected one per agent")


if TYPE_CHECKING:

    class GainsField:
        """Field of a law for gains, given as `Gains` or as a dictionary."""

        def __get__(self, law: object, kind: type | None = None) -> Gains: ...
        def __set__(self, law: object, value: Gains | Mapping[str, Any]) -> None: ...
else:
    GainsField = Gains


def gains_of(values: Mapping[str, Any]) -> Gains:
    """Return gains from a mapping; gains that it lacks keep their defaults."""
    names = [field.name for field in fields(Gains)]
    if (unknown := [name for name in values if name not in names]) != []:
        raise UnknownNameError("gain", unknown[0], names)
    return Gains(**values)


def ensure_gain(name: str, value: Any) -> float:
    """Return a finite gain >= 0."""
    gain = ensure_finite_scalar(name, value)
    if gain < 0.0:
        raise ArgumentError(f"{name} = {gain:g}: expected a gain >= 0; a negative one feeds energy in")
    return gain


def _column(gain: Any) -> Any:
    return np.array(gain)[:, None] if isinstance(gain, tuple) else gain
