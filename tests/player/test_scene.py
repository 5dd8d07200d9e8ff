import numpy as np
import pytest

from flockana import Algorithm1, Algorithm3, Capsule, Gains, LinearTarget, Sphere, Wall, scenario, simulate
from flockana.player.run_codec import decode
from flockana.player.scene import kept, outlines, scene
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking

Q = np.array([[0.0, 0.0], [7.0, 0.0], [3.0, 6.0]])


def short(law, q=Q, until=1.0, **how):
    return simulate(law, q, 0.0 * q, (0.0, until), **how)


def test_the_states_are_the_run_s_to_float32():
    run = short(Algorithm1())
    header, arrays = decode(scene(run, marks=[(0.5, "there")]))
    for name in ("t", "q", "p"):
        np.testing.assert_array_equal(arrays[name], getattr(run, name).astype(np.float32))
    assert (header["reach"], header["length"], header["marks"]) == (8.4, 7.0, [{"t": 0.5, "label": "there"}])
    names = [series["name"] for series in header["series"]]
    assert names[:2] == ["H", "residual"]
    np.testing.assert_allclose(arrays["series_0"], run.energy(), rtol=1e-6)
    effort = np.linalg.norm(run.u, axis=2).max(axis=1)
    np.testing.assert_allclose(arrays[f"series_{names.index('effort')}"], effort, rtol=1e-6)


@pytest.mark.slow
def test_obstacles_and_target():
    solids = Sphere((20.0, 0.0), 4.0), Wall((0.0, -9.0), (0.0, 2.0)), Capsule((30.0, 0.0), (35.0, 0.0), 1.0)
    law = Algorithm3(target=LinearTarget((1.0, 2.0), (3.0, 0.0)), obstacles=solids)
    run = short(law, method="scipy-DOP853")  # which compiles no integrator
    header, arrays = decode(scene(run))
    assert [each["kind"] for each in header["solids"]] == ["sphere", "wall", "other"]
    assert header["solids"][0]["par"] == [20.0, 0.0, 4.0]
    assert header["solids"][1]["par"] == [0.0, -9.0, 0.0, 1.0]
    corners = np.array(header["outlines"][0])
    assert np.abs(corners - (36.0, 0.0)).sum(axis=1).min() < 0.2
    assert header["beta"] == run.law.obstacle_field.beta.r
    np.testing.assert_allclose(arrays["stars"][:, 0], [[1.0 + 3.0 * t, 2.0] for t in run.t], rtol=1e-6)


def test_links_that_are_no_matter_of_range_are_told_by_frame():
    law = MinimalFlocking((1.0, 1.0, 1.0), edges=((0, 1), (1, 2)))
    header, arrays = decode(scene(short(law)))
    assert header["edge_counts"] == [2]
    assert sorted(map(tuple, arrays["edges"].astype(int).tolist())) == [(0, 1), (1, 2)]


def test_in_space_a_curved_obstacle_is_wires_upon_it_and_all_around():
    solid = Capsule((20.0, 0.0, 0.0), (26.0, 3.0, 1.0), 2.0)
    wires = outlines([solid, Sphere((0.0, 0.0, 0.0), 1.0), Wall((0.0, 0.0, -9.0), (0.0, 0.0, 1.0))])
    assert len(wires) == 5
    np.testing.assert_allclose(solid.clearance(np.concatenate(wires)), 0.0, atol=1e-9)
    low, high = np.array([18.0, -2.0, -2.0]), np.array([28.0, 5.0, 3.0])
    np.testing.assert_allclose(np.concatenate(wires).min(axis=0), low, atol=0.5)
    np.testing.assert_allclose(np.concatenate(wires).max(axis=0), high, atol=0.5)
    ball = outlines([Capsule((0.0, 0.0, 0.0), (0.0, 0.0, 1e-6), 1.0)])
    angles = [np.degrees(np.arctan2(wire[0, 1], wire[0, 0])) for wire in ball]
    np.testing.assert_allclose(angles, [0.0, 0.0, 45.0, 90.0, 135.0], atol=0.1)


def test_least_and_greatest_values_of_each_series_are_among_those_of_the_strip():
    t = np.linspace(0.0, 3.0, 1000)
    q = np.array([[0.0, 0.0], [6.7, 0.0], [3.35, 6.0]])  # they swing about their distance, between kept samples too
    run = simulate(Algorithm1(gains=Gains(c1_alpha=30.0, c2_alpha=0.1)), q, 0.0 * q, (0.0, 3.0), t_eval=t)
    header, arrays = decode(scene(run))
    assert len(arrays["series_t"]) < 200
    of = {series["name"]: arrays[f"series_{k}"] for k, series in enumerate(header["series"])}
    effort = np.linalg.norm(run.u, axis=2).max(axis=1)
    for name, values in (("H", run.energy()), ("min_distance", run.metric("min_distance")), ("effort", effort)):
        single = values.astype(np.float32)
        assert (of[name].min(), of[name].max()) == (single.min(), single.max())
    bare = run.metric("min_distance")[kept(len(t), 160)]
    assert bare.max() < run.metric("min_distance").max()  # else this test would say nothing


def test_a_large_run_is_thinned_and_stays_under_a_megabyte():
    rng = np.random.default_rng(0)
    run = simulate(
        Algorithm1(),
        rng.normal(0.0, 60.0, (150, 2)),
        rng.normal(0.0, 1.0, (150, 2)),
        (0.0, 4.0),
        t_eval=np.linspace(0.0, 4.0, 900),
    )
    data = scene(run)
    assert len(data) < 1_000_000
    t = decode(data)[1]["t"]
    assert (len(t), t[0], t[-1]) == (400, 0.0, 4.0)


@pytest.mark.parametrize("name", ["zone-52", "dead-zone-leaders", "headings-meet", "head-on"])
def test_laws_with_a_world_of_their_own(name):
    item = scenario(name)
    run = simulate(
        item.law,
        item.q0,
        item.p0,
        (item.t_span[0], item.t_span[0] + 2.0),
        **{k: v for k, v in item.options.items() if k == "dt"},
    )
    header, arrays = decode(scene(run, exact=False))
    assert arrays["q"].shape[1:] == (run.n, run.m)
    assert len(header["series"]) >= 3


def test_a_series_that_is_not_a_number_everywhere_is_left_out(monkeypatch):
    run = short(Algorithm1())
    metric = type(run).metric
    gap = lambda self, name: metric(self, name) * (np.nan if name == "min_distance" else 1.0)  # noqa: E731
    with_it = [series["name"] for series in decode(scene(run))[0]["series"]]
    monkeypatch.setattr(type(run), "metric", gap)
    assert "min_distance" in with_it
    assert [series["name"] for series in decode(scene(run))[0]["series"]] == [n for n in with_it if n != "min_distance"]
