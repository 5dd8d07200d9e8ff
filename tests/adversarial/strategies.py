"""Laws, starts and ways to integrate them: extreme, but valid. Sizes are pure numbers times the law's own scales."""

from math import sqrt

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from flockana import CallableTarget, CircleTarget, LinearTarget, RescaledVelocity, SineTarget, StaticTarget
from flockana.base.errors import ArgumentError
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from tests.adversarial import truth
from tests.adversarial.cases import Case

seeds = st.integers(0, 2**32 - 1)
plain = st.just({})  # as simulate does it by itself


def powers(low, high):
    """10^x with x between two exponents."""
    return st.floats(low, high).map(lambda x: 10.0**x)


@st.composite
def alphas(draw):
    """A pair law: micrometres to kilometres, σ-norms from quadratic to linear, bumps from steep to flat."""
    if draw(st.booleans()):
        return AlphaInteraction()
    d = draw(st.sampled_from((7.0, 1.0, 15.0, 0.02, 7e-6, 4e3)))
    unit = draw(st.sampled_from((1.0, d / 7.0)))
    b = draw(st.sampled_from((5.0, 1.0, 1e-3, 5e4)))
    eps = draw(powers(-3.0, 3.0)) / d**2 if draw(st.booleans()) else 0.1
    h, a = draw(st.sampled_from((0.2, 0.01, 0.5, 0.9, 0.99))), b * draw(st.sampled_from((1.0, 0.5, 0.01)))
    r = d * draw(st.sampled_from((1.05, 1.2, sqrt(2.0), 1.7, 2.5)))
    try:
        return AlphaInteraction(d=d, r=r, eps=eps, h=h, a=a, b=b, unit=unit)
    except ArgumentError:  # a σ-norm that floating point cannot resolve
        assume(False)


@st.composite
def pair_laws(draw, *, damping=(0.0, 1e-3, 0.3, 2.0), pulls=(0.0, 0.01, 1.0), algorithm=None, alpha=None):
    """Algorithm 1 or 2 with gains in units of the law's own time, so that no run is stiffer than its parameters say."""
    alpha = draw(alphas()) if alpha is None else alpha
    c1 = draw(st.sampled_from((1.0, 30.0, 1e-4, 1e6)))
    rate = 1.0 / truth.law_time(Algorithm1(alpha, Gains(c1_alpha=c1)))
    c2, pull, drag = (draw(st.sampled_from(some)) for some in (damping, pulls, damping))
    gains = Gains(c1_alpha=c1, c2_alpha=c2 * rate, c1_gamma=pull * rate**2, c2_gamma=drag * rate)
    if (algorithm or draw(st.integers(1, 2))) == 1:
        return Algorithm1(alpha, gains)
    return Algorithm2(alpha, gains, StaticTarget((0.0,)))


def targets(m, length, time):
    """γ-agents: at rest, moving, inconsistent, moving between samples only."""
    here, away = (0.3 * length,) * m, (length / time,) * m
    f = 1.0 / (5.0 * time)

    def jittering(t):
        return [length * np.sin(2.0 * np.pi * t / time)] * m, [0.0] * m

    line, sine = LinearTarget(here, away), SineTarget(here, away, 3.0 * length, f, axis=m - 1)
    some = [StaticTarget(here), StaticTarget(here, away), line, RescaledVelocity(line, 0.5), sine]
    some.append(CallableTarget(jittering, time))
    if m > 1:
        some += [CircleTarget(here, 3.0 * length, f), RescaledVelocity(CircleTarget(here, 2.0 * length, f), -1.0)]
    return st.sampled_from(some)


def aimed(law, target):
    """The law with a γ-agent of the right dimension, if it has one."""
    return Algorithm2(law.alpha, law.gains, target) if isinstance(law, Algorithm2) else law


@st.composite
def starts(draw, length, speed, *, n=None, m=None):
    """A flock of a few agents: at random, on a lattice, collinear, coincident, at rest, fast, in two far-off groups."""
    n = draw(st.integers(1, 5)) if n is None else n
    m = draw(st.integers(1, 3)) if m is None else m
    rng = np.random.default_rng(draw(seeds))
    place = draw(st.sampled_from(("random", "lattice", "line", "together", "apart", "wide")))
    q = rng.uniform(-1.0, 1.0, (n, m)) * n ** (1.0 / m)
    if place == "lattice":
        q = np.array([(*spot,)[:m] for spot in np.ndindex(*[n] * m)], dtype=float)[:n] + 1e-9 * q
    elif place == "line":
        q = np.outer(np.arange(n) * rng.uniform(0.5, 1.1), np.eye(m)[0])
    elif place == "together" and n > 1:
        q[1] = q[0]
    elif place == "apart":
        q[: n // 2] += 1e3
    elif place == "wide":
        q *= 30.0
    p = rng.normal(size=(n, m)) * draw(st.sampled_from((0.0, 1e-9, 0.1, 1.0, 10.0)))
    return length * q, speed * p


@st.composite
def samplings(draw, until):
    """When states are kept: at every step, densely, sparsely, at both ends alone, at the start alone, irregularly."""
    kind = draw(st.sampled_from(("steps", "steps", "dense", "sparse", "ends", "start", "irregular")))
    if kind == "steps":
        return {}
    rng = np.random.default_rng(draw(seeds))
    times = {
        "dense": np.linspace(0.0, until, 400),
        "sparse": np.linspace(0.0, until, 5),
        "ends": np.array([0.0, until]),
        "start": np.array([0.0]),
        "irregular": np.concatenate([[0.0], np.sort(rng.uniform(0.0, until, 10)), [until]]),
    }[kind]
    return {"t_eval": times}


@st.composite
def methods(draw, step):
    """How it is integrated, RK4 with a good step and with steps far too large among them; `step` is a good one."""
    fixed = [{"method": "RK4", "dt": step * size} for size in (1.0, 40.0, 4000.0)]
    adaptive = [{}, {"rtol": 1e-11, "atol": 1e-13}, {"rtol": 1e-4, "atol": 1e-6}, {"method": "RK45", "rtol": 1e-6}]
    return draw(st.sampled_from([*adaptive, *fixed]))


@st.composite
def ways(draw, until, step):
    """Method and sampling together; most often simulate's own."""
    if draw(st.booleans()):
        return {}
    return {**draw(methods(step)), **draw(samplings(until))}


@st.composite
def flocks(draw):
    """Any flock of at most five under Algorithm 1 or 2, at rest or fast, any γ-agent, for 10⁻⁷ to 30 law times."""
    law = draw(pair_laws())
    time, d = truth.law_time(law), law.alpha.d
    q, p = draw(starts(d, d / time))
    if isinstance(law, Algorithm2):
        law = Algorithm2(law.alpha, law.gains, draw(targets(q.shape[1], d, time)))
    until = time * draw(powers(-7.0, 1.5))
    return Case(law, q, p, until, draw(ways(until, min(until, time) / 50.0 + until / 2000.0)))
