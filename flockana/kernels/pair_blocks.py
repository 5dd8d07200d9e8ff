"""Potential and derivatives of a pair law over a block of pairs: a template (`flockana.kernels.bound_templates`)."""

import numpy as np

from flockana.jit import kernel
from flockana.kernels.agent_sums import square_between
from flockana.kernels.alpha import norm_alpha as norm  # bound
from flockana.kernels.alpha import pair_alpha_potential as potential  # bound
from flockana.kernels.alpha import pair_alpha_slope as slope  # bound
from flockana.kernels.alpha import stress_alpha as pair  # bound

NORMED = True  # bound


@kernel
def energy(q, i, j, par, panels):
    """Return the potential Σ ψ over the pairs of a block."""
    total = 0.0
    for k in range(i.size):
        total += potential(square_between(q, i[k], j[k]), par, panels)
    return total


@kernel
def terms(q, i, j, par):
    """Return weight w, adjacency a and dw/d(s²) of each pair of a block, shape (3, L)."""
    out = np.empty((3, i.size))
    for k in range(i.size):
        s2 = square_between(q, i[k], j[k])
        if NORMED:
            z, root = norm(s2, par)
            out[0, k], out[1, k] = pair(z, root, par)
        else:
            out[0, k], out[1, k] = pair(s2, par)
        out[2, k] = slope(s2, par)
    return out
