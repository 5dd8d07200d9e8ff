"""Statements that need no run: what the sources print and what is true, claim by claim, asked again and again."""

from __future__ import annotations

from dataclasses import replace

import pytest

from flockana import Tolerances, verify
from flockana.stability.delay import DELAYED
from tests.adversarial.cases import FALSE, REFUTED, TRUE, VERIFIED
from tests.adversarial.published import changes

# from the list of errata: `r` what is printed and false, `v` what is true; a search may come back without an answer
TRUTHS = {
    "E1": {"r": "printed printed-state printed-run", "v": "corrected"},
    "E2": {"r": "printed printed-state printed-run", "v": "corrected"},
    "E3": {"r": "share double-agent smallest strained algorithm-2"},
    "E4": {"v": "printed found vacuous barrier together"},
    "E5": {"r": "printed-13 printed-8", "v": "uncrossed-13 uncrossed-8 six"},
    "E6": {"r": "printed", "v": "corrected sharp"},
    "E7": {"r": "printed", "v": "corrected connectivity-1 connectivity-2 share-2"},
    "E8": {"r": "printed", "v": "corrected"},
    "E9": {"r": "printed", "v": "corrected excess"},
    "E10": {"r": "printed", "v": "corrected"},
    "E14": {"r": "printed translation", "v": "corrected state"},
    "E15": {"r": "printed-start printed-speed", "v": "predicted faster faster-as-run first-grows condition"},
    "E16": {"v": "necessary insufficient"},
    "deviation-energy": {"v": "jump corner potential-continuous potential-smooth"},
    "directed-nets": {"v": "undirected momentum-lost energy-rises follower leader"},
    "J1": {"r": "printed", "v": "corrected"},
    "J2": {"r": "hurwitz positive-definite", "v": "outside"},
    "J3": {"r": "printed hurwitz", "v": "trees"},
    "J4": {"r": "28 identity", "v": "34 loop"},
    "J5": {"r": "printed", "v": "runaway"},
    "J6": {"v": "directed-2 directed-3 undirected-2 undirected-3"},
    "J7": {"r": "reachable speed", "v": "step clip"},
    "J8": {"r": "equivalent holds-together", "v": "forms measured"},
    "J9": {"r": "printed flock", "v": "corrected"},
    "J10": {"r": "distances order weights", "v": "unordered-still recommended"},
    "J11": {"r": "aligned-2d aligned-3d cohesive-2d", "v": "recommended-2d recommended-3d"},
    "J12": {"r": "printed contact", "v": "corrected stand-off"},
    "J13": {"r": "letter clamped", "v": "reaching stand-off"},
    "J14": {"v": "one-informed none-informed two-of-ten none-of-ten"},
    "J15": {"r": "printed flock", "v": "rest sliding alone"},
    "J16": {"r": "at-walls fragments", "v": "growing", "maybe": "circling"},
    "J17": {"v": "delay none nearer"},
    "J18": {"v": "flock-10 flock-100 flock-500 local any-direction"},
    "L1": {"r": "printed", "v": "corrected"},
    "L2": {"r": "printed", "v": "corrected"},
    "L3": {"r": "printed", "v": "corrected"},
    "L4": {"r": "printed", "v": "wide-starts"},
    "L5": {"r": "printed", "v": "corrected across-the-switch"},
    "L6": {"v": "printed bound"},
    "L7": {"r": "printed", "v": "components chatter sliding ramp"},
    "L8": {"r": "printed balance-distance", "v": "contact"},
    "L9": {"r": "printed fraction", "v": "energy one-leader different-leaders acceleration acceleration-needed"},
    "L10": {"r": "printed-sufficient printed-necessary", "v": "sufficient not-necessary"},
    "tanner-minimum": {"r": "printed", "v": "corrected second-order"},
    "delay-margin": {"v": " ".join([*(f"algorithm-{k}-{late}" for k in (1, 2) for late in DELAYED), "pair"])},
    "sampling-margins": {"r": "msn", "v": "msn-few msn-few-in-place notebook-1 notebook-2 minimal"},
    "linearised-decay": {"v": "decay random range"},
    "zone-separation": {"r": "close-encounters", "v": "alone energy chain"},
    "delayed-consensus": {"v": "margin below above root-below root-above average"},
    "jlm-cut": {"v": "frame-bound clear-of-cut vectors"},
    "heterogeneous-gains": {"v": "printed simplified", "maybe": "apart"},
}
THEOREMS = tuple(TRUTHS)
SLOW = ("E3", "J11", "delay-margin", "sampling-margins", "linearised-decay", "heterogeneous-gains")


def cases():
    return [pytest.param(name, marks=pytest.mark.attack if name in SLOW else ()) for name in TRUTHS]


def expected(name):
    marks = {"r": REFUTED, "v": VERIFIED, "maybe": TRUE}
    return {claim: marks[kind] for kind, claims in TRUTHS[name].items() for claim in claims.split()}


@pytest.mark.parametrize("name", cases())
def test_what_is_printed_and_what_is_true(name, verdict_of):
    said = {claim.name: claim.status for claim in verdict_of(name).claims}
    assert said.keys() == expected(name).keys()
    assert {claim: said[claim] for claim, allowed in expected(name).items() if said[claim] not in allowed} == {}
    assert said == {claim.name: claim.status for claim in verify(name).claims}  # and so the second time
    assert all(claim.detail for claim in verdict_of(name).claims)
    assert changes(verdict_of(name)) == [], "if it is meant: python -m tests.adversarial.published"


@pytest.mark.attack
@pytest.mark.parametrize("factor", [0.5, 2.0])
@pytest.mark.parametrize("name", THEOREMS)
def test_thresholds_do_not_decide_what_is_true(name, factor):
    """Half and twice the tolerances (shares in (0, 1) stay such): nothing turns from true to false."""
    own = Tolerances()
    numbers = (
        "energy",
        "velocity",
        "force",
        "lattice",
        "quasi",
        "curvature",
        "contact",
        "deviation",
        "mismatch",
        "agreement",
    )
    scaled = replace(own, **{field: factor * getattr(own, field) for field in numbers})
    for claim in verify(name, tolerances=scaled).claims:
        assert claim.status in (FALSE if expected(name)[claim.name] == REFUTED else TRUE), claim
