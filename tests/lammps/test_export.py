"""What is written is read as LAMMPS documents it, by an emulator of its own, and moves agents as the law does."""

import numpy as np
import pytest

import flockana as fl
from benchmarks import engines
from flockana.base.errors import ArgumentError, FileError
from flockana.lammps.script import nearest_weight
from flockana.lattice import hexagonal_spiral
from flockana.scenarios import scenario
from tests.lammps.emulator import Lammps, read_data, read_table

NO_CONSENSUS = fl.Gains(c2_alpha=0.0)


def start(n=12, m=2, seed=0, speed=1.0):
    rng = np.random.default_rng(seed)
    if m == 2:
        q = hexagonal_spiral(n, 6.5) + 0.3 * rng.standard_normal((n, 2))
    else:
        q = rng.uniform(0.0, 4.0 * n ** (1.0 / m) * (5.0 if m == 1 else 1.0), (n, m))
    return q, speed * rng.standard_normal((n, m))


def sampled(law, q0, p0, folder, end=2.0, **options):
    """(the run of the emulator, the law's own run at the same times)."""
    fl.export_lammps(law, q0, p0, (1.0, 1.0 + end), folder, samples=20, **options)
    Lammps(folder)
    run = fl.read_lammps(folder / "flock.dump", law, start=1.0)
    return run, fl.simulate(law, q0, p0, (1.0, 1.0 + end), rtol=1e-11, t_eval=np.append(run.t[:-1], 1.0 + end))


def off(run, exact):
    return float(np.abs(run.q - exact.q).max())


@pytest.mark.parametrize("m", [1, 2, 3])
def test_data_file_holds_the_start_to_the_last_bit_within_its_box(tmp_path, m):
    q0, p0 = start(m=m)
    fl.export_lammps(fl.Algorithm1(), q0, p0, (0.0, 1.0), tmp_path)
    box, x, v = read_data(tmp_path / "flock.data")
    assert x[:, :m].tolist() == q0.tolist()
    assert v[:, :m].tolist() == p0.tolist()
    assert not x[:, m:].any()
    assert not v[:, m:].any()
    assert (box[:m, 0] < q0.min(axis=0)).all()
    assert (box[:m, 1] > q0.max(axis=0)).all()
    assert m == 3 or box[2].tolist() == [-0.5, 0.5]  # LAMMPS asks for a narrow box in two dimensions


@pytest.mark.parametrize(
    "law", [fl.Algorithm1(), fl.Algorithm1(alpha=fl.AlphaInteraction(a=3.0, b=5.0, h=0.7)), fl.DeadZoneFlocking()]
)
def test_table_is_the_law_s_pair_force_and_energy_within_the_stated_error(tmp_path, law):
    told = fl.export_lammps(law, [[0.0, 0.0], [6.0, 0.0]], np.zeros((2, 2)), (0.0, 1.0), tmp_path, points=3000)
    s2, energy, over = read_table(tmp_path / "pair.table", "PAIR")
    rng = np.random.default_rng(1)
    r = rng.uniform(np.sqrt(s2[0]), np.sqrt(s2[-1]), 500)
    still = np.zeros((2, 2))
    force = [law.acceleration(0.0, [[0.0, 0.0], [x, 0.0]], still)[1, 0] for x in r]
    far = law.energy(0.0, [[0.0, 0.0], [2.0 * law.pair.range, 0.0]], still)
    potential = [law.energy(0.0, [[0.0, 0.0], [x, 0.0]], still) - far for x in r]
    assert 0.0 < told.force_error < 1e-2 * np.abs(force).max()
    assert np.abs(np.interp(r**2, s2, over) * r - force).max() <= 1.2 * told.force_error
    assert np.abs(np.interp(r**2, s2, energy) - potential).max() <= 1.2 * told.energy_error
    assert np.abs(np.interp(r**2, s2, over) * r - force).max() >= 0.1 * told.force_error  # nor is the bound idle


def test_the_error_of_the_table_falls_with_the_square_of_its_points(tmp_path):
    found = [
        fl.export_lammps(fl.Algorithm1(), *start(), (0.0, 1.0), tmp_path, points=points).force_error
        for points in (1000, 4000)
    ]
    assert found[0] / found[1] == pytest.approx(16.0, rel=0.1)
    assert read_table(tmp_path / "pair.table", "PAIR")[0][0] == pytest.approx(8.4e-6**2)  # it begins near contact


def ensure_follows(law, flock, folder, *, order):
    """LAMMPS starts with the law's input, and nears the law's path by this order of the step."""
    coarse, exact = sampled(law, *flock, folder, dt=0.004)
    fine, _ = sampled(law, *flock, folder, dt=0.001)
    assert fine.extra["force_residual"][0] < 1e-6
    ratio = off(coarse, exact) / off(fine, exact)
    assert 0.7 * 4.0**order < ratio < 1.5 * 4.0**order
    return fine


@pytest.mark.parametrize("m", [1, 2, 3])
def test_pair_forces_move_agents_as_the_law_does(tmp_path, m):
    run = ensure_follows(fl.Algorithm1(gains=NO_CONSENSUS), start(m=m), tmp_path, order=2)
    assert run.m == m
    assert run.extra["force_residual"].max() < 1e-6  # conservative forces: those of the table alone
    assert np.abs(run.energy_residual).max() < 1e-3 * np.abs(run.energy()).max()


TARGETS = [
    fl.StaticTarget((3.0, -2.0)),
    fl.StaticTarget((3.0, -2.0), (0.5, -1.0)),
    fl.LinearTarget((3.0, -2.0), (-1.0, 2.0)),
    fl.SineTarget((1.0, 2.0), (1.0, -1.0), amplitude=-2.0, frequency=0.5, phase=-0.3, axis=0),
    fl.CircleTarget((-1.0, 2.0), 3.0, frequency=-0.25, phase=0.7),
    fl.RescaledVelocity(fl.CircleTarget((-1.0, 2.0), 3.0, frequency=0.25), -0.5),
    fl.RescaledVelocity(fl.StaticTarget((3.0, -2.0), (0.5, -1.0)), 2.0),
]


@pytest.mark.parametrize("law_of", [fl.Algorithm2, fl.Algorithm3])
@pytest.mark.parametrize("target", TARGETS)
def test_every_path_of_the_gamma_agent_pulls_as_the_law_does(tmp_path, law_of, target):
    alpha = fl.AlphaInteraction(unit=3.0)  # in which a bounded pull counts
    ensure_follows(law_of(alpha=alpha, target=target, gains=NO_CONSENSUS), start(7), tmp_path, order=1)


def test_a_consensus_of_constant_weight_is_exact(tmp_path):
    law = fl.DeadZoneFlocking(k2=0.7)
    told = fl.export_lammps(law, *start(7, speed=0.2), (0.0, 1.0), tmp_path)
    assert told.missing == ()
    ensure_follows(law, start(7, speed=0.2), tmp_path, order=1)


def test_a_consensus_that_is_missing_shows_in_both_residuals_and_the_nearest_style_shrinks_them(tmp_path):
    law = fl.Algorithm1()
    told = fl.export_lammps(law, *start(), (0.0, 1.0), tmp_path)
    assert any(text.startswith("velocity consensus") for text in told.missing)
    without, _ = sampled(law, *start(), tmp_path, dt=0.002)
    nearest, _ = sampled(law, *start(), tmp_path, dt=0.002, consensus="nearest")
    force, energy = (lambda run: run.extra["force_residual"].max()), lambda run: np.abs(run.energy_residual).max()
    assert force(without) > 0.01
    assert energy(without) > 0.1 * np.abs(without.energy()).max()
    assert force(nearest) < 0.6 * force(without)
    assert energy(nearest) < 0.6 * energy(without)
    with pytest.raises(ArgumentError, match="was made or changed by hand"):
        fl.verify("alpha-flocking", without)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_the_nearest_weight_is_nearest_among_evenly_spread_agents(m):
    law = fl.Algorithm1()
    s, error = nearest_weight(law.terms[0], m)
    r = np.linspace(0.0, law.pair.range, 2001)[1:-1]
    adjacency, x = law.pair.adjacency(law.pair.sigma_norm(r)), r / law.pair.range

    def apart(exponent):
        return float(np.sum(x ** (m - 1) * ((1.0 - x) ** (2.0 * exponent) - adjacency) ** 2))

    assert apart(s) < min(apart(s + 0.01), apart(s - 0.01))
    assert error == pytest.approx(np.abs((1.0 - x) ** (2.0 * s) - adjacency).max(), rel=1e-2)


def test_what_is_missing_stands_in_script_text_and_record(tmp_path):
    case = scenario("paper-split-rejoin")
    told = fl.export_lammps(case.law, case.q0, case.p0, case.t_span, tmp_path)
    assert any(text.startswith("ObstacleTerm") for text in told.missing)
    for file in ("in.flock", "README.txt"):
        text = (tmp_path / file).read_text()
        assert all(words in text for words in told.missing)
    own = fl.Algorithm2(target=fl.CallableTarget(lambda t: ((t, 0.0), (1.0, 0.0))))
    told = fl.export_lammps(own, *start(), (0.0, 1.0), tmp_path)
    assert any("no formula" in text for text in told.missing)
    each = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)), gains=fl.Gains(c1_gamma=np.arange(1.0, 13.0)))
    told = fl.export_lammps(each, *start(), (0.0, 1.0), tmp_path)
    assert any("gains for each agent" in text for text in told.missing)


def test_an_obstacle_law_without_obstacles_misses_none(tmp_path):
    told = fl.export_lammps(fl.Algorithm3(target=fl.StaticTarget((0.0, 0.0))), *start(), (0.0, 1.0), tmp_path)
    assert not any("Obstacle" in text for text in told.missing)


def test_jumps_of_the_force_are_told_and_kept_out_of_the_error(tmp_path):
    law = fl.DeadZoneFlocking(fl.DeadZoneInteraction(ramp=0.0, delta=1.0))
    told = fl.export_lammps(law, [[0.0, 0.0], [8.0, 0.0]], np.zeros((2, 2)), (0.0, 1.0), tmp_path)
    assert any(text.startswith("jumps of the force at 7, 9:") for text in told.near)
    assert told.force_error < 0.02 * law.interaction.contact_force
    ramped = fl.export_lammps(fl.DeadZoneFlocking(), [[0.0, 0.0], [8.0, 0.0]], np.zeros((2, 2)), (0.0, 1.0), tmp_path)
    assert ramped.near == ()


def test_steps_are_equal_end_on_time_and_are_no_longer_than_asked(tmp_path):
    told = fl.export_lammps(fl.Algorithm1(), *start(), (2.0, 5.0), tmp_path, dt=0.011, samples=7)
    assert told.steps % 7 == 0
    assert told.dt <= 0.011
    assert told.dt * told.steps == pytest.approx(3.0, rel=1e-14)
    assert told.steps == 7 * 39  # 3/7 in 39 steps of 0.01099


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"points": 1}, "points = 1: expected a whole number from 2"),
        ({"points": 2.5}, "points = 2.5: expected a whole number"),
        ({"samples": 0}, "samples = 0: expected a whole number from 1"),
        ({"dt": -1.0}, "dt = -1: expected a number > 0"),
        ({"inner": 9.0}, "inner = 9: expected less than the range 8.4"),
        ({"inner": 7.0}, "two agents start .* nearer than the table's first distance 7"),
        ({"consensus": "some"}, "unknown choice of consensus 'some'"),
    ],
)
def test_bad_arguments_are_refused_before_anything_is_written(tmp_path, options, message):
    with pytest.raises(ArgumentError, match=message):
        fl.export_lammps(fl.Algorithm1(), *start(), (0.0, 1.0), tmp_path / "none", **options)
    assert not (tmp_path / "none").exists()


def test_a_law_without_a_pair_term_is_refused(tmp_path):
    with pytest.raises(ArgumentError, match="MinimalFlocking has no pair term for LAMMPS to tabulate"):
        fl.export_lammps(fl.MinimalFlocking(), *start(), (0.0, 1.0), tmp_path)


def test_a_folder_that_is_a_file_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match=r"cannot make .*choose another folder"):
        fl.export_lammps(fl.Algorithm1(), *start(), (0.0, 1.0), tmp_path / "file")


def in_lammps(folder, law, **options):
    """Force residual at the end of a run of LAMMPS itself, and how far agents are from where the law takes them."""
    rng = np.random.default_rng(0)
    grid = np.stack(np.meshgrid(np.arange(4), np.arange(4)), axis=-1).reshape(-1, 2)
    q, p = 7.0 * grid + rng.normal(0.0, 0.2, (16, 2)), rng.normal(0.0, 0.5, (16, 2))
    fl.export_lammps(law, q, p, (0.0, 0.5), folder, samples=20, **options)
    engine = engines.lammps()
    engine.command(f"shell cd {folder}")
    engine.file("in.flock")
    engine.close()
    run = fl.read_lammps(folder / "flock.dump", law)
    own = fl.simulate(law, q, p, (0.0, 0.5), t_eval=run.t, rtol=1e-9)
    return float(run.extra["force_residual"].max()), float(np.abs(run.q - own.q).max())


def test_lammps_itself_runs_the_script_and_the_residual_says_what_is_missing(tmp_path):
    """A consensus left out shows, the nearest style less; an exact one is off by the step alone, in first order."""
    pytest.importorskip("lammps")
    missing = in_lammps(tmp_path / "missing", fl.Algorithm1())
    nearest = in_lammps(tmp_path / "nearest", fl.Algorithm1(), consensus="nearest")
    assert 0.1 < missing[0] < 1.0
    assert nearest[0] < 0.9 * missing[0]
    assert nearest[1] < 0.5 * missing[1]
    law = fl.DeadZoneFlocking(fl.DeadZoneInteraction(ramp=0.25))
    exact = [in_lammps(tmp_path / str(dt), law, dt=dt) for dt in (0.005, 0.0025)]
    assert exact[1][0] < 0.03
    assert [a / b for a, b in zip(*exact, strict=True)] == pytest.approx([2.0, 2.0], rel=0.15)
