"""The shared parts of verdicts: which law it is, what lies below what, and how far rounding can move either."""

from decimal import Decimal, getcontext
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import flockana as fl
from flockana import Algorithm1, Algorithm2, AlphaInteraction, DeadZoneFlocking, Gains, Trajectory
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.hypotheses import alpha_gain, common_gains, has_lattice, law_is, positive, positive_room
from flockana.theorems.rounding import energy_error, frame_error, spread_error

getcontext().prec = 60


def run_of(law, n=2):
    q = np.zeros((2, n, 2))
    return Trajectory(np.array([0.0, 1.0]), q, q, q, law)


@pytest.mark.parametrize(
    ("law", "exact"),
    [
        (Algorithm1(), True),
        (type("Mine", (Algorithm1,), {})(), False),
        (Algorithm1(alpha=type("Softer", (AlphaInteraction,), {})()), False),
        (Algorithm1(gains=type("Mine", (Gains,), {})()), False),
        (Algorithm2(target=fl.StaticTarget((0.0, 0.0))), False),
    ],
    ids=["itself", "a subclass", "another pair law", "other gains", "another law"],
)
def test_a_theorem_is_about_exactly_its_law(law, exact):
    found = law_is("Algorithm 1", Algorithm1)(run_of(law))
    assert found.status == ("met" if exact else "unmet")
    assert type(law).__name__ in found.detail


def test_gains_that_a_theorem_needs():
    target = fl.StaticTarget((0.0, 0.0))
    run = run_of(Algorithm2(gains=Gains(c1_gamma=0.0, c2_gamma=2.0), target=target))
    found = positive(run, c1_gamma="c1γ", c2_gamma="c2γ")
    assert (found.name, found.status, found.margin) == ("c1γ > 0 and c2γ > 0", "unmet", 0.0)
    assert common_gains(run).status == "met"
    each = run_of(Algorithm2(gains=Gains(c1_gamma=[1.0, 2.0]), target=target))
    assert common_gains(each).status == "unmet"
    assert [need.name for need in alpha_gain(each)] == ["one c1γ and one c2γ for all agents", "c1α > 0"]
    assert [need.name for need in alpha_gain(run_of(Algorithm1()))] == ["c1α > 0"]


def test_the_law_of_a_theorem_is_declared_before_there_is_a_run():
    target = fl.StaticTarget((0.0, 0.0))
    each = run_of(Algorithm2(gains=Gains(c1_gamma=[1.0, 2.0]), target=target))
    one, two = law_is("Algorithm 2", Algorithm2), law_is("Algorithm 2", Algorithm2, one_gain=True)
    assert (one(each).name, one(each).status) == ("Algorithm 2 is applied", "met")
    assert (two(each).name, two(each).status) == ("one c1γ and one c2γ for all agents", "unmet")
    assert two(run_of(Algorithm2(target=target))) == one(run_of(Algorithm2(target=target)))
    other = run_of(Algorithm1())
    assert (two(other).name, two(other).status, one(other).status) == ("Algorithm 2 is applied", "unmet", "unmet")
    assert has_lattice(other).status == "met"
    assert has_lattice(run_of(DeadZoneFlocking())).status == "unmet"


def test_equal_but_for_rounding_is_neither_below_nor_above():
    assert [positive_room("x", 1.0 - Enclosure.around(value, 0.1), "").status for value in (0.8, 0.95, 1.05, 1.2)] == [
        "met",
        "assumed",
        "assumed",
        "unmet",
    ]
    assert [
        positive_room("x < 1", 1.0 - Enclosure.around(value, 0.1), "").error for value in (0.8, 0.95, 1.2)
    ] == pytest.approx([0.1] * 3)


def exactly(x):
    return [[Decimal(float(value)) for value in row] for row in x]


def spread(rows):
    n = len(rows)
    mean = [sum(column) / n for column in zip(*rows, strict=True)]
    return sum((x - c) ** 2 for row in rows for x, c in zip(row, mean, strict=True)) / 2


@given(st.integers(0, 2**32 - 1), st.integers(1, 12), st.integers(1, 3), st.floats(-6.0, 9.0).map(lambda x: 10.0**x))
def test_rounding_of_spreads_is_within_its_bound(seed, n, m, offset):
    rng = np.random.default_rng(seed)
    x = rng.normal(size=(1, n, m)) + offset * rng.normal(size=m)
    found = 0.5 * float(np.sum((x[0] - x[0].mean(axis=0)) ** 2))
    true = spread(exactly(x[0]))
    assert abs(Decimal(found) - true) <= Decimal(float(spread_error(x)[0]))
    centred = x[0] - x[0].mean(axis=0)
    rows = exactly(x[0])
    mean = [sum(column) / n for column in zip(*rows, strict=True)]
    off = max(abs(Decimal(float(c)) - (v - w)) for r, s in zip(centred, rows, strict=True)
              for c, v, w in zip(r, s, mean, strict=True))  # fmt: skip
    assert off <= Decimal(frame_error(x))


@given(st.integers(0, 2**32 - 1), st.integers(2, 6), st.floats(-3.0, 7.0).map(lambda x: 10.0**x))
def test_rounding_of_energies_is_within_its_bound(seed, n, offset):
    law = Algorithm2(gains=Gains(c1_gamma=0.3), target=fl.StaticTarget((0.0, 0.0)))
    rng = np.random.default_rng(seed)
    q = np.round(rng.uniform(0.0, 15.0, (n, 2)) * 2.0**12) / 2.0**12
    p = np.round(rng.normal(size=(n, 2)) * 2.0**12) / 2.0**12
    shift = np.round(offset)
    one, two = law.energy(0.0, q, p), law.energy(0.0, q + shift, p + shift)
    bound = sum(float(energy_error(law, x[None], v[None], np.array([e]))[0])
                for x, v, e in ((q, p, one), (q + shift, p + shift, two)))  # fmt: skip
    assert abs(one - two) <= bound
    assert bound <= 1e-9 * one * max(1.0, offset)


def test_the_bound_of_a_pairs_energy_covers_what_the_panels_leave():
    law, alpha = Algorithm1(), AlphaInteraction()
    for s in np.linspace(0.0, 9.0, 40):
        q = np.array([[[0.0], [s]]])
        found = law.energy(0.0, q[0], 0.0 * q[0])
        true = 30.0 * float(_psi(s, alpha))
        assert abs(found - true) <= energy_error(law, q, 0.0 * q, np.array([found]))[0]


def _psi(s, alpha):
    """ψ_α at a length by quadrature, to twenty digits."""
    import mpmath

    with mpmath.workdps(30):
        norm = lambda x: (mpmath.sqrt(1 + mpmath.mpf(alpha.eps) * mpmath.mpf(x) ** 2) - 1) / mpmath.mpf(alpha.eps)  # noqa: E731
        z, z_d, z_r = norm(s), norm(alpha.d), norm(alpha.r)

        def phi(x):
            action = alpha.a * (x - z_d) / mpmath.sqrt(1 + (x - z_d) ** 2)
            y = x / z_r
            h = mpmath.mpf(alpha.h)
            return action if y < h else action * (1 + mpmath.cos(mpmath.pi * (y - h) / (1 - h))) / 2

        top = min(z, z_r)
        knots = sorted({z_d, top, *[x for x in (mpmath.mpf(alpha.h) * z_r, z_d - 3, z_d - 1, z_d + 1)
                                    if min(z_d, top) < x < max(z_d, top)]})  # fmt: skip
        value = mpmath.quad(phi, knots)
        return value if top >= z_d else -value


def test_every_pair_is_counted_in_the_bound():
    law, n = Algorithm1(), 60
    q = np.random.default_rng(0).uniform(0.0, 40.0, (1, n, 2))
    bound = float(energy_error(law, q, 0.0 * q, np.array([1.0]))[0])
    pairs = len(list(combinations(range(n), 2)))
    assert bound >= 30.0 * pairs * 1e-13 * law.alpha.c_star
