"""Truths of maps, weights, targets, output times and recordings by algebra, and what verdicts may say beside them.

Nothing here asks the library what is so: orbits of a map are mpmath's to 60 digits from the printed formulas, a force's
period is an integral of its own, and the rest is decided by how a case is built.
"""

from itertools import pairwise
from math import sqrt

import mpmath
import numpy as np
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

import flockana as fl
from flockana import (
    Algorithm1,
    Algorithm2,
    CallableTarget,
    Gains,
    Recording,
    SemiImplicitEuler,
    StaticTarget,
    Tolerances,
)
from flockana.theorems import verify
from tests.adversarial.cases import effort
from tests.adversarial.truth import psi_alpha

ALPHA = fl.AlphaInteraction()
_DT = 0.0625


def never(verdict, claim, truth):
    """Fail if a claim is decided against what is so, unless it says what it assumes; nothing decided is no fault."""
    made = verdict.claim(claim)
    assumed = made.about == "run" and any(need.status == "assumed" for need in made.needs)
    wrong = "refuted" if truth else "verified"
    assert made.status != wrong or (wrong == "verified" and assumed and "assumed:" in made.detail), (claim, truth, made)


# --- maps under relabelling and mirroring ---------------------------------------------------------------------------


def exact_pull(s):
    """Force along the line between two agents at a length s: φ_α times |n_ij|, in mpmath."""
    mp = mpmath.mpf
    d, r, eps, h, a, b = (mp(getattr(ALPHA, name)) for name in ("d", "r", "eps", "h", "a", "b"))
    if s >= r:
        return mp(0)

    def norm(x):
        return x * x / (mpmath.sqrt(1 + eps * x * x) + 1)

    y = norm(s) - norm(d) + (b - a) / mpmath.sqrt(4 * a * b)
    x = norm(s) / norm(r)
    bump = mp(1) if x < h else (1 + mpmath.cos(mpmath.pi * (x - h) / (1 - h))) / 2
    return bump * ((a + b) * y / mpmath.sqrt(1 + y * y) + a - b) / 2 * s / mpmath.sqrt(1 + eps * s * s)


def orbit_components(q, p, steps):
    """Components of the net after each step of the map p += dt u, q += dt p on a line without drag."""
    with mpmath.workdps(60):
        q, p, dt = [mpmath.mpf(float(x)) for x in q], [mpmath.mpf(float(x)) for x in p], mpmath.mpf(_DT)
        c1, pull = mpmath.mpf(30.0), mpmath.mpf(1.1)
        counts = []
        for _ in range(steps):
            u = [-pull * x for x in q]
            for i in range(len(q)):
                for j in range(i):
                    gap = q[j] - q[i]
                    force = c1 * exact_pull(abs(gap)) * mpmath.sign(gap)
                    u[i], u[j] = u[i] + force, u[j] - force
            p = [x + dt * f for x, f in zip(p, u, strict=True)]
            q = [x + dt * v for x, v in zip(q, p, strict=True)]
            line = sorted(q)
            counts.append(1 + sum(b - a >= mpmath.mpf(ALPHA.r) for a, b in pairwise(line)))
    return counts


MAPS = st.tuples(st.integers(3, 4), st.integers(20, 120), st.integers(0, 2**32 - 1))


def check_map(case):
    """The last two steps of a chaotic map, in another order and mirrored: no verdict against the exact orbit."""
    n, steps, seed = case
    rng = np.random.default_rng(seed)
    q = np.cumsum(rng.uniform(4.0, 9.0, n)).round(4)
    q, p = q - q.mean(), rng.uniform(-6.0, 6.0, n).round(4)
    truth = max(orbit_components(q, p, steps)[-2:]) == 1
    gains = Gains(c1_alpha=30.0, c2_alpha=0.0, c1_gamma=1.1, c2_gamma=0.0)
    law = SemiImplicitEuler(Algorithm2(gains=gains, target=StaticTarget((0.0,))), _DT)
    late = Tolerances(settle=(steps - 1.5) / steps)
    for order, side in ((np.arange(n), 1.0), (rng.permutation(n), -1.0)):
        start = side * q[order, None], side * p[order, None]
        verdict = verify(
            "alpha-flocking-strict", law=law, q0=start[0], p0=start[1], t_span=(0.0, steps * _DT), tolerances=late
        )
        never(verdict, "flock", truth)


# --- weights with a feature that steps may leap over ----------------------------------------------------------------

WEIGHTS = st.tuples(
    st.sampled_from([-2.0, 2.0]),
    st.floats(4.5, 6.5),
    st.floats(-6.0, -1.0),
    st.floats(0.5, 5.0),
    st.sampled_from([0, 1]),
)


def part_through(law, hump, speed, loose):
    """Let two agents part through the hump or hole of what averages their velocities: H rises in a hole alone."""
    start = [[0.0], [4.0]], [[-speed], [speed]]
    run = fl.simulate(law, *start, (0.0, 4.0 / speed), **({"rtol": 1e-4} if loose else {}))
    assert float(run.q[-1, 1, 0] - run.q[-1, 0, 0]) > 7.0  # it went through
    never(verify("energy", run), "rate", hump > 0.0)


def uneven_pair(hump, at, width):
    """A pair law that hardly pulls, whose adjacency has a hump or a hole of a width at a distance."""
    return fl.pair_law(
        "0.001*(1 - s/r)**3*s**2/d**2",
        adjacency="(1 - s/r)**2*(1 + A*exp(-((s - c)/w)**2))",
        range=9.0,
        length=3.0,
        parameters={"A": hump, "c": at, "w": 10.0**width},
    )


def check_weight(case):
    """The adjacency of the pair law itself has the hump or hole."""
    hump, at, width, speed, loose = case
    part_through(Algorithm1(uneven_pair(hump, at, width), Gains(c1_alpha=1.0, c2_alpha=1e-3)), hump, speed, loose)


def check_net(case):
    """The net of velocity consensus has it, beside a pair law with an adjacency of its own that is not read."""
    hump, at, width, speed, loose = case
    even = fl.pair_law("0.001*(1 - s/r)**3*s**2/d**2", adjacency="(1 - s/r)**2", range=9.0, length=3.0)
    law = fl.compose(pair=even, gradient=1.0, consensus=1e-3, net=uneven_pair(hump, at, width))
    part_through(law, hump, speed, loose)


# --- targets that report another velocity, for a moment -------------------------------------------------------------

TARGETS = st.tuples(st.floats(0.2, 2.5), st.floats(-4.0, -0.5), st.floats(0.5, 20.0), st.booleans())


def check_target(case):
    """Two agents at rest, one of which is told a velocity for a moment, start to move: their energy then rises."""
    since, width, size, moving = case
    end = since + 10.0**width

    def told(t):
        return ((0.0,), (size if since <= t <= end and moving else 0.0,))

    law = Algorithm2(gains=Gains(c1_gamma=(2.0, 0.0), c2_gamma=(2.0, 0.0)), target=CallableTarget(told))
    run = fl.simulate(law, [[0.0], [7.0]], [[0.0], [0.0]], (0.0, 3.0))
    for name, claim in (("energy", "rate"), ("su-informed", "energy")):
        never(verify(name, run), claim, not moving)


# --- output times chosen against a condition ------------------------------------------------------------------------

TIMES = st.tuples(st.floats(6.6, 6.9), st.integers(3, 8))


def check_times(case):
    """An undamped pair seen whenever it stands still: its velocities do not match, and it stays together."""
    shortest, count = case
    level = float(psi_alpha(shortest, ALPHA))
    longest = brentq(lambda s: float(psi_alpha(s, ALPHA)) - level, 7.0, 8.39)
    middle, half = 0.5 * (longest + shortest), 0.5 * (longest - shortest)

    def slowness(angle):  # ds/v with s = middle + half sin(angle), v² = 4 (ψ₀ − ψ) c1α
        s = middle + half * np.sin(angle)
        return half * np.cos(angle) / sqrt(max(4.0 * 30.0 * (level - float(psi_alpha(float(s), ALPHA))), 1e-300))

    nodes, weights = np.polynomial.legendre.leggauss(40)
    swing = float(sum(w * slowness(0.5 * np.pi * x) for x, w in zip(nodes, weights, strict=True)) * 0.5 * np.pi)
    law = Algorithm1(gains=Gains(c2_alpha=0.0))
    start = [[-0.5 * shortest], [0.5 * shortest]], [[0.0], [0.0]]
    run = fl.simulate(law, *start, (0.0, count * swing), t_eval=swing * np.arange(count + 1.0))
    assert np.abs(run.p).max() < 0.05 * half / swing  # it stands still whenever it is seen
    verdict = verify("alpha-flocking-strict", run)
    never(verdict, "mismatch", False)
    never(verdict, "flock", True)


# --- recordings at the edge of their bounds -------------------------------------------------------------------------

RECORDINGS = st.tuples(st.floats(-8.0, -1.0), st.floats(-3.0, 0.5), st.booleans(), st.integers(0, 2**32 - 1))


def check_recording(case):
    """Two agents at rest just inside or outside the range, recorded on the other side within the stated bound."""
    gap, share, inside, seed = case
    off = 10.0**gap
    distance = ALPHA.r * (1.0 - off if inside else 1.0 + off)
    bound, rng = ALPHA.r * off * 10.0**share, np.random.default_rng(seed)
    t, true = np.arange(8.0), np.array([[0.0, 0.0], [distance, 0.0]])
    errors = rng.normal(size=(8, 2, 2))
    errors *= rng.choice([0.0, 0.999], (8, 2, 1)) * bound / np.linalg.norm(errors, axis=2, keepdims=True)
    errors[0] = 0.999 * bound * np.array([[-1.0, 0.0], [1.0, 0.0]]) * (1.0 if inside else -1.0)
    rec = Recording(t, true + errors, np.zeros((8, 2, 2)), bound=bound)
    never(verify("alpha-flocking-strict", rec, law=Algorithm1()), "flock", inside)


def hold(road, share):
    """Draw a share of the profile's examples of one kind; each is reported as it was drawn."""
    cases, check = ROADS[road]
    settings(effort(share), phases=[Phase.generate])(given(cases)(check))()


ROADS = {
    "maps": (MAPS, check_map),
    "weights": (WEIGHTS, check_weight),
    "nets": (WEIGHTS, check_net),
    "targets": (TARGETS, check_target),
    "times": (TIMES, check_times),
    "recordings": (RECORDINGS, check_recording),
}
