"""The α- and β-pair laws as scalar functions of the squared distance or of the σ-norm.

Generated from `flockana.symbolic` by `python -m tools.formulas`; edit these.

Parameters are vectors of float64 whose places have the names below: OFFSET is the constant of ψ where ρ_h = 1, FAR is
ψ_α(r_α), AREA is ℓ², ℓ the length that σ₁ counts in. A pair contributes w (q_j − q_i) + ρ (p_j − p_i) to u_i.
"""

# fmt: off
from __future__ import annotations

from math import sqrt

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
D_BETA, BETA_OFFSET, BETA_AREA = range(2, 5)  # after ε and h


@register_jitable
def phi_alpha(z, par):
    """φ_α(z) = ρ_h(z/r_α) φ((z − d_α)/ℓ²)."""
    x0 = bump(z/par[R_ALPHA], par[H])
    x1 = phi((-par[D_ALPHA] + z)/par[AREA], par[A], par[B], par[C])
    return x0*x1


@register_jitable
def phi_alpha_slope(z, par):
    """dφ_α/dz."""
    x0 = 1.0/par[AREA]
    x1 = x0*(-par[D_ALPHA] + z)
    x2 = par[C] + x1
    x3 = (x2*x2) + 1.0
    x4 = 1.0/par[R_ALPHA]
    x5 = x4*z
    x6 = bump(x5, par[H])
    x7 = bump_slope(x5, par[H])
    x8 = phi(x1, par[A], par[B], par[C])
    return 0.5*x0*x6*(par[A] + par[B])/(x3*sqrt(x3)) + x4*x7*x8


@register_jitable
def psi_alpha(z, par, panels):
    """ψ_α(z), constant from r_α on."""
    if par[R_ALPHA] <= z:
        return par[FAR]
    if z < par[H]*par[R_ALPHA]:
        return par[AREA]*phi_integral((-par[D_ALPHA] + z)/par[AREA], par[A], par[B], par[C]) + par[OFFSET]
    return on_panels(z, panels)


@register_jitable
def adjacency_alpha(z, par):
    """a_ij by z = ‖q_j − q_i‖_σ."""
    return bump(z/par[R_ALPHA], par[H])


@register_jitable
def norm_alpha(s2, par):
    """(‖x‖_σ, √(1 + ε‖x‖²))."""
    x0 = sqrt(par[EPS]*s2 + 1.0)
    return s2/(x0 + 1.0), x0


@register_jitable
def stress_alpha(z, root, par):
    """Force weight s_ij and adjacency a_ij from `norm_alpha`."""
    c0 = 1.0/par[AREA]
    c1 = 1.0/par[R_ALPHA]
    x0 = c0*(-par[D_ALPHA] + z)
    x1 = phi_above(x0, par[A], par[B], par[C])
    x2 = phi_below(x0, par[A], par[B], par[C])
    x3 = taper(c1*z, par[H])
    return x1*x3/(x2*root), x3


@register_jitable
def pair_alpha(s2, par):
    """Force weight s_ij and adjacency a_ij of a pair at squared distance s2."""
    z, root = norm_alpha(s2, par)
    return stress_alpha(z, root, par)


@register_jitable
def pair_alpha_slope(s2, par):
    """Derivative d(s_ij)/d(s2) of a force weight."""
    x0 = 1.0/par[AREA]
    x1 = sigma_norm(s2, par[EPS])
    x2 = x0*(-par[D_ALPHA] + x1)
    x3 = par[C] + x2
    x4 = par[EPS]*s2 + 1.0
    x5 = (x3*x3) + 1.0
    x6 = 1.0/par[R_ALPHA]
    x7 = x1*x6
    x8 = bump(x7, par[H])
    x9 = bump_slope(x7, par[H])
    x10 = phi(x2, par[A], par[B], par[C])
    x11 = 1.0/x4
    x12 = 0.5*x10
    return -x12*x8*par[EPS]/(x4*sqrt(x4)) + 0.25*x0*x11*x8*(par[A] + par[B])/(x5*sqrt(x5)) + x11*x12*x6*x9


@register_jitable
def pair_alpha_adjacency_slope(s2, par):
    """Derivative d(a_ij)/d(s2) of an adjacency, for Jacobians."""
    x0 = 1.0/par[R_ALPHA]
    x1 = sigma_norm(s2, par[EPS])
    x2 = bump_slope(x0*x1, par[H])
    return 0.5*x0*x2/sqrt(par[EPS]*s2 + 1.0)


@register_jitable
def pair_alpha_potential(s2, par, panels):
    """ψ_α at squared distance s2."""
    x0 = sigma_norm(s2, par[EPS])
    return psi_alpha(x0, par, panels)


@register_jitable
def phi_beta(z, par):
    """φ_β(z) = ρ_h(z/d_β)(σ₁((z − d_β)/ℓ²) − 1)."""
    x0 = bump(z/par[D_BETA], par[H])
    x1 = sigma_1((-par[D_BETA] + z)/par[BETA_AREA])
    return x0*(x1 - 1.0)


@register_jitable
def integral_beta(z, par):
    """An antiderivative of φ_β where ρ_h = 1."""
    x0 = -z
    x1 = -par[D_BETA] - x0
    x2 = sigma_norm((x1*x1)/(par[BETA_AREA]*par[BETA_AREA]), 1.0)
    return x2*par[BETA_AREA] + x0


@register_jitable
def psi_beta(z, par, panels):
    """ψ_β(z), 0 from d_β on."""
    if par[D_BETA] <= z:
        return 0.0
    if z < par[D_BETA]*par[H]:
        return par[BETA_OFFSET] + integral_beta(z, par)
    return on_panels(z, panels)


@register_jitable
def adjacency_beta(z, par):
    """b_ik by z = ‖q̂_ik − q_i‖_σ."""
    return bump(z/par[D_BETA], par[H])


@register_jitable
def pair_beta(s2, par):
    """(weight of q̂_ik − q_i, b_ik) at squared distance s2."""
    x0 = sigma_norm(s2, par[EPS])
    x1 = sigma_1((-par[D_BETA] + x0)/par[BETA_AREA])
    x2 = bump(x0/par[D_BETA], par[H])
    return x2*(x1 - 1.0)/sqrt(par[EPS]*s2 + 1.0), x2


@register_jitable
def pair_beta_slope(s2, par):
    """d(weight)/d(s2), for the Hessian of ψ_β."""
    x0 = sigma_norm(s2, par[EPS])
    x1 = -par[D_BETA] + x0
    x2 = 1.0 + (x1*x1)/(par[BETA_AREA]*par[BETA_AREA])
    x3 = par[EPS]*s2 + 1.0
    x4 = 1.0/par[D_BETA]
    x5 = x0*x4
    x6 = bump(x5, par[H])
    x7 = bump_slope(x5, par[H])
    x8 = 1.0/par[BETA_AREA]
    x9 = sigma_1(x1*x8)
    x10 = 0.5/x3
    x11 = x9 - 1.0
    return -0.5*x11*x6*par[EPS]/(x3*sqrt(x3)) + x10*x11*x4*x7 + x10*x6*x8/(x2*sqrt(x2))


@register_jitable
def adjacency_beta_slope(s2, par):
    """d(b_ik)/d(s2)."""
    x0 = 1.0/par[D_BETA]
    x1 = sigma_norm(s2, par[EPS])
    x2 = bump_slope(x0*x1, par[H])
    return 0.5*x0*x2/sqrt(par[EPS]*s2 + 1.0)
