"""Runs as data: derived series by hand, files there and back, and files that are not ours."""

import pickle
import re

import numpy as np
import pytest
import xarray

import flockana as fl
from flockana import Algorithm1, Algorithm2, CallableTarget, CircleTarget, Gains, Trajectory, simulate
from flockana.base.errors import ArgumentError, FileError
from flockana.measures import measure, metrics
from tests.programs import full_disk


def make(n=5, m=2, **options):
    rng = np.random.default_rng(n)
    law = Algorithm2(target=CircleTarget((3.0, 1.0, 0.0)[:m], 5.0, 0.1), gains=Gains(c1_gamma=0.3))
    return simulate(law, rng.uniform(0, 12, (n, m)), rng.normal(0, 1, (n, m)), (0.0, 1.0), **options)


RUN = make(t_eval=np.linspace(0.0, 1.0, 11), method="scipy-DOP853")


def test_series():
    for k in (0, 5, 10):
        t, q, p = RUN.t[k], RUN.q[k], RUN.p[k]
        assert RUN.energy()[k] == RUN.law.energy(t, q, p)
        assert RUN.energy_rate()[k] == RUN.law.energy_rate(t, q, p)
        np.testing.assert_array_equal(RUN.u[k], RUN.law.acceleration(t, q, p))
    expected = RUN.energy() - RUN.energy()[0] - RUN.extra["work"]
    np.testing.assert_array_equal(RUN.energy_residual, expected)
    assert np.abs(RUN.energy_residual).max() <= 1e-6 * RUN.energy()[0]
    assert (RUN.n, RUN.m) == (5, 2)


def test_metrics_are_the_metrics():
    data, k = RUN.metrics(), 7
    q, p = RUN.q[k], RUN.p[k]
    assert data.cohesion_radius[k] == metrics.cohesion_radius(q)
    assert data.normalised_velocity_mismatch[k] == metrics.velocity_mismatch(p) / 5
    assert data.inertia[k] == metrics.inertia(q)
    assert data.min_distance[k] == metrics.min_distance(q)
    assert data.order[k] == metrics.order(p)
    assert data.connectivity[k] == metrics.connectivity(q, 8.4)
    assert data.giant_share[k] == metrics.giant_share(q, 8.4)
    assert data.normalised_deviation_energy[k] == metrics.deviation_energy(q, 7.0, 8.4) / 49.0
    np.testing.assert_array_equal(data.time, RUN.t)
    assert not {"deviation_energy", "velocity_mismatch"} & {*data}  # E and K, which functions of these names return


def test_one_metric_is_that_of_all_and_costs_no_other(monkeypatch):
    run = make(t_eval=RUN.t, method="scipy-DOP853")
    monkeypatch.setattr(measure, "nets", lambda *given: pytest.fail("a metric that was not asked for"))
    np.testing.assert_array_equal(run.metric("min_distance"), RUN.metrics().min_distance)
    np.testing.assert_array_equal(run.metric("coordination"), RUN.metrics().coordination)
    monkeypatch.undo()
    for name, series in RUN.metrics().items():
        np.testing.assert_array_equal(run.metric(name), series)
    with pytest.raises(ArgumentError, match="unknown metric 'min_distanc'; did you mean 'min_distance'"):
        run.metric("min_distanc")
    for measured_once in ("strain", "components"):  # numbers of a run, not series
        with pytest.raises(ArgumentError, match=f"unknown metric '{measured_once}'"):
            run.measure(measured_once)


def test_a_measured_run_crosses_processes():
    run = make(t_eval=[0.0, 1.0])
    run.metrics()
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(run)).metric("inertia"), run.metric("inertia"))


def test_min_distance_is_a_bound_of_the_samples():
    assert RUN.min_distance() == RUN.closest_approach().lower <= float(RUN.metrics().min_distance.min())


def test_the_energys_balance_counts_from_the_first_sample():
    q, p = [[0.0, 0.0], [5.0, 0.0], [3.0, 6.0]], [[1.0, 0.0], [0.0, 2.0], [-1.0, 0.0]]
    late = simulate(Algorithm1(), q, p, (0.0, 2.0), t_eval=[1.0, 1.5, 2.0])
    assert abs(late.extra["work"][0]) > 1.0
    assert np.abs(late.energy_residual).max() < 1e-5
    assert [c.status for c in fl.verify("energy", late).claims] == ["verified", "verified"]


def test_window():
    part = RUN.window(0.25, 0.75)
    np.testing.assert_allclose(part.t, [0.3, 0.4, 0.5, 0.6, 0.7])
    assert part.extra["work"][0] == 0.0
    np.testing.assert_allclose(part.energy_residual, RUN.energy_residual[3:8] - RUN.energy_residual[3], atol=1e-10)
    with pytest.raises(ArgumentError, match=re.escape("no sample between 5 and 6: the run spans 0 to 1")):
        RUN.window(5.0, 6.0)


def test_arrays_are_frozen_and_the_callers_are_not():
    q = np.zeros((2, 3, 1))
    run = Trajectory(np.array([0.0, 1.0]), q, q, q, Algorithm1())
    with pytest.raises(ValueError, match="read-only"):
        run.q[0] = 1.0
    assert q.flags.writeable
    assert run != Trajectory(run.t, q, q, q, run.law)  # compared by identity, without a broadcast


@pytest.mark.parametrize("shapes", [((3,), (2, 4, 1)), ((2,), (2, 4)), ((2, 1), (2, 4, 1))])
def test_shapes_must_fit(shapes):
    t, q = (np.zeros(s) for s in shapes)
    with pytest.raises(ArgumentError, match=re.escape("expected shapes (T,), (T, n, m), (T, n, m), (T, n, m)")):
        Trajectory(t, q, q, q, Algorithm1())


@pytest.mark.parametrize(("n", "m"), [(1, 1), (4, 1), (5, 2), (3, 3)])
def test_round_trip_is_exact(tmp_path, n, m):
    law = Algorithm1() if m == 1 else None
    run = make(n, m) if law is None else simulate(law, np.arange(n)[:, None] * 7.1, np.ones((n, 1)), (0.0, 1.0))
    path = run.save(tmp_path / "run.nc")
    again = Trajectory.load(path)
    for name in ("t", "q", "p", "u"):
        np.testing.assert_array_equal(getattr(again, name), getattr(run, name))
    np.testing.assert_array_equal(again.extra["work"], run.extra["work"])
    assert again.law == run.law
    assert (again.status, again.message) == (run.status, run.message)
    assert dict(again.stats) == dict(run.stats)
    np.testing.assert_array_equal(again.energy(), run.energy())
    assert again.min_distance() == run.min_distance()
    assert list(tmp_path.iterdir()) == [path]


def test_other_tools_can_read_it(tmp_path):
    data = xarray.open_dataset(RUN.save(tmp_path / "run.nc"), engine="h5netcdf")
    assert data.q.dims == ("time", "agent", "axis")
    assert data.axis.values.tolist() == ["x", "y"]
    assert data.attrs["format"] == "flockana-trajectory"
    data.close()


@pytest.mark.parametrize("room", [0, 1000, 15_000])
def test_a_save_onto_a_full_disk_keeps_the_old_file(tmp_path, room):
    path = RUN.save(tmp_path / "run.nc")
    before = path.read_bytes()
    with full_disk(room), pytest.raises(FileError, match="File too large; choose a file name and folder"):
        RUN.save(path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_the_old_file_is_replaced_in_one_move(tmp_path, monkeypatch):
    path = RUN.save(tmp_path / "run.nc")
    before = path.read_bytes()

    def refuse(source, target):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("flockana.dynamics.trajectory.os.replace", refuse)
    with pytest.raises(FileError, match="Permission denied; choose a file name and folder"):
        RUN.window(0.0, 0.5).save(path)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_places_that_cannot_be_written(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # names without a folder must leave nothing behind here
    (tmp_path / "file").write_text("x")
    for path in (tmp_path / "none" / "run.nc", tmp_path / "file" / "run.nc", tmp_path, "", "a\0b"):
        with pytest.raises(FileError, match=r"cannot write .*choose a file name and folder to write to"):
            RUN.save(path)
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


def test_a_users_function_is_refused_before_anything_is_written(tmp_path):
    law = Algorithm2(target=CallableTarget(lambda t: ((0.0,), (0.0,))))
    run = simulate(law, [[0.0]], [[0.0]], (0.0, 0.1))
    with pytest.raises(ArgumentError, match="a user's function has no such form"):
        run.save(tmp_path / "run.nc")
    assert list(tmp_path.iterdir()) == []


def tampered(path, **attributes):
    data = RUN.to_xarray()
    for name, value in attributes.items():
        if value is None:
            del data.attrs[name]
        else:
            data.attrs[name] = value
    data.to_netcdf(path, engine="h5netcdf")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("attributes", "message"),
    [
        ({"format": None}, "holds no flockana run (format None, expected 'flockana-trajectory')"),
        ({"format": "other"}, "holds no flockana run (format 'other'"),
        ({"format_version": 0}, "is damaged: there is no format 0"),
        ({"format_version": -1}, "is damaged: there is no format -1"),
        ({"format_version": 3}, "is of format 3, newer than 2: update flockana"),
        ({"format_version": None}, "is damaged: KeyError('format_version'); run the simulation again"),
        ({"format_version": "x"}, "is damaged"),
        ({"law": None}, "is damaged"),
        ({"law": "{"}, "is damaged"),
        ({"law": "[" * 100_000}, "is damaged"),
        ({"law": "null"}, "expected a law"),
        ({"law": '{"type": "flockana.interactions:Gains"}'}, "expected a law"),
        ({"law": '{"type": "flockana.laws.olfati_saber:Algorithm9"}'}, "cannot rebuild"),
        ({"law": '{"type": "my.laws:Mine"}'}, "the file needs my.laws:Mine, which is not part of flockana"),
        ({"stats": "x"}, "is damaged"),
        ({"status": None}, "is damaged"),
        ({"status": "fine"}, "status = 'fine': expected one of complete"),
    ],
)
def test_files_with_other_contents(tmp_path, attributes, message):
    path = tmp_path / "run.nc"
    tampered(path, **attributes)
    with pytest.raises(FileError, match=re.escape(message)):
        Trajectory.load(path)


def test_files_that_are_missing_foreign_or_broken(tmp_path):
    whole = RUN.save(tmp_path / "run.nc").read_bytes()
    with pytest.raises(FileError, match=r"no file .*nowhere.nc: expected one written by Trajectory.save"):
        Trajectory.load(tmp_path / "nowhere.nc")
    with pytest.raises(FileError, match="no file"):
        Trajectory.load(tmp_path)
    broken = tmp_path / "broken.nc"
    for content in (b"", b"not a netCDF file", whole[:100], whole[: len(whole) // 2], whole[:-10]):
        broken.write_bytes(content)
        with pytest.raises(FileError, match=r"cannot read .*broken.nc as netCDF-4"):
            Trajectory.load(broken)
    xarray.Dataset({"x": ("k", [1.0])}).to_netcdf(broken, engine="h5netcdf")
    with pytest.raises(FileError, match="holds no flockana run"):
        Trajectory.load(broken)


def test_a_file_without_its_velocities(tmp_path):
    path = tmp_path / "run.nc"
    RUN.to_xarray().drop_vars("p").to_netcdf(path, engine="h5netcdf")
    with pytest.raises(FileError, match="is damaged: KeyError"):
        Trajectory.load(path)


def test_a_run_shows_itself_in_one_line():
    run = simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0), t_eval=[0.0, 1.0])
    assert repr(run) == "<Trajectory of 2 agents, m = 1, Algorithm1, 2 samples, t = 0 to 1, complete>"


def test_a_run_travels_after_its_measures_were_taken():
    """Those of the dead zone are functions of the law's own until they are asked for."""
    run = fl.simulate(fl.DeadZoneFlocking(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    metrics = run.metrics()
    again = pickle.loads(pickle.dumps(run))
    np.testing.assert_array_equal(again.metrics()["literal_energy"], metrics["literal_energy"])


def test_floors_are_what_the_solver_was_allowed():
    law = fl.compose(pair=fl.AlphaInteraction(), gradient=30, consensus=10, drag=0.1)
    run = simulate(law, [[0.0, 0.0]], [[1e-13, 0.0]], (0.0, 60.0))
    place, speed, work = run.floors
    unit = law.scales
    assert (place, speed, work) == pytest.approx((1e-10 * unit.length, 1e-10 * unit.speed, 1e-10 * unit.energy))
    assert np.abs(run.energy()).max() < 1e-9 * work  # a balance of such energies means nothing


def test_floors_in_other_units_from_a_file_and_of_a_part(tmp_path):
    path = tmp_path / "run.nc"
    assert Trajectory.load(RUN.save(path)).floors == RUN.floors
    assert RUN.window(0.5, 1.0).floors == RUN.floors
    other = RUN.in_units(2.0**20, 2.0**-10).floors
    assert other == (RUN.floors.place * 2.0**20, RUN.floors.speed * 2.0**30, RUN.floors.work * 2.0**60)


def test_floors_without_tolerances_are_roundings():
    run = simulate(Algorithm1(), [[1e6], [1e6 + 8.0]], [[3.0], [-3.0]], (1e3, 1e3 + 1.0), method="RK4", dt=0.01)
    assert run.floors.place == np.spacing(1e6) + np.spacing(1e3) * np.abs(run.p).max()
    assert run.floors.speed == np.spacing(np.abs(run.p).max()) + np.spacing(1e3) * np.abs(run.u).max()
    assert run.floors.work == np.spacing(max(np.abs(run.energy()).max(), np.abs(run.extra["work"]).max()))
    parts = {name: getattr(run, name) for name in ("t", "q", "p", "u", "law")}
    assert Trajectory(**parts).floors == run.floors._replace(work=np.spacing(0.0))


def test_nothing_is_claimed_between_samples_whose_steps_are_not_known(tmp_path):
    """Two agents that meet and part between two samples: they come to 6.4812 of each other, by their energy."""
    law = Algorithm1(gains=Gains(c2_alpha=0.0))
    run = simulate(law, [[0.0, 0.0], [30.0, 0.0]], [[3.0, 0.0], [-3.0, 0.0]], (0.0, 10.0), t_eval=[0.0, 10.0])
    assert 6.48 < run.min_distance() < 6.4812191711
    for name in ("window", "file"):
        again = run.window(0.0, 10.0) if name == "window" else Trajectory.load(run.save(tmp_path / "run.nc"))
        assert again.resolved
        assert again.min_distance() == run.min_distance()
    sparse = Trajectory(run.t, run.q, run.p, run.u, law)
    assert not sparse.resolved
    assert sparse.min_distance() == 0.0
    assert sparse.closest_approach().lower_by_interval.tolist() == [0.0]
    assert sparse.cohesion_bound() == np.inf
    every = simulate(law, run.q[0], run.p[0], (0.0, 10.0))
    assert every.between is None
    assert every.resolved
    assert every.window(2.0, 8.0).resolved
    thinned = {name: getattr(every, name)[:: len(every.t) - 1] for name in "tqpu"}
    assert not Trajectory(**thinned, law=law, stats=every.stats).resolved
    one = Trajectory(run.t[:1], run.q[:1], run.p[:1], run.u[:1], law)
    assert one.min_distance() == 30.0


def test_who_watches_a_run_cannot_edit_it():
    def centred(sample):
        sample.q[:] -= sample.q.mean(axis=0) - 50.0

    watched, alone = make(t_eval=[0.0, 0.7, 1.0], watch=centred), make(t_eval=[0.0, 0.7, 1.0])
    np.testing.assert_array_equal(watched.q, alone.q)
