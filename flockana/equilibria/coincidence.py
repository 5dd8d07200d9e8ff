"""Least number of agents of a strict minimum of V with coincident agents."""

from math import ceil

import numpy as np

from flockana.base.value_checks import FloatArray, ensure_dimension
from flockana.interactions import AlphaInteraction

_ABOVE = 1e-9  # relative: the greatest trace is flat where it is found, so it is missed by far less


def hessian_trace(alpha: AlphaInteraction, lengths: FloatArray, m: int) -> FloatArray:
    """Return the trace of the Hessian block of a pair in R^m at each length."""
    z, root = alpha.sigma_norm(lengths), np.sqrt(1.0 + alpha.eps * lengths**2)
    phi, slope = alpha.phi_alpha(z), alpha.phi_alpha_slope(z)
    return slope * (lengths / root) ** 2 + phi / root**3 + (m - 1) * phi / root


def least_with_coincidence(alpha: AlphaInteraction, m: int = 2) -> int:
    """Return n such that no smaller configuration with coincident agents is a local minimum of V."""
    # Of c agents at one place the motions against each other feel c φ_α(0) I from within, negative, and one block per
    # agent elsewhere. These blocks must outweigh it in every direction, hence in the trace: k > m c |φ_α(0)|/max tr.
    from scipy.optimize import minimize_scalar

    m, repulsion = ensure_dimension(m), -float(alpha.phi_alpha(0.0))
    lengths = np.linspace(0.0, alpha.r, 4001)
    top = int(np.argmax(hessian_trace(alpha, lengths, m)))
    window = lengths[max(top - 1, 0)], lengths[min(top + 1, lengths.size - 1)]
    best = minimize_scalar(lambda s: -float(hessian_trace(alpha, np.array([s]), m)[0]), bounds=window, method="bounded")
    most = -float(best.fun) * (1.0 + _ABOVE)  # no less than the top, of which the search may stop short
    return 2 + max(1, ceil(2.0 * m * repulsion / most))  # c = 2 needs the fewest others; at d the trace is positive
