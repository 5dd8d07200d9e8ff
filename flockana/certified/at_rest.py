"""Krawczyk's test for an equilibrium modulo rigid motions, in balls.

Equilibria of the structure come as orbits, one net rotated, so a zero is sought of
(∇U(x) + Σ μ_k g_k + Σ ν_a e_a, Σ x_i, ⟨g_k, x − x̄⟩): the g_k are the turns of the computed x̄, the e_a the shifts.
∇U(x) is orthogonal to every turn Ωx, and so is e_a, as Σ x_i = 0; as the matrix ⟨g_k, Ω_l x⟩ is regular near x̄, all μ_k
are 0 there. What is left sums to n ν + c1γ Σ x_i = n ν over the agents, so that ν = 0: the zero is an equilibrium.
"""

from collections.abc import Callable, Sequence

import numpy as np
from flint import arb, arb_mat, fmpq

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError, SolverError
from flockana.certified.balls import ball, dot
from flockana.certified.krawczyk import enclose_zero
from flockana.certified.structure import Balls, Structure

BOX = fmpq(1, 10**13)  # of d: the half-width of the box in which there is one equilibrium
_NEWTON = 3
_NEAR = 1e-4  # of d: a start farther than that from what Newton's method finds is no equilibrium
_COLLINEAR = 1e-9


def enclose_rest(u: Structure, q: FloatArray) -> tuple[list[float], list[arb]]:
    """Return the computed equilibrium next to q, and balls that hold the true one of the same orientation."""
    _ensure_turnable(q)
    x = _refined(u, q)
    radius = ball(half_width(u))
    centre = [arb(y) for y in x]
    if not regular(u, x, radius):
        raise SolverError("the equilibrium's rotations may be dependent: its agents are nearly on one line")
    equations, slope = system(u, x)
    found = enclose_zero(equations, slope, [*centre, *[arb(0)] * (len(u.rotation_tangents(centre)) + u.m)], radius)
    if found is None:
        raise SolverError(
            "Krawczyk's test found no isolated equilibrium there: it is degenerate (a soft mode beyond the rigid "
            "motions), or find_equilibrium ended too early"
        )
    return x, found[: u.n * u.m]


def system(u: Structure, x: Sequence[float]) -> tuple[Callable[[Balls], list[arb]], Callable[[Balls], arb_mat]]:
    """Return the equations in (x, μ, ν) about a computed x̄, and their derivative."""
    centre, size = [arb(y) for y in x], len(x)
    motions, shifts = u.rotation_tangents(centre), u.translations()
    held = motions + shifts
    offsets = [dot(motion, centre) for motion in motions] + [arb(0)] * u.m

    def equations(unknown: Balls) -> list[arb]:
        place, factors = unknown[:size], unknown[size:]
        force = u.gradient(place)
        for factor, motion in zip(factors, held, strict=True):
            force = [f + factor * y for f, y in zip(force, motion, strict=True)]
        return force + [dot(motion, place) - offset for motion, offset in zip(held, offsets, strict=True)]

    def slope(unknown: Balls) -> arb_mat:
        rows = [[*row, *(motion[k] for motion in held)] for k, row in enumerate(u.hessian(unknown[:size]).tolist())]
        return arb_mat(rows + [[*motion, *[arb(0)] * len(held)] for motion in held])

    return equations, slope


def regular(u: Structure, x: Sequence[float], radius: arb) -> bool:
    """Return whether no configuration in the box has a rotation orthogonal to all those of the computed one."""
    fixed, moving = u.rotation_tangents([arb(y) for y in x]), u.rotation_tangents([arb(y, radius) for y in x])
    return not fixed or bool(arb_mat([[dot(a, b) for b in fixed] for a in moving]).det() != 0)


def half_width(u: Structure) -> fmpq:
    """Return the half-width of the box in which the equilibrium is unique."""
    return BOX * u.par.d


def _ensure_turnable(q: FloatArray) -> None:
    """Raise on a net in space that lies on one line, whose orbit is a sphere."""
    sizes = np.linalg.svd(q - q.mean(axis=0), compute_uv=False)
    if q.shape[1] == 3 and sizes[1] <= _COLLINEAR * sizes[0]:
        raise ArgumentError("the agents lie on one line in space: expected a net off a line; certify it in m = 1")


def _refined(u: Structure, q: FloatArray) -> list[float]:
    """Return Newton's method from q, centred, with forces from balls and slopes in floating point."""
    start = (q - q.mean(axis=0)).ravel()
    x, d = start.copy(), float(u.par.d.p) / float(u.par.d.q)
    for _ in range(_NEWTON):
        equations, slope = system(u, x.tolist())
        at = [arb(float(y)) for y in x] + [arb(0)] * (len(u.rotation_tangents([arb(0)] * len(x))) + u.m)
        matrix = np.array([[float(entry.mid()) for entry in row] for row in slope(at).tolist()])
        value = np.array([float(y.mid()) for y in equations(at)])
        x = x - np.linalg.lstsq(matrix, value, rcond=None)[0][: x.size]
        if not np.abs(x - start).max() <= _NEAR * d:
            raise ArgumentError(
                "there is no equilibrium beside these positions: expected what find_equilibrium returned, under the "
                "same law"
            )
    return [float(y) for y in x]
