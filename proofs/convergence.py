"""Theorem 3(ii), as far as it is proved: solutions converge to one equilibrium, almost all to one with ∇²U_λ >= 0.

Two theorems are cited: Łojasiewicz's inequality, of C¹ functions that are analytic in finitely many pieces, and the
centre-stable manifold of an equilibrium of a C¹ field. What they are applied to is checked here.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.scalar_functions import taper
from proofs.proof import Proof, Step
from proofs.smt import implication


def _smooth() -> Iterator[Step]:
    z, h = sp.symbols("z h", positive=True)
    falling = taper(z, h=h)
    ends = [sp.simplify(each.subs(z, end)) for each in (falling, sp.diff(falling, z)) for end in (h, 1)]
    yield Step(
        "ρ_h goes from 1 to 0 with slope 0 at both ends: a_ij and φ_α are C¹, ψ_α and U_λ C², and the field is C¹",
        ends == [1, 0, 0, 0],
        evidence="on [0, h], [h, 1] and [1, ∞) each is analytic, beyond the ends too: Łojasiewicz's inequality holds",
    )


def _descent() -> Iterator[Step]:
    """F = H + κ⟨∇U, v⟩ falls by squares of both ‖v‖ and ‖∇U‖."""
    x, y, a, b = sp.symbols("x y v_1 v_2", real=True)
    u = sp.Function("U")(x, y)
    grad, v = sp.Matrix([u.diff(x), u.diff(y)]), sp.Matrix([a, b])
    damping = sp.Matrix(2, 2, sp.symbols("d_11 d_12 d_12 d_22", real=True))
    push = -grad - damping * v
    product = grad.dot(v)
    rate = product.diff(x) * a + product.diff(y) * b + grad.dot(push)
    claimed = (v.T * sp.hessian(u, (x, y)) * v)[0] - grad.dot(grad) - grad.dot(damping * v)
    yield Step(
        "d⟨∇U, v⟩/dt = vᵀ∇²U v - ‖∇U‖² - ⟨∇U, Dv⟩ along x' = v, v' = -∇U - D v",
        sp.simplify(sp.expand(rate - claimed)) == 0,
        evidence="in two coordinates, of which every further pair adds the same",
    )
    speed, slope, c, most, bend, kappa, fall = z3.Reals("v grad_U c D_max M kappa fall")
    yield falls(speed, slope, (c, most, bend, kappa, fall), z3.RealVal(1))


def falls(speed: z3.ArithRef, slope: z3.ArithRef, constants: tuple[z3.ArithRef, ...], room: z3.ArithRef) -> Step:
    """F falls, if κ is so small that κ(2M + D²) <= c times some room: 1 is enough, more is not."""
    c, most, bend, kappa, fall = constants
    return implication(
        "with c <= D <= D_max and |∇²U| <= M on the bounded flock, κ(2M + D_max²) <= c leaves -F' >= ½c‖v‖² + ½κ‖∇U‖²",
        fall >= c * speed**2 / 2 + kappa * slope**2 / 2,
        *(speed >= 0, slope >= 0, c > 0, most >= 0, bend >= 0, kappa > 0, kappa * (2 * bend + most**2) <= c * room),
        fall >= (c - kappa * bend) * speed**2 - kappa * most * speed * slope + kappa * slope**2,
        latex=r"F = H + \kappa\langle\nabla U, v\rangle, \; -\dot F \ge \tfrac c2\|v\|^2 + \tfrac\kappa2\|\nabla U\|^2",
    )


def _length() -> Iterator[Step]:
    part, small, power = z3.Reals("part small power")
    yield implication(
        "Łojasiewicz: |U - U*|^θ <= C‖∇U‖ near a limit point, ½ <= θ < 1; a^2θ = a a^(2θ-1) <= a for a <= 1, so that "
        "|F - F*|^θ <= C(‖v‖ + ‖∇U‖) there",
        part <= small,
        *(small >= 0, small <= 1, power >= 0, power <= 1, part == small * power),
    )
    speed, slope, k, constant, level, rate, rest = z3.Reals("v grad_U k C level rate rest")
    yield implication(
        "then y = (F - F*)^(1-θ) falls at (1-θ)k/2C (‖v‖ + ‖∇U‖) at least: ∫‖v‖ dt is finite, and x has a limit",
        2 * constant * rate >= rest * k * (speed + slope),
        *(speed >= 0, slope >= 0, k > 0, constant > 0, rest > 0, level > 0, rate >= 0),
        *(level <= constant * (speed + slope), level * rate >= rest * k * (speed**2 + slope**2)),
        latex=r"-\dot y = (1-\theta)\frac{-\dot F}{(F - F^*)^\theta} \ge \frac{(1-\theta)k}{2C}(\|v\| + \|\nabla U\|)",
    )


def _saddles() -> Iterator[Step]:
    s = sp.Symbol("s", positive=True)
    n = 3
    w = sp.Matrix(sp.symbols("w1:4", real=True))
    hessian, damping = (
        sp.Matrix(n, n, lambda i, j, name=name: sp.Symbol(f"{name}{min(i, j)}{max(i, j)}", real=True)) for name in "bd"
    )
    matrix = sp.Matrix(sp.BlockMatrix([[sp.zeros(n), sp.eye(n)], [-hessian, -damping]]))
    state = sp.Matrix.vstack(w, s * w)
    left = (matrix * state - s * state).applyfunc(sp.expand)
    polynomial = ((s**2 * sp.eye(n) + s * damping + hessian) * w).applyfunc(sp.expand)
    yield Step(
        "(w, s w) is an eigenvector to s of the linearisation [[0, I], [-B, -D]] if and only if (s² + sD + B) w = 0",
        sp.expand(left[:n, :]) == sp.zeros(n, 1) and (left[n:, :] + polynomial).applyfunc(sp.expand) == sp.zeros(n, 1),
    )
    root, drag, bend, least = z3.Reals("s drag bend beta")
    yield implication(
        "a negative eigenvalue of B = ∇²U makes s² + sD + B indefinite at s = 0, and it is positive for s² > β: its "
        "least eigenvalue passes 0 at an s > 0. So a state at which B is not >= 0 is left along an unstable direction, "
        "and its centre-stable manifold has measure 0, as have the starts that a flow brings into countably many such",
        root**2 + root * drag + bend > 0,
        *(root > 0, drag >= 0, bend >= -least, root**2 > least),
    )


def _steps() -> Iterator[Step]:
    for part in (_smooth, _descent, _length, _saddles):
        yield from part()


PROOF = Proof(
    id="convergence",
    title="Theorem 3(ii): each solution has one limit, almost each a limit with ∇²U_λ >= 0",
    statement=(
        "Under Algorithm 2 each solution, seen from the centre of mass, converges to one equilibrium of U_λ; but for "
        "starts of measure 0 its Hessian there is positive semidefinite, as at every local minimum. Whether a "
        "degenerate one of these is a minimum is open. For every n, and m = 1, 2, 3."
    ),
    hypotheses=(
        "c1γ, c2γ > 0, c1α, c2α >= 0; 0 < a <= b, 0 < h < 1, 0 < d < r, ε > 0. The flock stays bounded and velocities "
        "tend to 0 (any-potential-limits). Łojasiewicz's inequality and the centre-stable manifold theorem are cited"
    ),
    rigour="smt",
    steps=_steps,
    size=7,
    theorems=("os-3",),
    cites=("Łojasiewicz", "centre-stable manifold"),
)
