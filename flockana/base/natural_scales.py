"""Natural length and time of a law; thresholds are multiples of these scales."""

from dataclasses import dataclass

from flockana.base.errors import ArgumentError

LEAST, MOST = 1e-45, 1e45  # sixth powers of such lengths are numbers


@dataclass(frozen=True)
class Scales:
    """Natural length and time of a law; thresholds are multiples of both, so no verdict depends on units."""

    length: float
    time: float

    def __post_init__(self) -> None:
        if not (LEAST <= self.length <= MOST and LEAST <= self.time <= MOST):
            scale_text = f"the law's length is {self.length:.3g} and its time {self.time:.3g}"
            raise ArgumentError(f"{scale_text}: expected both from {LEAST:g} to {MOST:g}; choose other units")

    @property
    def speed(self) -> float:
        """Unit of speed, length/time."""
        return self.length / self.time

    @property
    def force(self) -> float:
        """Unit of force, length/time²; forces are accelerations, as all masses are 1."""
        return self.length / self.time**2

    @property
    def energy(self) -> float:
        """Unit of energy per agent, speed²."""
        return self.speed**2
