"""Forces and potential of the pairs of a list, for integrators that are compiled too.

Pairs pass in blocks: differences are gathered, those within range kept without a branch; the rest is `lift_block`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from flockana.kernels.compiling import njit, register_jitable
from flockana.kernels.sweep import BLOCK, lift_block

CompiledFunction = Callable[..., float]
PARAMETERS = 32  # of a pair law, at most
MOST_TERMS = 8  # of a law: a compiled integrator takes their functions one by one (`flockana.kernels.advance`)


class Signatures(NamedTuple):
    """numba's types of what a term gives: x and v are seen from a frame, the agents in an order of their own.

    ``act(t, x, v, u, frame, numbers, panels, first, second, count, order, near, room)`` adds to u and returns the
    power, ``energy(t, x, v, frame, numbers, panels, first, second, count, order, near, room)`` returns the potential
    energy. The rows of `frame` are its place and velocity, `order` has every agent's own number; `near`, (2, BLOCK),
    and `room`, (3, BLOCK), are any term's to write to.
    """

    act: Any
    energy: Any


@cache
def signatures() -> Signatures:
    """Both, once numba is asked for."""
    from numba import float64, int64, uint32, uint64

    matrix, vector, indices = float64[:, ::1], float64[::1], uint32[::1]
    room = (uint64[:, ::1], matrix)
    shared = (matrix, vector, matrix, indices, indices, int64, uint64[::1], *room)
    act, energy = float64(float64, matrix, matrix, matrix, *shared), float64(float64, matrix, matrix, *shared)
    return Signatures(act, energy)


def term_functions(
    act: Callable[..., float], energy: Callable[..., float], *, allocates: bool = True
) -> tuple[CompiledFunction, CompiledFunction]:
    """Force and energy of a term, compiled so that compiled code may be handed them.

    A term that allocates nothing need count no references: for each array that it hands on, that costs as much as the
    potential of a pair.
    """
    force, potential = signatures()
    return _compiled(act, force, _nrt=allocates), _compiled(energy, potential, _nrt=allocates)


def _compiled(function: Callable[..., float], signature: Any, **options: Any) -> CompiledFunction:
    made = njit(cache=True, error_model="numpy", nogil=True, **options)(function)
    made.compile(signature)
    made.disable_compile()
    return made.dispatcher


def _no_force(t, x, v, u, frame, numbers, panels, first, second, size, order, near, room):
    return 0.0


def _no_energy(t, x, v, frame, numbers, panels, first, second, size, order, near, room):
    return 0.0


@cache
def no_term() -> tuple[CompiledFunction, CompiledFunction]:
    """Force and energy of nothing."""
    return term_functions(_no_force, _no_energy, allocates=False)


def listed_numbers(c1: float, c2: float, r: float, far: float, par: Any) -> Any:
    """The numbers of a pair term: gains, range, potential beyond it, and the law's parameters, padded."""
    return np.concatenate([[c1, c2, r, far], par, np.zeros(PARAMETERS - len(par))])


@register_jitable
def _as_tuple(par):
    """The parameters in registers, which no array can alias: what the compiler knows of lets it vectorise the law."""
    first = par[0], par[1], par[2], par[3], par[4], par[5], par[6], par[7]
    second = par[8], par[9], par[10], par[11], par[12], par[13], par[14], par[15]
    third = par[16], par[17], par[18], par[19], par[20], par[21], par[22], par[23]
    return (*first, *second, *third, par[24], par[25], par[26], par[27], par[28], par[29], par[30], par[31])


def lift_listed(
    pair: Callable[..., Any], potential: Callable[..., Any], norm: Callable[..., Any] | None, digest: int
) -> Callable[[int], tuple[CompiledFunction, CompiledFunction]]:
    """By dimension: force and potential of a pair law, compiled when first asked for; `listed_numbers` are theirs."""

    @cache
    def of(m: int) -> tuple[CompiledFunction, CompiledFunction]:
        add = lift_block(pair, m, norm)

        @register_jitable
        def gather(x, limit, first, second, begin, end, near, s2):
            count = 0
            if x.shape[1] != m:
                return count  # never, as in `lift_block`
            for k in range(begin, end):
                i, j = np.uint64(first[k]), np.uint64(second[k])
                square = 0.0
                for c in range(m):
                    gap = x[j, c] - x[i, c]
                    square += gap * gap
                s2[count], near[0, count], near[1, count] = square, i, j
                count += square < limit
            return count

        @njit(error_model="numpy", nogil=True, _nrt=False)
        def sweep(x, v, u, numbers, first, second, size, near, room):
            total, c1, c2, r = 0.0 * digest, numbers[0], numbers[1], numbers[2]
            par, limit = _as_tuple(numbers[4:]), max(r * r, 5e-324)
            for begin in range(0, size, BLOCK):
                count = gather(x, limit, first, second, begin, min(begin + BLOCK, size), near, room[0])
                total += add(count, near[0], near[1], room[0], room[1], room[2], x, v, u, par, c1, c2)
            return -c2 * total

        def act(t, x, v, u, frame, numbers, panels, first, second, size, order, near, room):
            return sweep(x, v, u, numbers, first, second, size, near, room)

        @njit(error_model="numpy", nogil=True, _nrt=False)
        def summed(x, numbers, panels, first, second, size, near, s2):
            total, r, par, pairs = 0.0 * digest, numbers[2], numbers[4:], 0
            for begin in range(0, size, BLOCK):
                count = gather(x, max(r * r, 5e-324), first, second, begin, min(begin + BLOCK, size), near, s2)
                pairs += count
                for k in range(count):
                    total += potential(s2[k], par, panels)
            n = x.shape[0]
            beyond = n * (n - 1) // 2 - pairs
            return numbers[0] * (total + beyond * numbers[3] if beyond > 0 else total)  # it may be infinite there

        def energy(t, x, v, frame, numbers, panels, first, second, size, order, near, room):
            return summed(x, numbers, panels, first, second, size, near, room[0])

        return term_functions(act, energy, allocates=False)

    return of
