"""Energy balances of laws written out for three agents: composed laws, velocity consensus, leaders, copies.

Three agents show every kind of pair, and a pull on one, two or all of them, so the identities are those of every n.
"""

from collections.abc import Callable
from itertools import combinations

import sympy as sp

from flockana.base.value_checks import ensure_dimension
from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.generic_pair import energy_balance, vector, with_derivative

K_2 = sp.Symbol("k_2", nonnegative=True)  # of velocity consensus
THRUST, BRAKE, DAMPING = sp.symbols("alpha beta c", real=True)
PULL, MATCH = sp.symbols("c_1 c_2", nonnegative=True)
WEIGHT = sp.Function("a", nonnegative=True)  # of the squared distance
_N = 3
T = sp.Symbol("t", real=True)
K1, K2, STIFFNESS, DRAG = sp.symbols("k_1 k_2 k b", real=True)  # of copies of a γ-agent with dynamics
_GROUP, _PINNED = (0, 0, 1), (0,)  # two agents of one leader, the first of them pinned, and one of another
_HALF_PULL = sp.Function("W", real=True)  # F(rho)/2rho as a function of rho^2: no roots, so residuals are polynomials
_OF_SQUARE = with_derivative("psi", _HALF_PULL)


def _state(m: int) -> tuple[list[sp.Matrix], list[sp.Matrix], tuple[sp.Matrix, sp.Matrix, sp.Matrix]]:
    q, p = ([vector(f"{name}_{i}", ensure_dimension(m)) for i in range(_N)] for name in ("q", "p"))
    return q, p, (vector("q_r", m), vector("p_r", m), vector("a_r", m))


def _weight(i: int, j: int) -> sp.Expr:
    return sp.Symbol(f"a_{i}{j}", nonnegative=True)


def _between_agents(
    q: list[sp.Matrix], p: list[sp.Matrix], weight: Callable[[int, int, sp.Expr], sp.Expr]
) -> tuple[list[sp.Matrix], list[sp.Matrix], sp.Expr, sp.Expr]:
    """Return potential forces, forces with consensus, potential and consensus power of three agents."""
    pulls, u, potential, power = [sp.zeros(*x.shape) for x in q], [sp.zeros(*x.shape) for x in q], sp.S.Zero, sp.S.Zero
    for i, j in combinations(range(_N), 2):
        displacement, velocity_difference = q[j] - q[i], p[j] - p[i]
        squared_value = displacement.dot(displacement)
        pull, own_weight = 2 * _HALF_PULL(squared_value) * displacement, weight(i, j, squared_value)
        for forces, force in ((pulls, pull), (u, pull + own_weight * velocity_difference)):
            forces[i], forces[j] = forces[i] + force, forces[j] - force
        potential += _OF_SQUARE(squared_value)
        power -= own_weight * velocity_difference.dot(velocity_difference)
    return pulls, u, potential, power


def given_frame_identity(m: int = 2, *, informed: int = 2) -> Derivation:
    """Derive dH/dt in the given frame, for a resting γ-agent that pulls some agents, and speed control."""
    # H = Σ ψ + c_1/2 Σ of the informed ‖q_i − q_r‖² + ½ Σ‖p_i‖² changes at −c pᵀLp − c_2 Σ of the informed ‖p_i‖² + Σ
    # (α − β‖p_i‖²)‖p_i‖²: drag (α < 0) takes energy, and a thrust adds it where agents are slower than √(α/β).
    q, p, (q_r, _, _) = _state(m)
    _, u, energy, rate = _between_agents(q, p, lambda i, j, _: DAMPING * _weight(i, j))
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
    """Derive dH/dt in the moving frame, for a γ-agent on any path, with feedforward and drag."""
    # H = Σ ψ + c_1/2 Σ‖x_i‖² + ½ Σ‖v_i‖² changes at −c vᵀLv − c_2 Σ‖v_i‖² + α Σ‖v_i‖², whatever the γ-agent does: what
    # acts on all alike does no work there.
    q, p, (q_r, p_r, a_r) = _state(m)
    _, u, energy, rate = _between_agents(q, p, lambda i, j, _: DAMPING * _weight(i, j))
    centre, drift = (sum(x[1:], x[0]) / _N for x in (q, p))
    for i in range(_N):
        x, v = q[i] - centre, p[i] - drift
        u[i] += THRUST * p[i] + a_r - PULL * (q[i] - q_r) - MATCH * (p[i] - p_r)
        energy += PULL * x.dot(x) / 2 + v.dot(v) / 2
        rate += (THRUST - MATCH) * v.dot(v)
    return energy_balance("Energy in the moving frame", energy, rate, q, p, u)


def matching_identity(m: int = 2, *, potential: bool = True) -> Derivation:
    """Derive dH/dt of three agents with velocity matching, from which the pair identity follows for every n."""
    # H = sum |p_i - p|^2/2 + sum psi(rho_ij^2), p the mean velocity; its rate is -sum a(rho_ij^2) |p_j - p_i|^2.
    q, p, _ = _state(m)
    mean = (p[0] + p[1] + p[2]) / _N
    pulls, u, energy, dissipated_power = _between_agents(q, p, lambda i, j, square: WEIGHT(square))
    if not potential:
        u, energy = [a - b for a, b in zip(u, pulls, strict=True)], sp.S.Zero
    energy += sum((v - mean).dot(v - mean) for v in p) / 2
    subject_text = "The energy in the frame of the centre of mass,"
    return energy_balance("Energy of agents that match velocities", energy, dissipated_power, q, p, u, of=subject_text)


def led_energy_identity(m: int = 2, *, feedforward: bool = True) -> Derivation:
    """Derive dH/dt of three agents and two leaders, with all kinds of pairs, pinned and not."""
    # H = sum |p_i - p_l|^2/2 + sum psi(rho_ij^2) + c_1/2 sum of the pinned |q_i - q_l|^2; its rate has -k_2 p^T L p
    # within groups, -c_2 |p_i - p_l|^2 of the pinned, and what agents of different leaders exchange, -sum f_i . p_l.
    q, p, _ = _state(m)
    leaders = [[vector(f"{name}_{number}", m) for number in "gh"] for name in ("q", "p", "a")]
    q_l, p_l, a_l = ([leader[number] for number in _GROUP] for leader in leaders)
    velocity_difference = [own_velocity - leader_velocity for own_velocity, leader_velocity in zip(p, p_l, strict=True)]
    same_group = [[int(a == b) for b in _GROUP] for a in _GROUP]
    pairs, u, energy, power = _between_agents(q, p, lambda i, j, _: K_2 * same_group[i][j] * _weight(i, j))
    for i in range(_N):
        u[i] += int(feedforward) * a_l[i]
        energy += velocity_difference[i].dot(velocity_difference[i]) / 2
        power -= pairs[i].dot(p_l[i]) + (0 if feedforward else velocity_difference[i].dot(a_l[i]))
        if i in _PINNED:
            u[i] -= PULL * (q[i] - q_l[i]) + MATCH * velocity_difference[i]
            energy += PULL * (q[i] - q_l[i]).dot(q[i] - q_l[i]) / 2
            power -= MATCH * velocity_difference[i].dot(velocity_difference[i])
    flow = [*q, *leaders[0]], [*p, *leaders[1]], [*u, *leaders[2]]
    title = "Energy of the dead-zone law with leaders"
    return energy_balance(title, energy, power, *flow, of="The energy in the frames of the leaders,")


def copies_balance() -> Derivation:
    """Derive the terms of dH/dt due to the pull of an agent to its own copy of the γ-agent.

    f is all else; what it does, p f, is counted where its energy is.
    """
    q, position, other_term = (sp.Function(name)(T) for name in ("q", "q_r", "f"))
    p, rate = q.diff(T), position.diff(T)
    acceleration = other_term - PULL * (q - position) - MATCH * (p - rate)
    energy = PULL * (q - position) ** 2 / 2 + p**2 / 2
    along = energy.diff(T).subs(q.diff(T, 2), acceleration) - p * other_term
    stated_form = -MATCH * p * (p - rate) - PULL * (q - position) * rate
    steps = (
        Step("Energy of one agent and its copy, a component of each:", energy),
        Step("Its rate along the law, without the power of all else:", sp.expand(along)),
    )
    return Derivation("Balance of an agent and its copy", steps, stated_form, (sp.expand(along - stated_form),))


def copies_part() -> Derivation:
    """Derive the equation for the distance of one copy of a γ-agent from the mean of all copies."""
    copies = [sp.Function(f"q_{i}")(T) for i in range(3)]
    mean = sum(copies) / 3
    pulls = (K1 * (mean - q) + K2 * (mean - q).diff(T) for q in copies)
    pulled = {q.diff(T, 2): -STIFFNESS * q - DRAG * q.diff(T) + pull for q, pull in zip(copies, pulls, strict=True)}
    away = copies[0] - mean
    left = away.diff(T, 2).subs(pulled)
    right = -(STIFFNESS + K1) * away - (DRAG + K2) * away.diff(T)
    d = sp.Function("d")(T)
    result = sp.Eq(d.diff(T, 2), (-DRAG - K2) * d.diff(T) + (-STIFFNESS - K1) * d)
    steps = (Step("Of a copy less the mean:", result),)
    return Derivation("How copies part", steps, result, (sp.expand((left - right).doit()),))
