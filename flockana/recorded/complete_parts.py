"""Parts of a recording in which no agent is missing."""

from typing import Any

import numpy as np
import numpy.typing as npt


def largest_complete_part(present: npt.NDArray[np.bool_]) -> tuple[slice, npt.NDArray[Any]]:
    """Return the consecutive samples and the agents, without gaps, that hold the most positions together.

    Examples
    --------
    >>> largest_complete_part(np.array([[1, 0], [1, 1], [1, 1]], dtype=bool))
    (slice(1, 3, None), array([0, 1]))
    """
    count, n = present.shape
    first_samples = np.empty((count + 1, n), dtype=np.intp)  # first sample from k on at which each agent is missing
    first_samples[count] = count
    for k in range(count - 1, -1, -1):
        first_samples[k] = np.where(present[k], first_samples[k + 1], k)
    starts = np.flatnonzero((present & ~np.vstack([np.zeros((1, n), dtype=bool), present[:-1]])).any(axis=1))
    best_area, window = 0, (0, 0)
    for k in starts.tolist():
        order = np.sort(first_samples[k])[::-1]
        area = (order - k) * np.arange(1, n + 1)
        if area.max() > best_area:
            j = int(np.argmax(area))
            best_area, window = int(area[j]), (k, int(order[j]))
    start, end = window
    return slice(start, end), np.flatnonzero(present[start:end].all(axis=0))
