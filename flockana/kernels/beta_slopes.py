"""Slopes of the β-pair law in the squared distance."""

from __future__ import annotations

from math import sqrt

from flockana.jit import register_jitable
from flockana.kernels.alpha import BETA_AREA, D_BETA, EPS, H
from flockana.kernels.scalars import bump, bump_slope, sigma_1, sigma_norm


@register_jitable
def adjacency_beta_slope(s2, par):
    """d(b_ik)/d(s²)."""
    z = sigma_norm(s2, par[EPS])
    return 0.5 * bump_slope(z / par[D_BETA], par[H]) / (par[D_BETA] * sqrt(1.0 + par[EPS] * s2))


@register_jitable
def pair_beta_slope(s2, par):
    """d/d(s²) of the weight of q̂_ik − q_i, what the Hessian of ψ_β needs beside the weight itself."""
    eps, h, d_beta, area = par[EPS], par[H], par[D_BETA], par[BETA_AREA]
    z, g = sigma_norm(s2, eps), 1.0 + eps * s2
    s, x = (z - d_beta) / area, z / d_beta
    phi = bump(x, h) * (sigma_1(s) - 1.0)
    slope = bump_slope(x, h) / d_beta * (sigma_1(s) - 1.0) + bump(x, h) / area / sqrt(1.0 + s * s) ** 3
    return 0.5 * (slope - eps * phi / sqrt(g)) / g
