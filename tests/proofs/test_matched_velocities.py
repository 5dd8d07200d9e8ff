"""The proof that velocities match: what is false of wrong constants, or of another law, is not called proved."""

import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]


from proofs import matched_velocities as proof
from tests.proofs.steps import failing


def test_all_steps_hold():
    assert failing(proof.PROOF.steps()) == []


@pytest.mark.parametrize(("count", "factor", "holds"), [(4, 4, True), (4, 3, False), (1, 1, True)])
def test_squares_over_a_path_need_the_number_of_its_links(count, factor, holds):
    assert proof.over_links(count, factor).holds is holds
