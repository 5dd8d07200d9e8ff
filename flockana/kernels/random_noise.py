"""Random numbers as a function of seed, agent and step, without a generator state.

A number is a hash of (seed, step, agent, partner, channel), by the finaliser of SplitMix64, as counter-based
generators do it. Integers and one exact conversion give it, so that every processor has the same bits.
"""

import numpy as np

from flockana.jit import kernel

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_FIRST, _SECOND = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
_30, _27, _31, _12 = np.uint64(30), np.uint64(27), np.uint64(31), np.uint64(12)
_ONE = np.uint64(1)
_TO_UNIT = 2.0**-51  # of whole numbers below 2⁵², and a half: to (0, 2)


@kernel
def _absorb(state, word):
    z = state + _GOLDEN * (np.uint64(word) + _ONE)
    z = (z ^ (z >> _30)) * _FIRST
    z = (z ^ (z >> _27)) * _SECOND
    return z ^ (z >> _31)


@kernel
def noise(seed, step, agent, partner, channel):
    """Return a number in (−1, 1) of uniform symmetric distribution over 2⁵² values, mean 0 and variance 1/3."""
    z = _absorb(_absorb(_absorb(_absorb(_absorb(np.uint64(0), seed), step), agent), partner), channel)
    return (np.float64(z >> _12) + 0.5) * _TO_UNIT - 1.0
