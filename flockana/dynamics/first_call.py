"""What a law gives is looked at once before it is integrated: an error then names the law and what it returned."""

from __future__ import annotations

from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.laws.discrete import DiscreteLaw
from flockana.laws.law import Law


def check_first_call(law: Law | DiscreteLaw, t0: float, q0: FloatArray, p0: FloatArray) -> None:
    """Raise unless the law gives what a law gives: real numbers in the flock's shape, finite where it starts."""
    name, at = type(law).__name__, f"at the start, t = {t0:g}"
    given: Any
    parts: tuple[str, ...]
    if isinstance(law, DiscreteLaw):
        memory = {key: np.array(value) for key, value in law.start(q0, p0).items()}
        given, expected, parts = law.step(t0, q0.copy(), p0.copy(), memory), "(q, p, u, memory)", ("q", "p", "u")
    else:
        given, expected, parts = law.flow(t0, q0, p0), "(u, dH/dt)", ("u",)
    if not isinstance(given, tuple) or len(given) != len(parts) + 1:
        raise ArgumentError(f"{name} gives {given!r} {at}: expected {expected}")
    for part, value in zip(parts, given, strict=False):
        array = np.asarray(value)
        if array.dtype.kind not in "fiu" or array.shape != q0.shape:
            kind = f"{array.dtype} of shape {array.shape}"
            raise ArgumentError(f"{name} gives {part} as {kind} {at}: expected real numbers of shape {q0.shape}")
    if not isinstance(law, DiscreteLaw):
        _check_finite(law, np.asarray(given[0]), given[1], t0, q0, p0, at)


def _check_finite(law: Law, u: FloatArray, rate: Any, t0: float, q0: FloatArray, p0: FloatArray, at: str) -> None:
    """Raise unless accelerations are finite, and the rate is that of an energy if there is one."""
    name, energy = type(law).__name__, law.hamiltonian(t0, q0, p0)
    if not (known := np.isfinite(u).all(axis=1)).all():
        i = int(np.argmin(known))
        raise ArgumentError(f"{name} gives u[{i}] = {u[i]} {at}: expected finite accelerations there")
    for what, number in (("H", energy), ("dH/dt", rate)):
        if np.ndim(number) != 0 or np.asarray(number).dtype.kind not in "fiu":
            raise ArgumentError(f"{name} gives {what} = {number!r} {at}: expected a real number, or NaN without energy")
    if np.isfinite(energy) and not np.isfinite(rate):
        raise ArgumentError(
            f"{name} gives H = {energy:g}, but dH/dt = {rate} {at}: expected the rate of that energy, or H = NaN for a "
            "law without one"
        )
