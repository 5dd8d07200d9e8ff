"""The table of errata against the catalogue, and numbers of errata that are known beforehand."""

from math import tanh

import numpy as np
import pytest

from flockana import DeadZoneInteraction, components, scenario, theorem, theorems
from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.sources.jond_2025.theorems.j01_edge_limits import random_forest
from flockana.sources.jond_2025.theorems.j03_eigenvalue_pairs import path_matrices
from flockana.sources.jond_2025.theorems.j07_speed_bound import dragged_speed
from flockana.sources.jond_2025.theorems.j17_late_reaction import first_step
from flockana.theorems.errata import SORTS, Erratum, errata, erratum_of, printed

RUNS = {"E11": "collapse", "E12": "msn-case4", "E13": "three-agents-1d"}  # a scenario that expects it
OTHER = ("tanner-minimum", "zone-separation")  # errata of the classics, and one without a number


def test_each_erratum_of_the_catalogue_stands_in_the_table_once():
    names = [item.id for item in errata()]
    assert len(set(names)) == len(names)
    numbered = {name for name in theorems() if name[0].isupper()}
    assert {name for name in names if not name.startswith("misprint")} == {*numbered, *OTHER}


@pytest.mark.parametrize("item", errata(), ids=lambda item: item.id)
def test_statuses_are_those_expected_of_the_catalogue(item):
    assert all((item.printer, item.where, item.in_paper))
    if item.id.startswith("misprint"):
        assert (item.claim, item.right_claim, item.mark) == (("", ""), ("", ""), "·")
        return
    expected = scenario(RUNS[item.id]).expected if item.id in RUNS else theorem(item.id).expected
    for name, status in (item.claim, item.right_claim):
        assert not name or expected[f"{item.id}:{name}"] == status
    assert item.right_claim[1] in ("verified", "")
    assert item.claim[1] in {"wrong": ("refuted",), "incomplete": ("refuted", ""), "confirmed": ("verified",)}.get(
        item.sort, ("verified", "vacuous")
    )


@pytest.mark.parametrize("item", [item for item in errata() if item.claim[0]], ids=lambda item: item.id)
def test_what_is_printed_is_the_sources_claim_and_what_is_right_is_its_own_or_a_correction(item):
    checked = theorem(item.id)
    assert checked.by(item.claim[0]) == "source"
    assert checked.erratum == item
    if item.sort == "wrong" and item.right_claim[0]:
        # what is right may be a part of what the source says
        assert item.right_claim != item.claim
    assert (checked.title == printed(item.id)) or item.id == "J6"


def test_sorts_are_those_that_are_explained():
    assert {item.sort for item in errata()} == set(SORTS)
    assert erratum_of("E4").sort == "vacuous"
    assert erratum_of("os-1") is None
    with pytest.raises(ArgumentError, match="erratum E0: sort = 'odd', expected one of wrong, incomplete, vacuous"):
        Erratum("E0", "a", "b", "c", ("", ""), "d", ("", ""), "odd", "no")
    with pytest.raises(UnknownNameError, match="unknown erratum 'E99'"):
        printed("E99")


def test_none_says_that_the_paper_has_it_unless_it_is_the_paper():
    assert {item.in_paper for item in errata() if item.id[0] == "E"} == {"not looked up", "no, the project's own"}
    assert {item.in_paper for item in errata() if item.id[0] in "JL"} == {"it is the paper"}


# --- numbers known beforehand: by hand, from the source, or from an independent calculation ---------------------------

approx = pytest.approx
COMPONENTS, LEAST = "components by seed", "least distance by seed"


def computed(name):
    return lambda claim: claim.computed[name]


def witness(name):
    return lambda claim: claim.witness[name]


def share_that_fails(claim):
    return 1.0 - claim.computed["holds"] / claim.computed["of"]


def how(claim):
    return claim.status, claim.rigour


KNOWN = [  # erratum, claim, what of it, its value
    ("J1", "corrected", computed("trees"), 200),
    ("J1", "corrected", lambda claim: claim.computed["interval"][0], approx(0.025 ** (1 / 200))),  # (α/2)^(1/200)
    ("J1", "printed", computed("trees whose edges might all vanish"), 0),
    ("J2", "hurwitz", "margin", approx(-(5**0.5 - 1) / 2)),
    ("J2", "hurwitz", witness("largest real part of the law's Jacobian there"), approx(0.618034)),
    ("J2", "positive-definite", "margin", approx(1 - 5**0.5 / 2)),
    ("J3", "printed", "computed", approx(0.2494, abs=1e-4)),
    ("J3", "hurwitz", "computed", approx(0.0108, abs=1e-4)),
    ("J5", "printed", lambda claim: (*how(claim), claim.margin), ("refuted", "smt", -0.5)),
    ("J5", "printed", lambda claim: list(claim.computed.values()), [1.0, 2.0]),  # an edge is wanted at two lengths
    ("J5", "runaway", "status", "verified"),
    ("J5", "runaway", computed("attracts at the rate"), approx(0.5, abs=1e-9)),
    ("J7", "speed", witness("mean speed over seeds"), approx(1.98, abs=0.03)),
    ("J7", "clip", witness("mean speed over seeds"), approx(3.0, abs=0.03)),
    ("J8", "holds-together", lambda claim: np.median(claim.witness[COMPONENTS]), 10),  # the flock disperses
    ("J9", "corrected", "computed", approx(3.0, abs=1e-6)),
    ("J10", "distances", share_that_fails, approx(0.96, abs=0.01)),
    ("J12", "stand-off", lambda claim: claim.computed.keys() == claim.stated.keys(), True),
    ("J12", "contact", computed("distance from the wall"), approx(0.0, abs=1e-6)),
    ("J14", "one-informed", "computed", approx([3.0, 3.0], rel=1e-8)),
    ("J14", "none-informed", "computed", approx([1.5, 1.5], rel=1e-8)),
    ("J15", "printed", "computed", approx(2.5, rel=1e-12)),
    ("J15", "alone", "computed", approx(3.0, rel=1e-6)),
    ("J17", "delay", "stated", approx(3.0 / 4.5)),
    ("L3", "printed", lambda claim: (*how(claim), claim.computed), ("refuted", "symbolic", "2*k_r")),
    ("L3", "corrected", lambda claim: (*how(claim), claim.computed), ("verified", "symbolic", ["0"] * 5)),
    ("L5", "printed", "computed", approx(DeadZoneInteraction(ramp=0.0).far_potential, rel=1e-9)),
    ("L6", "printed", "computed", approx([2.8460, 0.60128, 0.02761], rel=1e-3)),
    ("L8", "contact", "computed", approx(3.49973, abs=1e-5)),  # near where repulsion ends
    ("L9", "energy", "rigour", "symbolic"),
    ("L9", "energy", "witness", ["0", "0", "0"]),  # in each dimension
    ("L9", "different-leaders", "computed", approx(2.0, abs=1e-3)),
    ("L9", "fraction", "witness", {"force": 0.0, "distance": 20.0}),
    ("L10", "printed-necessary", "rigour", "symbolic"),
    ("L10", "not-necessary", "computed", approx(2.0, rel=1e-12)),
    ("E1", "printed", "rigour", "symbolic"),
    ("E1", "printed", "computed", "a residual that is not 0"),
    ("E1", "printed", lambda claim: "phi_alpha" in claim.witness, True),
    ("E1", "corrected", "rigour", "symbolic"),
    ("E1", "corrected", "computed", "residual 0"),
    ("E2", "printed-state", "computed", approx(1.6048889531, rel=1e-9)),
    ("E2", "corrected", "computed", "residual 0"),
    ("E2", "printed", lambda claim: "phi_alpha" in claim.witness, True),
    ("E7", "printed", "computed", 1.0),  # C* is a share of nodes
    ("E7", "corrected", "computed", 0.96),
    ("E7", "connectivity-1", "computed", 95 / 99),
    ("E7", "connectivity-2", "computed", 95 / 99),
    ("E7", "share-2", "computed", 0.2),
    ("E8", "printed", "computed", approx(2.0 / 3.0)),
    ("E8", "corrected", "computed", 1.0),
    ("E9", "printed", lambda claim: (*how(claim), claim.computed), ("refuted", "symbolic", "dt**2*u")),
    ("E9", "corrected", lambda claim: (claim.status, claim.computed), ("verified", "0")),
    ("E9", "excess", lambda claim: (claim.computed, claim.stated), (0.125, 0.125)),
    ("E10", "printed", "computed", "ρ₁(1⁻) - ρ₁(1⁺) = 1"),
]
BETWEEN = [  # the same with bounds, ends excluded
    ("J5", "runaway", lambda claim: claim.computed["largest error"] + claim.error, -1.0, 1e-6),
    ("J8", "equivalent", lambda claim: min(claim.witness["mean error of the estimate, by seed"]), 5.0, np.inf),
    ("J9", "printed", "computed", -np.inf, -10.0),  # the agent is far beyond the alien
    ("J12", "stand-off", lambda claim: max(abs(x - claim.stated[k]) for k, x in claim.computed.items()), -1.0, 1e-9),
    ("J12", "stand-off", "margin", 0.9e-6, np.nextafter(1e-6, 1.0)),  # what is left of 1e-6, in units of c
    ("J14", "none-of-ten", lambda claim: np.ptp(claim.witness["mean speed by seed"]), 0.5, np.inf),  # each its own
    ("J15", "sliding", lambda claim: claim.computed[0], 1.5 * (1.0 - 5e-3), 1.5),  # not at c w/(w + g) = 1
    ("J15", "sliding", lambda claim: claim.computed[1], 1.5, 1.5 * (1.0 + 5e-3)),
    ("J15", "flock", lambda claim: max(claim.witness[LEAST]), -np.inf, 3.0),
    ("J17", "nearer", lambda claim: float(np.diff(list(claim.computed.values()))[0]), 2.7, 3.3),  # what is seen less
    ("J18", "any-direction", lambda claim: min(claim.witness[COMPONENTS]), 1, np.inf),
    ("J18", "local", lambda claim: claim.computed[500] / claim.computed[100], 1.0, 1.25),
    ("L7", "chatter", lambda claim: claim.computed[0], 0.06, 0.1),  # √K̃ over time: from eight starts 0.075 to 0.086
    ("L7", "chatter", lambda claim: claim.computed[1] / claim.computed[0], 0.0, 0.5),
    ("L9", "one-leader", "computed", -np.inf, 1e-3),
    ("L10", "sufficient", "computed", -np.inf, 1.0),
    ("E2", "printed-run", lambda claim: claim.computed / claim.error, 100.0, np.inf),
    ("E2", "printed-run", lambda claim: claim.witness["time"], 0.0, 0.1),
]


def part(claim, what):
    return getattr(claim, what) if isinstance(what, str) else what(claim)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted({row[0] for row in (*KNOWN, *BETWEEN)}))
def test_what_is_known(name, verdict_of):
    for _, claim, what, value in (row for row in KNOWN if row[0] == name):
        assert part(verdict_of(name).claim(claim), what) == value, claim
    for _, claim, what, low, high in (row for row in BETWEEN if row[0] == name):
        assert low < part(verdict_of(name).claim(claim), what) < high, claim


def test_the_forest_is_made_of_trees():
    law, q, _ = random_forest(40, 5)
    labels = components(len(q), np.array(law.edges, dtype=np.int32))
    assert labels.max() == 39
    sizes = np.bincount(labels)
    assert sizes.min() >= 2
    assert sizes.max() <= 8
    assert np.bincount([i for _, i in law.edges], minlength=len(q)).max() == 1


def test_the_path_of_four():
    stiffness, damping = path_matrices(1.0)
    # by hand: ends want 1 and have 2.05, the middle ones want 2; an edge's row is minus the difference of two agents
    end, own, middle = 1 - 1 / 2.05, 1 - 2 / 2.05, 1 - 2 / 2.7
    np.testing.assert_allclose(stiffness[0], [end + own, -middle, 0.0], atol=1e-12)
    np.testing.assert_allclose(stiffness[1], [-own, 2 * middle, -own], atol=1e-12)
    np.testing.assert_allclose(damping, [[1.5, -0.5, 0.0], [-0.5, 1.0, -0.5], [0.0, -0.5, 1.5]], atol=1e-12)


def test_the_drag_and_that_what_never_happens_has_no_first_step():
    assert dragged_speed(0.1) == pytest.approx(2.0083, abs=5e-5)
    speeds = [dragged_speed(dt) for dt in (0.05, 0.01, 0.001)]
    np.testing.assert_allclose(speeds, [1.628, 0.974, 0.457], atol=1e-3)  # found by iteration, to three digits
    v = dragged_speed(0.1)
    assert 4.0 * tanh((v + 0.2) / 4.0) == pytest.approx(v, abs=1e-12)
    # Its number would be 0 by argmax, and two such would have no delay
    assert first_step(np.array([False, False, True, True])) == 2.0
    assert np.isnan(first_step(np.zeros(3, dtype=bool)))
