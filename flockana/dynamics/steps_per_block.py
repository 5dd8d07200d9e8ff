"""Number of steps to make at once, so that a block of them lasts a tenth of a second."""

import time

_LASTS = 0.1  # seconds: what a block is meant to last; its number of steps grows by _GROWS at most
_GROWS = 8.0


class Pace:
    """Context manager of a block of steps: entering gives the number of steps, leaving measures the time.

    Examples
    --------
    >>> pace = Pace(2, 512)
    >>> with pace as steps:
    ...     pass
    >>> steps, pace.steps
    (2, 16)
    """

    def __init__(self, first: int, most: int) -> None:
        self.most = max(1, most)
        self.steps = min(max(1, first), self.most)

    def __enter__(self) -> int:
        """Return the number of steps to make in this block."""
        self._started = time.perf_counter()
        return self.steps

    def __exit__(self, *_: object) -> None:
        """Adapt the number of steps in the next block to the time that this block took."""
        block_seconds = max(time.perf_counter() - self._started, 1e-9)
        self.steps = min(max(1, int(self.steps * min(_GROWS, _LASTS / block_seconds))), self.most)
