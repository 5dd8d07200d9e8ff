"""Alignment of a configuration with a rotated equilibrium, in balls: uniqueness, and a near-best rotation."""

from typing import Any

import numpy as np
from flint import arb, fmpq

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.certified.balls import ball, dot, square
from flockana.certified.structure import Balls, Structure


def unique_projection(u: Structure, rest: Balls, radius: fmpq) -> bool:
    """Return whether the nearest point of the orbit is certainly unique, and not degenerate, up to the radius."""
    if u.m == 1:
        return True
    size = dot(rest, rest)
    if u.m == 2:
        return bool(square(ball(radius)) < size)
    columns = [rest[a::3] for a in range(3)]
    largest = sum((square(dot(a, b)) for a in columns for b in columns), arb(0)).sqrt()
    return bool((1 + arb(3).sqrt()) * ball(radius) * largest.sqrt() < size - largest)


def centred(name: str, values: Any, shape: tuple[int, int]) -> list[arb]:
    """Return a list of balls whose sum over the agents is 0."""
    rows = [[arb(x) if isinstance(x, arb) else arb(float(x)) for x in row] for row in values]
    if len(rows) != shape[0] or any(len(row) != shape[1] for row in rows):
        raise ArgumentError(f"{name} has shape {np.shape(values)}: expected {shape}, as the equilibrium has")
    if not all(x.is_finite() for row in rows for x in row):
        raise ArgumentError(f"{name} holds a number that is not finite: expected finite coordinates")
    middle = [sum(column, arb(0)) / shape[0] for column in zip(*rows, strict=True)]
    return [x - c for row in rows for x, c in zip(row, middle, strict=True)]


def rotated_to(rest: Balls, x: Balls, shape: tuple[int, int]) -> list[arb]:
    """Return the equilibrium rotated, exactly but for its enclosure, to nearly the best alignment."""
    rotation = _rotation(*(np.array([float(y) for y in z]).reshape(shape) for z in (rest, x)))
    m = shape[1]
    return [dot(row, rest[i : i + m]) for i in range(0, len(rest), m) for row in rotation]


def _rotation(rest: FloatArray, x: FloatArray) -> list[list[arb]]:
    """Return balls around a rotation matrix, proposed by a singular value decomposition."""
    m = rest.shape[1]
    if m == 1:
        return [[arb(1)]]
    left, _, right = np.linalg.svd(x.T @ rest)
    left[:, -1] *= np.linalg.det(left @ right)
    found = left @ right
    if m == 2:
        c, s = arb(float(found[0, 0])), arb(float(found[1, 0]))
        size = (square(c) + square(s)).sqrt()
        return [[c / size, -s / size], [s / size, c / size]]
    from scipy.spatial.transform import Rotation

    a, b, c, w = (arb(float(y)) for y in Rotation.from_matrix(found).as_quat())
    size = square(a) + square(b) + square(c) + square(w)
    rows = [
        [w * w + a * a - b * b - c * c, 2 * (a * b - c * w), 2 * (a * c + b * w)],
        [2 * (a * b + c * w), w * w - a * a + b * b - c * c, 2 * (b * c - a * w)],
        [2 * (a * c - b * w), 2 * (b * c + a * w), w * w - a * a - b * b + c * c],
    ]
    return [[y / size for y in row] for row in rows]
