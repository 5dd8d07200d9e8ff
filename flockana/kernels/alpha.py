"""The α- and β-pair laws as scalar functions of the squared distance.

Parameter vectors (float64): α = (ε, h, a, b, c, d_α, r_α, constant of ψ where ρ_h = 1, ψ_α(r_α), ℓ²),
β = (ε, h, d_β, constant of ψ where ρ_h = 1, ℓ²), ℓ the length that σ₁ counts in. A pair contributes
w (q_j − q_i) + ρ (p_j − p_i) to u_i.
"""

from __future__ import annotations

from math import sqrt

from numba.extending import register_jitable

from flockana.kernels.scalars import (
    bump,
    bump_slope,
    clenshaw,
    phi,
    phi_integral,
    phi_slope,
    sigma_1,
    sigma_norm,
)


@register_jitable
def phi_alpha(z, par):
    """φ_α(z) = ρ_h(z/r_α) φ((z − d_α)/ℓ²)."""
    return bump(z / par[6], par[1]) * phi((z - par[5]) / par[9], par[2], par[3], par[4])


@register_jitable
def phi_alpha_slope(z, par):
    """dφ_α/dz."""
    x, s = z / par[6], (z - par[5]) / par[9]
    a, b, c = par[2], par[3], par[4]
    return bump_slope(x, par[1]) / par[6] * phi(s, a, b, c) + bump(x, par[1]) * phi_slope(s, a, b, c) / par[9]


@register_jitable
def psi_alpha(z, par, panels):
    """ψ_α(z): closed form where ρ_h = 1, Chebyshev panels on the taper, constant from r_α on."""
    if z >= par[6]:
        return par[8]
    if z < par[1] * par[6]:
        return par[9] * phi_integral((z - par[5]) / par[9], par[2], par[3], par[4]) + par[7]
    return clenshaw(z, panels)


@register_jitable
def adjacency_alpha(z, par):
    """a_ij as a function of z = ‖q_j − q_i‖_σ."""
    return bump(z / par[6], par[1])


@register_jitable
def pair_alpha(s2, par):
    """(stress s_ij, adjacency a_ij) of a pair at squared distance s2."""
    z = sigma_norm(s2, par[0])
    rho = bump(z / par[6], par[1])
    return rho * phi((z - par[5]) / par[9], par[2], par[3], par[4]) / sqrt(1.0 + par[0] * s2), rho


@register_jitable
def pair_alpha_slope(s2, par):
    """d(s_ij)/d(s2), what the Hessian of V needs beside s_ij itself."""
    eps = par[0]
    z, g = sigma_norm(s2, eps), 1.0 + eps * s2
    return 0.5 * (phi_alpha_slope(z, par) - eps * phi_alpha(z, par) / sqrt(g)) / g


@register_jitable
def pair_alpha_adjacency_slope(s2, par):
    """d(a_ij)/d(s2), what the Jacobian of the consensus term needs where velocities differ."""
    return 0.5 * bump_slope(sigma_norm(s2, par[0]) / par[6], par[1]) / (par[6] * sqrt(1.0 + par[0] * s2))


@register_jitable
def pair_alpha_potential(s2, par, panels):
    """ψ_α of a pair at squared distance s2."""
    return psi_alpha(sigma_norm(s2, par[0]), par, panels)


@register_jitable
def phi_beta(z, par):
    """φ_β(z) = ρ_h(z/d_β)(σ₁((z − d_β)/ℓ²) − 1)."""
    return bump(z / par[2], par[1]) * (sigma_1((z - par[2]) / par[4]) - 1.0)


@register_jitable
def psi_beta(z, par, panels):
    """ψ_β(z): closed form where ρ_h = 1, Chebyshev panels on the taper, 0 from d_β on."""
    if z >= par[2]:
        return 0.0
    if z < par[1] * par[2]:
        return par[4] * sigma_norm(((z - par[2]) / par[4]) ** 2, 1.0) - z + par[3]  # √(1+s²) − 1 − z: no cancellation
    return clenshaw(z, panels)


@register_jitable
def adjacency_beta(z, par):
    """b_ik as a function of z = ‖q̂_ik − q_i‖_σ."""
    return bump(z / par[2], par[1])


@register_jitable
def pair_beta(s2, par):
    """(weight of q̂_ik − q_i, b_ik) of an agent and its β-agent at squared distance s2."""
    z = sigma_norm(s2, par[0])
    rho = bump(z / par[2], par[1])
    return rho * (sigma_1((z - par[2]) / par[4]) - 1.0) / sqrt(1.0 + par[0] * s2), rho
