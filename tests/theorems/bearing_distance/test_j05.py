"""Erratum J5: the path of three that accelerates for ever."""

import pytest


def test_an_edge_is_wanted_at_two_lengths(verdict_of):
    printed = verdict_of("J5").claim("printed")
    assert (printed.status, printed.rigour, printed.margin) == ("refuted", "smt", -0.5)
    assert list(printed.computed.values()) == [1.0, 2.0]


def test_the_runaway(verdict_of):
    """Each run is within 1e-6 of it at the end, by its own error too."""
    runaway = verdict_of("J5").claim("runaway")
    assert runaway.status == "verified"
    assert runaway.computed["largest error"] + runaway.error < 1e-6
    assert runaway.computed["attracts at the rate"] == pytest.approx(0.5, abs=1e-9)
