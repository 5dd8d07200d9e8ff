"""An equilibrium modulo rigid motions in balls: Krawczyk's test, uniqueness of the nearest point, alignment.

Equilibria of the structure come as orbits, one net rotated, so a zero is sought of
(∇U(x) + Σ μ_k g_k + Σ ν_a e_a, Σ x_i, ⟨g_k, x − x̄⟩): the g_k are the turns of the computed x̄, the e_a the shifts.
∇U(x) is orthogonal to every turn Ωx, and so is e_a, as Σ x_i = 0; as the matrix ⟨g_k, Ω_l x⟩ is regular near x̄, all μ_k
are 0 there. What is left sums to n ν + c1γ Σ x_i = n ν over the agents, so that ν = 0: the zero is an equilibrium.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from flint import arb, arb_mat, fmpq

from flockana.base.errors import ArgumentError, SolverError
from flockana.base.value_checks import FloatArray
from flockana.certified.balls import ball, dot, norm, norm2, square
from flockana.certified.krawczyk import enclose_zero
from flockana.certified.structural_potential import Balls, Structure

BOX = fmpq(1, 10**13)  # of d: the half-width of the box in which there is one equilibrium
_NEWTON = 3
_NEAR = 1e-4  # of d: a start farther than that from what Newton's method finds is no equilibrium
_COLLINEAR = 1e-9


def enclose_rest(u: Structure, q: FloatArray) -> tuple[list[float], list[arb]]:
    """Return the equilibrium computed from positions q, and balls that certainly contain the exact one."""
    singular_values = np.linalg.svd(q - q.mean(axis=0), compute_uv=False)
    if u.m == 3 and singular_values[1] <= _COLLINEAR * singular_values[0]:  # its orbit is a sphere
        raise ArgumentError("the agents lie on one line in space: expected a net off a line; certify it in m = 1")
    x = _refined(u, q)
    radius = ball(BOX * u.par.d)
    centre = [arb(y) for y in x]
    if not regular(u, x, radius):
        raise SolverError("the equilibrium's rotations may be dependent: its agents are nearly on one line")
    equations, slope = system(u, x)
    solution = enclose_zero(equations, slope, [*centre, *_multipliers(u)], radius)
    if solution is None:
        fault = "it is degenerate (a soft mode beyond the rigid motions), or find_equilibrium ended too early"
        raise SolverError(f"Krawczyk's test found no isolated equilibrium there: {fault}")
    return x, solution[: u.n * u.m]


def system(u: Structure, x: Sequence[float]) -> tuple[Callable[[Balls], list[arb]], Callable[[Balls], arb_mat]]:
    """Return the equilibrium equations with multipliers for fixed rigid motions, and their Jacobian."""
    centre, size = [arb(y) for y in x], len(x)
    motions, shifts = u.rotation_tangents(centre), u.translations()
    fixed = motions + shifts
    offsets = [dot(motion, centre) for motion in motions] + [arb(0)] * u.m

    def equations(unknown: Balls) -> list[arb]:
        position, factors = unknown[:size], unknown[size:]
        columns = zip(u.gradient(position), *fixed, strict=True)
        force = [f + dot(factors, motions) for f, *motions in columns]
        return force + [dot(motion, position) - offset for motion, offset in zip(fixed, offsets, strict=True)]

    def slope(unknown: Balls) -> arb_mat:
        rows = [[*row, *(motion[k] for motion in fixed)] for k, row in enumerate(u.hessian(unknown[:size]).tolist())]
        return arb_mat(rows + [[*motion, *[arb(0)] * len(fixed)] for motion in fixed])

    return equations, slope


def _multipliers(u: Structure) -> list[arb]:
    """Return initial Lagrange multipliers, all 0: one for each rotation and each translation."""
    return [arb(0)] * (u.m * (u.m + 1) // 2)


def regular(u: Structure, x: Sequence[float], radius: arb) -> bool:
    """Return whether the equations that fix the rotations are certainly independent on a whole box."""
    fixed, moving = u.rotation_tangents([arb(y) for y in x]), u.rotation_tangents([arb(y, radius) for y in x])
    return not fixed or bool(arb_mat([[dot(a, b) for b in fixed] for a in moving]).det() != 0)


def _refined(u: Structure, q: FloatArray) -> list[float]:
    """Return the centred equilibrium that Newton's method finds from positions q."""
    start = (q - q.mean(axis=0)).ravel()
    x, d = start.copy(), float(u.par.d.p) / float(u.par.d.q)
    for _ in range(_NEWTON):
        equations, slope = system(u, x.tolist())
        unknown_values = [arb(float(y)) for y in x] + _multipliers(u)
        matrix = np.array([[float(entry.mid()) for entry in row] for row in slope(unknown_values).tolist()])
        value = np.array([float(y.mid()) for y in equations(unknown_values)])
        x = x - np.linalg.lstsq(matrix, value, rcond=None)[0][: x.size]
        if not np.abs(x - start).max() <= _NEAR * d:
            expected = "expected what find_equilibrium returned, under the same law"
            raise ArgumentError(f"there is no equilibrium beside these positions: {expected}")
    return [float(y) for y in x]


def unique_projection(u: Structure, rest: Balls, radius: fmpq) -> bool:
    """Return whether each state within the radius certainly has one nearest point on the orbit."""
    if u.m == 1:
        return True
    rest_square = dot(rest, rest)
    if u.m == 2:
        return bool(square(ball(radius)) < rest_square)
    columns = [rest[a::3] for a in range(3)]
    largest = norm([dot(a, b) for a in columns for b in columns])
    return bool((1 + arb(3).sqrt()) * ball(radius) * largest.sqrt() < rest_square - largest)


def centred(name: str, values: Any, shape: tuple[int, int]) -> list[arb]:
    """Return coordinates relative to the mean over the agents, as balls."""
    rows = [[arb(x) if isinstance(x, arb) else arb(float(x)) for x in row] for row in values]
    if len(rows) != shape[0] or any(len(row) != shape[1] for row in rows):
        raise ArgumentError(f"{name} has shape {np.shape(values)}: expected {shape}, as the equilibrium has")
    if not all(x.is_finite() for row in rows for x in row):
        raise ArgumentError(f"{name} holds a number that is not finite: expected finite coordinates")
    column_means = [sum(column, arb(0)) / shape[0] for column in zip(*rows, strict=True)]
    return [x - c for row in rows for x, c in zip(row, column_means, strict=True)]


def rotated_to(rest: Balls, x: Balls, shape: tuple[int, int]) -> list[arb]:
    """Return the equilibrium rotated to nearly the best alignment with given positions, as balls."""
    rotation = _rotation(*(np.array([float(y) for y in z]).reshape(shape) for z in (rest, x)))
    m = shape[1]
    return [dot(row, rest[i : i + m]) for i in range(0, len(rest), m) for row in rotation]


def _rotation(rest: FloatArray, x: FloatArray) -> list[list[arb]]:
    """Return balls of a rotation matrix that nearly aligns the equilibrium with given positions."""
    m = rest.shape[1]
    if m == 1:
        return [[arb(1)]]
    left, _, right = np.linalg.svd(x.T @ rest)
    left[:, -1] *= np.linalg.det(left @ right)
    rotation = left @ right
    if m == 2:
        c, s = arb(float(rotation[0, 0])), arb(float(rotation[1, 0]))
        vector_norm = norm([c, s])
        return [[c / vector_norm, -s / vector_norm], [s / vector_norm, c / vector_norm]]
    from scipy.spatial.transform import Rotation

    a, b, c, w = (arb(float(y)) for y in Rotation.from_matrix(rotation).as_quat())
    rows = [
        [w * w + a * a - b * b - c * c, 2 * (a * b - c * w), 2 * (a * c + b * w)],
        [2 * (a * b + c * w), w * w - a * a + b * b - c * c, 2 * (b * c - a * w)],
        [2 * (a * c - b * w), 2 * (b * c + a * w), w * w - a * a - b * b + c * c],
    ]
    return [[y / norm2([a, b, c, w]) for y in row] for row in rows]
