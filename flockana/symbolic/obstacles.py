"""β-agents at walls and spheres: gradient of their potential, and sign of their power.

The normal of a wall is any nonzero vector here, the centre and radius of a sphere are symbols; agents sit at
q = y + x, with y a point of the wall or the centre. What is computed is rational in x and, at a sphere, |x|.
"""

from dataclasses import dataclass

import sympy as sp

from flockana.base.value_checks import ensure_dimension, ensure_known
from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.generic_pair import along_flow, vector, with_derivative
from flockana.symbolic.parameter_symbols import GAINS, GainSymbols
from flockana.symbolic.scalar_functions import HALF
from flockana.symbolic.sigma_norms import EPS, sigma_norm, sigma_norm_gradient

KINDS = ("wall", "sphere")
RADIUS = sp.Symbol("R", positive=True)
NORMAL_SPEED = sp.Symbol("w", real=True)  # <a, p>
TANGENT_SQUARE = sp.Symbol("T", nonnegative=True)  # |P p|^2
DEPTH = sp.Symbol("tau", positive=True)
PHI_BETA = sp.Function("phi_beta", real=True)
WEIGHT = sp.Function("b", real=True)
PSI_BETA = with_derivative("psi_beta", PHI_BETA)


def wall_beta(q: sp.Matrix, p: sp.Matrix, point: sp.Matrix, normal: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
    """Return (q_hat, p_hat) = (P q + (I - P) y, P p), the beta-agent on a wall (Olfati-Saber 2006)."""
    projection = sp.eye(len(q)) - normal * normal.T / normal.dot(normal)
    return projection * q + (sp.eye(len(q)) - projection) * point, projection * p


def sphere_beta(q: sp.Matrix, p: sp.Matrix, centre: sp.Matrix, radius: sp.Expr) -> tuple[sp.Matrix, sp.Matrix]:
    """Return (q_hat, p_hat) = (mu q + (1 - mu) y, mu P p), the beta-agent on a sphere (Olfati-Saber 2006)."""
    x = q - centre
    mu = radius / sp.sqrt(x.dot(x))
    projection = sp.eye(len(q)) - x * x.T / x.dot(x)
    return mu * q + (1 - mu) * centre, mu * projection * p


class GenericObstacle:
    """Generic agent and obstacle of one kind (wall or sphere), written by components."""

    distance = sp.Symbol("rho", positive=True)
    z = sp.Symbol("z_ik", nonnegative=True)

    def __init__(self, kind: str, m: int) -> None:
        ensure_known("kind of obstacle", kind, KINDS)
        self.kind, self.m = kind, ensure_dimension(m)
        self.x, self.p, y = (vector(name, m) for name in ("x", "p_i", "y"))
        q = y + self.x
        if kind == "wall":
            self.normal, self.mu = vector("n", m), sp.S.One
            beta = wall_beta(q, self.p, y, self.normal)
        else:
            self.normal, self.mu = self.x, RADIUS / sp.sqrt(self.x.dot(self.x))
            beta = sphere_beta(q, self.p, y, RADIUS)
        self.gap, self.rate = (beta[0] - q).applyfunc(sp.cancel), beta[1]
        self.derivative = beta[0].jacobian(self.x)  # of q_hat in q = y + x

    def reduce(self, expression: sp.Expr) -> sp.Expr:
        """Return an expression in normal form, with |x| named rho, so that identities reduce to 0."""
        square, first = self.x.dot(self.x), self.x[0]
        on_a_line = {sp.Abs(first): self.distance, sp.sign(first): first / self.distance}  # sqrt(x . x) if m = 1
        substituted = expression.xreplace(on_a_line if self.m == 1 else {square: self.distance**2})
        numerator, denominator = sp.fraction(sp.together(substituted))
        remainder = sp.rem(sp.expand(numerator), sp.expand(self.distance**2 - square), first)
        return sp.factor(remainder) / denominator if remainder != 0 else sp.S.Zero

    def braking(self) -> sp.Expr:
        """Return <p_i, p_hat - p_i> of an agent with velocity p_i and its β-agent, by components."""
        return self.p.dot(self.rate - self.p)

    def force(self, gains: GainSymbols = GAINS) -> sp.Matrix:
        """Return the obstacle's force on agent i: c1_beta phi_beta n_hat + c2_beta b (p_hat - p_i)."""
        z = sigma_norm(self.gap)
        attraction = gains.c1_beta * PHI_BETA(z) * sigma_norm_gradient(self.gap)
        return attraction + gains.c2_beta * WEIGHT(z) * (self.rate - self.p)

    def energy_residual(self, gains: GainSymbols = GAINS) -> sp.Expr:
        """Return the rate of c1_beta psi_beta + |p|^2/2 under `force`, less c2_beta b <p, p_hat - p>, reduced."""
        energy = gains.c1_beta * PSI_BETA(sigma_norm(self.gap)) + HALF * self.p.dot(self.p)
        rate = along_flow(energy, self.x, self.p, self.force(gains))
        stated_rate = gains.c2_beta * WEIGHT(sigma_norm(self.gap)) * self.braking()
        phi, b, root = sp.symbols("phi b root", positive=True)
        sigma = sigma_norm(self.gap)
        substituted = (rate - stated_rate).xreplace({sigma: self.z}).subs(1 + EPS * sigma, root)
        return self.reduce(substituted.xreplace({PHI_BETA(self.z): phi, WEIGHT(self.z): b}))


def derive_envelope(kind: str, m: int = 2) -> Derivation:
    """Derive that the gradient of psi_beta needs no derivative of q_hat, and that p_hat is the rate of q_hat."""
    # With D = dq_hat/dq the gradient of |q_hat - q|^2/2 is (D - I)^T (q_hat - q). The gap q_hat - q is normal to the
    # surface and D maps into its tangent space, so D^T (q_hat - q) = 0 and -(q_hat - q) is left. This holds inside the
    # obstacle too, except at a sphere's centre, where q_hat does not exist.
    generic = GenericObstacle(kind, m)
    gap, jacobian = generic.gap, generic.derivative
    squared = HALF * gap.dot(gap)
    gradient = sp.Matrix([sp.diff(squared, x) for x in generic.x])
    expressions = (jacobian.T * gap, gradient + gap, jacobian * generic.p - generic.rate, jacobian - jacobian.T)
    steps = (
        Step(r"The derivative of the closest point, $D = \partial \hat q/\partial q$, with $x = q - y$:", jacobian),
        Step(r"maps the gap $\hat q - q =$", gap.applyfunc(generic.reduce)),
        Step(r"to zero, $D^T (\hat q - q) = 0$; so the gradient of $\|\hat q - q\|^2/2$ is $-(\hat q - q)$;", squared),
        Step(r"and $\hat p = D p$ is the velocity of $\hat q$.", generic.rate),
    )
    residuals = tuple(generic.reduce(term) for group in expressions for term in group)
    return Derivation(f"The closest point of a {kind}", steps, jacobian, residuals)


@dataclass(frozen=True)
class Braking:
    """Effect of an obstacle on the kinetic energy, <p, p_hat - p>, and its sign."""

    kind: str
    residual: sp.Expr  # <p, p_hat - p> less its geometric form (mu - 1) |P p|^2 - <a, p>^2, computed: 0
    terms: tuple[sp.Expr, ...]  # of the geometric form outside the obstacle (mu = 1/(1 + tau), tau > 0, at a sphere)

    @property
    def holds(self) -> bool:
        """Return whether the braking form is exact, and every term provably nonpositive outside the obstacle."""
        return bool(self.residual == 0) and all(term.is_nonpositive is True for term in self.terms)


def derive_braking(kind: str, m: int = 2) -> Braking:
    """Derive <p, p_hat - p> = (mu - 1) |P p|^2 - <a, p>^2 and the sign of each term; mu = 1 at a wall."""
    generic_obstacle = GenericObstacle(kind, m)
    normal, p = generic_obstacle.normal, generic_obstacle.p
    axial_square = normal.dot(p) ** 2 / normal.dot(normal)
    geometric = (generic_obstacle.mu - 1) * (p.dot(p) - axial_square) - axial_square
    residual = generic_obstacle.reduce(generic_obstacle.braking() - geometric)
    mu = sp.S.One if kind == "wall" else 1 / (1 + DEPTH)
    return Braking(kind, residual, (sp.factor((mu - 1) * TANGENT_SQUARE), -(NORMAL_SPEED**2)))
