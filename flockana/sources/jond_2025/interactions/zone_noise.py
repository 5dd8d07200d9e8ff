"""Randomness in zone-based flocking: noisy weights and gusts, reproducible by a seed."""

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from typing import ClassVar

from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.base.value_checks import ensure_nonnegative, ensure_seed, normalise


@dataclass(frozen=True)
class ZoneNoise:
    """Stochastic elements that Jond's conclusions propose: random perturbations of weights and velocities.

    Every number is a function of (seed, step, agent, whom it is about, behaviour) and of nothing else
    (`flockana.kernels.random_noise`): runs repeat to the bit, whatever was computed before or beside them.

    Parameters
    ----------
    weights : float
        s, at most 1: in each step each weight is multiplied by a number of its own, uniform in (1 − s, 1 + s).
    velocities : float
        Standard deviation of what each component of each velocity gets in each step, before its bound (10). It is
        uniform, at most √3 times that.
    seed : int
        Which of the runs, >= 0.

    Examples
    --------
    >>> ZoneNoise(weights=0.5).quiet, ZoneNoise().quiet
    (False, True)
    """

    _: KW_ONLY
    weights: float = 0.0
    velocities: float = 0.0
    seed: int = 0

    units: ClassVar[Mapping[str, Powers]] = {"velocities": (1, -1)}

    def __post_init__(self) -> None:
        normalise(self, ensure_nonnegative, "weights", "velocities")
        if self.weights > 1.0:
            raise ArgumentError(f"weights = {self.weights:g}: expected at most 1, so that no weight becomes negative")
        object.__setattr__(self, "seed", ensure_seed(self.seed, 63))

    @property
    def quiet(self) -> bool:
        """Whether no noise is added."""
        return self.weights == 0.0 and self.velocities == 0.0
