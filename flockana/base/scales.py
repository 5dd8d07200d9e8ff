"""Natural length and time of a law, in which thresholds are measured."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Scales:
    """Natural length and time of a law; thresholds are multiples of them, so no verdict depends on units."""

    length: float
    time: float

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
