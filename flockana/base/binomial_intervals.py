"""Exact confidence intervals of a probability from a count of successes (Clopper and Pearson)."""

from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import ensure_finite_scalar, real_array

_MOST = 2.0**53  # up to which every whole number is a float


def ensure_level(level: Any) -> float:
    """Return a confidence level as a float between 0 and 1."""
    value = ensure_finite_scalar("level", level)
    if not 0.0 < value < 1.0:
        raise ArgumentError(f"level = {value:g}: expected a confidence level between 0 and 1, such as 0.95")
    return value


def clopper_pearson(successes: Any, trials: Any, *, level: float = 0.95) -> tuple[Any, Any]:
    """Return the exact two-sided confidence interval of a probability from a count of successes.

    It covers the true share with at least the stated probability for every n, unlike the interval of the normal
    approximation, which collapses to a point where all runs agree. Source: Clopper and Pearson (1934).

    Parameters
    ----------
    successes, trials : array_like of int
        Counts, 0 <= successes <= trials; of no trials nothing follows, and the interval is [0, 1].
    level : float
        Confidence.

    Returns
    -------
    tuple of float or ndarray
        Lower and upper ends, of the shape of the counts.

    Raises
    ------
    ArgumentError
        On counts that are no whole numbers, are negative or exceed the trials, or a level outside of (0, 1).

    Examples
    --------
    All of 200 runs agree; the rule of three says at least about 1 − 3/200, one-sided:

    >>> low, high = clopper_pearson(200, 200)
    >>> round(low, 4), high
    (0.9817, 1.0)
    """
    from scipy.special import betaincinv

    counts_text = f"successes = {format_value(successes)}, trials = {format_value(trials)}"
    try:
        k, n = np.broadcast_arrays(real_array(successes), real_array(trials))
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"{counts_text}: expected counts") from None
    if not ((k >= 0.0) & (k <= n) & (n <= _MOST) & (k == np.floor(k)) & (n == np.floor(n))).all():
        raise ArgumentError(f"{counts_text}: expected whole numbers 0 <= successes <= trials")
    tail = 0.5 * (1.0 - ensure_level(level))
    # the arguments are kept positive where the end is known without them
    low = np.where(k > 0.0, betaincinv(np.maximum(k, 1.0), n - k + 1.0, tail), 0.0)
    high = np.where(k < n, betaincinv(k + 1.0, np.maximum(n - k, 1.0), 1.0 - tail), 1.0)
    return (low, high) if low.shape else (float(low), float(high))
