"""Margins of loops with both delay and sampling, by search over one-period maps (`lifted`)."""

from collections.abc import Callable
from math import inf, nan, pi

import numpy as np

from flockana.base.value_checks import FloatArray, ensure_positive
from flockana.stability.cost_estimates import LIMIT, ensure_maps
from flockana.stability.delay import DelayMargin, DelaySystem, delay_margin
from flockana.stability.delay_roots import LatePart
from flockana.stability.lifted_loops import MOST, first_growth, moving_multipliers
from flockana.stability.sampling import ModePeriod, SamplingMargin

_DELAY, _PERIOD = "the delay margin of a sampled flock", "the sampling margin of a delayed flock"
_HALVINGS = 30  # of two searches between trials
_TRIALS = 48  # delays or periods at which a search looks
_AGAIN = 60  # further ones below what is found, where delay and period are whole or half multiples of each other
_LARGE = 600  # states of a lifted map beyond which those are left out
_FAR = 4.0  # times the delay margin without a hold, and periods: where the search ends
_BRIEF = 1e-3  # of the shortest time of the flock: the shortest period that is tried


def _multiplier(system: DelaySystem, delay: float, period: float) -> complex:
    """Return the multiplier of largest modulus of a one-period map off the neutral motions; 0 if none."""
    clock, parts = np.zeros(len(system.prompt[0])), (LatePart(0.0, *system.prompt), LatePart(delay, *system.late))
    values = moving_multipliers(parts, period, clock, system.neutral)
    return complex(values[0]) if values.size else 0j


def _search(radius: Callable[[float], float], trials: FloatArray, whole: FloatArray) -> float:
    """Return the least argument at which a spectral radius exceeds 1, on a grid and at values of `whole`."""
    # Between multiples of the period a delay changes little; there growth may begin, end at once, and begin again.
    growth = first_growth(radius, trials)
    if growth in (0.0, inf):
        return growth
    second_growth = first_growth(radius, np.concatenate([trials[:1], np.sort(whole[whole < growth])[-_AGAIN:]]))
    return min(growth, second_growth)


def sampled_delay_margin(system: DelaySystem, period: float, *, limit: float = LIMIT) -> DelayMargin:
    """Return the longest stable delay of a flock whose whole input is held for a period.

    Parameters
    ----------
    system : DelaySystem
        The linearised flock, its late part read a delay before each sample.
    period : float
        Of the hold.
    limit : float
        Seconds of estimated work from which on it is refused.

    Returns
    -------
    DelayMargin
        The first delay at which a search, coarse and then fine, meets growth: nothing is certified (`least` is 0).
        Infinite if it meets none up to four times the margin without a hold and four periods.

    Examples
    --------
    x'' = −x' with the velocity held for 0.5: read at once it is stable, z = 0.5; a period late z² − z + ½ is, and the
    delay that it bears is longer:

    >>> blank = np.zeros((1, 1))
    >>> drag = DelaySystem((blank, blank), (blank, np.eye(1)), neutral=1)
    >>> margin = sampled_delay_margin(drag, 0.5)
    >>> 0.5 < margin.delay < 1.5, margin.certified
    (True, False)
    """
    period, dimension = ensure_positive("period", period), len(system.prompt[0])
    ensure_maps(_DELAY, dimension, np.zeros(_TRIALS + _AGAIN), limit)  # even if none holds much of the past
    ideal_delay = delay_margin(system, limit=limit).delay
    if ideal_delay == 0.0 or abs(_multiplier(system, 0.0, period)) >= 1.0:
        return DelayMargin(0.0, nan, 0.0)
    far = _FAR * (period + (ideal_delay if ideal_delay < inf else period))
    trials: FloatArray = np.concatenate([[0.0], np.linspace(far / _TRIALS, far, _TRIALS)])
    whole = 0.5 * period * np.arange(1.0, 2.0 * far / period)
    early = trials[trials <= far / _FAR] / period
    ensure_maps(_DELAY, dimension, np.append(early, np.full(min(_AGAIN, whole.size) + _HALVINGS, early[-1])), limit)
    growth = _search(lambda delay: abs(_multiplier(system, delay, period)), trials, whole)
    if growth == inf:
        return DelayMargin(inf, nan, 0.0)
    return DelayMargin(growth, abs(float(np.angle(_multiplier(system, growth, period)))) / period, 0.0)


def delayed_sampling_margin(system: DelaySystem, delay: float, *, limit: float = LIMIT) -> SamplingMargin:
    """Return the longest stable hold period of a delayed flock.

    Parameters
    ----------
    system : DelaySystem
        The linearised flock.
    delay : float
        How old its late part is at each sample.
    limit : float
        Seconds of estimated work from which on it is refused.

    Returns
    -------
    SamplingMargin
        The first period at which a search, coarse and then fine, meets growth: nothing is certified (`least` is 0). NaN
        where even the shortest that is looked at grows, by the states of its lifted map: the margin is less.

    Examples
    --------
    >>> blank = np.zeros((1, 1))
    >>> swing = DelaySystem((blank, blank), (4.0 * np.eye(1), np.eye(1)))
    >>> 0.0 < delayed_sampling_margin(swing, 0.1).period < 0.5
    True
    """
    delay, dimension = ensure_positive("delay", delay), len(system.prompt[0])
    ensure_maps(_PERIOD, dimension, np.zeros(_TRIALS + _AGAIN), limit)
    ideal_delay = delay_margin(system, limit=limit).delay
    if delay >= ideal_delay:
        return SamplingMargin("hold, delayed", 0.0, 0.0, ())
    quickest_period = 2.0 * pi / system.highest if system.highest > 0.0 else 1.0
    radius: Callable[[float], float] = lambda period: abs(_multiplier(system, delay, period))  # noqa: E731
    shortest = delay / max(MOST // dimension - 6, 1)
    start = max(_BRIEF * quickest_period, delay / 50.0, shortest)
    while radius(start) >= 1.0:  # without a hold it is stable: shorter ones are, at last
        start *= 0.5
        if start < shortest:
            return SamplingMargin("hold, delayed", nan, 0.0, ())
    shortest_period = delay / max(_LARGE // dimension - 6, 1)
    trial_delays = 2.0 * delay / np.arange(1.0, 2.0 * delay / max(start, shortest_period))
    trials: FloatArray = np.geomspace(start, max(50.0 * quickest_period, 2.0 * start), _TRIALS)
    ensure_maps(_PERIOD, dimension, delay / trials, limit)
    growth = _search(radius, trials, trial_delays)
    if growth in (0.0, inf):
        return SamplingMargin("hold, delayed", growth, 0.0, ())
    z = _multiplier(system, delay, growth)
    return SamplingMargin("hold, delayed", growth, 0.0, (ModePeriod(growth, z / abs(z), np.zeros((0, 0))),))
