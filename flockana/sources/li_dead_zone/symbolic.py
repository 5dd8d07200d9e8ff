"""The dead-zone pair law of Li, Yuan and Liu in sympy: force, potential in closed form, jumps, saturated energy."""

import sympy as sp

from flockana.base.value_checks import ensure_dimension
from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.generic_pair import along_flow, vector, with_derivative

RHO = sp.Symbol("rho", positive=True)
ETA, ETA_POSITIVE = sp.Symbol("eta", nonnegative=True), sp.Symbol("eta", positive=True)
K_R, K_DELTA, K_1, K_2 = sp.symbols("k_r k_delta k_1 k_2", nonnegative=True)
D_1, D_2, R, R_D = sp.symbols("d_1 d_2 r r_d", positive=True)

FORCE = sp.Function("F", real=True)
PSI = with_derivative("psi", FORCE)


def repulsion(rho: sp.Expr = RHO) -> sp.Expr:
    """Return the repulsion below d_1, 2k_r/rho^2 + k_delta."""
    return 2 * K_R / rho**2 + K_DELTA


def attraction(rho: sp.Expr = RHO) -> sp.Expr:
    """Return the attraction between d_2 and r, 2k_r/(r_d - rho)^2 + k_delta."""
    return 2 * K_R / (R_D - rho) ** 2 + K_DELTA


def direction(rho: sp.Expr = RHO, eta: sp.Expr = ETA) -> sp.Expr:
    """Return the length of n_ij, rho/sqrt(1 + eta rho^2), by eq. (8); not a unit vector."""
    return rho / sp.sqrt(1 + eta * rho**2)


def _pieces(rho: sp.Expr, beyond: sp.Expr, near: sp.Expr, between: sp.Expr, far: sp.Expr) -> sp.Expr:
    return sp.Piecewise((beyond, rho >= R), (near, rho < D_1), (between, rho <= D_2), (far, True))


def action(rho: sp.Expr = RHO, *, ramp: sp.Expr = sp.S.Zero) -> sp.Expr:
    """Return the scalar force f(rho): < 0 where repulsive, 0 on [d_1, d_2] and from r on."""
    inner, outer = (sp.S.One,) * 2 if ramp == 0 else (sp.Min(1, (D_1 - rho) / ramp), sp.Min(1, (rho - D_2) / ramp))
    return _pieces(rho, sp.S.Zero, -inner * repulsion(rho), sp.S.Zero, outer * attraction(rho))


def force(rho: sp.Expr = RHO, *, ramp: sp.Expr = sp.S.Zero) -> sp.Expr:
    """Return the pair force F(rho) = f rho/sqrt(1 + eta rho^2) + k_1 rho within r, 0 beyond."""
    return action(rho, ramp=ramp) * direction(rho) + sp.Piecewise((K_1 * rho, rho < R), (sp.S.Zero, True))


def repulsive_primitive(s: sp.Expr = RHO, *, eta: sp.Expr = ETA_POSITIVE) -> sp.Expr:
    """Return the antiderivative P_r of (2k_r/s^2 + k_delta) s/sqrt(1 + eta s^2), for eta > 0 or eta = 0."""
    if eta == 0:
        return 2 * K_R * sp.log(s) + K_DELTA * s**2 / 2
    return -2 * K_R * sp.asinh(1 / (sp.sqrt(eta) * s)) + K_DELTA * sp.sqrt(1 + eta * s**2) / eta


def attractive_primitive(s: sp.Expr = RHO, *, eta: sp.Expr = ETA_POSITIVE) -> sp.Expr:
    """Return the antiderivative P_a of (2k_r/(r_d - s)^2 + k_delta) s/sqrt(1 + eta s^2), for eta >= 0."""
    if eta == 0:
        return 2 * K_R * (R_D / (R_D - s) + sp.log(R_D - s)) + K_DELTA * s**2 / 2
    big, root = 1 + eta * R_D**2, sp.sqrt(1 + eta * s**2)
    logarithm = sp.log((1 + eta * R_D * s + sp.sqrt(big) * root) / (R_D - s)) / big ** sp.Rational(3, 2)
    return 2 * K_R * (root * R_D / (big * (R_D - s)) - logarithm) + K_DELTA * root / eta


def potential(rho: sp.Expr = RHO, *, eta: sp.Expr = ETA_POSITIVE) -> sp.Expr:
    """Return the saturated potential of a pair without ramp, psi(min(rho, r)), for d_2 < r."""

    def far(s: sp.Expr) -> sp.Expr:
        return attractive_primitive(s, eta=eta) - attractive_primitive(D_2, eta=eta) + K_1 * s**2 / 2

    pull, inner_potential = K_1 * rho**2 / 2, repulsive_primitive(D_1, eta=eta) - repulsive_primitive(rho, eta=eta)
    return _pieces(rho, far(R), inner_potential + pull, pull, far(rho))


def derive_potential() -> Derivation:
    """Derive psi: the derivative identities of both primitives, for eta > 0 and eta = 0, and its growth at 0."""
    s = sp.Symbol("s", positive=True)
    gap = sp.Symbol("g", positive=True)  # r_d = s + g keeps every root and logarithm real
    steps, residuals = [], []
    for eta in (ETA_POSITIVE, sp.Integer(0)):
        case = sp.Gt(eta, 0) if eta != 0 else sp.Eq(ETA, 0)
        for name, primitive, strength in (
            ("repulsion", repulsive_primitive(s, eta=eta), repulsion(s)),
            ("attraction", attractive_primitive(s, eta=eta), attraction(s)),
        ):
            steps.append(Step(f"Primitive of the {name}:", primitive, case))
            left = sp.diff(primitive, s) - strength * direction(s, eta)
            residuals.append(sp.simplify(left.subs(R_D, s + gap)))
    growth = sp.limit(repulsive_primitive(s).subs({K_R: 1, K_DELTA: 0}) / (2 * sp.log(s)), s, 0, "+")
    steps.append(Step(r"At 0 it grows as $-2k_r \ln\rho$ only: $P_r/(2 k_r \ln s)$ tends to", growth))
    residuals.append(growth - 1)
    return Derivation("Potential of the dead-zone force", tuple(steps), potential(), tuple(residuals))


def jumps() -> dict[str, tuple[sp.Expr, sp.Expr]]:
    """Return the pair force F just below and just above d_1, d_2 and r, without ramp, for d_2 < r."""
    inner_force, outer_force = repulsion() * direction(), attraction() * direction()
    pull = K_1 * RHO
    return {
        "d1": ((pull - inner_force).subs(RHO, D_1), pull.subs(RHO, D_1)),
        "d2": (pull.subs(RHO, D_2), (pull + outer_force).subs(RHO, D_2)),
        "r": ((pull + outer_force).subs(RHO, R), sp.S.Zero),
    }


def saturated_energy_identity(m: int = 2) -> Derivation:
    """Derive dH/dt = -k_2 p^T L p from one generic pair: psi' = F within r, and psi constant with F = a = 0 beyond."""
    q_i, q_j, p_i, p_j = (vector(name, ensure_dimension(m)) for name in ("q_i", "q_j", "p_i", "p_j"))
    delta, slip = q_j - q_i, p_j - p_i
    rho = sp.sqrt(delta.dot(delta))
    weight = sp.Symbol("a_ij", nonnegative=True)
    on_i = FORCE(rho) * delta / rho + K_2 * weight * slip
    energy = PSI(rho) + (p_i.dot(p_i) + p_j.dot(p_j)) / 2
    rate = along_flow(energy, [*q_i, *q_j], [*p_i, *p_j], [*on_i, *(-on_i)])
    stated_rate = -K_2 * weight * slip.dot(slip)
    steps = (
        Step("The energy of one pair,", energy),
        Step(r"changes, with $d\psi/d\rho = F$ and opposite forces on the two, at", stated_rate),
    )
    apart = {q_j[0]: q_i[0] + sp.Symbol("x", real=True, nonzero=True)}  # two agents differ along some axis: the first
    left = sp.simplify((rate - stated_rate).subs(apart))
    return Derivation("Saturated energy of the dead-zone law", steps, stated_rate, (left,))
