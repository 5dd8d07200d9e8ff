"""The dead-zone scenarios: as specified, and what they show at other seeds and in other boxes."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from flockana.base.errors import ArgumentError
from flockana.scenarios import scenario


def test_the_default_is_the_specified_one():
    item = scenario("dead-zone")
    assert (item.q0.shape, item.law.dt, item.t_span) == ((50, 2), 0.01, (0.0, 200.0))
    assert 0.0 <= item.q0.min() <= item.q0.max() <= 40.0
    assert np.abs(item.p0).max() <= 1.0
    pair = item.law.law.interaction
    assert (pair.r, pair.delta, pair.k_delta, pair.d1, pair.d2) == (15.0, 4.5, 1.3, 3.5, 12.5)


@pytest.mark.parametrize("seed", [1, 2])
def test_the_spacing_is_that_of_the_reference(seed):
    """3.40 in the mean at k1 = 0.01 (an independent computation with the same scheme)."""
    item = scenario("dead-zone", seed=seed)
    run = item.run()
    claims = {claim.name: claim for claim in item.verify(run)[-1].claims}
    assert claims["lattice"].computed == pytest.approx(3.40, abs=0.01)
    assert claims["consensus"].computed < 1e-9


def test_the_box_decides_whether_the_flock_is_one():
    """Erratum L4. An ensemble over `box` gives the shares: 1.00, 0.84, 0.18 and 0 of 100 seeds at 40, 60, 80, 150."""
    for seed, box, together in ((0, 60.0, "verified"), (1, 150.0, "refuted")):
        item = scenario("dead-zone", seed, box=box)
        assert 0.9 * box < item.q0.max() <= box
        verdicts = item.verify(item.run())
        assert [item.surprises(verdict) for verdict in verdicts] == [(), (), ()]
        assert verdicts[-1].claim("together").status == together
    with pytest.raises(ArgumentError, match="box = -1: expected a number > 0"):
        scenario("dead-zone", box=-1.0)


def test_hard_jumps_leave_the_mismatch_of_the_erratum():
    """Erratum L7: contacts chatter, and velocities stay off the mean by 0.1 to 0.7; how, step by step, is chaos."""
    run = scenario("dead-zone-hard").run()
    off = np.linalg.norm(run.p - run.p.mean(axis=1, keepdims=True), axis=2).max(axis=1)
    late = off[len(off) // 2 :]
    assert late.min() > 0.1  # it never comes to rest (0.45 to 0.98 at eight seeds)
    assert 0.4 < np.median(late) < 0.8  # 0.65 to 0.69
    nearest = KDTree(run.q[-1]).query(run.q[-1], k=2)[0][:, 1]
    assert np.median(nearest) == pytest.approx(3.5, abs=0.01)  # of the mean, one pair that is pressed in takes 0.07
