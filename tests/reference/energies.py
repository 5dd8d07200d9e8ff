"""The potentials of the laws once more, from their formulas, for real and complex numbers and for CasADi's symbols.

Pair potentials are integrals of the printed forces by Gauss and Legendre; nothing is shared with the kernels, nor with
the expressions that the library itself gives to CasADi. Agents are at rest: what damps says nothing.
"""

from itertools import combinations

import casadi as ca
import numpy as np

NODES, WEIGHTS = (x.tolist() for x in np.polynomial.legendre.leggauss(20))
PANELS = 8


class Numbers:
    """Real or complex numbers, compared by their real parts."""

    sqrt, cos, log = np.sqrt, np.cos, np.log

    @staticmethod
    def choose(a, b, below, otherwise):
        """One value if a < b, the other if not."""
        return np.where(np.real(a) < np.real(b), below, otherwise)

    @staticmethod
    def summed(potential, squares):
        """The sum of a potential over squared distances."""
        return potential(np.array(squares)).sum()


class Symbols:
    """CasADi's expressions."""

    sqrt, cos, log = ca.sqrt, ca.cos, ca.log

    @staticmethod
    def choose(a, b, below, otherwise):
        return ca.if_else(a < b, below, otherwise)

    @staticmethod
    def summed(potential, squares):
        x = ca.SX.sym("x")
        once = ca.Function("once", [x], [potential(x)])
        return sum(once(square) for square in squares)


def integral(function, start, end):
    width = (end - start) / PANELS
    total = 0.0
    for k in range(PANELS):
        middle = start + (k + 0.5) * width
        total = total + sum(w * function(middle + 0.5 * width * x) for x, w in zip(NODES, WEIGHTS, strict=True))
    return 0.5 * width * total


def between(x, low, high, on):
    x = on.choose(x, low, low, x)
    return on.choose(x, high, x, high)


def sigma(square, eps, on):
    return (on.sqrt(1.0 + eps * square) - 1.0) / eps


def psi_alpha(square, pair, on):
    """∫ φ_α from d_α to ‖z‖_σ; φ_α = ρ_h φ, and ρ_h is 1 up to h r_α and (1 + cos)/2 from there to r_α."""
    d, r, c = sigma(pair.d**2, pair.eps, Numbers), sigma(pair.r**2, pair.eps, Numbers), (pair.b - pair.a)
    c = abs(c) / np.sqrt(4.0 * pair.a * pair.b)

    def phi(z):
        s = z - d + c
        return 0.5 * ((pair.a + pair.b) * s / on.sqrt(1.0 + s * s) + pair.a - pair.b)

    def tapered(z):
        return 0.5 * (1.0 + on.cos(np.pi * (z / r - pair.h) / (1.0 - pair.h))) * phi(z)

    z, knee = sigma(square, pair.eps, on), pair.h * r
    inner = integral(phi, min(d, knee), between(z, 0.0, knee, on))
    return inner + integral(tapered, max(d, knee), between(z, knee, r, on))


def psi_beta(square, beta, on):
    """∫ φ_β from d_β; φ_β = ρ_h(z/d_β) (σ₁(z − d_β) − 1)."""
    d = sigma(beta.d**2, beta.eps, Numbers)

    def phi(z):
        return (z - d) / on.sqrt(1.0 + (z - d) * (z - d)) - 1.0

    def tapered(z):
        return 0.5 * (1.0 + on.cos(np.pi * (z / d - beta.h) / (1.0 - beta.h))) * phi(z)

    z, knee = sigma(square, beta.eps, on), beta.h * d
    return integral(phi, knee, between(z, 0.0, knee, on)) + integral(tapered, d, between(z, knee, d, on))


def dead_zone(square, pair, on):
    """∫ F from d₁, of the printed force, jumps and all; constant from r on."""
    low, high, s = pair.r_b - pair.delta, pair.r_b + pair.delta, on.sqrt(square)

    def drawn(x):
        return x / on.sqrt(1.0 + pair.eta * x * x)

    near = integral(lambda x: -(2.0 * pair.k_r / (x * x) + pair.k_delta) * drawn(x), low, between(s, 0.0, low, on))
    far = integral(
        lambda x: (2.0 * pair.k_r / ((pair.r_d - x) * (pair.r_d - x)) + pair.k_delta) * drawn(x),
        high,
        between(s, high, pair.r, on),
    )
    least = between(s, 0.0, pair.r, on)
    return near + far + 0.5 * pair.k1 * least * least


def logarithmic(square, potential, reach, on):
    square = on.choose(square, reach**2, square, reach**2)
    x = potential.d**2 / square
    return potential.strength * (x - 1.0 - on.log(x))


def tension(square, law, on):
    return law.k * square / (law.r - on.sqrt(square))


def over_pairs(q, potential, on, pairs=None):
    every = combinations(range(len(q)), 2) if pairs is None else pairs
    return on.summed(potential, [sum((a - b) * (a - b) for a, b in zip(q[i], q[j], strict=True)) for i, j in every])


def pulled(q, gain):
    """Half the squared distance from the origin, where each γ-agent, copy and leader of these laws rests."""
    return 0.5 * gain * sum(x * x for place in q for x in place)


def drawn(q, gain, on):
    """The bounded pull of Algorithm 3, −c1γ σ₁, to the same place."""
    return gain * sum(on.sqrt(1.0 + sum(x * x for x in place)) - 1.0 for place in q)


def walled(q, law, on):
    """One ball: the β-agent is the nearest point of its surface."""
    (ball,) = law.obstacles
    away = [[x - y for x, y in zip(place, ball.centre, strict=True)] for place in q]
    clearances = [on.sqrt(sum(x * x for x in place)) - ball.radius for place in away]
    return law.gains.c1_beta * on.summed(lambda s2: psi_beta(s2, law.beta, on), [s * s for s in clearances])
