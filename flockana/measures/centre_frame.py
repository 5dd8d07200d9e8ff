"""Moving frame of the flock's centre of mass."""

import numpy as np

from flockana.base.value_checks import FloatArray


def moving_frame(x: FloatArray) -> FloatArray:
    """Return the deviations from the mean over agents, x_i − x_c."""
    return x - np.add.reduce(x, axis=0) / len(x)  # x.mean, without its checks
