"""The potentials of the laws once more, from their formulas, for real and complex numbers.

Pair potentials are integrals of the printed forces by Gauss and Legendre; nothing is shared with the kernels, nor with
the expressions that the library itself gives to CasADi. Agents are at rest: what damps says nothing.
"""

from itertools import combinations

import numpy as np

NODES, WEIGHTS = (x.tolist() for x in np.polynomial.legendre.leggauss(20))
PANELS = 8


def choose(a, b, below, otherwise):
    """One value if a < b, the other if not; complex numbers are compared by their real parts."""
    return np.where(np.real(a) < np.real(b), below, otherwise)


def integral(function, start, end):
    width = (end - start) / PANELS
    total = 0.0
    for k in range(PANELS):
        middle = start + (k + 0.5) * width
        total = total + sum(w * function(middle + 0.5 * width * x) for x, w in zip(NODES, WEIGHTS, strict=True))
    return 0.5 * width * total


def between(x, low, high):
    x = choose(x, low, low, x)
    return choose(x, high, x, high)


def sigma(square, eps):
    return (np.sqrt(1.0 + eps * square) - 1.0) / eps


def psi_alpha(square, pair):
    """∫ φ_α from d_α to ‖z‖_σ; φ_α = ρ_h φ, and ρ_h is 1 up to h r_α and (1 + cos)/2 from there to r_α."""
    d, r, c = sigma(pair.d**2, pair.eps), sigma(pair.r**2, pair.eps), (pair.b - pair.a)
    c = abs(c) / np.sqrt(4.0 * pair.a * pair.b)

    def phi(z):
        s = z - d + c
        return 0.5 * ((pair.a + pair.b) * s / np.sqrt(1.0 + s * s) + pair.a - pair.b)

    def tapered(z):
        return 0.5 * (1.0 + np.cos(np.pi * (z / r - pair.h) / (1.0 - pair.h))) * phi(z)

    z, knee = sigma(square, pair.eps), pair.h * r
    inner = integral(phi, min(d, knee), between(z, 0.0, knee))
    return inner + integral(tapered, max(d, knee), between(z, knee, r))


def psi_beta(square, beta):
    """∫ φ_β from d_β; φ_β = ρ_h(z/d_β) (σ₁(z − d_β) − 1)."""
    d = sigma(beta.d**2, beta.eps)

    def phi(z):
        return (z - d) / np.sqrt(1.0 + (z - d) * (z - d)) - 1.0

    def tapered(z):
        return 0.5 * (1.0 + np.cos(np.pi * (z / d - beta.h) / (1.0 - beta.h))) * phi(z)

    z, knee = sigma(square, beta.eps), beta.h * d
    return integral(phi, knee, between(z, 0.0, knee)) + integral(tapered, d, between(z, knee, d))


def dead_zone(square, pair):
    """∫ F from d₁, of the printed force, jumps and all; constant from r on."""
    low, high, s = pair.r_b - pair.delta, pair.r_b + pair.delta, np.sqrt(square)

    def drawn(x):
        return x / np.sqrt(1.0 + pair.eta * x * x)

    near = integral(lambda x: -(2.0 * pair.k_r / (x * x) + pair.k_delta) * drawn(x), low, between(s, 0.0, low))
    far = integral(
        lambda x: (2.0 * pair.k_r / ((pair.r_d - x) * (pair.r_d - x)) + pair.k_delta) * drawn(x),
        high,
        between(s, high, pair.r),
    )
    least = between(s, 0.0, pair.r)
    return near + far + 0.5 * pair.k1 * least * least


def logarithmic(square, potential, reach):
    square = choose(square, reach**2, square, reach**2)
    x = potential.d**2 / square
    return potential.strength * (x - 1.0 - np.log(x))


def tension(square, law):
    return law.k * square / (law.r - np.sqrt(square))


def over_pairs(q, potential, pairs=None):
    every = combinations(range(len(q)), 2) if pairs is None else pairs
    squares = [sum((a - b) * (a - b) for a, b in zip(q[i], q[j], strict=True)) for i, j in every]
    return potential(np.array(squares)).sum()


def pulled(q, gain):
    """Half the squared distance from the origin, where each γ-agent, copy and leader of these laws rests."""
    return 0.5 * gain * sum(x * x for place in q for x in place)


def drawn(q, gain):
    """The bounded pull of Algorithm 3, −c1γ σ₁, to the same place."""
    return gain * sum(np.sqrt(1.0 + sum(x * x for x in place)) - 1.0 for place in q)


def walled(q, law):
    """One ball: the β-agent is the nearest point of its surface."""
    (ball,) = law.obstacles
    away = [[x - y for x, y in zip(place, ball.centre, strict=True)] for place in q]
    clearances = [np.sqrt(sum(x * x for x in place)) - ball.radius for place in away]
    return law.gains.c1_beta * psi_beta(np.square(clearances), law.beta).sum()
