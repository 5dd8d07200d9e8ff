"""How smooth the bump, the pair functions and the potential are: what an integrator of high order meets."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from flockana.symbolic.parameter_symbols import AlphaSymbols
from flockana.symbolic.scalar_functions import bump, phi, taper
from flockana.symbolic.sigma_norms import sigma_1, sigma_norm
from proofs.proof import Proof, Step

Z, S = sp.Symbol("z", positive=True), sp.Symbol("s", real=True)
H = 1 / (1 + sp.Symbol("t", positive=True))  # any h in (0, 1)
R_ALPHA, D_BETA = sp.symbols("r_alpha d_beta", positive=True)
PHI = sp.Function("phi", real=True)  # any smooth function


def jumps(before: sp.Expr, after: sp.Expr, at: sp.Expr) -> list[sp.Expr]:
    """Value, slope and second derivative from the right less from the left, both pieces smooth at the point."""
    return [sp.simplify((after - before).diff(Z, k).subs(Z, at).doit()) for k in range(3)]


def _bump() -> Iterator[Step]:
    falling, jump = taper(Z, h=H), -(sp.pi**2) / (2 * (1 - H) ** 2)
    for name, at, before, after in (("h", H, sp.S.One, falling), ("1", sp.S.One, falling, sp.S.Zero)):
        found = jumps(before, after, at)
        yield Step(
            f"ρ_h at z = {name}: value and slope agree from both sides",
            found[:2] == [0, 0],
            rf"\rho_h({name}^+) = \rho_h({name}^-), \qquad \rho_h'({name}^+) = \rho_h'({name}^-)",
        )
        yield Step(
            f"ρ_h at z = {name}: the second derivative jumps, for every h",
            sp.simplify(found[2] - jump) == 0 and sp.simplify(jump).is_negative is True,
            rf"\rho_h''({name}^+) - \rho_h''({name}^-) = -\frac{{\pi^2}}{{2(1-h)^2}}",
        )


def _phi() -> Iterator[Step]:
    yield Step(
        "φ is smooth: σ₁ is the derivative of √(1 + s²), a root that is never of 0",
        sp.simplify(sp.sqrt(1 + S**2).diff(S) - sigma_1(S)) == 0 and (1 + S**2).is_positive is True,
        r"\sigma_1(s) = \frac{d}{ds}\sqrt{1+s^2}",
    )
    a, k, c = sp.Symbol("a", positive=True), sp.Symbol("k", nonnegative=True), sp.Symbol("c", nonnegative=True)
    at_zero = phi(sp.S.Zero, alpha=AlphaSymbols(a=a, b=a + k))
    slope = (2 * a + k) / 2 * (1 + (S + c) ** 2) ** sp.Rational(-3, 2)
    found = phi(S, alpha=AlphaSymbols(a=a, b=a + k, c=c)).diff(S)
    yield Step(
        "φ increases from φ(0) = 0, so that φ(r_α - d_α) > 0",
        _vanishes(at_zero) and sp.simplify(found - slope) == 0 and slope.is_positive is True,
        r"\varphi'(s) = \tfrac{a+b}{2}\,\bigl(1+(s+c)^2\bigr)^{-3/2} > 0, \qquad \varphi(0) = 0",
        "for b = a + k, k >= 0",
    )


def _vanishes(expression: sp.Expr) -> bool:
    """Whether it is 0, once what stands under its roots is factored."""
    roots = expression.replace(lambda e: e.is_Pow and e.exp.is_Rational, lambda e: sp.factor(e.base) ** e.exp)
    return bool(sp.simplify(roots) == 0)


def _action() -> Iterator[Step]:
    action, jump = taper(Z / R_ALPHA, h=H) * PHI(Z), -(sp.pi**2) / (2 * (1 - H) ** 2 * R_ALPHA**2)
    for name, at, before, after in (("h r_α", H * R_ALPHA, PHI(Z), action), ("r_α", R_ALPHA, action, sp.S.Zero)):
        found = jumps(before, after, at)
        yield Step(f"φ_α at z = {name}: value and slope agree from both sides", found[:2] == [0, 0])
        yield Step(
            f"φ_α at z = {name}: the second derivative jumps by -π²/(2 (1-h)² r_α²) φ({name} - d_α)",
            sp.simplify(found[2] - jump * PHI(at)) == 0 and sp.simplify(jump).is_negative is True,
            r"\phi_\alpha''(z^+) - \phi_\alpha''(z^-) = -\frac{\pi^2}{2(1-h)^2 r_\alpha^2}\,\varphi(z - d_\alpha)",
            "for any smooth φ; never 0 at r_α, and 0 at h r_α only if d_α is there",
        )
    repulsion = taper(Z / D_BETA, h=H) * (sigma_1(Z - D_BETA) - 1)
    found, jump = jumps(repulsion, sp.S.Zero, D_BETA), sp.pi**2 / (2 * (1 - H) ** 2 * D_BETA**2)
    yield Step(
        "φ_β at d_β: value and slope agree, the second derivative jumps",
        found[:2] == [0, 0] and sp.simplify(found[2] - jump) == 0 and sp.simplify(jump).is_positive is True,
        r"\phi_\beta''(d_\beta^+) - \phi_\beta''(d_\beta^-) = \frac{\pi^2}{2(1-h)^2 d_\beta^2}",
    )


def _potential() -> Iterator[Step]:
    x, eps, k = sp.Symbol("x", positive=True), sp.Symbol("epsilon", positive=True), sp.Symbol("k")
    z, square = sigma_norm(x, eps=eps), sp.Symbol("s", nonnegative=True)
    yield Step(
        "the σ-norm is a smooth function of ‖q_j - q_i‖², at coincident agents too: V is as smooth as ψ_α",
        (1 + eps * square).is_positive is True and sp.simplify(z.diff(x)).is_positive is True,
        r"z = \frac{\sqrt{1 + \epsilon x^2} - 1}{\epsilon}, \qquad z'(x) = \frac{x}{\sqrt{1+\epsilon x^2}} > 0",
    )
    third = k**3 * z.diff(x) ** 3 + 3 * k**2 * z.diff(x) * z.diff(x, 2) + k * z.diff(x, 3)
    yield Step(
        "two agents at distance x, the others out of range: of the terms of d³V/dx³, φ_α'' z'³ jumps at r_α, alone",
        sp.simplify(sp.exp(k * z).diff(x, 3) * sp.exp(-k * z) - third) == 0,
        r"\frac{d^3}{dx^3}\psi_\alpha(z) = \phi_\alpha''(z)\,z'^3 + 3\,\phi_\alpha'(z)\,z' z'' + \phi_\alpha(z)\,z'''",
        "the coefficients are the same for every ψ: compared for exp(kz), whose derivatives the powers of k tell apart",
    )


def _indicator() -> Iterator[Step]:
    indicator, side = bump(Z, h=sp.S.One), sp.Symbol("tau", positive=True)
    left, right = indicator.subs(Z, 1 - side), indicator.subs(Z, 1 + side)
    yield Step(
        "E10: at h = 1 the bump is 1 on the left of z = 1 and 0 on the right: it jumps by 1",
        left == 1 and right == 0,
        r"\rho_1(1^-) - \rho_1(1^+) = 1",
    )


def _steps() -> Iterator[Step]:
    for part in (_bump, _phi, _action, _potential, _indicator):
        yield from part()


PROOF = Proof(
    id="smoothness",
    title="How smooth the bump, the forces and V are",
    statement=(
        "For every 0 < h < 1, ρ_h, φ_α and φ_β are once continuously differentiable and not twice; so V is twice "
        "continuously differentiable and not three times, where a pair passes the distance r. At h = 1 the bump jumps, "
        "against what is printed (E10)."
    ),
    hypotheses="0 < h < 1, 0 < a <= b, 0 < d < r, ε > 0; V of n >= 2 agents",
    rigour="symbolic",
    steps=_steps,
    size=14,
    theorems=("E10",),
)
