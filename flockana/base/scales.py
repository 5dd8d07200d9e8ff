"""The natural length and time of a law: what its thresholds are multiples of."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Scales:
    """A natural length and time of a law: thresholds are multiples of them, so that no verdict depends on units.

    Examples
    --------
    >>> Scales(length=6.0, time=2.0).speed, Scales(length=6.0, time=2.0).force
    (3.0, 1.5)
    """

    length: float
    time: float

    @property
    def speed(self) -> float:
        """length/time."""
        return self.length / self.time

    @property
    def force(self) -> float:
        """length/time²: forces are accelerations here, for all masses are 1."""
        return self.length / self.time**2

    @property
    def energy(self) -> float:
        """speed²: per agent, for all masses are 1."""
        return self.speed**2
