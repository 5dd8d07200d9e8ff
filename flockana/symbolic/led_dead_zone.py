"""The dead-zone law with leaders in sympy: its energy in their frames, written out for a small flock."""

from itertools import combinations

import sympy as sp
from sympy.core.function import UndefinedFunction

from flockana.base.checks import ensure_dimension
from flockana.symbolic.dead_zone import K_2
from flockana.symbolic.derivation import Derivation
from flockana.symbolic.pair import energy_balance, vector

C_1, C_2 = sp.symbols("c_1 c_2", nonnegative=True)
HALF_PULL = sp.Function("W", real=True)  # F(rho)/2rho as a function of rho^2: no roots: residuals are polynomials
OF_SQUARE = UndefinedFunction("psi", real=True, __dict__={"fdiff": lambda self, argindex=1: HALF_PULL(self.args[0])})
GROUP, PINNED = (0, 0, 1), (0,)  # three agents: two of one leader, the first of them pinned, and one of another


def led_energy_identity(m: int = 2, *, feedforward: bool = True) -> Derivation:
    """Derive dH/dt of three agents and two leaders, with all kinds of pairs, pinned and not."""
    # H = sum |p_i - p_l|^2/2 + sum psi(rho_ij^2) + c_1/2 sum of the pinned |q_i - q_l|^2; its rate has -k_2 p^T L p
    # within groups, -c_2 |p_i - p_l|^2 of the pinned, and what agents of different leaders exchange, -sum f_i . p_l.
    ensure_dimension(m)
    q, p = ([vector(f"{name}_{i}", m) for i in range(3)] for name in "qp")
    leaders = [[vector(f"{name}_{number}", m) for number in "gh"] for name in ("q", "p", "a")]
    q_l, p_l, a_l = ([each[number] for number in GROUP] for each in leaders)
    slip = [own - led for own, led in zip(p, p_l, strict=True)]
    pairs = [sp.zeros(m, 1) for _ in GROUP]
    energy, lost = sp.S.Zero, sp.S.Zero
    u = [sp.Matrix(a) if feedforward else sp.zeros(m, 1) for a in a_l]
    for i, j in combinations(range(3), 2):
        delta, weight = q[j] - q[i], sp.Symbol(f"a_{i}{j}", nonnegative=True)
        energy += OF_SQUARE(delta.dot(delta))
        force = 2 * HALF_PULL(delta.dot(delta)) * delta
        pairs[i], pairs[j] = pairs[i] + force, pairs[j] - force
        if GROUP[i] == GROUP[j]:
            match = K_2 * weight * (p[j] - p[i])
            u[i], u[j] = u[i] + match, u[j] - match
            lost -= K_2 * weight * (p[j] - p[i]).dot(p[j] - p[i])
    for i in range(3):
        u[i] += pairs[i]
        energy += slip[i].dot(slip[i]) / 2
        lost -= pairs[i].dot(p_l[i]) + (0 if feedforward else slip[i].dot(a_l[i]))
        if i in PINNED:
            u[i] -= C_1 * (q[i] - q_l[i]) + C_2 * slip[i]
            energy += C_1 * (q[i] - q_l[i]).dot(q[i] - q_l[i]) / 2
            lost -= C_2 * slip[i].dot(slip[i])
    flow = [*q, *leaders[0]], [*p, *leaders[1]], [*u, *leaders[2]]
    title = "Energy of the dead-zone law with leaders"
    return energy_balance(title, energy, lost, *flow, of="The energy in the frames of the leaders,")
