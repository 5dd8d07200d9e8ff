"""Joint connectivity over windows, and diameters, against their definitions."""

from math import isnan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana import Algorithm1, HeadingAveraging, MinimalFlocking, components, diameter, joint_windows, simulate
from flockana.measures.connectivity_windows import windows_of
from flockana.measures.measure import measures
from tests.refused import refused

pairs = st.tuples(st.integers(0, 3), st.integers(0, 3)).filter(lambda pair: pair[0] < pair[1])


@given(st.lists(st.lists(pairs, max_size=2), max_size=12))
def test_windows_are_contiguous_jointly_connected_and_shortest(nets):
    nets = [np.array(net, dtype=np.int32).reshape(-1, 2) for net in nets]
    windows = joint_windows(4, nets)
    assert [start for start, _ in windows] == [0, *[stop for _, stop in windows]][: len(windows)]
    for start, stop in windows:
        assert components(4, np.concatenate(nets[start:stop])).max() == 0
        assert stop - start == 1 or components(4, np.concatenate(nets[start : stop - 1])).max() > 0
    rest = nets[windows[-1][1] if windows else 0 :]
    assert not rest or components(4, np.concatenate(rest)).max() > 0


def test_one_agent_is_connected_at_every_instant():
    assert joint_windows(1, [np.empty((0, 2), dtype=int)] * 2) == ((0, 1), (1, 2))


def test_windows_of_a_run():
    run = simulate(Algorithm1(), [[0.0], [7.0]], [[0.0], [0.0]], (0.0, 1.0), t_eval=[0.0, 0.5, 1.0])
    assert windows_of(run) == ((0, 1), (1, 2), (2, 3))
    assert isnan(measures()["joint_windows"].number(run))  # not of every law: it costs a net for each sample
    law = HeadingAveraging(range=8.0)
    flock = simulate(law, [[0.0, 0.0], [7.0, 0.0]], law.velocities([1.0, 1.0]), (0.0, 2.0))
    assert measures()["joint_windows"].number(flock) == 3.0


@given(st.integers(1, 7), st.integers(1, 3), st.integers(0, 99))
def test_the_diameter_is_the_greatest_distance(n, m, seed):
    x = np.random.default_rng(seed).normal(size=(n, m))
    assert diameter(x) == pytest.approx(max(np.linalg.norm(a - b) for a in x for b in x), abs=1e-15)


LONE = MinimalFlocking(edges=[(0, 1)], spacing=1.0)
test_bad_input = refused(
    (lambda: windows_of(simulate(LONE, [[0.0], [1.0]], [[0.0]] * 2, (0.0, 0.1))), "MinimalFlocking has no net"),
)
