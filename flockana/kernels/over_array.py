"""A scalar function over a one-dimensional array: a template (`flockana.kernels.bound_templates`)."""

import numpy as np

from flockana.jit import kernel
from flockana.kernels.scalars import sigma_1 as function  # bound


@kernel
def over_array(z, parameters):
    """Evaluate function(z_k, *parameters) for every k."""
    output = np.empty(z.size)
    for k in range(z.size):
        output[k] = function(z[k], *parameters)
    return output
