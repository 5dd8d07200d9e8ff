"""Links that a tension keeps: the force by hand, derivatives, what is refused."""

import numpy as np
import pytest

import flockana as fl
from flockana.sources.zavlanos_2007.laws import LinkKeeping
from tests.refused import refused

CHAIN = LinkKeeping(((1, 0), (1, 2)), r=2.0, k=0.5, c=0.25)
Q = np.array([[0.0, 0.0], [1.2, 0.0], [1.2, 0.9]])
P = np.array([[0.1, 0.0], [0.0, 0.2], [0.0, -0.3]])


def test_force_energy_and_rate_by_hand():
    u = CHAIN.acceleration(0.0, Q, P)
    w = [0.5 * (4.0 - s) / (2.0 - s) ** 2 for s in (1.2, 0.9)]  # ψ'/s
    assert u[0] == pytest.approx([w[0] * 1.2 + 0.25 * -0.1, 0.25 * 0.2], rel=1e-14)
    assert u[2] == pytest.approx([0.0, -w[1] * 0.9 + 0.25 * 0.5], rel=1e-14)
    assert u.sum(axis=0) == pytest.approx([0.0, 0.0], abs=1e-15)
    tension = 0.5 * (1.44 / 0.8 + 0.81 / 1.1)
    assert CHAIN.energy(0.0, Q, P) == pytest.approx(tension + 0.5 * 0.14, rel=1e-14)
    assert CHAIN.energy_rate(0.0, Q, P) == pytest.approx(-0.25 * (0.01 + 0.04 + 0.25), rel=1e-14)


def test_pairs_without_a_link_do_not_interact():
    alone = LinkKeeping((), r=1.0)
    assert not alone.acceleration(0.0, Q, P).any()
    assert alone.tension.r == 1.0
    assert (alone.pair, alone.lattice, alone.surfaces) == (None, None, ())


def test_the_length_of_a_level():
    for energy in (1e-9, 0.3, 1e9):
        s = CHAIN.longest(energy)
        assert 0.0 < s <= CHAIN.r
        assert CHAIN.k * s**2 == pytest.approx(energy * (CHAIN.r - s), rel=1e-6, abs=1e-9 * energy)
    assert CHAIN.longest(0.0) == 0.0


test_bad_input = refused(
    (lambda: LinkKeeping(((0, 1), (1, 0))), "once"),
    (lambda: LinkKeeping(((0, 1, 2),)), "two different agents"),
    (lambda: LinkKeeping(((-1, 0),)), "two different agents"),
    (lambda: fl.simulate(LinkKeeping(((0, 1),)), Q, P, (0.0, 1.0)), r"link \(0, 1\) is 1.2 long"),
    (lambda: LinkKeeping(((0, 7),)).acceleration(0.0, Q, P), "name agent 7"),
)


def test_it_is_compiled_beside_terms_without_a_list_alone():
    rng = np.random.default_rng(1)
    law = LinkKeeping(((0, 1), (2, 1)), r=2.0, k=1.5, c=0.5)
    q, p = rng.uniform(0.0, 1.0, (4, 3)), rng.normal(size=(4, 3))
    ours, plain = (fl.simulate(law, q, p, (0.0, 3.0), method=name) for name in ("DOP853", "scipy-DOP853"))
    assert ours.stats["steps"] == plain.stats["steps"]
    np.testing.assert_allclose(ours.q, plain.q, atol=1e-9)
    np.testing.assert_allclose(ours.extra["work"], plain.extra["work"], atol=1e-8)
    assert np.abs(ours.energy_residual).max() < 1e-6
    assert law.compiled(3) is not None
    listed = fl.PairTerm(fl.AlphaInteraction(), 1.0, 1.0)
    both = type("Both", (LinkKeeping,), {"terms": (*law.terms, listed)})(law.links)
    assert both.compiled(3) is None  # agents are sorted for the list, and links name them by their numbers
