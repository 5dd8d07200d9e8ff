"""Energy balance of velocity consensus with any weight of the distance and any pair potential."""

from itertools import combinations

import sympy as sp

from flockana.base.checks import ensure_dimension
from flockana.symbolic.derivation import Derivation
from flockana.symbolic.led_dead_zone import HALF_PULL, OF_SQUARE
from flockana.symbolic.pair import energy_balance, vector

WEIGHT = sp.Function("a", nonnegative=True)  # of the squared distance


def matching_identity(m: int = 2, *, potential: bool = True) -> Derivation:
    """Derive dH/dt of three agents that match velocities, which gives the identity in pairs for every n."""
    # H = sum |p_i - p|^2/2 + sum psi(rho_ij^2), p the mean velocity; its rate is -sum a(rho_ij^2) |p_j - p_i|^2.
    ensure_dimension(m)
    q, p = ([vector(f"{name}_{i}", m) for i in range(3)] for name in "qp")
    mean = (p[0] + p[1] + p[2]) / 3
    u, energy, lost = [sp.zeros(m, 1) for _ in q], sp.S.Zero, sp.S.Zero
    for i, j in combinations(range(3), 2):
        delta, slip = q[j] - q[i], p[j] - p[i]
        square = delta.dot(delta)
        push = WEIGHT(square) * slip
        if potential:
            energy += OF_SQUARE(square)
            push += 2 * HALF_PULL(square) * delta
        u[i], u[j] = u[i] + push, u[j] - push
        lost -= WEIGHT(square) * slip.dot(slip)
    energy += sum((v - mean).dot(v - mean) for v in p) / 2
    of = "The energy in the frame of the centre of mass,"
    return energy_balance("Energy of agents that match velocities", energy, lost, q, p, u, of=of)
