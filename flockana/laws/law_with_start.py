"""Objects with a law and a start, such as a flock or a scenario."""

from abc import ABC, abstractmethod
from typing import Any


class WithStart(ABC):
    """A law with positions, velocities and a time span to run it from."""

    @abstractmethod
    def law_and_start(self, seed: int) -> tuple[Any, Any, Any, tuple[float, float]]:
        """Return the law, positions, velocities and time span; random parts are drawn from the seed."""
