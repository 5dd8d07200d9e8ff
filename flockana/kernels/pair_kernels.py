"""From scalar functions of a pair law to sums over all pairs: forces, dissipation, potential, Hessian blocks.

The sums are ordinary source (`pair_sums`, `pair_blocks`, `over_array`), bound to the functions of a law.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from types import ModuleType
from typing import Any

import numpy as np

from flockana.jit import Kernel, thawed
from flockana.kernels.bound_templates import bound
from flockana.kernels.pair_helpers import APART, as_tuple

_ROOM = "flockana.kernels."


@dataclass(frozen=True, eq=False)
class PairKernels:
    """Compiled sums over all pairs within range, or over a block of pairs (i, j)."""

    pair: Kernel  # the law's scalar functions
    slope_of_pair: Kernel
    energy_of_pair: Kernel
    slope_of_adjacency: Kernel | None  # two more, if it gives them
    norm: Kernel | None

    @property
    def law(self) -> dict[str, Any]:
        """Return the pair law's scalar functions by the names to which a template binds them."""
        norm_option = {} if self.norm is None else {"norm": self.norm}
        return {"pair": self.pair, "potential": self.energy_of_pair, "NORMED": self.norm is not None, **norm_option}

    def sums(self, m: int, parameters: int) -> ModuleType:
        """Return `flockana.kernels.pair_sums` for this law in m dimensions, with a given number of parameters."""
        return _sums(self, m, parameters)

    @cached_property
    def _blocks(self) -> ModuleType:
        return bound(_ROOM + "pair_blocks", **self.law, slope=self.slope_of_pair)

    @property
    def potential(self) -> Callable[..., float]:
        """``potential(q, i, j, par, panels)``: Σ ψ over the block."""
        return self._blocks.energy

    def energy_in_slabs(self, *, several: bool) -> Callable[..., tuple[float, int]]:
        """``(q, r, par, panels)``: Σ ψ over all pairs of a large flock within r, and their number."""
        energy: Kernel = self._blocks.parallel_energy_in_slabs if several else self._blocks.energy_in_slabs
        return energy

    @property
    def terms(self) -> Callable[..., Any]:
        """``terms(q, i, j, par)``: per pair the weight w, the adjacency a and dw/d(s²)."""
        return self._blocks.terms

    @cached_property
    def energies(self) -> Callable[..., Any]:
        """``energies(s2, par, panels)``: ψ over an array of squared distances."""
        return lift_scalar(self.energy_of_pair)

    @cached_property
    def adjacency_slope(self) -> Callable[..., Any] | None:
        """``adjacency_slope(s2, par)``: da/d(s²) over an array of squared distances; None if the law gives none."""
        return None if self.slope_of_adjacency is None else lift_scalar(self.slope_of_adjacency)


@cache
def _sums(kernels: PairKernels, m: int, parameters: int) -> ModuleType:
    return bound(_ROOM + "pair_sums", **kernels.law, M=m, apart=APART[m], as_tuple=as_tuple(parameters))


def lift(
    pair: Callable[..., Any],
    slope: Callable[..., Any],
    potential: Callable[..., Any],
    adjacency_slope: Callable[..., float] | None = None,
    *,
    norm: Callable[..., Any] | None = None,
) -> PairKernels:
    """Return the pair sums of a law given by scalar functions of the squared distance s²."""
    return PairKernels(pair, slope, potential, adjacency_slope, norm)  # type: ignore[arg-type]


def lift_scalar(function: Callable[..., float]) -> Callable[..., Any]:
    """Return a function of ``(z, *parameters)`` that runs over a one-dimensional array z."""
    row: list[Any] = []

    def over_array(z: Any, *parameters: Any) -> Any:
        if not row:  # bound, and numba loaded, at the first call
            row.append(bound(_ROOM + "over_array", function=function).over_array)
        numbers = tuple(thawed(each) if isinstance(each, np.ndarray) else float(each) for each in parameters)
        return row[0](z, numbers)

    return over_array
