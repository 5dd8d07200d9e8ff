"""Jacobians of Algorithms 1, 2 and 3 at any state, from one generic pair, one agent and one obstacle.

u_i is a sum over the other agents, one own term and a sum over obstacles, so its Jacobian is put together from these
blocks for every n. The action functions and weights stay generic: φ' and a' are functions of the σ-distance.
"""

from typing import Any

import sympy as sp

from flockana.base.value_checks import ensure_dimension
from flockana.symbolic.algorithm3_energy import gamma_force
from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.energy import GenericPair
from flockana.symbolic.generic_pair import ADJACENCY, PHI, own_force, vector, with_derivative
from flockana.symbolic.obstacles import PHI_BETA, WEIGHT, GenericObstacle
from flockana.symbolic.parameter_symbols import GAINS, GainSymbols
from flockana.symbolic.sigma_norms import EPS, sigma_norm

ROOT = sp.Symbol("w", positive=True)  # √(1 + ε s²), s the distance
PHI_SLOPE, ADJACENCY_SLOPE, PHI_BETA_SLOPE, WEIGHT_SLOPE = (
    sp.Function(name, real=True) for name in ("phi_alpha'", "a'", "phi_beta'", "b'")
)


def _slopes(force: sp.Matrix, table: dict[Any, Any], variables: sp.Matrix, sigma: sp.Expr, z: sp.Symbol) -> sp.Matrix:
    """Return the Jacobian of a force with respect to some variables, in terms of named functions of σ."""
    aware = {function: with_derivative(f"{function.__name__}*", slope) for function, slope in table.items()}
    for function, differentiable in aware.items():
        force = force.replace(function, differentiable)
    slopes = sp.Matrix(force).jacobian(sp.Matrix(list(variables))).xreplace({sigma: z}).subs(1 + EPS * sigma, ROOT)
    return sp.ImmutableMatrix(slopes.xreplace({aware[function](z): function(z) for function in table}))


def _jacobian(
    name: str, steps: tuple[Step, ...], by_position: sp.Matrix, by_velocity: sp.Matrix, residuals: list[sp.Expr]
) -> Derivation:
    """Return a derivation whose result is the Jacobian (∂u_i/∂q, ∂u_i/∂p), side by side."""
    result = sp.ImmutableMatrix(sp.Matrix.hstack(by_position, by_velocity))
    return Derivation(f"Jacobian of {name}", steps, result, tuple(residuals))


def derive_pair_jacobian(m: int = 2, *, gains: GainSymbols = GAINS) -> Derivation:
    """Derive agent j's part of ∂u_i/∂(q, p): c1 (w I + 2 w' ΔΔᵀ) + 2 c2 a' (p_j − p_i) Δᵀ in q_j, c2 a I in p_j."""
    # w is the weight of Δ = q_j − q_i in the force; w' and a' are derivatives in ‖Δ‖². The result is (∂/∂q_j, ∂/∂p_j),
    # side by side; those in q_i, p_i are their negatives, and those of the force on j are the opposite of all: the
    # residuals hold each of them.
    pair = GenericPair(m)
    (q_i, q_j), (p_i, p_j) = pair.q, pair.p
    delta, velocity_difference, z = q_j - q_i, p_j - p_i, pair.z
    table = {PHI: PHI_SLOPE, ADJACENCY: ADJACENCY_SLOPE}
    weight, slope = PHI(z) / ROOT, (PHI_SLOPE(z) - EPS * PHI(z) / ROOT) / (2 * ROOT**2)
    consensus = ADJACENCY_SLOPE(z) / (2 * ROOT)
    stiffness = gains.c1_alpha * (weight * sp.eye(m) + 2 * slope * delta * delta.T)
    by_position = stiffness + 2 * gains.c2_alpha * consensus * velocity_difference * delta.T
    by_velocity = gains.c2_alpha * ADJACENCY(z) * sp.eye(m)
    stated_rates = (-by_position, by_position, -by_velocity, by_velocity)
    residuals = [
        sp.expand(entry)
        for force, sign in zip(pair.forces(gains), (1, -1), strict=True)
        for end, stated_block in zip((q_i, q_j, p_i, p_j), stated_rates, strict=True)
        for entry in _slopes(force, table, end, sigma_norm(delta), z) - sign * stated_block
    ]
    first_text = r"The force of $j$ on $i$ in $\Delta = q_j - q_i$, with $w = \sqrt{1 + \epsilon \|\Delta\|^2}$:"
    steps = (
        Step(first_text, weight * delta),
        Step(r"the slope of its weight in $\|\Delta\|^2$,", slope),
        Step(r"and of $a_{ij}$,", consensus),
        Step(r"so $\partial u_i/\partial q_j = -\partial u_i/\partial q_i$ has from this pair", by_position),
        Step(r"and $\partial u_i/\partial p_j = -\partial u_i/\partial p_i$", by_velocity),
    )
    return _jacobian("one pair", steps, by_position, by_velocity, residuals)


def derive_agent_jacobian(m: int = 2, *, gains: GainSymbols = GAINS, bounded: bool = False) -> Derivation:
    """Derive the γ-agent's part of ∂u_i/∂(q_i, p_i), x = q_i − q_r: −c1 I, or −c1 (I/w − x xᵀ/w³), and −c2 I."""
    q_i, p_i, q_r, p_r = (vector(name, ensure_dimension(m)) for name in ("q_i", "p_i", "q_r", "p_r"))
    x = q_i - q_r
    force = (gamma_force if bounded else own_force)(q_i, p_i, q_r, p_r, gains=gains)
    root = sp.sqrt(1 + sp.Add(*(c**2 for c in x)))
    pull = sp.eye(m) / root - x * x.T / root**3 if bounded else sp.eye(m)
    by_position, by_velocity = -gains.c1_gamma * pull, -gains.c2_gamma * sp.eye(m)
    stated_pairs = ((q_i, by_position), (p_i, by_velocity), (q_r, -by_position), (p_r, -by_velocity))
    residuals = [
        sp.simplify(entry)
        for end, stated_block in stated_pairs
        for entry in sp.ImmutableMatrix(force).jacobian(sp.Matrix(list(end))) - stated_block
    ]
    steps = (
        Step(r"The pull to the $\gamma$-agent:", force),
        Step(r"in $q_i$, and with the other sign in $q_r$,", by_position),
        Step(r"in $p_i$, and with the other sign in $p_r$,", by_velocity),
    )
    return _jacobian("the pull to the gamma-agent", steps, by_position, by_velocity, residuals)


def turn(obstacle: GenericObstacle) -> sp.Matrix:
    """Return the derivative of the β-agent's velocity p_hat by the agent's position q, at fixed p."""
    # Zero at a wall; at a sphere, along e, −(μ/ρ) [⟨a, e⟩ Pp + ⟨a, p⟩ Pe + a ⟨Pe, p⟩] with a = x/ρ.
    m, x, p = obstacle.m, obstacle.x, obstacle.p
    if obstacle.kind == "wall":
        return sp.zeros(m, m)
    distance = sp.sqrt(x.dot(x))
    a = x / distance
    projection = sp.eye(m) - a * a.T
    curvature_term = projection * p * a.T + a.dot(p) * projection + a * (projection * p).T
    return -obstacle.mu / distance * curvature_term


def derive_obstacle_jacobian(kind: str, m: int = 2, *, gains: GainSymbols = GAINS) -> Derivation:
    """Derive an obstacle's part of ∂u_i/∂(q_i, p_i), its β-agent moving with the agent."""
    # With the gap g = q̂ − q, D = ∂q̂/∂q and w the weight of g: in q_i −c1 [w (I − D) + 2 w' g gᵀ] + c2 [b ∂p̂/∂q − 2
    # b' (p̂ − p) gᵀ], since the gradient of ‖g‖² is −2g; in p_i c2 b (D − I).
    obstacle = GenericObstacle(kind, m)
    gap, velocity_difference, z = obstacle.gap, obstacle.rate - obstacle.p, obstacle.z
    table = {PHI_BETA: PHI_BETA_SLOPE, WEIGHT: WEIGHT_SLOPE}
    weight = PHI_BETA(z) / ROOT
    slope = (PHI_BETA_SLOPE(z) - EPS * PHI_BETA(z) / ROOT) / (2 * ROOT**2)
    weight_slope = WEIGHT_SLOPE(z) / (2 * ROOT)
    identity = sp.eye(m) - obstacle.derivative
    by_position = -gains.c1_beta * (weight * identity + 2 * slope * gap * gap.T)
    by_position += gains.c2_beta * (WEIGHT(z) * turn(obstacle) - 2 * weight_slope * velocity_difference * gap.T)
    by_velocity = -gains.c2_beta * WEIGHT(z) * identity
    functions = (PHI_BETA, WEIGHT, PHI_BETA_SLOPE, WEIGHT_SLOPE)
    names = {f(z): sp.Symbol(f.__name__) for f in functions}  # then it is rational
    force = obstacle.force(gains)
    residuals = [
        obstacle.reduce((entry - stated_entry).xreplace(names))
        for end, block in ((obstacle.x, by_position), (obstacle.p, by_velocity))
        for entry, stated_entry in zip(_slopes(force, table, end, sigma_norm(gap), z), block, strict=True)
    ]
    steps = (
        Step(r"The gap to the closest point, $g = \hat q - q$:", gap),
        Step(r"how the closest point follows, $D = \partial \hat q/\partial q$:", obstacle.derivative),
        Step(r"how its velocity turns, $\partial \hat p/\partial q$:", turn(obstacle)),
        Step(r"so in $q_i$, with $w = \sqrt{1 + \epsilon \|g\|^2}$,", by_position),
        Step(r"and in $p_i$", by_velocity),
    )
    return _jacobian(f"a {kind}", steps, by_position, by_velocity, residuals)
