"""Random starts of section 5.1: where agents begin, how far apart and how fast, and the runs from them."""

import numpy as np

from flockana import ZoneFlocking, components, links, min_distance, simulate
from flockana.sources.jond_2025.theorems import random_starts


def test_starts_are_what_they_say():
    q, p = random_starts.zone_start(3)
    assert q.shape == p.shape == (10, 2)
    assert p.min() > 0.0
    q, _ = random_starts.separated_start(3)
    assert min_distance(q) > 2.0
    assert components(10, links(q, 5.0)).max() == 0


def test_one_run_of_twenty_seconds_from_each_start():
    law = ZoneFlocking()
    runs = random_starts.runs_from_random_starts(law, random_starts.separated_start)
    assert len(runs) == 20
    for seed, run in enumerate(runs):
        np.testing.assert_array_equal(run.q[0], random_starts.separated_start(seed)[0])
        assert run.t[-1] == 20.0
    np.testing.assert_array_equal(runs[3].q, simulate(law, *random_starts.separated_start(3), (0.0, 20.0)).q)


def test_crowds_are_as_dense_and_apart():
    q, p = random_starts.crowd_start(3, 200)
    assert q.shape == p.shape == (200, 2)
    assert min_distance(q) > 2.0
    assert 43.0 < q.max() < 10.0 * 20.0**0.5
    assert p.min() > 0.0 > random_starts.crowd_start(3, 200, any_direction=True)[1].min()
