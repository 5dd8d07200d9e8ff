"""Erratum E7: C* is a share of nodes: the figures of the slides, as printed and as corrected."""

from __future__ import annotations


def test_the_figures_of_the_source(verdict_of):
    verdict = verdict_of("E7")
    assert (verdict.claim("printed").computed, verdict.claim("corrected").computed) == (1.0, 0.96)
