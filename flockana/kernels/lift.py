"""From a scalar pair law to sums over all pairs: forces, dissipation, potential, Hessian blocks.

`lift` compiles the loops around a law's scalar functions; everything inlines into one loop over a block of pairs.
numba's disk cache looks only at the file of the outer function, so each lifted loop also closes over a digest of
the scalar functions' own source: editing them invalidates the cache.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from flockana.kernels.compiling import njit, register_jitable
from flockana.kernels.listed import CompiledFunction, lift_listed
from flockana.kernels.sweep import lift_sweep


@dataclass(frozen=True)
class PairKernels:
    """CompiledFunction sums over all pairs within range, or over a block of pairs (i, j).

    Attributes
    ----------
    sweeps : tuple of pairs of callables
        The forces of all pairs, and of those given, in one, two and three dimensions (`lift_sweep`).
    listed : callable
        By dimension, force and potential of the pairs of a list, for compiled integrators (`lift_listed`).
    potential : callable
        ``potential(q, i, j, par, panels)`` returns Σ ψ over the block.
    terms : callable
        ``terms(q, i, j, par)`` returns per pair the weight w, the adjacency a and dw/d(s²).
    adjacency_slope : callable, optional
        ``adjacency_slope(s2, par)`` returns da/d(s²) over an array of squared distances; None if the law gives none.
    """

    sweeps: tuple[tuple[Callable[..., Any], Callable[..., float]], ...]
    listed: Callable[[int], tuple[CompiledFunction, CompiledFunction]]
    potential: Callable[..., float]
    terms: Callable[..., Any]
    adjacency_slope: Callable[..., Any] | None = None


def source_digest(*functions: Callable[..., Any]) -> int:
    """A number that changes when a file that defines one of `functions` (or what it imports from flockana) changes.

    A function that no file has (`flockana.kernels.generated`) is known by its name, which tells its text.

    Parameters
    ----------
    *functions : callable
        Python functions.
    """
    names = {f.__module__ for f in functions} | {"flockana.kernels.scalars"}
    files = sorted({getattr(sys.modules.get(name), "__file__", None) or "" for name in names} - {""})
    made = sorted(f.__name__ for f in functions if not hasattr(sys.modules.get(f.__module__), f.__name__))
    digest = hashlib.sha256("".join(made).encode())
    for file in files:
        digest.update(Path(file).read_bytes())
    return int.from_bytes(digest.digest()[:4], "big")


def lift(
    pair: Callable[..., Any],
    slope: Callable[..., Any],
    potential: Callable[..., Any],
    adjacency_slope: Callable[..., float] | None = None,
    *,
    norm: Callable[..., Any] | None = None,
    error_model: str = "python",
) -> PairKernels:
    """Compile the pair sums of a law given by scalar functions of the squared distance s².

    Parameters
    ----------
    pair : callable
        ``pair(s2, par) -> (w, a)``, a `flockana.kernels.compiling.register_jitable` function.
    slope : callable
        ``slope(s2, par)`` = dw/d(s²).
    potential : callable
        ``potential(s2, par, panels)`` = ψ, whose gradient in q_i is −w (q_j − q_i).
    adjacency_slope : callable, optional
        ``adjacency_slope(s2, par)`` = da/d(s²): only the Jacobian at unequal velocities needs it.
    norm : callable, optional
        ``norm(s2, par) -> (z, root)``: two numbers that the law begins with. If given, it is ``pair(z, root, par)``.
    error_model : {"python", "numpy"}
        numba's: whether a division by zero raises, outside the sums of forces, or gives an infinity or NaN.

    Returns
    -------
    PairKernels
    """
    digest = source_digest(pair, slope, potential, *([] if norm is None else [norm]))
    at = pair if norm is None else _of_square(norm, pair)

    @njit(cache=True, error_model=error_model)
    def energy(q, i, j, par, panels):
        total = 0.0 * digest
        for k in range(i.size):
            s2 = 0.0
            for c in range(q.shape[1]):
                s2 += (q[j[k], c] - q[i[k], c]) ** 2
            total += potential(s2, par, panels)
        return total

    @njit(cache=True, error_model=error_model)
    def terms(q, i, j, par):
        out = np.empty((3, i.size)) + 0.0 * digest
        for k in range(i.size):
            s2 = 0.0
            for c in range(q.shape[1]):
                s2 += (q[j[k], c] - q[i[k], c]) ** 2
            out[0, k], out[1, k] = at(s2, par)
            out[2, k] = slope(s2, par)
        return out

    sweeps = tuple(lift_sweep(pair, m, norm, digest) for m in (1, 2, 3))
    listed = lift_listed(pair, potential, norm, digest)
    slopes = None if adjacency_slope is None else lift_scalar(adjacency_slope, error_model=error_model)
    return PairKernels(sweeps, listed, energy, terms, slopes)


def _of_square(norm: Callable[..., Any], pair: Callable[..., Any]) -> Callable[..., Any]:
    """The law as a function of the squared distance."""

    @register_jitable
    def at(s2, par):
        z, root = norm(s2, par)
        return pair(z, root, par)

    return at


def lift_scalar(function: Callable[..., float], *, error_model: str = "python") -> Callable[..., Any]:
    """Compile ``function(z, *parameters)`` to run over a one-dimensional array z.

    Parameters
    ----------
    function : callable
        A `register_jitable` scalar function.
    error_model : {"python", "numpy"}
        As in `lift`.
    """
    digest = source_digest(function)

    @njit(cache=True, error_model=error_model)
    def over_array(z, *parameters):
        out = np.empty(z.size) + 0.0 * digest
        for k in range(z.size):
            out[k] = function(z[k], *parameters)
        return out

    return over_array
