"""Errata L1 to L8: each claim that has a proof names it."""

from __future__ import annotations


def test_claims_name_the_proof_of_what_they_say(verdict_of):
    errata = [f"L{k}" for k in range(1, 9)]
    named = {f"{key}:{claim.name}" for key in errata for claim in verdict_of(key).claims if claim.proof == "dead-zone"}
    assert named == {
        *("L2:printed", "L3:printed", "L3:corrected", "L4:printed", "L5:printed", "L5:corrected", "L6:printed"),
        *("L6:bound", "L8:printed", "L8:contact"),
    }
