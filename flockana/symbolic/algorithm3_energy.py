"""dH/dt of Algorithm 3 (Olfati-Saber 2006, Theorem 6), and erratum E2: V_alpha counts every pair once.

As for Algorithms 1 and 2, H and the u_i are sums: over pairs, over agents with the gamma-agent, and over agents with
obstacles. One generic term of each kind gives dH/dt for every n and any number of obstacles.
"""

from collections.abc import Iterable
from dataclasses import replace

import sympy as sp

from flockana.symbolic.derivation import Step
from flockana.symbolic.energy import EnergyIdentity, GenericPair
from flockana.symbolic.errata import RisingEnergy, with_pair_law
from flockana.symbolic.generic_pair import along_flow, vector
from flockana.symbolic.obstacles import KINDS, PSI_BETA, WEIGHT, GenericObstacle
from flockana.symbolic.parameter_symbols import GAINS, AlphaSymbols, GainSymbols
from flockana.symbolic.scalar_functions import HALF
from flockana.symbolic.sigma_norms import sigma_1, sigma_norm
from flockana.symbolic.sums_over_pairs import (
    I_,
    K_,
    N,
    P,
    Q,
    collective_potential,
    half_square,
    indexed,
    over_agents,
    sum_over,
)

COUNT = sp.Symbol("l", integer=True, nonnegative=True)  # of obstacles
CLEARANCE = sp.IndexedBase("zhat", nonnegative=True)  # sigma-norm of q_hat_ik - q_i
BRAKING = sp.IndexedBase("B", real=True)  # <p_i, p_hat_ik - p_i>
_ONE = sp.Integer(1)


def _over_obstacles(summand: sp.Expr) -> sp.Expr:
    """Return the sum of an expression over all agents and obstacles."""
    return sum_over(summand, (K_, 1, COUNT), (I_, 1, N))


def gamma_force(
    q_i: sp.Matrix, p_i: sp.Matrix, q_r: sp.Matrix, p_r: sp.Matrix, *, gains: GainSymbols = GAINS
) -> sp.Matrix:
    """Return the navigational feedback of Algorithm 3: -c1_gamma sigma_1(q_i - q_r) - c2_gamma (p_i - p_r)."""
    return -gains.c1_gamma * sigma_1(q_i - q_r) - gains.c2_gamma * (p_i - p_r)


def _agent_rates(m: int, gains: GainSymbols, moving: bool) -> tuple[sp.Expr, sp.Expr]:
    """Return the terms of dH/dt from one agent and the gamma-agent, as derived and as claimed."""
    q_i, p_i, q_r, p_r, speed = (vector(name, m) for name in ("q_i", "p_i", "q_r", "p_r", "s"))  # s: the true dq_r/dt
    energy = gains.c1_gamma * sigma_norm(q_i - q_r, eps=_ONE) + HALF * p_i.dot(p_i)
    force = gamma_force(q_i, p_i, q_r, p_r, gains=gains)
    rate = along_flow(energy, [*q_i, *q_r], [*p_i, *speed], [*force, *sp.zeros(m, 1)])
    stated_rate = -gains.c2_gamma * p_i.dot(p_i - p_r) - gains.c1_gamma * sigma_1(q_i - q_r).dot(speed)
    names = indexed((Q, q_i), (P, p_i)) | ({} if moving else dict.fromkeys(speed, sp.S.Zero))
    return sp.expand(rate).xreplace(names), sp.expand(stated_rate).xreplace(names)


def theorem6_identity(
    m: int = 2,
    *,
    gains: GainSymbols = GAINS,
    kinds: Iterable[str] = KINDS,
    moving: bool = False,
    copies: sp.Expr = _ONE,
) -> EnergyIdentity:
    """Derive dH/dt along Algorithm 3: consensus, damping at obstacles, drag towards p_r (Olfati-Saber, Theorem 6)."""
    pair = GenericPair(m)
    total = pair.tidy(sp.Add(*pair.energy_rates(gains, copies=copies)))
    dissipation = -gains.c2_alpha * pair.laplacian_form()
    own_rate, own_claimed = _agent_rates(m, gains, moving)
    left = sp.Add(*(GenericObstacle(kind, m).energy_residual(gains) for kind in kinds))
    braking_power = gains.c2_beta * _over_obstacles(WEIGHT(CLEARANCE[I_, K_]) * BRAKING[I_, K_])
    rate = pair.lift(total) + over_agents(own_rate) + braking_power + _over_obstacles(left)
    stated_rate = pair.lift(dissipation) + over_agents(own_claimed) + braking_power
    residual = pair.lift(pair.tidy(total - dissipation)) + over_agents(sp.expand(own_rate - own_claimed))
    pull = sigma_norm(sp.Matrix([Q[I_, k] for k in range(1, m + 1)]) - vector("q_r", m), eps=_ONE)
    energy = (
        copies * collective_potential(gains)
        + gains.c1_beta * _over_obstacles(PSI_BETA(CLEARANCE[I_, K_]))
        + gains.c1_gamma * over_agents(pull)
        + half_square(P, m)
    )
    steps = (
        Step("The energy, every pair once:", energy),
        Step("One generic pair contributes", total),
        Step(
            r"One obstacle and one agent: $\nabla\psi_\beta = -\phi_\beta \hat n$ without any derivative of $\hat q$, "
            r"so the forces cancel, and $c_2^\beta b \langle p_i, \hat p - p_i\rangle$ remains. Left over:",
            left,
        ),
        Step("One agent and the gamma-agent contribute", own_rate),
        Step(r"Together $\dot H$ is", rate),
        Step("and the closed form is", stated_rate),
    )
    return EnergyIdentity("Algorithm 3: energy", energy, rate, stated_rate, residual + _over_obstacles(left), steps)


def condition_76_residual(m: int = 2) -> sp.Expr:
    """Return sum <p_i, p_i - p_d> - (2 T - n <p_c, p_d>), which is 0: condition (76) is the sign of the drag."""
    axes = range(1, m + 1)
    p_d = vector("p_d", m)
    drag = over_agents(sp.Add(*(P[I_, k] ** 2 - P[I_, k] * p_d[k - 1] for k in axes)))
    kinetic = HALF * sp.Add(*(over_agents(P[I_, k] ** 2) for k in axes))
    centre = [over_agents(P[I_, k]) / N for k in axes]
    return sp.expand(drag - (2 * kinetic - N * sp.Add(*(c * p for c, p in zip(centre, p_d, strict=True)))))


def e2_identity(m: int = 2) -> EnergyIdentity:
    """Derive dH/dt of the printed H, which counts every pair twice and keeps an indefinite dV_alpha/dt."""
    identity = theorem6_identity(m, copies=sp.Integer(2))
    left = Step(r"The difference is $\dot V_\alpha$ with every pair once, which has no sign:", identity.residual)
    name = r"E2: the printed $V_\alpha = \sum_i \sum_{j \neq i} \psi_\alpha$"
    return replace(identity, name=name, steps=(*identity.steps, left))


def e2_counterexample() -> RisingEnergy:
    """Return two close approaching agents on a line, for which the printed H of Algorithm 3 rises."""
    # The gamma-agent rests at the origin; no obstacle is near.
    alpha = AlphaSymbols(eps=0.1, h=0.2, a=5, b=5, d=7, r=8.4)
    gains = GainSymbols(c1_alpha=1, c2_alpha=1, c1_gamma=1, c2_gamma=1, c1_beta=1, c2_beta=1)
    q, p = (sp.Integer(0), sp.Integer(2)), (sp.Integer(0), -sp.Rational(1, 5))
    pair = GenericPair(1)
    state = {s[0]: x for ends, part in ((pair.q, q), (pair.p, p)) for s, x in zip(ends, part, strict=True)}
    state |= {pair.z: sigma_norm(q[1] - q[0], eps=alpha.eps), sp.Symbol("epsilon", positive=True): alpha.eps}
    drag = -gains.c2_gamma * sp.Add(*(speed**2 for speed in p))  # the gamma-agent's pull and potential cancel

    def rate(copies: int) -> sp.Expr:
        total = pair.tidy(sp.Add(*pair.energy_rates(gains, copies=sp.Integer(copies))))
        return with_pair_law(total.subs(state), alpha) + drag

    return RisingEnergy(alpha, gains, q, p, rate(2), rate(1))
