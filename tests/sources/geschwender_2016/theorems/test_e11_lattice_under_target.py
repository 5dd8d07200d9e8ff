"""E11: brackets whose ends were tried, limits that are certified, and laws at the edge of what it speaks of."""

import numpy as np
import pytest

from flockana import Algorithm2, StaticTarget, Tolerances, Trajectory, simulate, theorem, verify
from flockana.base.errors import SolverError
from flockana.equilibria.lattice_collapse import natural_ratio, threshold
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_patch
from flockana.sources.geschwender_2016.theorems import e11_lattice_under_target as module
from flockana.sources.geschwender_2016.theorems.e11_lattice_under_target import collapse_threshold
from flockana.theorems.observed_run import Observed

ORIGIN = StaticTarget((0.0, 0.0))
LAW = Algorithm2(target=ORIGIN)


@pytest.fixture(scope="module")
def settled():
    """Seven agents that come to rest under the default gains, pressed a little."""
    return simulate(LAW, hexagonal_patch(1, 6.95), np.zeros((7, 2)), (0.0, 25.0), t_eval=[0.0, 25.0])


@pytest.fixture
def brackets(monkeypatch):
    """Brackets found before, or why there are none: the search itself takes a quarter of a minute."""

    def give(found):
        monkeypatch.setattr(module, "_brackets", lambda alpha: found)

    give({7: (3.9, 4.0), 19: (1.1, 1.2), 37: (0.52, 0.54)})
    return give


def claims(run):
    return {claim.name: claim for claim in theorem("E11").examine(Observed.of(run), Tolerances())[1]}


def test_a_pressed_flock_at_rest_is_a_quasi_lattice_and_a_minimum(settled, brackets):
    found = claims(settled)
    assert {name: claim.status for name, claim in found.items()} == dict.fromkeys(found, "verified")
    assert found["printed"].margin == pytest.approx(Tolerances().quasi - found["printed"].computed, abs=1e-6)
    assert found["minimum"].margin > 0.99
    assert found["threshold"].error < found["threshold"].margin
    assert found["threshold"].error == pytest.approx(0.5 * np.log(0.54 / 0.52 * 1.2 / 1.1))


def test_a_flock_that_moves_or_stretches_has_no_limit_yet(settled, brackets):
    start = simulate(LAW, hexagonal_patch(1, 6.0), np.zeros((7, 2)), (0.0, 0.05), t_eval=[0.0, 0.05])
    p = settled.p[-1] + 0.3 * np.random.default_rng(0).standard_normal((7, 2))
    swing = simulate(LAW, settled.q[-1], p, (0.0, 0.01), t_eval=[0.0, 0.01])
    for run in (start, swing):
        found = claims(run)
        assert (found["printed"].status, found["minimum"].status) == ("inconclusive", "inconclusive")
        assert "not certified to stay" in found["printed"].detail or "no basin" in found["printed"].detail


def test_without_links_nothing_is_said_of_a_lattice(brackets):
    law = Algorithm2(target=ORIGIN, gains=Gains(c1_gamma=1e-9))
    q = np.array([[-20.0, 0.0], [20.0, 0.0]])
    found = claims(Trajectory(np.array([0.0, 1.0]), np.array([q, q]), np.zeros((2, 2, 2)), np.zeros((2, 2, 2)), law))
    assert found["printed"].status == "inconclusive"
    assert "the last state has no links" in found["printed"].detail
    assert np.isnan(found["printed"].computed)


@pytest.mark.parametrize("gains", [Gains(c1_alpha=0.0), Gains(c1_gamma=0.0), Gains(c1_alpha=0.0, c1_gamma=0.0)])
def test_it_speaks_of_both_forces(gains):
    law = Algorithm2(target=ORIGIN, gains=gains)
    verdict = verify("E11", law=law, q0=hexagonal_patch(1, 7.0), p0=np.zeros((7, 2)), t_span=(0.0, 0.1))
    assert verdict.status == "vacuous"
    assert (verdict.hypotheses[-1].name, verdict.hypotheses[-1].status) == ("c1α > 0 and c1γ > 0", "unmet")


def test_the_threshold_scales_with_the_force():
    """a = b = 5e4 presses ten thousand times as hard: so does the γ-agent that it takes."""
    strong = Algorithm2(alpha=AlphaInteraction(a=5e4, b=5e4), target=ORIGIN)
    assert natural_ratio(strong.alpha) == pytest.approx(1e4 * natural_ratio(LAW.alpha), rel=1e-12)
    for low, high in (collapse_threshold(LAW, 1), np.array(collapse_threshold(strong, 1)) / 1e4):
        assert 3.5 < low < high < 4.5


@pytest.mark.parametrize(
    ("found", "status"),
    [
        ({7: (3.9, 4.0), 19: (3.95, 4.1), 37: (0.52, 0.54)}, "inconclusive"),  # two brackets overlap
        ({7: (1.0, 1.1), 19: (3.95, 4.1), 37: (0.52, 0.54)}, "refuted"),
        ({7: (0.01, 4.0), 19: (0.01, 0.02), 37: (0.005, 0.009)}, "inconclusive"),  # one tells nothing
        ("collapse, or no result, at all ratios down to 1e-6", "inconclusive"),
    ],
)
def test_brackets_that_do_not_lie_below_each_other(settled, brackets, found, status):
    brackets(found)
    claim = claims(settled)["threshold"]
    assert claim.status == status


def test_both_ends_of_a_bracket_have_been_tried():
    for lowest in (1e-3, 1.0, 50.0):
        tried = {}

        def collapsing(ratio, tried=tried):
            tried[ratio] = ratio > 0.7
            return tried[ratio]

        low, high = threshold(collapsing, lowest=lowest, factor=1.3)
        assert tried[low] is False
        assert tried[high] is True
        assert high / low < 1.02


def test_a_try_that_fails_widens_the_bracket():
    def moody(ratio):
        if 0.5 < ratio < 0.9:
            raise SolverError("did not settle")
        return ratio > 0.7

    low, high = threshold(moody, lowest=0.1, factor=1.3)
    assert low <= 0.5
    assert high >= 0.9
    with pytest.raises(SolverError, match=r"collapse, or no result, at all ratios down to .*: expected no collapse"):
        threshold(lambda ratio: True)
