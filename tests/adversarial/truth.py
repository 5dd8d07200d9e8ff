"""What is so, from the mathematics alone: nothing here calls the library's formulas, kernels or integrators.

Laws are read as plain parameters (d, r, ε, h, a, b, σ₁'s unit of length, the gains, the target's numbers).
"""

from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from math import cos, hypot, isqrt, pi, sqrt

import mpmath
import numpy as np
from scipy.integrate import solve_ivp

_DIGITS = 30


# --- the α-pair law -------------------------------------------------------------------------------------------------


def sigma(s, eps):
    """‖·‖_σ of a length."""
    return s * s / (sqrt(1.0 + eps * s * s) + 1.0)


def bump(z, h):
    """ρ_h."""
    return 1.0 if z < h else 0.5 * (1.0 + cos(pi * (z - h) / (1.0 - h))) if z < 1.0 else 0.0


def adjacency(s, alpha):
    """a_ij at a length s."""
    return bump(sigma(s, alpha.eps) / sigma(alpha.r, alpha.eps), alpha.h) if s < alpha.r else 0.0


def phi_alpha(s, alpha):
    """φ_α at a length s (not at its σ-norm)."""
    a, b = alpha.a, alpha.b
    y = (sigma(s, alpha.eps) - sigma(alpha.d, alpha.eps)) / alpha.unit**2 + (b - a) / sqrt(4.0 * a * b)
    return adjacency(s, alpha) * 0.5 * ((a + b) * y / sqrt(1.0 + y * y) + a - b)


def pull(s, alpha):
    """φ_α times |n_ij|: the force along the line, negative if it repels."""
    return phi_alpha(s, alpha) * s / sqrt(1.0 + alpha.eps * s * s)


@lru_cache(maxsize=4096)
def psi_alpha(s, alpha):
    """ψ_α at a length s, to 30 digits."""
    with mpmath.workdps(_DIGITS):
        mp = mpmath.mpf
        d, r, eps, h, a, b, unit = (mp(getattr(alpha, name)) for name in ("d", "r", "eps", "h", "a", "b", "unit"))

        def norm(x):
            return x * x / (mpmath.sqrt(1 + eps * x * x) + 1)

        z, z_d, z_r = norm(mp(s)), norm(d), norm(r)
        c = (b - a) / mpmath.sqrt(4 * a * b)

        def phi(x):
            y = (x - z_d) / unit**2 + c
            action = ((a + b) * y / mpmath.sqrt(1 + y * y) + a - b) / 2
            x = x / z_r
            return action if x < h else action * (1 + mpmath.cos(mpmath.pi * (x - h) / (1 - h))) / 2

        z = min(z, z_r)
        turns = [z_d + k * unit**2 * mp(2) ** j for k in (-1, 1) for j in range(-2, 12, 2)]  # where σ₁ bends
        inner = [x for x in [h * z_r, *turns] if min(z, z_d) < x < max(z, z_d)]
        return mpmath.quad(phi, sorted([z_d, *inner, z], reverse=z < z_d))


def far(alpha):
    """ψ_α(r_α): what each pair out of range adds to V."""
    return psi_alpha(alpha.r, alpha)


def c_star(law):
    """c1α ψ_α(0)."""
    return law.gains.c1_alpha * psi_alpha(0.0, law.alpha)


def structural_energy(law, q, p):
    """H(x, v), or H_λ(x, v) of Algorithm 2, of the floating-point numbers given, to 30 digits."""
    with mpmath.workdps(_DIGITS):
        q, p = ([[mpmath.mpf(float(x)) for x in row] for row in np.asarray(state)] for state in (q, p))
        n = len(q)

        def spread(rows):
            mean = [sum(column) / n for column in zip(*rows, strict=True)]
            return sum((x - c) ** 2 for row in rows for x, c in zip(row, mean, strict=True)) / 2

        total = spread(p)
        if law.gains.c1_alpha:
            for one, other in combinations(q, 2):
                length = mpmath.sqrt(sum((x - y) ** 2 for x, y in zip(one, other, strict=True)))
                total += law.gains.c1_alpha * psi_alpha(min(length, mpmath.mpf(law.alpha.r)), law.alpha)
        return total + (law.gains.c1_gamma * spread(q) if law.target is not None else 0)


def law_time(law):
    """√(d / largest force of a pair), or what the γ-agent sets where pairs exert none."""
    force = law.gains.c1_alpha * max(abs(pull(s, law.alpha)) for s in np.linspace(0.0, law.alpha.r, 400))
    if force > 0.0:
        return sqrt(law.alpha.d / force)
    return 1.0 / sqrt(law.gains.c1_gamma) if law.gains.c1_gamma else 1.0


# --- motion of a few agents -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Motion:
    """A reference solution in the moving frame: times, positions, velocities, shape (T, n, m)."""

    t: np.ndarray
    x: np.ndarray
    v: np.ndarray

    def distance(self, i, j):
        """Of a pair at the reference's own (dense) times."""
        return np.linalg.norm(self.x[:, j] - self.x[:, i], axis=1)

    def crossings(self):
        """Pairs of a flock on a line that change their order: they have coincided."""
        order = self.x[:, :, 0]
        pairs = combinations(range(order.shape[1]), 2)
        return {(i, j) for i, j in pairs if (np.diff(np.sign(order[:, j] - order[:, i])) != 0.0).any()}


def structural(law, x, v):
    """v' of Algorithms 1 and 2 in the moving frame: there the γ-agent's place does not matter."""
    g, alpha = law.gains, law.alpha
    u = -g.c1_gamma * x - g.c2_gamma * v if law.target is not None else np.zeros_like(x)
    for i, j in combinations(range(len(x)), 2):
        apart = x[j] - x[i]
        s = hypot(*apart)
        if s < alpha.r:
            spring = g.c1_alpha * phi_alpha(s, alpha) / sqrt(1.0 + alpha.eps * s * s)
            force = spring * apart + g.c2_alpha * adjacency(s, alpha) * (v[j] - v[i])
            u[i] += force
            u[j] -= force
    return u


def motion(law, q, p, until):
    """Integrate a few agents with a step that no encounter fits into: ½v² ≤ H bounds how far anyone gets in it."""
    q, p = np.asarray(q, float), np.asarray(p, float)
    n, m = q.shape
    x, v = q - q.mean(axis=0), p - p.mean(axis=0)
    fastest = 2.0 * sqrt(float(structural_energy(law, q, p)) or 1e-300)  # of a pair's closing speed
    step = 0.2 * law.alpha.d / fastest

    def rhs(_, y):
        v = y[n * m :].reshape(n, m)
        return np.concatenate([v.ravel(), structural(law, y[: n * m].reshape(n, m), v).ravel()])

    scale = np.concatenate([np.full(n * m, law.alpha.d), np.full(n * m, fastest)])
    start = np.concatenate([x.ravel(), v.ravel()])
    done = solve_ivp(rhs, (0.0, until), start, "DOP853", rtol=1e-12, atol=1e-14 * scale, max_step=step)
    y = done.y.T
    shape = (-1, n, m)
    return Motion(done.t, y[:, : n * m].reshape(shape), y[:, n * m :].reshape(shape))


def head_on(law, s0, speed, until):
    """Two agents on a line, at distance s0, closing in at this speed: when they meet, or None if not by then.

    The reduced problem s'' = −2 c1α F(s) − (2 c2α a(s) + c2γ) s' − c1γ s, from where the pair first exerts a force.
    """
    alpha, g = law.alpha, law.gains
    c1, c2 = (g.c1_gamma, g.c2_gamma) if law.target is not None else (0.0, 0.0)
    flown = 0.0
    if c1 == c2 == 0.0 and s0 > alpha.r:  # free until they are in range
        flown = (s0 - alpha.r) / speed if speed > 0.0 else until
        s0 = alpha.r
    if flown >= until:
        return None
    fastest = 2.0 * sqrt(float(structural_energy(law, [[0.0], [s0]], [[0.5 * speed], [-0.5 * speed]])))

    def rhs(_, y):
        s, rate = y
        drag = 2.0 * g.c2_alpha * adjacency(abs(s), alpha) + c2
        return rate, -2.0 * g.c1_alpha * (pull(s, alpha) if s > 0.0 else -pull(-s, alpha)) - drag * rate - c1 * s

    def meeting(_, y):
        return y[0]

    meeting.terminal = True
    done = solve_ivp(
        rhs,
        (0.0, until - flown),
        (s0, -speed),
        "DOP853",
        rtol=1e-12,
        atol=(1e-14 * alpha.d, 1e-14 * fastest),
        max_step=0.2 * alpha.d / fastest,
        events=meeting,
    )
    return flown + done.t[-1] if done.status == 1 else None


def harmonic(law, q, p, times):
    """x(t), v(t) in the moving frame of a flock without pair forces (c1α = c2α = 0) under Algorithm 2: closed form."""
    x, v = (np.asarray(state, float) - np.mean(state, axis=0) for state in (q, p))
    t = np.asarray(times, float)[:, None, None]
    fast, slow = np.roots([1.0, law.gains.c2_gamma, law.gains.c1_gamma]).astype(complex)
    if abs(fast - slow) > 1e-7 * abs(fast):
        grow = (np.exp(fast * t) - np.exp(slow * t)) / (fast - slow)
        hold = (fast * np.exp(slow * t) - slow * np.exp(fast * t)) / (fast - slow)
    else:
        grow, hold = t * np.exp(slow * t), (1.0 - slow * t) * np.exp(slow * t)
    return (hold * x + grow * v).real, (hold * v - grow * (law.gains.c1_gamma * x + law.gains.c2_gamma * v)).real


# --- equilibria of two agents ---------------------------------------------------------------------------------------


def balanced_length(law):
    """The stable distance of two agents under Algorithm 2: c1α φ_α |n| = −½ c1γ s, by bisection below d."""

    def force(s):
        return law.gains.c1_alpha * pull(s, law.alpha) + 0.5 * law.gains.c1_gamma * s

    grid = np.linspace(0.0, law.alpha.d, 2001)[1:]
    values = np.array([force(s) for s in grid])
    low = np.flatnonzero(values[:-1] < 0.0)
    if not low.size:
        return 0.0  # squeezed: nothing but coincidence is left
    a, b = grid[low[-1]], grid[low[-1] + 1]
    for _ in range(200):
        middle = 0.5 * (a + b)
        a, b = (middle, b) if force(middle) < 0.0 else (a, middle)
    return 0.5 * (a + b)


def pair_rates(law, s):
    """(spring, damping) of y'' = −spring y − damping y' for a pair's distance near its balanced length s."""
    h = 1e-6 * s
    slope = (pull(s + h, law.alpha) - pull(s - h, law.alpha)) / (2.0 * h)
    a = adjacency(s, law.alpha)
    gamma = law.target is not None
    spring = 2.0 * law.gains.c1_alpha * slope + (law.gains.c1_gamma if gamma else 0.0)
    return spring, 2.0 * law.gains.c2_alpha * a + (law.gains.c2_gamma if gamma else 0.0)


def decay_rate(spring, damping):
    """−Re of the slower root of s² + damping s + spring."""
    return float(-np.roots([1.0, damping, spring]).real.max())


# --- the centre of mass as a filter (E12) ---------------------------------------------------------------------------


def filter_gain(c1, c2, omega, factor=1.0):
    """|(c1 + factor jω c2) / (c1 − ω² + jω c2)|."""
    return hypot(c1, factor * omega * c2) / hypot(c1 - omega * omega, omega * c2)


# --- nets of lattices, in integers ----------------------------------------------------------------------------------


def lattice_links(cells):
    """Pairs of cells (a, b) of the triangular lattice at distance 1: a² + ab + b² = 1, in integers."""
    pairs = combinations(range(len(cells)), 2)
    steps = ((i, j, cells[j][0] - cells[i][0], cells[j][1] - cells[i][1]) for i, j in pairs)
    return [(i, j) for i, j, a, b in steps if a * a + a * b + b * b == 1]


def crossing_count(q, links):
    """Pairs of links of a plane net that cross properly, in exact arithmetic on the positions as given."""
    from fractions import Fraction

    points = [tuple(map(Fraction, map(float, row))) for row in q]

    def side(a, b, c):
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        return (area > 0) - (area < 0)

    count = 0
    for (a, b), (c, d) in combinations(links, 2):
        if len({a, b, c, d}) == 4:
            one, two, three, four = points[a], points[b], points[c], points[d]
            count += side(one, two, three) * side(one, two, four) < 0 > side(three, four, one) * side(three, four, two)
    return count


def harborth(n):
    """⌊3n − √(12n − 3)⌋ in integers."""
    root = isqrt(12 * n - 3)
    return 3 * n - root - (root * root < 12 * n - 3)


# --- averaged headings ----------------------------------------------------------------------------------------------


def two_headings(apart, one, other, step, steps):
    """(whether two agents come within 1 of each other in so many steps, whether that is plain, the room that says so).

    Where they meet the room is how far from 1 their distance is one step after, when they have one heading for ever,
    or 0 if that is beyond 1; where they do not, how much faster than by a hundredth of the step they part at the end.
    """
    tiny = 1e-12
    gap = np.array([apart, 0.0])
    slip = step * np.array([cos(other) - cos(one), np.sin(other) - np.sin(one)])
    sure = True
    for k in range(steps):
        distance = hypot(*(gap + k * slip))
        sure = sure and abs(distance - 1.0) > tiny
        if distance <= 1.0:
            after = hypot(*(gap + (k + 1) * slip))
            return True, sure, 1.0 - after
    end = gap + steps * slip
    distance = hypot(*end)
    parting = float(end @ slip) / distance / step
    return False, sure, min(distance - 1.0, parting) if distance > 1.0 else 0.0


# --- velocity consensus alone -----------------------------------------------------------------------------------------


def weight_left(start, strength, length, decay):
    """∫ K (1 + s²/ℓ²)^−β from a distance on, to 30 digits; infinite for β <= ½."""
    if decay <= 0.5:
        return float("inf")
    with mpmath.workdps(_DIGITS):
        y, beta = mpmath.mpf(start) / length, mpmath.mpf(decay)
        return float(strength * length * mpmath.quad(lambda s: (1 + s * s) ** -beta, [y, y + 1, y + 100, mpmath.inf]))
