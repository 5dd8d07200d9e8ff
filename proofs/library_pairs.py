"""The pair sums' scalar functions are the proved formulas, and each slope is the derivative of what it is named for.

As in `library-formulas`, the kernels' own code is executed on symbols. The bump and the action enter as functions of
which nothing is assumed, so that what is proved of a pair holds wherever these are differentiable.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import sympy as sp

from flockana.kernels import alpha, beta_slopes, scalars
from flockana.symbolic.functions import taper
from flockana.symbolic.norms import sigma_1, sigma_norm
from proofs.library_formulas import below_overflow, on_symbols
from proofs.proof import Proof, Step

S2, EPS, AREA = sp.symbols("s2 epsilon A", positive=True)  # the squared distance; A = ℓ²
FIRST, LAST = sp.symbols("d_alpha r_alpha", positive=True)  # σ-norms of d and r, of d' for a β-agent
RHO, PHI = sp.Function("rho"), sp.Function("phi")
Z = sp.Function("z")(S2)  # the σ-norm of a pair, whose slope is 1/(2√(1 + εs²))
RHO_SLOPE, PHI_SLOPE = (sp.Function(f"{name}_slope") for name in ("rho", "phi"))
_KNOWN = {
    "bump": lambda x, h: RHO(x),
    "taper": lambda x, h: RHO(x),
    "bump_slope": lambda x, h: RHO_SLOPE(x),
    "phi": lambda s, a, b, c: PHI(s),
    "phi_parts": lambda s, a, b, c: (PHI(s), sp.S.One),
    "phi_slope": lambda s, a, b, c: PHI_SLOPE(s),
}


def parameters(**places: Any) -> list[Any]:
    """A vector of parameters, by the names of its places; those that nothing reads are 0."""
    values = {getattr(alpha, name): value for name, value in places.items()}
    return [values.get(k, sp.S.Zero) for k in range(10)]


ALPHA = parameters(EPS=EPS, D_ALPHA=FIRST, R_ALPHA=LAST, AREA=AREA)
BETA = parameters(EPS=EPS, D_BETA=LAST, BETA_AREA=AREA)


def root() -> sp.Expr:
    """√(1 + ε s²)."""
    return sp.sqrt(1 + EPS * S2)


def stress() -> sp.Expr:
    """ρ(z/r_α) φ((z - d_α)/ℓ²)/√(1 + ε s²), z a function of s²: the weight of q_j - q_i in u_i."""
    return RHO(Z / LAST) * PHI((Z - FIRST) / AREA) / root()


def beta_stress() -> sp.Expr:
    """ρ(z/d_β)(σ₁((z - d_β)/ℓ²) - 1)/√(1 + ε s²)."""
    return RHO(Z / LAST) * (sigma_1((Z - LAST) / AREA) - 1) / root()


def by_square(expression: sp.Expr) -> sp.Expr:
    """Its derivative in s², by dz/ds² = 1/(2√(1 + ε s²)), with names for the slopes of ρ and φ."""
    x = sp.Dummy("x")
    slopes = {RHO: RHO_SLOPE, PHI: PHI_SLOPE}
    derivative = expression.diff(S2).doit().subs(Z.diff(S2), 1 / (2 * root()))
    for function, slope in slopes.items():
        derivative = derivative.replace(
            lambda node, f=function: isinstance(node, sp.Subs) and node.expr.has(f),
            lambda node, g=slope: g(node.point[0]),
        )
        derivative = derivative.replace(sp.Derivative(function(x), x), slope(x))
    return derivative


def residual(function: Any, par: list[Any], formula: sp.Expr, pick: int | None = None) -> sp.Expr:
    """The library's function of s² less a formula in z and s²: 0."""
    found = on_symbols(function, **_KNOWN, sigma_norm=lambda s2, eps: Z, abs=below_overflow)(S2, par)
    # `pair_alpha` has the σ-norm written out
    written = {S2 / (root() + 1): Z}
    return sp.simplify((found if pick is None else found[pick]).subs(written) - formula)


def integral_residual(sign: int) -> list[sp.Expr]:
    """The library's ∫φ at 0, and its slope less φ, where (s + c)c has this sign: both 0; c = (b - a)/√(4ab)."""
    a, y = sp.symbols("a y", positive=True)
    c, s = sp.Symbol("c", positive=True), sp.Symbol("s", real=True)
    b = a * (1 + 2 * c * (c + sp.sqrt(1 + c**2)))  # so that (b - a)/√(4ab) = c
    place = sign * y - c
    code = on_symbols(scalars.phi_integral)(place, a, b, c)
    true = ((a + b) * sigma_1(s + c) + a - b) / 2
    slope = sp.simplify(code.diff(y) * sign - true.subs(s, place))
    at_zero = on_symbols(scalars.phi_integral)(sp.S.Zero, a, b, c)
    shift = sp.simplify((b - a) ** 2 - 4 * a * b * c**2)
    return [sp.simplify(slope), sp.simplify(at_zero), shift]


def _slopes() -> Iterator[Step]:
    a, b, c = sp.symbols("a b c", positive=True)
    s = sp.Symbol("s", real=True)
    action = ((a + b) * sigma_1(s + c) + a - b) / 2
    yield Step(
        "the slope of φ is its derivative",
        sp.simplify(on_symbols(scalars.phi_slope)(s, a, b, c) - action.diff(s)) == 0,
    )
    more, rest = sp.symbols("B A_1", positive=True)  # h < z < 1
    z, h = sp.symbols("z h", positive=True)
    within = {z: 1 - rest, h: 1 - rest - more}
    code = on_symbols(scalars.bump_slope, sin=sp.sin)(within[z], within[h])
    yield Step(
        "the slope of the bump is that of its taper, h < z < 1",
        sp.simplify(code - taper(z, h=h).diff(z).subs(within)) == 0,
    )
    for sign in (1, -1):
        yield Step(
            f"the integral of φ, s + c {'>' if sign > 0 else '<'} 0 (c > 0): 0 at s = 0, and its slope is φ",
            all(part == 0 for part in integral_residual(sign)),
            r"\int_0^s \phi = \tfrac12\bigl[(a+b)(\sqrt{1+(s+c)^2} - \sqrt{1+c^2}) + (a-b)s\bigr]",
        )


def _pairs() -> Iterator[Step]:
    yield Step(
        "an α-pair's stress is ρ φ/√(1 + εs²), its adjacency ρ",
        residual(alpha.pair_alpha, ALPHA, stress(), 0) == 0
        and residual(alpha.pair_alpha, ALPHA, RHO(Z / LAST), 1) == 0,
        r"s_{ij} = \rho_h(z/r_\alpha)\,\phi\bigl((z - d_\alpha)/\ell^2\bigr)/\sqrt{1 + \epsilon\|q_j - q_i\|^2}",
    )
    yield Step(
        "its slope is the derivative in the squared distance",
        residual(alpha.pair_alpha_slope, ALPHA, by_square(stress())) == 0,
    )
    yield Step(
        "and so is that of the adjacency",
        residual(alpha.pair_alpha_adjacency_slope, ALPHA, by_square(RHO(Z / LAST))) == 0,
    )
    yield Step(
        "the weight of a β-agent is ρ (σ₁ - 1)/√(1 + εs²), its adjacency ρ",
        residual(alpha.pair_beta, BETA, beta_stress(), 0) == 0
        and residual(alpha.pair_beta, BETA, RHO(Z / LAST), 1) == 0,
    )
    yield Step(
        "its slope is the derivative in the squared distance",
        residual(beta_slopes.pair_beta_slope, BETA, by_square(beta_stress())) == 0,
    )
    yield Step(
        "and so is that of the adjacency",
        residual(beta_slopes.adjacency_beta_slope, BETA, by_square(RHO(Z / LAST))) == 0,
    )
    x = sp.Symbol("x", positive=True)
    yield Step(
        "dz/ds² = 1/(2√(1 + εs²)), z = ‖q_j - q_i‖_σ and s² = ‖q_j - q_i‖²",
        sp.simplify(sigma_norm(x, eps=EPS).diff(x) / (2 * x) - 1 / (2 * sp.sqrt(1 + EPS * x**2))) == 0,
    )


def _steps() -> Iterator[Step]:
    yield from _slopes()
    yield from _pairs()


PROOF = Proof(
    id="library-pairs",
    title="What the library computes of a pair, and its slopes, are the proved formulas",
    statement=(
        "The code of an α-pair's stress and adjacency and of a β-agent's weight, executed on symbols, is the formula "
        "in the σ-norm, bump and action; the slopes that Hessians and Jacobians are made of are their derivatives; "
        "so are those of φ and of the bump, and the closed form of ∫φ is one."
    ),
    hypotheses="arguments below 1e100; rounding left out; between the ends of the taper; 0 < a < b for ∫φ",
    rigour="symbolic",
    steps=_steps,
    size=11,
)
