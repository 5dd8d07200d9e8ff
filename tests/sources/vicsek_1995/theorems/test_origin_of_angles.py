"""Mean headings counted from a direction: the pair that turns round, as it is told."""

from fractions import Fraction

from flockana.sources.vicsek_1995.theorems.origin_of_angles import averaged


def test_the_witness_is_the_pair_whose_mean_is_turned_round(verdict_of):
    claim = verdict_of("jlm-cut").claim("frame-bound")
    pair = [Fraction(heading) for heading in claim.witness["headings, in turns"]]
    assert sum(pair) == 1  # as far to one side of direction 0 as to the other
    assert str(averaged(tuple(pair))) == claim.witness["mean"] == claim.computed == "1/2"
