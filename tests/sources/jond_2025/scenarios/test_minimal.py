"""The minimal model's runs and the frozen trees: starts as printed, and trees at other seeds."""

import numpy as np
import pytest

from flockana import DiscreteMinimalFlocking, MinimalFlocking, scenario
from flockana.measures.perception import both_ways, out_tree_root


@pytest.mark.slow
@pytest.mark.parametrize("name", ["zone-tree", "zone-path"])
@pytest.mark.parametrize("seed", [1, 7, 11])
def test_trees_hold_from_other_starts_too(name, seed):
    entry = scenario(name, seed)
    for verdict in entry.verify(entry.run()):
        assert entry.surprises(verdict) == ()


@pytest.mark.parametrize(("m", "duration"), [(2, 20.0), (3, 10.0)])
def test_as_printed(m, duration):
    entry = scenario(f"minimal-{m}d-printed", seed=4)
    assert entry.q0.shape == entry.p0.shape == (60, m)
    assert entry.q0.min() >= 0.0
    assert 28.0 < entry.q0.max() <= 30.0
    assert -1.0 <= entry.p0.min() < -0.9
    assert entry.t_span == (0.0, duration)
    assert entry.law == DiscreteMinimalFlocking(MinimalFlocking(10.0, mu=1.0, sigma=1.0), 0.1)
    assert len(entry.run().t) == round(duration / 0.1) + 1


def test_recommended_settings_start_alike():
    for m in (2, 3):
        printed, ours = scenario(f"minimal-{m}d-printed", 3), scenario(f"minimal-{m}d", 3)
        np.testing.assert_array_equal(printed.q0, ours.q0)
        np.testing.assert_array_equal(printed.p0, ours.p0)
        assert not ours.law.law.normalised


def test_the_mean_velocity_is_kept_where_forces_are_mutual():
    entry = scenario("minimal-2d", 2)
    run = entry.run()
    np.testing.assert_allclose(run.p.mean(axis=1), np.tile(entry.p0.mean(axis=0), (len(run.t), 1)), atol=1e-9)


def test_the_trees_are_trees():
    for seed in range(4):
        entry = scenario("zone-tree", seed)
        assert out_tree_root(8, entry.law.edges) == 0
    assert scenario("zone-path").law.edges == both_ways([(k, k + 1) for k in range(5)])
    assert scenario("zone-path").law.reciprocal
    assert scenario("zone-tree", n=4, m=3).q0.shape == (4, 3)


def test_metrics_show_the_edges():
    run = scenario("zone-tree").run()
    error = run.metrics().edge_error.values
    lengths = np.linalg.norm(run.q[0][[j for j, _ in run.law.edges]] - run.q[0][[i for _, i in run.law.edges]], axis=1)
    assert error[0] == pytest.approx(np.abs(lengths - 2.0).max())
    assert error[-1] < 1e-6
    apart = scenario("minimal-2d-printed").run().metrics()
    assert apart.giant_share[-1] < 1.0
    assert apart.connectivity[-1] < 1.0
