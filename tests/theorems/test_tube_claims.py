"""Verdicts from tubes: decided where the tube is narrow enough, with a reason where it is not."""

from types import SimpleNamespace

import numpy as np
import pytest
from flint import arb

from flockana import Algorithm1, Algorithm2, Basin, StaticTarget, Tolerances, enclose, simulate, verify
from flockana.base.errors import ArgumentError
from flockana.certified.structural_potential import Structure
from flockana.theorems.tube_claims import met, rest_strain
from tests.theorems.made_up import statuses

LED = Algorithm2(target=StaticTarget((0.0,)))
NEAR = np.array([[-3.5], [3.5]])


class Everything(Basin):
    """A basin that says of every state whether it holds it, and of itself that it is whole."""

    def __init__(self, law, answer=True):
        for name, value in {"law": law, "answer": answer, "rest": NEAR}.items():
            object.__setattr__(self, name, value)

    def ensure_unedited(self):
        pass

    @property
    def proof(self):
        law, (n, m) = self.law, self.rest.shape
        return SimpleNamespace(structure=Structure.of(law, n, m), rest=[arb(x) for x in self.rest.ravel().tolist()])

    def holds(self, q, p):
        return self.answer


@pytest.fixture(scope="module")
def pair():
    return enclose(LED, NEAR, 0.0 * NEAR, (0.0, 0.25))


def test_all_of_theorem_3_is_decided_and_its_rigour_reads_interval(pair):
    verdict = verify("os-3", pair, basin=Everything(LED))
    assert (verdict.status, verdict.rigour) == ("verified", "interval")
    decided = statuses(verdict)
    assert [name for name, status in decided.items() if status == "vacuous"] == []
    assert decided["ii"] == decided["iii"] == decided["iv-none"] == "verified"
    assert "from then on in the basin" in verdict.claim("iv-none").detail
    assert verdict.claim("iv-none").margin < 7.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("basin", "reason"),
    [
        (None, "no certified basin was given"),
        (Everything(LED, answer=False), "is not certainly in the basin"),
        (Everything(Algorithm1()), "is not certainly in the basin"),  # that of another law
    ],
)
def test_a_limit_needs_a_basin_that_certainly_holds_the_end(pair, basin, reason):
    verdict = verify("os-3", pair, basin=basin)
    assert verdict.status == "inconclusive"
    assert verdict.claim("i").status == "verified"
    assert verdict.claim("ii").status == "inconclusive"
    assert reason in verdict.claim("ii").detail
    assert (verdict.claim("iii").status, verdict.claim("iii").rigour) == ("verified", "smt")  # proved of every start


def test_a_tube_that_ends_early_proves_no_limit():
    broken = enclose(LED, NEAR, 0.0 * NEAR, (0.0, 1.0), steps=2)
    claim = verify("os-3", broken, basin=Everything(LED)).claim("ii")
    assert claim.status == "inconclusive"
    assert "the tube ends early: it took 2 steps" in claim.detail


def test_a_tube_that_breaks_proves_no_absence_of_collisions():
    law, q, p = Algorithm1(), np.array([[0.0], [1.0]]), np.array([[32.0], [-32.0]])
    early = enclose(law, q, p, (0.0, 0.0625), steps=1)
    whole = enclose(law, q, p, (0.0, 0.0625))
    twice = verify("collision-energy", early).claim("twice")
    assert (twice.status, verify("collision-energy", whole).claim("twice").status) == ("inconclusive", "refuted")
    assert "always" not in twice.stated
    at_once = enclose(LED, NEAR, 0.0 * NEAR, (0.0, 1.0), radius=3.5, widest=0.1)
    assert (at_once.status, len(at_once.taken)) == ("broken", 0)
    assert at_once.min_distance().lower <= 0.0
    assert set(statuses(verify("os-3", at_once)).values()) <= {"inconclusive", "vacuous"}


def test_a_tube_that_is_too_wide_is_inconclusive_and_says_so():
    wide = enclose(LED, NEAR, 0.0 * NEAR, (0.0, 0.03125), radius=(3.75, 0.0), widest=100.0)
    verdict = verify("collision-energy", wide)
    assert verdict.status == "inconclusive"
    assert "too wide to tell: the margin is between" in verdict.claim("twice").detail
    assert [h.status for h in verdict.hypotheses if h.name.startswith("H(0)")] != ["met", "met"]


def test_agents_that_change_places_on_a_line_met():
    law = Algorithm1()
    tube = enclose(law, [[0.0], [1.0]], [[32.0], [-32.0]], (0.0, 0.03125))
    assert list(met(tube)) == [(0, 1)]
    assert 1.0 / 64.0 < met(tube)[0, 1] <= 0.03125
    verdict = verify("collision-energy", tube)
    assert statuses(verdict) == {"below": "vacuous", "twice": "refuted"}
    assert verdict.rigour == "interval"
    beside = enclose(law, [[0.0, 0.0], [1.0, 0.0]], [[32.0, 0.0], [-32.0, 0.0]], (0.0, 0.03125))
    assert met(beside) == {}
    assert statuses(verify("collision-energy", beside))["twice"] == "inconclusive"


@pytest.mark.slow
def test_theorem_1_from_a_tube():
    law = Algorithm1()
    tube = enclose(law, NEAR, 0.0 * NEAR, (0.0, 0.125))
    verdict = verify("os-1", tube, basin=Everything(law))
    assert verdict.hypotheses[3].status == "met"  # two at rest at d cannot part
    assert statuses(verdict) == {"i": "verified", "ii": "verified", "iii": "verified", "iii-barrier": "verified"}
    stretched = Everything(law)
    object.__setattr__(stretched, "rest", 1.1 * NEAR)
    strained = verify("os-1", tube, basin=stretched).claim("i")
    assert (strained.status, strained.margin < -strained.error) == ("refuted", True)
    apart = enclose(law, 3.0 * NEAR, 0.0 * NEAR, (0.0, 0.125))
    assert set(statuses(verify("os-1", apart)).values()) == {"vacuous"}


def test_flocking_is_judged_at_all_times_of_its_window(pair):
    plain, strict = verify("alpha-flocking", pair), verify("alpha-flocking-strict", pair)
    assert set(statuses(plain).values()) == set(statuses(strict).values()) == {"verified"}
    apart = enclose(Algorithm1(), [[0.0], [20.0]], [[0.0], [1.0]], (0.0, 1.0))
    assert statuses(verify("alpha-flocking-strict", apart))["flock"] == "refuted"
    assert statuses(verify("alpha-flocking", apart))["giant"] == "refuted"
    halved = verify("alpha-flocking", pair, tolerances=Tolerances(deviation=1e-12)).claim("deviation")
    assert halved.status == "refuted"


def test_what_a_tube_cannot_decide_is_said(pair):
    with pytest.raises(ArgumentError, match="energy is not decided from a tube: expected a Trajectory, or one of"):
        verify("energy", pair)
    with pytest.raises(ArgumentError, match="a basin decides the limit of a tube"):
        verify("os-3", simulate(LED, NEAR, 0.0 * NEAR, (0.0, 0.1)), basin=Everything(LED))


def test_the_strain_of_an_equilibrium_is_a_ball_of_its_links():
    basin = Everything(LED)
    object.__setattr__(basin, "rest", np.array([[-3.5], [3.5], [10.85]]))  # links of 7 and 7.35, a pair of 14.35
    assert abs(rest_strain(basin, LED.alpha) - arb("0.05")) < 1e-12
    object.__setattr__(basin, "rest", 2.0 * NEAR)
    assert rest_strain(basin, LED.alpha) == 1
    near_r = SimpleNamespace(structure=Structure.of(LED, 2, 1), rest=[arb(0), arb(8.4, 0.1)])
    strain = rest_strain(SimpleNamespace(proof=near_r), LED.alpha)
    assert strain.contains(arb("0.2"))  # a link of 8.4
    assert strain.contains(arb(1))  # or none
