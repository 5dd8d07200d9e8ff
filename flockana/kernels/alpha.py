"""The α- and β-pair laws as scalar functions of the squared distance.

Parameters are vectors of float64 whose places have the names below: OFFSET is the constant of ψ where ρ_h = 1, FAR is
ψ_α(r_α), AREA is ℓ², ℓ the length that σ₁ counts in. A pair contributes w (q_j − q_i) + ρ (p_j − p_i) to u_i.
"""

from __future__ import annotations

from math import sqrt

from flockana.jit import register_jitable
from flockana.kernels.scalars import (
    bump,
    bump_slope,
    on_panels,
    phi,
    phi_integral,
    phi_parts,
    phi_slope,
    sigma_1,
    sigma_norm,
    taper,
)

EPS, H, A, B, C, D_ALPHA, R_ALPHA, OFFSET, FAR, AREA = range(10)
D_BETA, BETA_OFFSET, BETA_AREA = range(2, 5)  # after ε and h


@register_jitable
def phi_alpha(z, par):
    """φ_α(z) = ρ_h(z/r_α) φ((z − d_α)/ℓ²)."""
    return bump(z / par[R_ALPHA], par[H]) * phi((z - par[D_ALPHA]) / par[AREA], par[A], par[B], par[C])


@register_jitable
def phi_alpha_slope(z, par):
    """dφ_α/dz."""
    x, s = z / par[R_ALPHA], (z - par[D_ALPHA]) / par[AREA]
    a, b, c = par[A], par[B], par[C]
    return bump_slope(x, par[H]) / par[R_ALPHA] * phi(s, a, b, c) + bump(x, par[H]) * phi_slope(s, a, b, c) / par[AREA]


@register_jitable
def psi_alpha(z, par, panels):
    """ψ_α(z): closed form where ρ_h = 1, Chebyshev panels on the taper, constant from r_α on."""
    if z >= par[R_ALPHA]:
        return par[FAR]
    if z < par[H] * par[R_ALPHA]:
        return par[AREA] * phi_integral((z - par[D_ALPHA]) / par[AREA], par[A], par[B], par[C]) + par[OFFSET]
    return on_panels(z, panels)


@register_jitable
def adjacency_alpha(z, par):
    """a_ij as a function of z = ‖q_j − q_i‖_σ."""
    return bump(z / par[R_ALPHA], par[H])


@register_jitable
def norm_alpha(s2, par):
    """(‖x‖_σ, √(1 + ε‖x‖²)) of a pair at squared distance s2 within range: `sigma_norm` without its branch."""
    root = sqrt(1.0 + par[EPS] * s2)
    return s2 / (root + 1.0), root


@register_jitable
def stress_alpha(z, root, par):
    """(stress s_ij, adjacency a_ij) of a pair from what `norm_alpha` gives."""
    rho = taper(z * (1.0 / par[R_ALPHA]), par[H])
    above, below = phi_parts((z - par[D_ALPHA]) * (1.0 / par[AREA]), par[A], par[B], par[C])
    return rho * above / (below * root), rho


@register_jitable
def pair_alpha(s2, par):
    """(stress s_ij, adjacency a_ij) of a pair at squared distance s2."""
    z, root = norm_alpha(s2, par)
    return stress_alpha(z, root, par)


@register_jitable
def pair_alpha_slope(s2, par):
    """d(s_ij)/d(s2), what the Hessian of V needs beside s_ij itself."""
    eps = par[EPS]
    z, g = sigma_norm(s2, eps), 1.0 + eps * s2
    return 0.5 * (phi_alpha_slope(z, par) - eps * phi_alpha(z, par) / sqrt(g)) / g


@register_jitable
def pair_alpha_adjacency_slope(s2, par):
    """d(a_ij)/d(s2), what the Jacobian of the consensus term needs where velocities differ."""
    r_alpha, x = par[R_ALPHA], sigma_norm(s2, par[EPS]) / par[R_ALPHA]
    return 0.5 * bump_slope(x, par[H]) / (r_alpha * sqrt(1.0 + par[EPS] * s2))


@register_jitable
def pair_alpha_potential(s2, par, panels):
    """ψ_α of a pair at squared distance s2."""
    return psi_alpha(sigma_norm(s2, par[EPS]), par, panels)


@register_jitable
def phi_beta(z, par):
    """φ_β(z) = ρ_h(z/d_β)(σ₁((z − d_β)/ℓ²) − 1)."""
    return bump(z / par[D_BETA], par[H]) * (sigma_1((z - par[D_BETA]) / par[BETA_AREA]) - 1.0)


@register_jitable
def psi_beta(z, par, panels):
    """ψ_β(z): closed form where ρ_h = 1, Chebyshev panels on the taper, 0 from d_β on."""
    if z >= par[D_BETA]:
        return 0.0
    if z < par[H] * par[D_BETA]:
        s = (z - par[D_BETA]) / par[BETA_AREA]
        return par[BETA_AREA] * sigma_norm(s**2, 1.0) - z + par[BETA_OFFSET]  # √(1+s²) − 1 − z: no cancellation
    return on_panels(z, panels)


@register_jitable
def adjacency_beta(z, par):
    """b_ik as a function of z = ‖q̂_ik − q_i‖_σ."""
    return bump(z / par[D_BETA], par[H])


@register_jitable
def pair_beta(s2, par):
    """(weight of q̂_ik − q_i, b_ik) of an agent and its β-agent at squared distance s2."""
    z = sigma_norm(s2, par[EPS])
    rho = bump(z / par[D_BETA], par[H])
    return rho * (sigma_1((z - par[D_BETA]) / par[BETA_AREA]) - 1.0) / sqrt(1.0 + par[EPS] * s2), rho
