"""The dead-zone theorem: parting for ever, gliding within the dead zone, an energy that jumps, undamped swings."""

from math import sqrt

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

from flockana import DeadZoneFlocking, DeadZoneInteraction
from tests.adversarial.cases import FALSE, REFUTED, TRUE, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import powers, samplings, seeds, ways

THEOREMS = ("dead-zone-1-printed", "dead-zone-1-corrected")
CORRECTED = dict.fromkeys(("rate", "balance", "components", "distance"), TRUE)


def force(s, pair):
    """F(ρ) of a pair, negative if it repels: the specification's f ρ/√(1 + ηρ²) + k₁ρ, with its ramps."""
    if s >= pair.r:
        return 0.0
    low, high = pair.r_b - pair.delta, pair.r_b + pair.delta
    f = 0.0
    if s < low:
        f = -(2.0 * pair.k_r / s**2 + pair.k_delta) * (min(1.0, (low - s) / pair.ramp) if pair.ramp else 1.0)
    elif s > high:
        f = 2.0 * pair.k_r / (pair.r_d - s) ** 2 + pair.k_delta
        f *= min(1.0, (s - high) / pair.ramp) if pair.ramp else 1.0
    return f * s / sqrt(1.0 + pair.eta * s * s) + pair.k1 * s


def climb(pair, start):
    """ψ(r) − ψ(start)."""
    marks = sorted({pair.r_b + pair.delta, pair.r_b - pair.delta, pair.r_b + pair.delta + pair.ramp})
    inside = [x for x in marks if start < x < pair.r]
    return quad(force, start, pair.r, (pair,), points=inside or None, limit=200)[0]


@st.composite
def dead_zones(draw, *, k2=(1.0, 0.1), k1=(0.01, 0.0)):
    """The dead-zone law in any unit: at its defaults, without pull, with printed jumps or ramps, other strengths."""
    L, T = draw(st.sampled_from(((1.0, 1.0), (1.0, 1.0), (1e-3, 1.0), (1e3, 60.0), (1e-6, 1e-3))))
    ramp, eta, k_r = (draw(st.sampled_from(some)) for some in ((0.25, 0.0), (1.0, 0.0, 0.1), (200.0, 1.0)))
    pair = DeadZoneInteraction(
        r=15.0 * L, r_b=8.0 * L, delta=4.5 * L, r_d=40.0 * L, ramp=ramp * L, eta=eta / L**2,
        k_r=k_r * L**2 / T**2, k_delta=1.3 / T**2, k1=draw(st.sampled_from(k1)) / T**2,
    )  # fmt: skip
    return DeadZoneFlocking(pair, draw(st.sampled_from(k2)) / T), L, T


def two(s, rate, m=2, offset=0.0):
    q, p = np.zeros((2, m)), np.zeros((2, m))
    q[:, 0], p[:, 0] = (-0.5 * s, 0.5 * s), (-0.5 * rate, 0.5 * rate)
    if m > 1:
        q[:, 1] = (-0.5 * offset, 0.5 * offset)
    return q, p


def both(case, printed, corrected):
    """Either form of the theorem."""
    hold("dead-zone-1-printed", case, printed)
    hold("dead-zone-1-corrected", case, corrected)


@effort(0.3)
@given(dead_zones(), powers(-2.0, 2.0), powers(-7.0, 2.0), st.integers(1, 3), st.data())
def test_out_of_range_and_parting(drawn, speed, until, m, data):
    law, L, T = drawn
    q, p = two(1.1 * law.interaction.r, speed * L / T, m)
    case = Case(law, q, p, until * T, data.draw(ways(until * T, until * T / 100.0)))
    sure = REFUTED if not case.options and until > 1e-3 else FALSE
    both(case, {"cohesion": sure, "velocity": sure, "energy": TRUE, "collision": TRUE}, CORRECTED)


@effort(0.3)
@given(dead_zones(k1=(0.0,)), powers(-6.0, 1.5), st.data())
def test_leaving_range_fast(drawn, until, data):
    """L4: from within range, but faster than damping and attraction can stop: 2 k₂ r + √(4ψ(r)) is more than enough."""
    law, _, T = drawn
    start = 0.93 * law.interaction.r
    speed = 2.5 * law.k2 * law.interaction.r + 3.0 * sqrt(climb(law.interaction, start))
    q, p = two(start, speed)
    case = Case(law, q, p, until * T, data.draw(ways(until * T, until * T / 2000.0)))
    both(case, {"cohesion": FALSE, "velocity": FALSE, "energy": TRUE, "collision": TRUE}, CORRECTED)


@effort(0.3)
@given(dead_zones(), st.sampled_from((0.5, 5.0, 50.0, 500.0)), st.sampled_from((0.0, 0.5, 0.9)), st.data())
def test_coming_into_range(drawn, speed, offset, data):
    """L5: the energy of neighbours jumps up by ψ(r) as a pair comes into range, however fast it passes."""
    law, L, T = drawn
    pair = law.interaction
    s, b = 3.0 * pair.r, offset * pair.r
    q, p = two(s, -speed * L / T, 2, b)
    until = 1.25 * s / (speed * L / T)  # it comes into range before 0.86 of s over its speed
    case = Case(law, q, p, until, data.draw(samplings(until)))
    gain = climb(pair, pair.r_b)  # ψ(r) − ψ(r_b) <= ψ(r)
    apart = offset > 0.0 or (speed * L / T) ** 2 < 80.0 * pair.k_r  # head on, ρ >= d₁ exp(-H̄/2k_r), H̄ = speed²/4
    clear = not case.options and apart and gain > 1e-3 * (0.5 * speed * L / T) ** 2
    both(case, {"energy": REFUTED if clear else FALSE, "collision": TRUE}, CORRECTED)


@effort(0.2)
@given(dead_zones(k1=(0.0,)), powers(-6.0, -0.5), st.booleans(), st.integers(1, 3))
def test_gliding_to_rest_within_the_dead_zone(drawn, speed, long, m):
    """x'' = −2 k₂ x': velocities match as exp(−2k₂t), closed form."""
    law, L, _ = drawn
    q, p = two(law.interaction.r_b, speed * 2.0 * law.k2 * L, m)
    case = Case(law, q, p, (45.0 if long else 0.01) / (2.0 * law.k2))
    limit = VERIFIED if long else TRUE
    rest = {"cohesion": TRUE, "energy": TRUE, "collision": TRUE}
    both(case, {"velocity": limit, **rest}, CORRECTED | {"components": limit, "rate": TRUE})


@effort(0.3)
@given(st.floats(6.0, 16.0), st.sampled_from((-1e-3, 1e-3, 0.5, 2.0)), st.sampled_from((1.0, 1e-6, 1e3)))
def test_a_glide_that_ends_just_out_of_range(constants, after, L):
    """Nothing attracts (r_b + δ >= r, k₁ = 0): gliding out of range after so many time constants they part for ever.

    Until then everything decays as if it were settling, and afterwards a speed of e^-constants never changes again.
    """
    sizes = {name: x * L for name, x in {"r": 15.0, "r_b": 12.0, "delta": 4.5, "r_d": 40.0, "ramp": 0.25}.items()}
    pair = DeadZoneInteraction(**sizes, k_r=60.0 * L**2, k1=0.0, eta=0.0)
    law, start = DeadZoneFlocking(pair, 0.5), 9.0 * L
    rate = (pair.r - start) / -np.expm1(-constants)  # s' = rate e^-t, s(constants) = r
    q, p = two(start, rate)
    case = Case(law, q, p, constants + after)
    both(case, {"cohesion": FALSE, "energy": TRUE, "collision": TRUE}, CORRECTED)


@effort(0.2)
@given(dead_zones(k2=(0.0,), k1=(0.0,)), st.floats(0.2, 0.6), st.integers(1, 4))
def test_an_undamped_pair_swings_for_ever(drawn, share, halves):
    """k₂ = 0 and less energy than ψ(r): bound for ever, at rest at its turning points alone, where the run stops."""
    law, L, T = drawn
    pair = law.interaction
    assume(pair.ramp > 0.0)
    start = pair.r_b + pair.delta + share * (pair.r - pair.r_b - pair.delta)

    def turning(_, y):
        return y[1]

    turning.terminal, turning.direction = True, 1.0  # the inner turning point: each half swing lasts as long
    swing = solve_ivp(
        lambda _, y: (y[1], -2.0 * force(y[0], pair)), (0.0, 400.0 * T), (start, 0.0), "DOP853",
        rtol=1e-11, atol=1e-13 * L, events=turning, max_step=0.05 * T,
    )  # fmt: skip
    half = swing.t_events[0]
    assume(len(half) == 1)
    q, p = two(start, 0.0)
    case = Case(law, q, p, halves * float(half[0]))
    both(case, {"velocity": FALSE, "energy": TRUE, "collision": TRUE}, CORRECTED | {"components": FALSE})


@effort(0.3)
@given(dead_zones(k2=(1.0, 0.0)), st.integers(2, 6), st.integers(1, 3), seeds, st.data())
def test_what_holds_of_every_flock(drawn, n, m, seed, data):
    law, L, T = drawn
    rng = np.random.default_rng(seed)
    q = rng.uniform(-1.0, 1.0, (n, m)) * L * data.draw(st.sampled_from((2.0, 10.0, 60.0)))
    p = rng.normal(size=(n, m)) * L / T * data.draw(st.sampled_from((0.0, 1.0, 20.0)))
    assume(min(np.linalg.norm(q[i] - q[j]) for i in range(n) for j in range(i)) > 0.1 * L)
    until = T * data.draw(powers(-6.0, 0.8))
    case = Case(law, q, p, until, data.draw(samplings(until)))
    undamped = {} if law.k2 else {"components": TRUE | FALSE}
    both(case, {"collision": TRUE}, CORRECTED | undamped)
