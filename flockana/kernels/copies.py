"""Copies of arrays, number by number: numba's own assignment also compiles the text of an error, for 1 s or 2."""

from __future__ import annotations

from flockana.kernels.compiling import njit


@njit(cache=True, error_model="numpy", nogil=True, _nrt=False)
def put(values, into):
    """Write an array to the front of another; both are contiguous."""
    source, target = values.reshape(values.size), into.reshape(into.size)
    for k in range(source.size):
        target[k] = source[k]
