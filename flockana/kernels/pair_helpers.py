"""Helpers of all sums over pairs: blocks of pairs, differences of two rows, parameters in registers."""

from functools import cache

from flockana.jit import Kernel, register_jitable
from flockana.kernels.bound_templates import made

BLOCK = 512  # pairs: what is known of them stays in the first-level cache


# The differences of two rows at once: all is read before anything is written, which might be the same place.
@register_jitable
def apart_1(x, i, j):
    """Return the difference x_j − x_i of two agents on the line."""
    return (x[j, 0] - x[i, 0],)


@register_jitable
def apart_2(x, i, j):
    """Return the difference x_j − x_i of two agents in the plane."""
    return x[j, 0] - x[i, 0], x[j, 1] - x[i, 1]


@register_jitable
def apart_3(x, i, j):
    """Return the difference x_j − x_i of two agents in space."""
    return x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[j, 2] - x[i, 2]


APART = {1: apart_1, 2: apart_2, 3: apart_3}


@register_jitable
def as_they_are(par):
    """Return the parameters unchanged, as an array, for laws with too many for registers."""
    return par


@cache
def as_tuple(count: int) -> Kernel:
    """Return a function that loads parameters into registers, so that the law is vectorised."""
    values = "".join(f"par[{k}], " for k in range(count))
    text = (
        f"from flockana.jit import register_jitable\n\n\n@register_jitable\ndef unpacked(par):\n    return ({values})\n"
    )
    kernel: Kernel = made(text, "parameters").unpacked
    return kernel
