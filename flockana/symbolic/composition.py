"""Energy balance of composed laws, written out for a small flock, with drag and thrust.

Three agents show every kind of pair, and a pull on one, two or all of them, so the identities are those of every n.
"""

from itertools import combinations

import sympy as sp

from flockana.base.checks import ensure_dimension
from flockana.symbolic.derivation import Derivation
from flockana.symbolic.led_dead_zone import HALF_PULL, OF_SQUARE
from flockana.symbolic.pair import energy_balance, vector

THRUST, BRAKE, DAMPING = sp.symbols("alpha beta c", real=True)
PULL, MATCH = sp.symbols("c_1 c_2", nonnegative=True)
_N = 3


def _state(m: int) -> tuple[list[sp.Matrix], list[sp.Matrix], tuple[sp.Matrix, sp.Matrix, sp.Matrix]]:
    q, p = ([vector(f"{name}_{i}", ensure_dimension(m)) for i in range(_N)] for name in ("q", "p"))
    return q, p, (vector("q_r", m), vector("p_r", m), vector("a_r", m))


def _between_agents(q: list[sp.Matrix], p: list[sp.Matrix]) -> tuple[list[sp.Matrix], sp.Expr, sp.Expr]:
    """Return (forces, potential, power of the consensus), with symmetric but otherwise free weights."""
    u, potential, power = [sp.zeros(*x.shape) for x in q], sp.Integer(0), sp.Integer(0)
    for i, j in combinations(range(_N), 2):
        weight, apart, slip = sp.Symbol(f"a_{i}{j}", nonnegative=True), q[j] - q[i], p[j] - p[i]
        square = apart.dot(apart)
        push = 2 * HALF_PULL(square) * apart + DAMPING * weight * slip
        u[i], u[j] = u[i] + push, u[j] - push
        potential += OF_SQUARE(square)
        power -= DAMPING * weight * slip.dot(slip)
    return u, potential, power


def given_frame_identity(m: int = 2, *, informed: int = 2) -> Derivation:
    """Derive dH/dt in the given frame, of a γ-agent at rest that pulls some, and of speed control of all."""
    # H = Σ ψ + c_1/2 Σ of the informed ‖q_i − q_r‖² + ½ Σ‖p_i‖² changes at −c pᵀLp − c_2 Σ of the informed ‖p_i‖² + Σ
    # (α − β‖p_i‖²)‖p_i‖²: drag (α < 0) takes energy, and a thrust adds it where agents are slower than √(α/β).
    q, p, (q_r, _, _) = _state(m)
    u, energy, rate = _between_agents(q, p)
    for i in range(_N):
        factor = THRUST - BRAKE * p[i].dot(p[i])
        u[i] += factor * p[i]
        energy += p[i].dot(p[i]) / 2
        rate += factor * p[i].dot(p[i])
        if i < informed:
            u[i] -= PULL * (q[i] - q_r) + MATCH * p[i]
            energy += PULL * (q[i] - q_r).dot(q[i] - q_r) / 2
            rate -= MATCH * p[i].dot(p[i])
    return energy_balance("Energy in the given frame", energy, rate, q, p, u)


def moving_frame_identity(m: int = 2) -> Derivation:
    """Derive dH/dt in the moving frame, for a γ-agent on any path that pulls all, with feedforward and drag."""
    # H = Σ ψ + c_1/2 Σ‖x_i‖² + ½ Σ‖v_i‖² changes at −c vᵀLv − c_2 Σ‖v_i‖² + α Σ‖v_i‖², whatever the γ-agent does: what
    # acts on all alike does no work there.
    q, p, (q_r, p_r, a_r) = _state(m)
    u, energy, rate = _between_agents(q, p)
    centre, drift = (sum(x[1:], x[0]) / _N for x in (q, p))
    for i in range(_N):
        x, v = q[i] - centre, p[i] - drift
        u[i] += THRUST * p[i] + a_r - PULL * (q[i] - q_r) - MATCH * (p[i] - p_r)
        energy += PULL * x.dot(x) / 2 + v.dot(v) / 2
        rate += (THRUST - MATCH) * v.dot(v)
    return energy_balance("Energy in the moving frame", energy, rate, q, p, u)
