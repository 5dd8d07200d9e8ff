"""Recordings: what they hold, what they refuse, and what is measured of them without a law."""

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError, FlockanaError
from flockana.recorded.accuracy import band
from flockana.recorded.recording import recording_of

T = np.linspace(0.0, 1.0, 11)


@pytest.fixture(scope="module")
def run():
    q0 = fl.lattice.triangular(12, 7.0) + np.random.default_rng(0).normal(0.0, 1.0, (12, 2))
    p0 = np.random.default_rng(1).normal(0.0, 1.0, (12, 2))
    return fl.simulate(fl.Algorithm1(), q0, p0, (0.0, 1.0), t_eval=T)


def test_gaps_are_whole_vectors_and_are_counted(run):
    q = run.q.copy()
    q[3, 2, 1] = np.nan
    rec = fl.Recording(T, q, run.p)
    assert rec.gaps == 1
    assert np.isnan(rec.q[3, 2]).all()
    assert not rec.present[3, 2]
    assert rec.window(0.35, 1.0).gaps == 0
    assert rec.select(agents=[0, 1]).gaps == 0
    assert fl.Recording(T, np.ma.masked_greater(run.q, 1e9)).gaps == 0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"t": T[::-1]}, "expected rising times"),
        ({"t": T[:-1]}, "expected 11 times"),
        ({"q": np.zeros((11, 24))}, r"expected \(T, n, m\)"),
        ({"p": np.zeros((11, 3, 2))}, r"p has shape \(11, 3, 2\): expected \(11, 12, 2\)"),
        ({"q": np.full((11, 12, 2), np.inf)}, r"q\[0, 0, 0\] = inf: expected numbers up to 1e\+50"),
        ({"t": T * 1e52}, r"t\[1\] = 1e\+51: expected numbers up to 1e\+50"),
        ({"q": np.full((11, 12, 2), np.nan)}, "NaN throughout"),
        ({"bound": -1.0}, "bound = -1: expected a number >= 0"),
        ({"bound": 1.0, "sd": 1.0}, "bound and sd are given: expected one kind of accuracy"),
        ({"sd": 1.0, "p_bound": 1.0}, "sd and p_bound are given: .* or sd and p_sd"),
        ({"bound": np.zeros(3)}, r"bound has shape \(3,\)"),
        ({"bound": np.full((11, 12), np.nan)}, "expected a finite number >= 0"),
        ({"bound": [[0.1], [0.1, 0.1]]}, "expected one real number"),
        ({"ids": ["a"]}, "ids has 1 names: expected 12"),
        ({"q": [["a"]]}, "expected real numbers"),
    ],
)
def test_what_is_no_recording_is_refused_in_words(run, change, message):
    with pytest.raises(ArgumentError, match=message):
        fl.Recording(**({"t": T, "q": run.q} | change))


def test_a_band_of_many_samples_is_wider_than_one_of_a_single_sample(run):
    """Of one coordinate the band is the two-sided 0.99 quantile of a Gaussian, 2.5758."""
    assert band(1, 1) == pytest.approx(2.575829, abs=1e-5)
    rec = fl.Recording(T, run.q, run.p, sd=0.1)
    assert rec.accuracy.place == pytest.approx(0.1 * band(2 * 11 * 12, 2))
    rng, width, inside = np.random.default_rng(0), rec.accuracy.place, 0
    for _ in range(400):
        inside += np.linalg.norm(rng.normal(0.0, 0.1, run.q.shape), axis=2).max() <= width
    assert 390 <= inside <= 400  # 0.99 holds of positions and velocities together


def test_units_change_nothing_that_is_measured_in_its_own(run):
    rec = recording_of(run, bound=0.01)
    other = fl.rescale(rec, length=1000.0, time=60.0)
    a, b = rec.metrics(d=7.0, r=8.4), other.metrics(d=7000.0, r=8400.0)
    np.testing.assert_allclose(a["connectivity"], b["connectivity"])
    np.testing.assert_allclose(1000.0 * a["cohesion_radius_error"], b["cohesion_radius_error"])
    np.testing.assert_allclose(
        (1000.0 / 60.0) ** 2 * a["normalised_velocity_mismatch"], b["normalised_velocity_mismatch"]
    )


def test_each_measure_lies_within_its_error_of_that_of_every_flock_within_the_bound(run):
    rng, bound = np.random.default_rng(3), 0.05
    rec = fl.Recording(T, run.q, run.p, bound=bound, p_bound=bound)
    seen = rec.metrics(d=7.0, r=8.4)
    names = [name for name in seen if f"{name}_error" in seen]
    assert {"connectivity", "giant_share", "order", "inertia", "normalised_deviation_energy"} <= set(names)
    largest = dict.fromkeys(names, 0.0)
    for _ in range(40):
        ways = rng.normal(size=(2, *run.q.shape))
        ways *= bound / np.linalg.norm(ways, axis=3, keepdims=True)
        other = fl.Recording(T, run.q + ways[0], run.p + ways[1], bound=0.0).metrics(d=7.0, r=8.4)
        for name in names:
            off, error = np.abs(other[name] - seen[name]).values, seen[f"{name}_error"].values
            assert (off <= error + 1e-12).all(), name
            largest[name] = max(largest[name], float((off / np.maximum(error, 1e-300)).max()))
    assert min(largest[name] for name in ("cohesion_radius", "min_distance", "velocity_diameter")) > 0.15  # no excess


def test_measures_at_a_gap_are_those_of_the_agents_that_were_seen(run):
    q = run.q.copy()
    q[3:5, 2] = np.nan
    seen = fl.Recording(T, q, run.p, bound=0.0).metrics(d=7.0, r=8.4)
    rest = np.delete(run.q[3], 2, axis=0)
    assert float(seen["cohesion_radius"][3]) == pytest.approx(fl.cohesion_radius(rest))
    assert float(seen["order"][3]) == pytest.approx(fl.order(np.delete(run.p[3], 2, axis=0)))
    assert seen["agents"].values.tolist() == [12] * 3 + [11] * 2 + [12] * 6
    assert np.isinf(fl.Recording(T, q, run.p).metrics(d=7.0, r=8.4)["inertia_error"]).all()


def test_a_recording_is_drawn_and_played_without_a_law(run, tmp_path):
    rec = recording_of(run, bound=0.0)
    assert rec.player(d=7.0, r=8.4).save(str(tmp_path / "it.html")).stat().st_size > 10_000
    assert rec.trajectory(d=7.0, r=8.4).metric("connectivity")[0] == fl.connectivity(run.q[0], 8.4)
    assert "bound" in repr(rec)
    with pytest.raises(ArgumentError, match=r"cannot write UnknownLaw.*; rec\.save writes recordings"):
        rec.trajectory().save(tmp_path / "it.nc")


@pytest.mark.parametrize("accuracy", [{}, {"bound": 0.1, "p_bound": 0.2}, {"sd": 0.3, "estimated": True}])
def test_a_saved_recording_is_read_back_with_its_accuracy(run, tmp_path, accuracy):
    q = run.q.copy()
    q[3, 2] = np.nan
    rec = fl.Recording(T, q, run.p, **accuracy, ids=[f"bird{i}" for i in range(12)], source="a camera")
    back = fl.read_recording(rec.save(tmp_path / "it.npz"))
    for name in ("t", "q", "p", "u", "bound", "sd", "p_bound", "p_sd", "estimated", "ids", "source"):
        np.testing.assert_array_equal(getattr(back, name), getattr(rec, name), err_msg=name)
    assert fl.read_recording(tmp_path / "it.npz", sd=0.5).accuracy.kind == "sd"
    with pytest.raises(FlockanaError, match=r"expected a name that ends in \.npz"):
        rec.save(tmp_path / "it.csv")


def test_what_needs_every_agent_names_the_first_gap(run):
    q = run.q.copy()
    q[3, 2] = np.nan
    with pytest.raises(ArgumentError, match=r"agent 2 is missing at t = 0\.3 \(1 gaps\)"):
        fl.Recording(T, q, run.p).trajectory()
