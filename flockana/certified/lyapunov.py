"""A strict Lyapunov function in a basin, and the exponential rate that it guarantees.

With w the displacement from the best aligned equilibrium and E = U − U* + ½‖v‖², let F = E + ε⟨w, v⟩. Half the squared
distance to the orbit is P = ½‖w‖² = ½‖x‖² + ½‖x*‖² − max_R ⟨x, R x*⟩: ∇P = w, and ∇²P <= 1, as a maximum of linear
functions is convex. So d⟨w, v⟩/dt <= ‖v‖² − ⟨w, ∇U⟩ − ⟨w, D v⟩, and with |⟨w, D v⟩| <= ½κM‖w‖² + ⟨v, D v⟩/(2κ)

    dF/dt <= −(1 − ε/2κ)⟨v, D v⟩ + ε‖v‖² − ε⟨∇U, w⟩ + ½εκM‖w‖².

⟨∇U, w⟩ >= θ(U − U*) + c‖w‖², c = θ s + (1 − θ)λ, is a mean of the two bounds of `shells` (λ curvature, s surplus), and
2|⟨w, v⟩| <= τ‖w‖² + ‖v‖²/τ. As U − U* >= ½λ‖w‖², dF/dt <= −αF if

    α <= εθ,   α(λ/2 + ετ/2) <= ε(θλ/2 + c − κM/2),   α(½ + ε/2τ) <= (1 − ε/2κ)μ − ε,   ε <= 2κ.

(`proofs/certified_basins.py` checks it.) And (1 − e)E <= F <= (1 + e)E, e = ε/√λ < 1: E falls at the rate α, distance
and speed at half of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from flint import arb, fmpq

from flockana.certified.decimals import floored, raised
from flockana.certified.intervals import ball

_DIGITS = 3
_STEPS = 13
_ROUNDS = 12


@dataclass(frozen=True)
class Bounds:
    """What is known of U and of the damping in the basin: curvature λ, surplus s, damping μ <= D <= M."""

    curvature: fmpq
    surplus: fmpq
    least: fmpq
    most: fmpq


@dataclass(frozen=True)
class Decay:
    """ε, θ, κ and τ, and with them half the proved rate α, rounded down, and (1 + e)/(1 − e), rounded up."""

    eps: fmpq
    theta: fmpq
    kappa: fmpq
    tau: fmpq
    rate: fmpq
    overshoot: fmpq


def rate_of(bounds: Bounds, eps: fmpq, theta: fmpq, kappa: fmpq, tau: fmpq) -> fmpq:
    """The largest α of the inequalities; 0 if there is none above it. Exact."""
    curvature, least, most = bounds.curvature, bounds.least, bounds.most
    mixed = theta * bounds.surplus + (1 - theta) * curvature
    places = eps * (theta * curvature / 2 + mixed - kappa * most / 2) / (curvature / 2 + eps * tau / 2)
    speeds = ((1 - eps / (2 * kappa)) * least - eps) / (fmpq(1, 2) + eps / (2 * tau))
    if eps > 2 * kappa or not 0 <= theta <= 1 or eps * eps >= curvature:
        return fmpq(0)
    return max(fmpq(0), min(eps * theta, places, speeds))


def decay(bounds: Bounds) -> Decay:
    """A good choice of ε, θ, κ and τ, by a search in floating point, and what it proves.

    Examples
    --------
    >>> of_spring = decay(Bounds(fmpq(1), fmpq(1, 2), fmpq(1), fmpq(1)))  # x'' + x' + x = 0: x falls like exp(-t/2)
    >>> 0.15 < float(of_spring.rate) < 0.5
    True
    """
    curvature = float(bounds.curvature)
    scales = np.array([min(float(bounds.least), curvature**0.5), 0.5, curvature / float(bounds.most), curvature**0.5])
    best, spread = scales * [0.25, 0.5, 0.25, 1.0], 4.0
    for _ in range(_ROUNDS):  # of coordinate pairs: ε with κ, then θ with τ, on ever finer grids
        for pair in ((0, 2), (1, 3), (0, 1), (2, 3)):
            best = _improved(bounds, best, pair, spread)
        spread = 1.0 + (spread - 1.0) * 0.6
    eps, theta, kappa, tau = (floored(arb(float(x)), _DIGITS) for x in best)
    rate = floored(rate_of(bounds, eps, theta, kappa, tau) / 2, _DIGITS)
    share = ball(eps) / ball(bounds.curvature).sqrt()
    return Decay(eps, theta, kappa, tau, rate, raised((1 + share) / (1 - share), _DIGITS))


def _improved(bounds: Bounds, at: np.ndarray, pair: tuple[int, int], spread: float) -> np.ndarray:
    """The best of a grid in two of the four, by factors."""
    factors = spread ** np.linspace(-1.0, 1.0, _STEPS)
    tried = np.tile(at, (_STEPS, _STEPS, 1))
    tried[..., pair[0]] *= factors[:, None]
    tried[..., pair[1]] *= factors
    tried[..., 1] = np.minimum(tried[..., 1], 1.0)
    tried[..., 0] = np.minimum(tried[..., 0], 0.5 * float(bounds.curvature) ** 0.5)
    values = _rates(bounds, *np.moveaxis(tried, -1, 0))
    found: np.ndarray = tried[np.unravel_index(int(np.argmax(values)), values.shape)]
    return found


def _rates(bounds: Bounds, eps: np.ndarray, theta: np.ndarray, kappa: np.ndarray, tau: np.ndarray) -> np.ndarray:
    """`rate_of` in floating point, not cut off at 0."""
    curvature, surplus, least, most = map(float, (bounds.curvature, bounds.surplus, bounds.least, bounds.most))
    mixed = theta * surplus + (1.0 - theta) * curvature
    places = eps * (0.5 * theta * curvature + mixed - 0.5 * kappa * most) / (0.5 * curvature + 0.5 * eps * tau)
    speeds = ((1.0 - 0.5 * eps / kappa) * least - eps) / (0.5 + 0.5 * eps / tau)
    found: np.ndarray = np.minimum(np.minimum(eps * theta, places), speeds)
    return found
