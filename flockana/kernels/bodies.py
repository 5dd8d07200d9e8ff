"""Obstacles for integrators that are compiled too: forces, potential, and what no step may leap over.

Of one kind, `numbers` are: how many there are, m, the range r', gains c1 and c2, the law's parameters; then where the
parameters of each obstacle begin (K + 1), its ball (m + 1 each), and its parameters. Each kind is a term of its own: in
what company it is compiles nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from flockana.kernels.alpha import BETA_AREA
from flockana.kernels.compiling import njit
from flockana.kernels.listed import CompiledFunction, term_functions

_COUNT, _DIMENSION, _REACH, _C1, _C2, _BETA = range(6)
_LAW = BETA_AREA + 1  # parameters of the law
_STARTS = _BETA + _LAW


class BodyFunctions(NamedTuple):
    """Force, potential energy, and what share of a step may be taken (`flockana.kernels.shells`).

    ``guard(points, allowance, numbers, shell, far, share)`` returns the share given, or less.
    """

    act: CompiledFunction
    energy: CompiledFunction
    guard: CompiledFunction


def body_numbers(reach: float, c1: float, c2: float, law: Any, pars: Any, starts: Any, balls: Any) -> Any:
    """The numbers of an obstacle term."""
    count, m = balls.shape[0], balls.shape[1] - 1
    return np.concatenate([[count, m, reach, c1, c2], law, starts, balls.ravel(), pars])


@njit(error_model="numpy", nogil=True)
def _bodies(numbers):
    """(parameters, where each obstacle's begin, balls)."""
    count, m = np.int64(numbers[_COUNT]), np.int64(numbers[_DIMENSION])
    balls, starts = _STARTS + count + 1, np.empty(count + 1, np.int64)
    pars = balls + count * (m + 1)
    for k in range(count + 1):
        starts[k] = np.int64(numbers[_STARTS + k])
    return numbers[pars:], starts, numbers[balls:pars].reshape(count, m + 1)


def _no_guard(points, allowance, numbers, shell, far, share):
    return share


@cache
def guard_signature() -> Any:
    """numba's type of a guard, once numba is asked for."""
    from numba import float64

    return float64(float64[:, :, ::1], float64[::1], float64[::1], float64, float64, float64)


def _guard(function: Callable[..., float]) -> CompiledFunction:
    made = njit(cache=True, error_model="numpy", nogil=True)(function)
    made.compile(guard_signature())
    made.disable_compile()
    return made.dispatcher


@cache
def no_guard() -> CompiledFunction:
    """A guard of nothing."""
    return _guard(_no_guard)


@dataclass(frozen=True, eq=False)
class Bodies:
    """One kind of obstacle: force, potential and guard, to be compiled as `BodyFunctions` are.

    Parameters
    ----------
    act, energy, guard : callable
        Not yet compiled.
    """

    act: Callable[..., float]
    energy: Callable[..., float]
    guard: Callable[..., float]


def lift_bodies(forces: Callable[..., float], potential: Callable[..., float], share: Callable[..., float]) -> Bodies:
    """Of one kind of obstacle (`flockana.kernels.obstacles`)."""

    def act(t, x, v, u, frame, numbers, panels, first, second, size, order, near, room):
        pars, starts, balls = _bodies(numbers)
        law, reach, c1, c2 = numbers[_BETA:_STARTS], numbers[_REACH], numbers[_C1], numbers[_C2]
        return c2 * forces(x + frame[0], v + frame[1], pars, starts, balls, law, reach, c1, c2, u)

    def energy(t, x, v, frame, numbers, panels, first, second, size, order, near, room):
        pars, starts, balls = _bodies(numbers)
        law, reach = numbers[_BETA:_STARTS], numbers[_REACH]
        return numbers[_C1] * potential(x + frame[0], pars, starts, balls, law, panels, reach)

    def guard(points, allowance, numbers, shell, far, most):
        return share(points, allowance, *_bodies(numbers), shell, far, most)

    return Bodies(act, energy, guard)


@cache
def body_functions(kind: Bodies) -> BodyFunctions:
    """Of a kind of obstacle, compiled when first asked for."""
    return BodyFunctions(*term_functions(kind.act, kind.energy), _guard(kind.guard))
