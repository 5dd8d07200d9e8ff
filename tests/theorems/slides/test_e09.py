"""Erratum E9: the excess of the printed step."""

from flockana.theorems import verify


def test_printed_and_corrected():
    verdict = verify("E9")
    assert verdict.status == "refuted"
    assert verdict.claim("printed").computed == "dt**2*u"
    assert (verdict.claim("printed").status, verdict.claim("printed").rigour) == ("refuted", "symbolic")
    assert (verdict.claim("corrected").status, verdict.claim("corrected").computed) == ("verified", "0")
    assert verdict.claim("excess").computed == verdict.claim("excess").stated == 0.125
