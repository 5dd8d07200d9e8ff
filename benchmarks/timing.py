"""CPU time of functions that take turns, so that what slows the machine slows all of them alike."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

import numpy as np
import numpy.typing as npt

_LEAST = 0.02  # seconds in a turn: well above the clock's grain

Call = Callable[[], object]


def seconds_of(call: Call, number: int = 1) -> float:
    """CPU seconds of one call, over `number` of them."""
    started = time.process_time()
    for _ in range(number):
        call()
    return (time.process_time() - started) / number


def interleaved(calls: Mapping[str, Call], *, rounds: int, least: float = _LEAST) -> dict[str, npt.NDArray[np.float64]]:
    """CPU seconds per call of each function, (rounds,), all of them once in every round.

    Parameters
    ----------
    calls : mapping of str to callable
        What to time; each is called once before, to compile and to fill the caches.
    rounds : int
        Turns of each.
    least : float
        Seconds that a turn takes at least, by repetition.
    """
    numbers = {}
    for name, call in calls.items():
        call()
        numbers[name] = max(1, int(np.ceil(least / max(seconds_of(call), 1e-9))))
    found: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(rounds):
        for name, call in calls.items():
            found[name].append(seconds_of(call, numbers[name]))
    return {name: np.array(values) for name, values in found.items()}


def ratio(of: npt.NDArray[np.float64], over: npt.NDArray[np.float64]) -> float:
    """Median of the ratios round by round: what is slow for a while is slow for both."""
    return float(np.median(of / over))
