"""Claims about t → ∞: two agents near their balance, damped or not, and flocks of springs alone, in closed form."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from flockana import Algorithm1, Algorithm2, AlphaInteraction, Gains, StaticTarget
from tests.adversarial import truth
from tests.adversarial.cases import FALSE, OPEN, REFUTED, TRUE, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import aimed, alphas, pair_laws, powers, ways

THEOREMS = ("os-1", "os-3", "lattice-limit-printed", "E11", "alpha-flocking", "alpha-flocking-strict")


def pair(law, s, rate, m, *, turn=0.0):
    """Two agents at distance s whose distance grows at this rate, on a line at an angle in m dimensions."""
    axis = np.eye(m)[0] if m == 1 else np.array([np.cos(turn), np.sin(turn), 0.0][:m])
    return np.outer([-0.5, 0.5], s * axis), np.outer([-0.5, 0.5], rate * axis)


@st.composite
def near_balance(draw, **gains):
    """(law, q, p, spring, damping, balanced length): a pair a little off its balance, at rest."""
    law = draw(pair_laws(**gains))
    gamma = isinstance(law, Algorithm2)
    s = truth.balanced_length(law) if gamma else law.alpha.d
    assume(s > 0.0)
    spring, damping = truth.pair_rates(law, s)
    off = draw(st.sampled_from((1e-2, -1e-2, 3e-3))) * (law.alpha.r - s) / s
    assume(spring > 0.0)
    m = draw(st.integers(1, 3))
    q, p = pair(law, s * (1.0 + off), 0.0, m, turn=draw(st.floats(0.0, 6.0)))
    rest = [[0.0], [float(law.alpha.r)]], [[0.0], [0.0]]
    if not gamma:  # bound for ever, and no state of the level set is disconnected
        assume(truth.structural_energy(law, q, p) < 0.5 * truth.structural_energy(law, *rest))
    return aimed(law, StaticTarget((0.0,) * m)), q, p, spring, damping, s


@effort(0.3)
@given(near_balance(damping=(0.3, 2.0), pulls=(0.01, 0.3)), st.data())
def test_a_damped_pair_settles(drawn, data):
    """By 45 decay times everything has come to rest; before, only a certificate of the basin can tell."""
    law, q, p, spring, damping, s = drawn
    rate = truth.decay_rate(spring, damping)
    assume(45.0 * np.sqrt(spring) < 400.0 * rate)
    long = data.draw(st.booleans())
    until = (45.0 if long else 0.05) / rate
    case = Case(law, q, p, until, data.draw(ways(until, 0.05 / np.sqrt(spring))))
    settled = VERIFIED if long and not case.options else TRUE
    rough = case.options.get("method") == "RK4"
    if isinstance(law, Algorithm1):
        hold("os-1", case, {"i": settled, "ii": settled}, may_refuse=rough)
        hold("lattice-limit-printed", case, {"lattice": settled}, may_refuse=rough)
        return
    hold("os-3", case, {"i": TRUE, "ii": settled, "iii": settled}, may_refuse=rough)
    strain = abs(s / law.alpha.d - 1.0)
    assume(abs(strain / 1e-6 - 1.0) > 1e-2)
    lattice = TRUE if strain < 1e-6 else FALSE
    lattice = REFUTED if long and not case.options and strain > 1e-4 else lattice
    hold("lattice-limit-printed", case, {"lattice": lattice}, may_refuse=rough)


@effort(0.25)
@given(near_balance(damping=(0.0,), pulls=(0.01,)), st.integers(1, 20), st.data())
def test_an_undamped_pair_swings_for_ever(drawn, halves, data):
    """Seen at its turning points, where for an instant nothing moves, or so that it looks like a decay: no limit."""
    law, q, p, spring, _, _ = drawn
    until, k = halves * np.pi / np.sqrt(spring), np.arange(1, halves + 1)
    decaying = (np.pi * k - np.arcsin(np.maximum(data.draw(st.floats(0.1, 0.9)) ** k, 1e-9))) / np.sqrt(spring)
    turning, often = np.linspace(0.0, until, halves + 1), np.linspace(0.0, until, 300)
    times = data.draw(st.sampled_from((None, turning, often, np.concatenate([[0.0], decaying]))))
    case = Case(law, q, p, until, {} if times is None else {"t_eval": times})
    if isinstance(law, Algorithm1):
        hold("os-1", case, {"i": OPEN, "ii": OPEN})
    else:
        hold("os-3", case, {"i": OPEN, "ii": OPEN, "iii": OPEN})  # c2γ > 0 is asked for, and is not so
    hold("lattice-limit-printed", case, {"lattice": FALSE})


@effort(0.4)
@given(alphas(), st.sampled_from((1.2, 3.0, 30.0)), powers(-7.0, 0.5), st.booleans())
def test_a_pair_that_leaves_is_caught_by_nothing(alpha, share, until, late):
    """From its balance with more energy than ψ(r_α), hardly damped: it parts for ever, however steep the well."""
    far = float(truth.far(alpha))
    speed = 2.0 * np.sqrt(share * far)
    law = Algorithm1(alpha, Gains(c1_alpha=1.0, c2_alpha=1e-3 * speed / alpha.d))  # costs 10⁻² of the speed at most
    q, p = pair(law, alpha.d, speed, 2, turn=1.0)
    case = Case(law, q, p, until * (alpha.r - alpha.d) / speed + (2.0 * alpha.r / speed if late else 0.0))
    hold("lattice-limit-printed", case, {"lattice": FALSE})
    hold("os-1", case, {"i": OPEN, "ii": OPEN, "iii": TRUE})


@effort(0.2)
@given(alphas(), st.sampled_from((0.0, 0.1, 2.0, 10.0)), st.integers(1, 5), st.integers(1, 3), st.data())
def test_springs_alone(alpha, drag, n, m, data):
    """c1α = 0 leaves x'' = −c1γ x − c2γ x': every theorem says something of it, and none what is not so."""
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32 - 1)))
    law = Algorithm2(alpha, Gains(0.0, 0.0, 0.0, 0.0, 1.0, drag), StaticTarget((0.0,) * m))
    q, p = alpha.d * rng.normal(size=(n, m)), alpha.d * rng.normal(size=(n, m)) * data.draw(st.sampled_from((0.0, 1.0)))
    long = data.draw(st.booleans())
    rate = truth.decay_rate(1.0, drag)
    until = 45.0 / rate if long and rate else np.pi if not rate else 0.02
    assume(until < 1e3)
    case = Case(law, q, p, until, data.draw(ways(until, 0.05)))
    rough = case.options.get("method") == "RK4"
    limit = TRUE if drag else OPEN
    hold("os-3", case, {"i": limit, "ii": limit, "iii": limit}, may_refuse=rough)
    for theorem in ("energy", "collision-energy", "E13", "lattice-limit-printed"):
        hold(theorem, case, {"rate": TRUE, "balance": TRUE, "below": TRUE}, may_refuse=rough)


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize(("pull_", "truths"), [(1e-3, VERIFIED), (0.03, VERIFIED), (2.0, REFUTED)])
def test_a_squeezed_pair(pull_, m, truths):
    """E11: how far the γ-agent presses a pair together is the root of one equation."""
    alpha, c1 = AlphaInteraction(), 1.0
    law = Algorithm2(alpha, Gains(c1, 2.0, 0.0, 0.0, pull_ * c1, 2.0), StaticTarget((0.0,) * m))
    s = truth.balanced_length(law)
    assert (abs(s / alpha.d - 1.0) <= 0.1) == (truths is VERIFIED)
    q, p = pair(law, max(s, 1e-3), 0.0, m, turn=1.0)
    case = Case(law, q, p, 200.0)
    hold("E11", case, {"printed": truths, "minimum": TRUE})


@effort(0.25)
@given(powers(-3.0, 3.0), powers(-3.0, 3.0), st.integers(2, 4), st.data())
def test_flocking_by_definition(drift, size, n, data):
    alpha = AlphaInteraction()
    law = Algorithm2(alpha, Gains(0.0, 0.0, 0.0, 0.0, 1.0, 0.0), StaticTarget((0.0, 0.0)))
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32 - 1)))
    q = size * rng.normal(size=(n, 2))
    p = np.tile(drift * rng.normal(size=2), (n, 1))  # a common velocity: the moving frame does not see it
    until = 2.0 * np.pi * data.draw(st.integers(1, 4))
    turning = np.linspace(0.0, until, round(until / np.pi) + 1)
    options = data.draw(st.sampled_from(({}, {"t_eval": turning}, {"t_eval": np.linspace(0.0, until, 401)})))
    case = Case(law, q, p, until, options)
    x, v = truth.harmonic(law, q, p, np.linspace(0.5 * until, until, 2001))
    mismatch = 0.5 * (v**2).sum(axis=(1, 2)) / n
    reach = np.linalg.norm(x, axis=2).max(axis=1)
    expected = {"mismatch": _above(mismatch.max(), 50.0, 5e-5), "cohesive": _above(reach.max() / reach[0], 1.6, 1.4)}
    for theorem in ("alpha-flocking", "alpha-flocking-strict"):
        hold(theorem, case, expected)


def _above(value, high, low):
    return FALSE if value > high else TRUE if value < low else TRUE | FALSE
