"""Delay margins against closed forms, roots against the margin, and delayed flocks just below and above it."""

from math import inf, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import lambertw

from flockana import Algorithm1, Algorithm2, Delayed, Gains, MinimalFlocking, StaticTarget, find_equilibrium, simulate
from flockana.base.errors import ArgumentError
from flockana.lattice import hexagonal_spiral
from flockana.stability import axis_crossings
from flockana.stability.delay import DelaySystem, delay_margin, scalar_margin
from flockana.stability.delay_roots import rightmost_roots
from flockana.stability.law_studies import delay_system
from tests.refused import refused

ORIGIN = StaticTarget((0.0, 0.0))
LAW = Algorithm2(target=ORIGIN)


def scalar(k, d, k0=0.0, d0=0.0, neutral=0):
    return DelaySystem((np.array([[k0]]), np.array([[d0]])), (np.array([[k]]), np.array([[d]])), neutral)


def lone(c1, c2, target=None):
    return Algorithm2(gains=Gains(c1_gamma=c1, c2_gamma=c2), target=target or StaticTarget((0.0,)))


@given(st.floats(0.0, 30.0), st.floats(0.1, 20.0))
@settings(max_examples=25, deadline=None)
def test_the_sweep_finds_the_scalar_margin(k, d):
    """k + jωd = ω² e^jωτ: on the axis the equation holds, and the sweep finds the same delay."""
    margin = scalar_margin(k, d)
    w, tau = margin.frequency, margin.delay
    assert k + 1j * w * d == pytest.approx(w * w * np.exp(1j * w * tau), rel=1e-9)
    assert delay_margin(scalar(k, d, neutral=int(k == 0.0))).delay == pytest.approx(tau, rel=1e-9)


def test_margins_that_are_known():
    assert scalar_margin(0.0, 2.0).delay == pytest.approx(pi / 4)  # v' = −2 v(t − τ): π/(2·2)
    assert scalar_margin(9.0, 0.0).delay == 0.0  # without damping any delay feeds energy in
    assert scalar_margin(0.0, 0.0).delay == inf
    assert delay_margin(scalar(4.0, -1.0)).delay == 0.0  # unstable without delay
    # prompt damping that outweighs the delayed pull at every frequency: |ω² + jω d0| > k where d0² > 2 k ... never lost
    assert delay_margin(scalar(1.0, 0.0, k0=3.0, d0=4.0)).delay == inf


def test_modes_that_commute_have_the_least_of_their_margins():
    rng = np.random.default_rng(3)
    basis = np.linalg.qr(rng.standard_normal((5, 5)))[0]
    k, d = rng.uniform(1.0, 40.0, 5), rng.uniform(0.5, 8.0, 5)
    zero = np.zeros((5, 5))
    system = DelaySystem((zero, zero), (basis * k @ basis.T, basis * d @ basis.T))
    each = [scalar_margin(*pair) for pair in zip(k, d, strict=True)]
    best = min(each, key=lambda margin: margin.delay)
    found = delay_margin(system)
    assert (found.delay, found.frequency) == pytest.approx((best.delay, best.frequency), rel=1e-9)


def test_a_lightly_damped_swing_has_a_narrow_band():
    """x'' + 0.01 x' + x + 0.0101 x(t − τ) = 0: |1 − ω² + 0.01jω| < 0.0101 from ω = 0.99929 to 1.00061 only."""
    x = np.roots([1.0, 0.01**2 - 2.0, 1.0 - 0.0101**2])
    delays = [float(np.angle(-0.0101 / complex(1.0 - w * w, 0.01 * w))) % (2.0 * pi) / w for w in np.sqrt(x)]
    margin = delay_margin(scalar(0.0101, 0.0, k0=1.0, d0=0.01))
    assert margin.delay == pytest.approx(min(delays), rel=1e-12)
    assert margin.delay == pytest.approx(1.43389, abs=5e-6)
    assert margin.certified


def reference(system):
    """The margin by brute force: A ⊗ A* − B ⊗ B* is singular at the crossings, a polynomial of degree 4 in ω."""
    (k0, d0), (k1, d1) = system.prompt, system.late
    size, one = len(k0) ** 2, np.eye(len(k0))
    parts = [(k0, 1j * d0, -one), (k1, 1j * d1)]
    coefficients = np.zeros((5, size, size), complex)
    for sign, terms in zip((1.0, -1.0), parts, strict=True):
        for a, first in enumerate(terms):
            for b, second in enumerate(terms):
                coefficients[a + b] += sign * np.kron(first, second.conj())
    companion = np.zeros((4 * size, 4 * size), complex)
    companion[: 3 * size, size:] = np.eye(3 * size)
    companion[3 * size :] = -np.hstack(list(np.linalg.solve(coefficients[4], coefficients[:4])))
    roots, delays = np.linalg.eigvals(companion), [inf]
    for w in roots.real[(np.abs(roots.imag) < 1e-6) & (roots.real > 1e-6)]:
        z = np.linalg.eigvals(-np.linalg.solve(k0 - w * w * one + 1j * w * d0, k1 + 1j * w * d1))
        delays += [float(np.angle(x)) % (2.0 * pi) / w for x in z if abs(abs(x) - 1.0) < 1e-6]
    return min(delays)


@pytest.mark.parametrize("seed", range(5))
def test_modes_that_directed_nets_share(seed):
    """Four polynomials in one matrix that is not symmetric: held against the polynomial of degree 4 N² in ω."""
    rng = np.random.default_rng(seed)
    net = 0.3 * rng.uniform(0.0, 1.0, (3, 3))
    one = np.eye(3)
    system = DelaySystem((2.0 * one - net, 1.5 * one - 0.5 * net), (one - net @ net, 0.4 * one - net))
    margin, exact = delay_margin(system), reference(system)
    assert margin.delay == (pytest.approx(exact, rel=1e-7) if np.isfinite(exact) else inf)
    assert margin.certified or not np.isfinite(exact)


def test_a_tree_of_the_minimal_model_bears_what_one_edge_does():
    """All of it late: per edge s² + (s + 1) e^(−sτ) along it, s² + s e^(−sτ) across."""
    law = MinimalFlocking(edges=((0, 1), (1, 2)), spacing=1.0)
    system = delay_system(law, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    best = min(scalar_margin(1.0, 1.0), scalar_margin(0.0, 1.0), key=lambda margin: margin.delay)
    assert delay_margin(system).delay == pytest.approx(best.delay, rel=1e-6)
    heard = delay_system(law, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], delayed="neighbours")
    assert not any(part[4:, 4:].any() for part in heard.late)  # agent 2 knows its own state at once
    np.testing.assert_array_equal(heard.late[1][4:, 2:4], system.late[1][4:, 2:4])


@pytest.mark.parametrize("seed", range(16))
def test_no_band_is_too_narrow(seed):
    """Three coupled swings with dampings from 1e-4 to 1, late terms of about that size, in modes of their own."""
    rng = np.random.default_rng(seed)
    damping = 10.0 ** rng.uniform(-4.0, 0.0)

    def mixed(low, high):
        turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
        return turn * rng.uniform(low, high, 3) @ turn.T

    system = DelaySystem(
        (mixed(1.0, 9.0), damping * mixed(0.8, 1.2)),
        (2.0 * damping * mixed(-1.0, 1.0), 0.5 * damping * mixed(-1.0, 1.0)),
    )
    margin, exact = delay_margin(system), reference(system)
    assert margin.delay == (pytest.approx(exact, rel=1e-7) if np.isfinite(exact) else inf)
    assert margin.certified
    if np.isfinite(exact):
        collocated = [rightmost_roots(system, s * exact, nodes=40, count=1)[0].real for s in (0.99, 1.01)]
        assert collocated[0] < 0.0 < collocated[1]


def test_a_search_that_is_cut_short_says_at_most(monkeypatch):
    q = find_equilibrium(LAW, hexagonal_spiral(9, 7.0)).q
    system = delay_system(LAW, q, delayed="neighbours")
    whole = delay_margin(system)
    assert whole.certified
    assert 0.999998 * whole.delay < whole.least < whole.delay
    monkeypatch.setattr(axis_crossings, "MOST", 40)
    cut = delay_margin(system)
    assert cut.least == 0.0
    assert not cut.certified
    assert cut.delay >= whole.delay * (1.0 - 1e-9)


@pytest.mark.parametrize("power", [-300, -40, 40, 300])
def test_units_of_time_do_not_matter(power):
    q, unit = find_equilibrium(LAW, hexagonal_spiral(3, 7.0)).q, 2.0**power
    for delayed in ("all", "neighbours"):
        system = delay_system(LAW, q, delayed=delayed)
        (k0, d0), (k1, d1) = system.prompt, system.late
        there = DelaySystem((k0 * unit * unit, d0 * unit), (k1 * unit * unit, d1 * unit), system.neutral)
        here, margin = delay_margin(system), delay_margin(there)
        assert (margin.delay * unit, margin.frequency / unit) == (here.delay, here.frequency)
    assert scalar_margin(4.0 * unit * unit, 3.0 * unit).delay * unit == scalar_margin(4.0, 3.0).delay


@pytest.mark.parametrize("tau", [0.3, 1.0, 3.0])
def test_roots_of_a_first_order_equation_are_lambert_w(tau):
    """v' = −v(t − τ): s = W_k(−τ)/τ; the position adds the root 0, set apart as neutral."""
    found = rightmost_roots(scalar(0.0, 1.0, neutral=1), tau, nodes=20, count=4)
    exact = np.array([lambertw(-tau, k) for k in (-3, -2, -1, 0, 1, 2)]) / tau
    exact = exact[np.lexsort((-exact.imag, -exact.real.round(9)))][:4]
    np.testing.assert_allclose(found, exact, rtol=1e-9)


@pytest.mark.parametrize("delayed", ["all", "pairs", "neighbours"])
def test_at_the_margin_the_rightmost_roots_are_on_the_axis(delayed):
    system = delay_system(LAW, find_equilibrium(LAW, hexagonal_spiral(3, 7.0)).q, delayed=delayed)
    margin = delay_margin(system)
    for share, sign in ((0.9, -1.0), (1.0, 0.0), (1.1, 1.0)):
        root = rightmost_roots(system, share * margin.delay, nodes=10, count=1)[0]
        assert np.sign(root.real.round(9)) == sign
        assert np.linalg.svd(system.characteristic(root, share * margin.delay))[1][-1] < 1e-8
        if share == 1.0:
            assert abs(root.imag) == pytest.approx(margin.frequency, rel=1e-9)


def test_a_flocks_margin_lies_between_those_of_its_numerical_range():
    """Frozen: n = 7 under the default gains, by sweep and by collocation; damping by the γ-agent delayed or not."""
    q = find_equilibrium(LAW, hexagonal_spiral(7, 7.0)).q
    margins = [delay_margin(delay_system(LAW, q, delayed=name)).delay for name in ("all", "pairs", "neighbours")]
    assert margins[:2] == pytest.approx([0.0127827452, 0.0129921726], rel=1e-8)
    assert margins[2] == pytest.approx(0.0303, abs=5e-5)
    lattice = delay_margin(delay_system(Algorithm1(), hexagonal_spiral(7, 7.0)))
    assert lattice.delay == pytest.approx(0.0086924950, rel=1e-8)


def test_modes_that_pass_together_are_all_asked_for_their_delay():
    """Under Algorithm 1 the hexagon's symmetry makes moduli coincide whose phases are 0.0238 and 0.148 apart."""
    system = delay_system(Algorithm1(), hexagonal_spiral(7, 7.0), delayed="neighbours")
    assert system.neutral == 3  # to be seen late slows a drift: only places and orientation stay neutral
    margin = delay_margin(system)
    assert margin.delay == pytest.approx(0.0238327387, rel=1e-8)
    assert abs(rightmost_roots(system, margin.delay, count=1)[0] - 1j * margin.frequency) < 1e-8


def grown(system, q, share, law, delayed="all"):
    """(slope of log amplitude of the nonlinear delayed flock, rightmost real part), started in the rightmost mode."""
    tau = share * delay_margin(system).delay
    root = rightmost_roots(system, tau, nodes=10, count=1)[0]
    mode = np.linalg.svd(system.characteristic(root, tau))[2][-1].conj()
    size = 1e-5 / np.abs(mode).max()
    span, steps = 1.2, 8
    q0, p0 = (
        q + size * (s * mode).real.reshape(q.shape) if k == 0 else size * (s * mode).real.reshape(q.shape)
        for k, s in enumerate((1.0, root))
    )
    run = simulate(Delayed(law, tau, delayed), q0, p0, (0.0, span), dt=tau / steps)
    amplitude = np.linalg.norm((run.p @ np.eye(q.shape[1])).reshape(len(run.t), -1), axis=1)
    period = 2 * pi / abs(root.imag)
    centres = np.arange(0.4 * span, span - period, period)
    tops = [np.log(np.sqrt(np.mean(amplitude[(run.t >= c) & (run.t < c + period)] ** 2))) for c in centres]
    return np.polyfit(centres, tops, 1)[0], root.real


@pytest.mark.slow
@pytest.mark.parametrize(
    ("delayed", "share"), [("all", 0.85), ("all", 1.15), ("pairs", 0.85), ("pairs", 1.15), ("neighbours", 1.15)]
)
def test_the_nonlinear_flock_decays_below_the_margin_and_grows_above(delayed, share):
    q = find_equilibrium(LAW, hexagonal_spiral(3, 7.0)).q
    slope, predicted = grown(delay_system(LAW, q, delayed=delayed), q, share, LAW, delayed)
    assert np.sign(slope) == np.sign(share - 1.0)
    assert slope == pytest.approx(
        predicted, rel=0.1
    )  # the past before the start is a line, no mode: others are excited


test_refusals = refused(
    (lambda: delay_system(LAW, [[0.0, 0.0]], delayed="some"), "unknown set of delayed terms 'some'"),
    (lambda: rightmost_roots(scalar(1.0, 1.0), 0.0), "delay = 0: expected a number > 0"),
    (lambda: scalar_margin("x", 1), "k = 'x': expected one real number"),
    (lambda: scalar_margin(1.0, -1.0), "d = -1: expected a number >= 0"),
)


def test_long_work_is_refused_with_an_estimate_before_it_begins():
    rng = np.random.default_rng(0)
    k, d = (x @ x.T for x in rng.standard_normal((2, 40, 40)))
    system = DelaySystem((k, np.zeros_like(k)), (k, d + np.eye(40)))
    with pytest.raises(ArgumentError, match=r"the delay margin of 40 coordinates would take about .* s and .* MB"):
        delay_margin(system, limit=1e-3)
    alike = DelaySystem((k, k), (k, k))  # in closed form, mode by mode: no search
    assert delay_margin(alike, limit=0.01).certified
