"""Numbers of obstacle terms for compiled functions.

They are: how many obstacles of one kind there are, m, the range r', gains c1 and c2, the law's parameters; then where
the parameters of each obstacle begin (K + 1), its ball (m + 1 each), and its parameters.
"""

from typing import Any

import numpy as np

from flockana.jit import register_jitable
from flockana.kernels.alpha import BETA_AREA

COUNT, DIMENSION, REACH, C1, C2, BETA = range(6)
STARTS = BETA + BETA_AREA + 1  # after the parameters of the law


def body_numbers(reach: float, c1: float, c2: float, law: Any, pars: Any, starts: Any, balls: Any) -> Any:
    """Return the numbers of an obstacle term for its compiled functions."""
    count, m = balls.shape[0], balls.shape[1] - 1
    return np.concatenate([[count, m, reach, c1, c2], law, starts, balls.ravel(), pars])


@register_jitable
def bodies_of(numbers):
    """Return (parameters of all obstacles, start index of each obstacle, bounding balls)."""
    count, m = np.int64(numbers[COUNT]), np.int64(numbers[DIMENSION])
    balls, starts = STARTS + count + 1, np.empty(count + 1, np.int64)
    pars = balls + count * (m + 1)
    for k in range(count + 1):
        starts[k] = np.int64(numbers[STARTS + k])
    return numbers[pars:], starts, numbers[balls:pars].reshape(count, m + 1)
