"""Erratum E13: which runs the proof by interval arithmetic encloses, and what it counts."""

from dataclasses import replace

import numpy as np
import pytest

from flockana import scenario, simulate, verify


@pytest.fixture(scope="module")
def own():
    return scenario("three-agents-1d")


def proof_of(law, q, p, t_span):
    return verify("E13", simulate(law, q, p, t_span)).claim("printed").disproof


@pytest.mark.parametrize(
    ("start", "until", "proof"),
    [(0.0, 0.03, "distinct-pairs"), (0.0, 0.02, None), (8.0, 8.04, "distinct-pairs"), (8.0, 8.02, None)],
)
def test_the_proof_is_of_this_start_for_as_long_as_both_pairs_take(own, start, until, proof):
    assert proof_of(own.law, own.q0, own.p0, (start, until)) == proof


def test_another_start_or_law_has_no_proof(own):
    later = (0.0, 0.04)
    assert proof_of(own.law, own.q0, np.nextafter(own.p0, 0.0), later) is None
    assert proof_of(own.law, np.add(own.q0, [[0.0], [0.0], [1e-9]]), own.p0, later) is None
    other = replace(own.law, gains=replace(own.law.gains, c2_alpha=1.5))
    assert proof_of(other, own.q0, own.p0, later) is None
