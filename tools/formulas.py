"""Write the kernels and the enclosures of the pair laws, generated from their formulas (`python -m tools.formulas`).

A test compares what is in the package with what `sources` gives.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import sympy as sp

from flockana.symbolic.code_printing import FloatCode
from flockana.symbolic.named_functions import (
    Bump,
    BumpSlope,
    Phi,
    PhiAbove,
    PhiBelow,
    PhiIntegral,
    Place,
    Sigma1,
    SigmaNorm,
    Taper,
    written,
)
from flockana.symbolic.parameter_symbols import AlphaSymbols, BetaSymbols
from flockana.symbolic.scalar_functions import alpha_smooth, beta_closed, beta_smooth
from tools.formula_code import BallCode, IntegrandCode, by_inverse_roots, shared_text

S2, Z, ROOT = sp.symbols("s2 z root", positive=True)
_S = sp.Symbol("s", real=True)
_H, _EPS, _A, _B, _C = sp.symbols("h eps a b c", positive=True)
_LARGE, _INF, _PAR, _PANELS = sp.symbols("LARGE inf par panels", positive=True)
_TAPER, _ON_PANELS = sp.Function("taper"), sp.Function("on_panels")
_PIECE = sp.Symbol("piece")
_HEAD = '''"""{title}

Generated from `flockana.symbolic` by `python -m tools.formulas`; edit these.{more}
"""

# fmt: off
from __future__ import annotations

'''
_SCALARS = (
    _HEAD.format(
        title="The scalar functions of Olfati-Saber's pair laws, for compiled and interpreted use.", more=""
    ).replace("# fmt: off", "# fmt: off\n# ruff: noqa: SIM300")
    + """from math import inf, pi, sqrt

from flockana.jit import register_jitable
from flockana.kernels.sine_and_cosine import quarter_sine, sine

LARGE = 2.0**400  # beyond it σ₁ is 1; a power of two: φ reaches its limits exactly
tiny = 1e-300  # keeps 0/0 out"""
)
_PAIRS = (
    _HEAD.format(
        title="The α- and β-pair laws as scalar functions of the squared distance or of the σ-norm.",
        more="""

Parameters are vectors of float64 whose places have the names below: OFFSET is the constant of ψ where ρ_h = 1, FAR is
ψ_α(r_α), AREA is ℓ², ℓ the length that σ₁ counts in. A pair contributes w (q_j − q_i) + ρ (p_j − p_i) to u_i.""",
    )
    + """from math import sqrt

from flockana.jit import register_jitable
from flockana.kernels.integral_tables import on_panels
from flockana.kernels.scalars import (
    bump,
    bump_slope,
    phi,
    phi_above,
    phi_below,
    phi_integral,
    sigma_1,
    sigma_norm,
    taper,
)

EPS, H, A, B, C, D_ALPHA, R_ALPHA, OFFSET, FAR, AREA = range(10)
D_BETA, BETA_OFFSET, BETA_AREA = range(2, 5)  # after ε and h"""
)
_BALLS = (
    _HEAD.format(
        title="A pair law in balls and power series (Arb), for the provers.",
        more="""

`law` holds the numbers of an α- or β-pair as balls (`flockana.certified.pair_laws_in_series`); `piece` says on which
piece of ρ_h a
series lies. The checkers have formulas of their own.""",
    )
    + """from typing import Any

from flint import arb

from flockana.certified.balls import monotone, place, square"""
)
_PAIR_ALPHA = '''@register_jitable
def pair_alpha(s2, par):
    """Force weight s_ij and adjacency a_ij of a pair at squared distance s2."""
    z, root = norm_alpha(s2, par)
    return stress_alpha(z, root, par)'''


@dataclass(frozen=True)
class _Law:
    """Pair law with symbols that print as its numbers; `smooth` is its action without bump, `closed` its integral."""

    eps: sp.Expr
    h: sp.Expr
    cutoff: sp.Expr
    smooth: sp.Expr
    closed: sp.Expr

    @property
    def bump(self) -> sp.Expr:
        """Return the adjacency as a function of the sigma-norm."""
        return Bump(Z / self.cutoff, self.h)

    @property
    def action(self) -> sp.Expr:
        """Return the action as a function of the sigma-norm."""
        return self.bump * self.smooth

    @property
    def pair(self) -> list[sp.Expr]:
        """Return the weight of q_j - q_i in the force, and the adjacency, as functions of the squared distance."""
        norm = SigmaNorm(S2, self.eps)
        return [self.action.subs(Z, norm) / sp.sqrt(1 + self.eps * S2), self.bump.subs(Z, norm)]

    @property
    def slopes(self) -> list[sp.Expr]:
        """Return the derivatives of the two."""
        return [sp.diff(each, S2) for each in self.pair]

    @property
    def stiffness(self) -> sp.Expr:
        """Return F'' of F(length) = psi(sigma-norm), as a function of the squared distance."""
        length = sp.Symbol("length", positive=True)
        slant = length / sp.sqrt(1 + self.eps * length**2)
        bend = sp.diff(self.action, Z) * slant**2 + self.action * sp.simplify(sp.diff(slant, length))
        return bend.subs(Z, SigmaNorm(S2, self.eps)).subs(length, sp.sqrt(S2))

    def potential(self, far: sp.Expr, offset: sp.Expr) -> sp.Expr:
        """Return psi: closed before the taper, by panels on it, constant beyond."""
        on_taper = _ON_PANELS(Z, _PANELS)
        return sp.Piecewise((far, self.cutoff <= Z), (self.closed + offset, self.h * self.cutoff > Z), (on_taper, True))


def _alpha(number: Callable[[str], sp.Symbol]) -> _Law:
    names = {"eps": "EPS", "h": "H", "a": "A", "b": "B", "c": "C", "d_alpha": "D_ALPHA", "r_alpha": "R_ALPHA"}
    of = AlphaSymbols(**{name: number(place) for name, place in names.items()}, unit=sp.sqrt(number("AREA")))
    smooth = alpha_smooth(Z, of)
    return _Law(of.eps, of.h, of.r_alpha, smooth, of.unit**2 * PhiIntegral(*smooth.args))


def _beta(number: Callable[[str], sp.Symbol]) -> _Law:
    of = BetaSymbols(eps=number("EPS"), h=number("H"), d_beta=number("D_BETA"), unit=sp.sqrt(number("BETA_AREA")))
    return _Law(of.eps, of.h, of.d_beta, beta_smooth(Z, of), beta_closed(Z, of))


def _scalars() -> Iterable[str]:
    kept = sp.Piecewise((_LARGE, _S > _LARGE), (-_LARGE, _S < -_LARGE), (_S, True))
    clipped, z, sigmoid = sp.Function("clipped", real=True)(_S), sp.Symbol("z", real=True), (_S, _A, _B, _C)
    norm = SigmaNorm(S2, _EPS).stable
    norm = sp.Piecewise((norm, sp.sqrt(1 + _EPS * S2) < _INF), (sp.sqrt(S2 / _EPS), True))
    quotient = _quotient(clipped, *sigmoid[1:])
    yield _kernel("sigma_norm(s2, eps)", "‖x‖_σ from s2 = ‖x‖².", norm, lazy=True)
    yield _kernel("clipped(s)", "s, cut off where squares would overflow.", kept)
    yield _kernel("sigma_1(s)", "σ₁(s) = s/√(1+s²).", Sigma1(clipped).composed)
    yield _kernel("taper(z, h)", "ρ_h(z) for z ≥ 0.", Bump(Z, _H).stable, moving=[Z])
    yield _kernel("bump(z, h)", "ρ_h(z), 0 for z < 0.", sp.Piecewise((0, z < 0), (_TAPER(z, _H), True)))
    yield _kernel("bump_slope(z, h)", "dρ_h/dz, 0 at the ends of the taper.", BumpSlope(Z, _H).composed, lazy=True)
    yield _kernel(
        "phi_above(s, a, b, c)", "Numerator of the uneven sigmoid φ(s).", PhiAbove(*sigmoid).stable, moving=[_S]
    )
    yield _kernel(
        "phi_below(s, a, b, c)", "Denominator of the uneven sigmoid φ(s).", PhiBelow(*sigmoid).stable, moving=[_S]
    )
    yield _kernel("phi(s, a, b, c)", "φ(s) = ½[(a+b) σ₁(s+c) + (a−b)] for c = (b−a)/√(4ab).", quotient)
    yield _kernel("phi_integral(s, a, b, c)", "∫₀ˢ φ ≥ 0.", PhiIntegral(*sigmoid).stable, moving=[_S])


def _pairs() -> Iterable[str]:
    def number(name: str) -> sp.Symbol:
        return sp.Symbol(f"par[{name}]", positive=True)

    alpha, beta = _alpha(number), _beta(number)
    norm = SigmaNorm(S2, alpha.eps)
    in_sums = [each.replace(Bump, _TAPER).replace(Phi, _quotient) for each in (alpha.action / ROOT, alpha.bump)]
    at, far, offset = sp.Function("psi_alpha")(norm, _PAR, _PANELS), number("FAR"), number("OFFSET")
    yield _kernel("phi_alpha(z, par)", "φ_α(z) = ρ_h(z/r_α) φ((z − d_α)/ℓ²).", alpha.action)
    yield _kernel("phi_alpha_slope(z, par)", "dφ_α/dz.", sp.diff(alpha.action, Z))
    yield _kernel("psi_alpha(z, par, panels)", "ψ_α(z), constant from r_α on.", alpha.potential(far, offset), lazy=True)
    yield _kernel("adjacency_alpha(z, par)", "a_ij by z = ‖q_j − q_i‖_σ.", alpha.bump)
    yield _kernel("norm_alpha(s2, par)", "(‖x‖_σ, √(1 + ε‖x‖²)).", norm.stable, sp.sqrt(1 + alpha.eps * S2))
    yield _kernel(
        "stress_alpha(z, root, par)",
        "Force weight s_ij and adjacency a_ij from `norm_alpha`.",
        *in_sums,
        moving=[Z, ROOT],
    )
    yield _PAIR_ALPHA
    yield _kernel("pair_alpha_slope(s2, par)", "Derivative d(s_ij)/d(s2) of a force weight.", alpha.slopes[0])
    yield _kernel(
        "pair_alpha_adjacency_slope(s2, par)",
        "Derivative d(a_ij)/d(s2) of an adjacency, for Jacobians.",
        alpha.slopes[1],
    )
    yield _kernel("pair_alpha_potential(s2, par, panels)", "ψ_α at squared distance s2.", at)
    psi = beta.potential(sp.S.Zero, number("BETA_OFFSET")).subs(beta.closed, sp.Function("integral_beta")(Z, _PAR))
    yield _kernel("phi_beta(z, par)", "φ_β(z) = ρ_h(z/d_β)(σ₁((z − d_β)/ℓ²) − 1).", beta.action)
    yield _kernel("integral_beta(z, par)", "An antiderivative of φ_β where ρ_h = 1.", beta.closed)
    yield _kernel("psi_beta(z, par, panels)", "ψ_β(z), 0 from d_β on.", psi, lazy=True)
    yield _kernel("adjacency_beta(z, par)", "b_ik by z = ‖q̂_ik − q_i‖_σ.", beta.bump)
    yield _kernel("pair_beta(s2, par)", "(weight of q̂_ik − q_i, b_ik) at squared distance s2.", *beta.pair)
    yield _kernel("pair_beta_slope(s2, par)", "d(weight)/d(s2), for the Hessian of ψ_β.", beta.slopes[0])
    yield _kernel("adjacency_beta_slope(s2, par)", "d(b_ik)/d(s2).", beta.slopes[1])


def _quotient(*arguments: sp.Expr) -> sp.Expr:
    """Return phi as a quotient, so that a weight divides once."""
    return PhiAbove(*arguments) / PhiBelow(*arguments)


def _kernel(head: str, doc: str, *of: sp.Expr, moving: Iterable[sp.Symbol] = (), lazy: bool = False) -> str:
    return "@register_jitable\n" + shared_text(head, doc, list(of), FloatCode(), moving, lazy=lazy)


def _balls() -> Iterable[str]:
    def number(name: str) -> sp.Symbol:
        named = {"D_ALPHA": "zero", "R_ALPHA": "cutoff"}.get(name, name.lower())
        return sp.Symbol(f"law.{named}", positive=True)

    law = _alpha(number)
    tapered = Taper(Place(Z / law.cutoff, law.h)) * law.smooth
    yield _monotone("sigma_norm(s2, eps)", "‖x‖_σ", SigmaNorm(S2, _EPS).stable)
    yield _monotone("sigma_1(s)", "σ₁(s)", Sigma1(_S).composed)
    yield _monotone("taper(s)", "Half-cosine of ρ_h", Taper(_S).composed)
    yield _ball("phi(s, a, b, c)", "φ(s), increasing.", Phi(_S, _A, _B, _C).composed)
    yield _ball("pair(s2, law, piece)", "Force weight and adjacency of a pair at squared distance s2.", *law.pair)
    yield _ball("slopes(s2, law, piece)", "Derivatives of (weight, adjacency) by s2.", *law.slopes)
    yield _ball("stiffness(s2, law, piece)", "F''(ℓ) of F = ψ(‖·‖_σ), by s2 = ℓ².", law.stiffness)
    yield _ball("closed(z, law)", "An antiderivative of the action where ρ_h = 1.", written(law.closed))
    yield _ball("tapered(z, law, analytic)", "The action on the taper.", written(tapered))


def _monotone(head: str, what: str, of: sp.Expr) -> str:
    """Return the text of a monotone function: of a ball from its ends."""
    variable = re.split(r"\W", head)[1]
    value = f"monotone(lambda {variable}: {BallCode().doprint(by_inverse_roots(of))}, {variable})"
    return f'def {_typed(head)}:\n    """{what}, monotone."""\n    return {value}'


def _ball(head: str, doc: str, *of: sp.Expr) -> str:
    placed = (each.replace(Bump, _taper).replace(BumpSlope, _taper_slope) for each in of)
    code = IntegrandCode() if "analytic" in head else BallCode()
    return shared_text(_typed(head), doc, [sp.factor_terms(by_inverse_roots(each)) for each in placed], code)


def _typed(head: str) -> str:
    return re.sub(r"(?<=[(, ])(\w+)(?=[,)])", r"\1: Any", head) + " -> Any"


def _taper(z: sp.Expr, h: sp.Expr) -> sp.Expr:
    """Return the bump by its place on the taper, which is 0 or 1 off it."""
    return Taper(Place(z, h, _PIECE))


def _taper_slope(z: sp.Expr, h: sp.Expr) -> sp.Expr:
    at = sp.Dummy("at", real=True)
    return Taper(at).fdiff().subs(at, Place(z, h, _PIECE)) * Place(z, h).fdiff()


def sources() -> dict[str, str]:
    """Return the text of every generated file, by its path in the package."""
    modules = {
        "kernels/scalars.py": (_SCALARS, _scalars()),
        "kernels/alpha.py": (_PAIRS, _pairs()),
        "certified/formula_in_balls.py": (_BALLS, _balls()),
    }
    return {path: "\n\n\n".join([head, *functions]) + "\n" for path, (head, functions) in modules.items()}


if __name__ == "__main__":
    for path, text in sources().items():
        (Path(__file__).parents[1] / "flockana" / path).write_text(text, "utf-8")
