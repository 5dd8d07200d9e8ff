"""The frame that moves with the flock's centre of mass."""

from __future__ import annotations

from flockana.base.checks import FloatArray


def moving_frame(x: FloatArray) -> FloatArray:
    """Deviations from the mean over agents, x_i − x_c.

    Examples
    --------
    >>> import numpy as np
    >>> moving_frame(np.array([[0.0], [4.0]])).tolist()
    [[-2.0], [2.0]]
    """
    deviations: FloatArray = x - x.mean(axis=0)
    return deviations
