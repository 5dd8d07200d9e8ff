"""Erratum E7: C* is a share of nodes: the figures of the slides, as printed and as corrected."""


def test_the_figures_of_the_source(verdict_of):
    verdict = verdict_of("E7")
    assert (verdict.claim("printed").computed, verdict.claim("corrected").computed) == (1.0, 0.96)
    assert [verdict.claim(f"connectivity-{k}").computed for k in (1, 2)] == [95 / 99, 95 / 99]
    assert verdict.claim("share-2").computed == 0.2
