"""Strict Lyapunov function in a basin, and the guaranteed exponential rate.

With w the displacement from the best aligned equilibrium and E = U − U* + ½‖v‖², let F = E + ε⟨w, v⟩. Half the squared
distance to the orbit is P = ½‖w‖² = ½‖x‖² + ½‖x*‖² − max_R ⟨x, R x*⟩: ∇P = w, and ∇²P <= 1, as a maximum of linear
functions is convex. So d⟨w, v⟩/dt <= ‖v‖² − ⟨w, ∇U⟩ − ⟨w, D v⟩, and with |⟨w, D v⟩| <= ½κM‖w‖² + ⟨v, D v⟩/(2κ)

    dF/dt <= −(1 − ε/2κ)⟨v, D v⟩ + ε‖v‖² − ε⟨∇U, w⟩ + ½εκM‖w‖².

⟨∇U, w⟩ >= θ(U − U*) + c‖w‖², c = θ s + (1 − θ)λ, is a mean of the two bounds of `shells` (λ curvature, s surplus), and
2|⟨w, v⟩| <= τ‖w‖² + ‖v‖²/τ. As U − U* >= ½λ‖w‖², dF/dt <= −αF if

    α <= εθ,   α(λ/2 + ετ/2) <= ε(θλ/2 + c − κM/2),   α(½ + ε/2τ) <= (1 − ε/2κ)μ − ε,   ε <= 2κ.

(`proofs/certified_basins.py` checks it.) And (1 − e)E <= F <= (1 + e)E, e = ε/√λ < 1: E falls at the rate α, distance
and speed at half of it.

D = c2γ + c2α L̂(x), and weights fall with the length while the eigenvalues of a Laplacian rise with its weights: the
second eigenvalue is at least that of the net with every pair at its longest, and none is above twice the largest degree
with every pair at its shortest.

The best choice is known but for ε. At given α and ε, θ is 1 or α/ε, as θλ/2 + c rises in it or falls. Then the second
inequality leaves X = θλ/2 + c − αλ/2ε for κM/2 + ατ/2, and the third wants μ/2κ + α/2τ small: by Cauchy and Schwarz it
is (√(μM) + α)²/4X at least, where τ = 2X/(√(μM) + α) and κ = τ√(μ/M). What it then leaves falls in α, and is bisected.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from flint import arb, arb_mat, fmpq

from flockana.base.value_checks import FloatArray
from flockana.certified.balls import ball, square
from flockana.certified.decimal_rounding import round_down, round_up
from flockana.certified.krawczyk import least_eigenvalue
from flockana.certified.structural_potential import Structure

_DIGITS, _CHOSEN = 3, 9  # digits of proved numbers, and of the parameters, whose differences can be small
_DAMPING_DIGITS = 4
_LEAST, _STEPS = 1e-6, 4000  # values of ε that are tried, from this share of the largest up, 0.4 % apart
_HALVINGS = 60


@dataclass(frozen=True)
class Bounds:
    """Bounds in the basin: curvature λ and surplus s of U, and the damping D with μ <= D <= M."""

    curvature: fmpq
    surplus: fmpq
    least: fmpq
    most: fmpq


@dataclass(frozen=True)
class Decay:
    """Parameters ε, θ, κ, τ of the Lyapunov function, half the proved rate α, and the factor (1 + e)/(1 − e)."""

    eps: fmpq
    theta: fmpq
    kappa: fmpq
    tau: fmpq
    rate: fmpq
    overshoot: fmpq


def damping(u: Structure, lengths: Mapping[tuple[int, int], arb], reach: fmpq) -> tuple[fmpq, fmpq]:
    """Return the weighted net's second eigenvalue, rounded down, and its largest degree, rounded up."""
    # So c2γ + c2α second <= D <= c2γ + 2 c2α degree on Σ v_i = 0.
    length_change = ball(reach)
    weakest = {pair: u.weight(square(distance + length_change)).lower() for pair, distance in lengths.items()}
    strongest = {pair: u.weight(square((distance - length_change).max(arb(0)))) for pair, distance in lengths.items()}
    degrees = [sum((w for pair, w in strongest.items() if i in pair), arb(0)) for i in range(u.n)]
    second_eigenvalue = _second_eigenvalue(u.n, weakest)
    floor = fmpq(0) if second_eigenvalue is None else round_down(second_eigenvalue, _DAMPING_DIGITS)
    return floor, round_up(max(degree.upper() for degree in degrees), _DAMPING_DIGITS)


def _second_eigenvalue(n: int, weights: Mapping[tuple[int, int], arb]) -> arb | None:
    """Return a positive lower bound of the Laplacian's second eigenvalue; None if none is certain."""
    rows = [[arb(1)] * n for _ in range(n)]  # 11ᵀ, whose eigenvalue n is above the second one, as all weights are <= 1
    for (i, j), weight in weights.items():
        for p, q, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
            rows[p][q] += sign * weight
    return least_eigenvalue(arb_mat(rows))


def rate_of(bounds: Bounds, eps: fmpq, theta: fmpq, kappa: fmpq, tau: fmpq) -> fmpq:
    """Return the largest decay rate α that the Lyapunov inequalities allow for given parameters; or 0."""
    curvature, lowest_value, maximum = bounds.curvature, bounds.least, bounds.most
    mixed_curvature = theta * bounds.surplus + (1 - theta) * curvature
    places = eps * (theta * curvature / 2 + mixed_curvature - kappa * maximum / 2) / (curvature / 2 + eps * tau / 2)
    speeds = ((1 - eps / (2 * kappa)) * lowest_value - eps) / (fmpq(1, 2) + eps / (2 * tau))
    if not 0 <= theta <= 1 or eps * eps >= curvature:
        return fmpq(0)  # where ε > 2κ, `speeds` is below 0
    return max(fmpq(0), min(eps * theta, places, speeds))


def decay(bounds: Bounds) -> Decay:
    """Return nearly the best ε, θ, κ and τ with e <= ½, proposed in floating point, and the proved rate."""
    widest = min(0.5 * float(bounds.curvature) ** 0.5, float(bounds.least))  # beyond, e > ½ or no speed falls
    eps = widest * np.geomspace(_LEAST, 1.0, _STEPS)
    low, high = np.zeros_like(eps), np.minimum(eps, 2.0 * float(bounds.least))
    for _ in range(_HALVINGS):
        midpoint = 0.5 * (low + high)
        left = _left(bounds, eps, midpoint) > 0.0
        low, high = np.where(left, midpoint, low), np.where(left, high, midpoint)
    best_index = int(np.argmax(low))
    proposal = (eps[best_index], *(x[best_index] for x in _others(bounds, eps, low)))
    epsilon, theta, kappa, tau = (round_down(arb(float(x)), _CHOSEN) for x in proposal)
    rate = round_down(rate_of(bounds, epsilon, theta, kappa, tau) / 2, _DIGITS)
    share = ball(epsilon) / ball(bounds.curvature).sqrt()
    return Decay(epsilon, theta, kappa, tau, rate, round_up((1 + share) / (1 - share), _DIGITS))


def _others(bounds: Bounds, eps: FloatArray, alpha: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the best Lyapunov parameters θ, κ and τ for given ε and α; κ, τ <= 0 if α is too large."""
    curvature, surplus, lowest, maximum = map(float, (bounds.curvature, bounds.surplus, bounds.least, bounds.most))
    theta = np.ones_like(eps) if surplus >= 0.5 * curvature else alpha / eps
    margin = curvature + theta * (surplus - 0.5 * curvature) - 0.5 * alpha * curvature / eps
    tau = 2.0 * margin / ((lowest * maximum) ** 0.5 + alpha)
    return theta, tau * (lowest / maximum) ** 0.5, tau


def _left(bounds: Bounds, eps: FloatArray, alpha: FloatArray) -> FloatArray:
    """Return the slack of the Lyapunov inequality in the velocities; negative if the inequality fails."""
    _, kappa, tau = _others(bounds, eps, alpha)
    lowest_value, is_sound = float(bounds.least), tau > 0.0
    cost = 1.0 + 0.5 * lowest_value / np.where(is_sound, kappa, 1.0) + 0.5 * alpha / np.where(is_sound, tau, 1.0)
    return np.where(is_sound, lowest_value - 0.5 * alpha - eps * cost, -1.0)
