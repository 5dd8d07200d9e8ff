"""Data that the compiled terms of a law read beside the state, and the parameters of a pair term."""

from typing import Any, NamedTuple

import numpy as np

from flockana.jit import subroutine


class Listed(NamedTuple):
    """Pairs listed for a term, the frame of x and v, and work space for a block of pairs."""

    frame: Any  # (2, m): its place and velocity
    first: Any  # the pairs: uint32
    second: Any
    count: Any  # how many there are
    cuts: Any  # where those of each slab begin, and those of the last one end (`flockana.kernels.cell_grid`)
    order: Any  # (n,), uint64: every agent's own number
    near: Any  # (2 slabs, BLOCK), work space of each term in turn
    room: Any  # (3 slabs, BLOCK), the same


@subroutine
def no_energy(t, x, v, numbers, panels, listed):
    """Return 0, the energy of a term without a potential."""
    return 0.0


def listed_numbers(c1: float, c2: float, r: float, far: float, par: Any) -> Any:
    """Return the numbers of a pair term: gains, range, potential beyond it, and the law's parameters."""
    return np.concatenate([[c1, c2, r, far], par])
