"""Numbers of errata that are known beforehand: by hand, from the source, or from an independent calculation."""

import numpy as np
import pytest

from flockana.interactions import DeadZoneInteraction
from flockana.theorems import theorem

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


def named(row):
    return f"{row[0]}-{row[1]}"


@pytest.mark.parametrize("row", KNOWN, ids=named)
def test_what_is_known(row, verdict_of):
    name, claim, what, value = row
    assert part(verdict_of(name).claim(claim), what) == value


@pytest.mark.parametrize("row", BETWEEN, ids=named)
def test_what_is_known_within_bounds(row, verdict_of):
    name, claim, what, low, high = row
    assert low < part(verdict_of(name).claim(claim), what) < high


@pytest.mark.parametrize("name", ["E2", "E9"])
def test_statuses_are_as_the_catalogue_expects(name, verdict_of):
    verdict, expected = verdict_of(name), dict(theorem(name).expected)
    assert expected.pop(name) == verdict.status == "refuted"
    assert {f"{name}:{claim.name}": claim.status for claim in verdict.claims} == expected
