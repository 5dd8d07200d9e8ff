"""Gradients of the potentials as CasADi functions, generated from the definitions in `flockana.symbolic`.

ψ_α and ψ_β have no closed form on their tapers, but their derivatives φ_α and φ_β have: the gradients here are exact,
and so are the Hessians that CasADi derives from them.
"""

from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np
import sympy as sp

from flockana.base.errors import ArgumentError
from flockana.environment.obstacles import Obstacle, Sphere, Wall
from flockana.equilibria.translate import to_casadi
from flockana.interactions import AlphaInteraction, BetaInteraction, DeadZoneInteraction, PairInteraction
from flockana.laws.terms.navigation import Navigation
from flockana.laws.terms.obstacles import ObstacleTerm
from flockana.laws.terms.term import Term
from flockana.symbolic import dead_zone as dead
from flockana.symbolic.functions import phi_alpha, phi_beta
from flockana.symbolic.norms import EPS, sigma_1, sigma_norm
from flockana.symbolic.obstacles import PHI_BETA, PSI_BETA, sphere_beta, wall_beta
from flockana.symbolic.pair import PHI, pair_potential, vector
from flockana.symbolic.parameters import AlphaSymbols, BetaSymbols, GainSymbols


def _compile(name: str, gradient: list[Any], symbols: Any, values: dict[Any, float] | None = None) -> ca.Function:
    """Return name(x) -> (gradient, Hessian), the Hessian by CasADi's differentiation."""
    x = ca.SX.sym("x", len(symbols))
    table = {symbol: x[k] for k, symbol in enumerate(symbols)} | (values or {})
    slope = ca.vertcat(*(to_casadi(component, table) for component in gradient))
    hessian = ca.densify(ca.jacobian(slope, x))
    return ca.Function(name, [x], [slope, hessian], ["x"], ["gradient", "hessian"])


@lru_cache(maxsize=64)
def pair_term(pair: PairInteraction, m: int) -> ca.Function:
    """Return gradient (m,) and Hessian (m, m) of the pair's potential in Δ = q_j − q_i."""
    delta = vector("Delta_", m)
    if isinstance(pair, DeadZoneInteraction):
        return _compile("pair", list(dead_zone_gradient(delta, pair)), delta)
    if not isinstance(pair, AlphaInteraction):
        raise ArgumentError(f"{pair}: expected AlphaInteraction or DeadZoneInteraction; no other has a symbolic form")
    parameters = AlphaSymbols(**{name: getattr(pair, name) for name in ("eps", "h", "a", "b", "d", "r", "unit")})
    potential = pair_potential(sp.zeros(m, 1), delta, gains=GainSymbols(c1_alpha=1)).subs(EPS, parameters.eps)
    gradient = [sp.diff(potential, x).replace(PHI, lambda z: phi_alpha(z, alpha=parameters)) for x in delta]
    return _compile("pair", gradient, delta)


def dead_zone_gradient(delta: sp.Matrix, pair: DeadZoneInteraction) -> sp.Matrix:
    """Return F(‖Δ‖) Δ/‖Δ‖ with a pair law's numbers inserted."""
    names = {"d_1": "d1", "d_2": "d2", "r": "r", "r_d": "r_d", "k_r": "k_r", "k_delta": "k_delta"}
    names |= {"k_1": "k1", "eta": "eta"}
    rho = sp.sqrt(delta.dot(delta))
    weight = dead.force(dead.RHO, ramp=sp.Float(pair.ramp)) / dead.RHO
    numbers = {s: getattr(pair, names[s.name]) for s in weight.free_symbols if s.name in names}
    return weight.subs(numbers).subs(dead.RHO, rho) * delta


def has_form(pair: PairInteraction, others: Iterable[Term]) -> bool:
    """Return whether gradient and Hessian of a potential can be generated from a formula."""
    known = isinstance(pair, AlphaInteraction | DeadZoneInteraction)
    return known and all(isinstance(term, Navigation | ObstacleTerm) for term in others)


def own_derivatives(term: Term, t: float, q: Any) -> Iterator[tuple[Any, Any]]:
    """Return gradient (m, n) and Hessian blocks (m, m n) of a term of single agents, piece by piece."""
    m, n = q.shape
    if isinstance(term, ObstacleTerm):
        for obstacle in term.field.obstacles:
            slope, blocks = obstacle_term(obstacle, term.field.beta).map(n)(q)
            yield term.stiffness * slope, term.stiffness * blocks
    elif isinstance(term, Navigation):
        gains = np.broadcast_to(np.ravel(term.gains.pull), n)
        if term.moving:  # J about the centre that the gauge holds: the same value, a diagonal Hessian
            x = q - ca.repmat(ca.sum2(q) / n, 1, n)
        else:
            x = q - ca.repmat(ca.DM(np.asarray(term.target.state(t)[0], dtype=float)), 1, n)
        slope, blocks = (x, ca.repmat(ca.MX.eye(m), 1, n)) if term.unit is None else pull_term(m, term.unit).map(n)(x)
        by_agent = ca.DM(np.tile(gains, (m, 1)))
        yield by_agent * slope, ca.DM(np.tile(np.repeat(gains, m), (m, 1))) * blocks


@lru_cache(maxsize=64)
def pull_term(m: int, unit: float = 1.0) -> ca.Function:
    """Return gradient and Hessian of ℓ²(√(1 + ‖x‖²/ℓ²) − 1), Algorithm 3's pull to the γ-agent, in x = q_i − q_r."""
    x = vector("x", m)
    return _compile("pull", list(unit * sigma_1(x / unit)), x)


@lru_cache(maxsize=256)
def obstacle_term(obstacle: Obstacle, beta: BetaInteraction) -> ca.Function:
    """Return gradient and Hessian of ψ_β(‖q̂ − q‖_σ) of one obstacle in the agent's position q."""
    m = obstacle.dimension
    q = vector("q", m)
    parameters = BetaSymbols(eps=beta.eps, h=beta.h, d=beta.d, unit=beta.unit)
    at_rest, (centre, other) = sp.zeros(m, 1), (vector("y", m), vector("a", m))
    if isinstance(obstacle, Wall):
        foot = wall_beta(q, at_rest, centre, other)[0]
        values = dict(zip((*centre, *other), obstacle.par.tolist(), strict=True))
    elif isinstance(obstacle, Sphere):
        radius = sp.Symbol("R", positive=True)
        foot = sphere_beta(q, at_rest, centre, radius)[0]
        values = dict(zip((*centre, radius), obstacle.par.tolist(), strict=True))
    else:
        raise ArgumentError(f"{obstacle}: expected spheres and walls; equilibria at other obstacles are not supported")
    potential = PSI_BETA(sigma_norm(foot - q)).subs(EPS, parameters.eps)
    gradient = [sp.diff(potential, x).replace(PHI_BETA, lambda z: phi_beta(z, beta=parameters)) for x in q]
    return _compile("obstacle", gradient, q, values)
