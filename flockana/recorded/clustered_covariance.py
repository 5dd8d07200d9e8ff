"""Covariance of least-squares estimates from residuals that are correlated within each agent."""

import numpy as np

from flockana.base.value_checks import FloatArray

_ALONE = 1e-9  # of the squared slopes: if the other agents have no more, one agent determines an estimate alone


def covariance_over_agents(slopes: FloatArray, residuals: FloatArray) -> tuple[FloatArray, float]:
    """Return the covariance (P, P) of estimates, by the jackknife over agents, and its degrees of freedom.

    Slopes have the shape (K, n, m, P), residuals (K, n, m). Residuals of one agent are dependent, and less than its
    errors, as the estimates follow them: each agent's count as large as they are to estimates from all the others.
    Where few agents tell an estimate, it has as many degrees of freedom: (Σv)²/Σv² of their shares v in its variance.
    Where there are no others, or these do not tell a parameter, all residuals count as independent.
    """
    n, count = residuals.shape[1], slopes.shape[-1]
    squares = np.einsum("kimc,kimd->icd", slopes, slopes)
    inverse = np.linalg.pinv(squares.sum(axis=0))
    leverage_complement = np.eye(count) - squares @ inverse
    if n < 2 or np.linalg.eigvals(leverage_complement).real.min() < _ALONE:
        degrees_of_freedom = max(residuals.size - count, 1)
        return inverse * (float(np.sum(residuals**2)) / degrees_of_freedom), degrees_of_freedom
    scores = np.linalg.solve(leverage_complement, np.einsum("kimc,kim->ic", slopes, residuals)[:, :, None])[:, :, 0]
    covariance: FloatArray = inverse @ (scores.T @ scores) @ inverse * ((n - 1) / n)
    shares = np.einsum("ab,ibc,ca->ia", inverse, squares, inverse)
    has_share = shares.sum(axis=0) > 0.0
    effective_count = shares.sum(axis=0)[has_share] ** 2 / np.sum(shares[:, has_share] ** 2, axis=0)
    return covariance, float(effective_count.min(initial=n - 1))
