"""What was made or changed by hand is no evidence: of every kind, each field alone, at every door."""

import copy
import pickle
from dataclasses import fields, replace
from types import SimpleNamespace

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError
from flockana.base.integrity_seals import is_sealed
from flockana.certified.certificate import basin_certificate, tube_certificate
from flockana.equilibria.equilibrium_files import write_equilibrium
from flockana.explore.streamed_runs import shown
from flockana.stability.motion_of_mode import mode_motion

LAW = fl.Algorithm1()
RUN = fl.simulate(LAW, [[0.0, 0.0], [8.0, 1.0], [3.0, 7.0]], np.zeros((3, 2)), (0.0, 1.0), t_eval=np.linspace(0, 1, 9))
EQUILIBRIUM = fl.find_equilibrium(LAW, [[0.0], [6.9]])
BASIN = fl.certify(EQUILIBRIUM)
TUBE = fl.enclose(LAW, [[0.0], [7.1]], [[0.0], [0.0]], (0.0, 0.03125))
FOUND = fl.falsify("collision-energy", "head-on", claim="twice", budget=60)


KINDS = {"run": RUN, "tube": TUBE, "basin": BASIN, "equilibrium": EQUILIBRIUM, "falsification": FOUND}
KINDS["counterexample"] = FOUND.counterexample()


def doors(kind, folder):
    """One of that kind, and where it may be used."""
    at_rest, file = ([[0.0], [7.0]], [[0.0], [0.0]]), folder / "written.json"
    return KINDS[kind], {
        "run": [lambda run: fl.verify("energy", run), lambda run: fl.verify("os-1", run)],
        "tube": [
            lambda tube: fl.verify("collision-energy", tube),
            lambda tube: fl.verify("os-1", tube, basin=BASIN),
            lambda tube: tube.ends_in(BASIN),
            lambda tube: fl.write_tube_certificate(tube, file),
            tube_certificate,
        ],
        "basin": [
            lambda basin: fl.verify("os-1", TUBE, basin=basin),
            lambda basin: tube_certificate(TUBE, basin=basin),
            lambda basin: TUBE.ends_in(basin),
            lambda basin: basin.holds(*at_rest),
            lambda basin: fl.write_certificate(basin, file),
            basin_certificate,
        ],
        "equilibrium": [lambda one: write_equilibrium(one, file), fl.certify, lambda one: fl.linearise(LAW, one)],
        "falsification": [lambda found: found.counterexample(), lambda found: found.save(file)],
        "counterexample": [lambda one: one.save(file), lambda one: one.check()],
    }[kind]


FIELDS = [(kind, field.name) for kind, whole in KINDS.items() for field in fields(whole)]


def altered(value):
    if isinstance(value, bool) or value is None:
        return 1
    for cls, change in (
        (np.ndarray, lambda x: x + 1),
        (str, lambda x: x + " "),
        (dict, lambda x: x | {"more": 1}),
        (tuple, lambda x: x[:-1] or ("another",)),
        (fl.Algorithm1, lambda x: fl.Algorithm1(gains=fl.Gains(c1_alpha=1e4))),
    ):
        if isinstance(value, cls):
            return change(value)
    return 100 * value + 1 if isinstance(value, float) or hasattr(value, "numerator") else SimpleNamespace()


@pytest.mark.parametrize(("kind", "name"), FIELDS)
def test_every_field_that_is_altered_alone_is_told_by_its_name(kind, name, tmp_path):
    whole, uses = doors(kind, tmp_path)
    other = copy.copy(whole)
    assert is_sealed(other)
    object.__setattr__(other, name, altered(getattr(whole, name)))
    for use in uses:
        with pytest.raises(ArgumentError, match=rf"was changed by hand since \({name}\): expected "):
            use(other)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("kind", KINDS)
def test_a_copy_with_other_fields_has_no_seal_even_if_they_are_the_same(kind, tmp_path):
    whole, uses = doors(kind, tmp_path)
    first = fields(whole)[0].name
    for other in (replace(whole), replace(whole, **{first: getattr(whole, first)})):
        for use in uses:
            with pytest.raises(ArgumentError, match="was made or changed by hand: expected "):
                use(other)
    for use in uses:
        use(whole)


@pytest.mark.parametrize("part", ["t", "q", "p", "u"])
def test_a_number_that_is_changed_in_place_is_told(part):
    for path in ([part], ["between", part]):
        run = copy.deepcopy(fl.simulate(LAW, RUN.q[0], RUN.p[0], (0.0, 1.0), t_eval=[0.0, 0.5, 1.0]))
        array = run
        for name in path:
            array = getattr(array, name)
        array.setflags(write=True)
        array.flat[-1] = np.nextafter(array.flat[-1], 99.0)
        with pytest.raises(ArgumentError, match=rf"was changed by hand since \({path[0]}\)"):
            fl.verify("energy", run)


def test_further_series_facts_and_parameters_that_are_changed_in_place_are_told():
    for change, name in (
        (lambda run: run.extra.update(work=0.0 * run.extra["work"]), "extra"),
        (lambda run: run.stats.update(rtol=10.0), "stats"),
        (lambda run: object.__setattr__(run.law.gains, "c1_alpha", 29.0), "law"),
        (lambda run: object.__setattr__(run.law.alpha, "d", 6.0), "law"),
    ):
        run = copy.deepcopy(RUN)
        fl.verify("energy", run)
        change(run)
        with pytest.raises(ArgumentError, match=rf"was changed by hand since \({name}\)"):
            fl.verify("energy", run)


def test_what_a_run_gives_can_be_written_to_without_harm():
    run = copy.deepcopy(RUN)
    for values in (run.energy(), run.energy_rate(), run.metric("cohesion_radius"), run.energy_residual):
        values[:] = 1e9
    np.testing.assert_array_equal(run.energy(), RUN.energy())
    np.testing.assert_array_equal(run.energy_rate(), RUN.energy_rate())
    np.testing.assert_array_equal(run.metric("cohesion_radius"), RUN.metric("cohesion_radius"))


def test_the_library_s_own_transformations_seal_anew_and_forge_nothing(tmp_path):
    window = RUN.window(0.2, 0.8)
    for run in (
        window,
        fl.rescale(RUN, length=1e3, time=60.0),
        fl.rescale(window, time=0.5),
        pickle.loads(pickle.dumps(RUN)),
        copy.deepcopy(RUN),
        fl.Trajectory.load(RUN.save(tmp_path / "run.nc")),
        fl.Trajectory.load(window.save(tmp_path / "window.nc")),
    ):
        assert is_sealed(run)
    forged = replace(RUN, q=2.0 * RUN.q)
    for run in (forged.window(0.2, 0.8), fl.rescale(forged, length=2.0), pickle.loads(pickle.dumps(forged))):
        assert not is_sealed(run)
    assert shown(RUN, lambda data: None) is RUN


def test_the_law_of_a_user_with_a_function_of_its_own_keeps_its_seal():
    law = fl.Algorithm2(target=fl.CallableTarget(lambda t: ((t,), (1.0,))))
    run = fl.simulate(law, [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    fl.verify("energy", run)

    def twice_as_fast(t):
        return (2.0 * t,), (2.0,)

    object.__setattr__(law.target, "function", twice_as_fast)  # functions are told apart by their names
    with pytest.raises(ArgumentError, match=r"was changed by hand since \(law\)"):
        fl.verify("energy", run)


@pytest.mark.parametrize("stats", [{}, {"rtol": 10}, {"method": "DOP853", "rtol": 1e-8, "atol": 1e-10}])
def test_a_recording_is_measured_and_drawn_but_not_judged(stats):
    q = np.cumsum(np.random.default_rng(0).normal(size=(20, 3, 2)), axis=0)
    law = fl.Algorithm2(target=fl.StaticTarget((0, 0)))
    walk = fl.Trajectory(np.arange(20.0), q, 0.0 * q, 0.0 * q, law, stats=stats)
    assert walk.metrics()["cohesion_radius"].shape == (20,)
    assert walk.window(3.0, 9.0).min_distance() >= 0.0
    for name in ("os-3", "energy", "su-varying"):
        with pytest.raises(ArgumentError, match=r"run as simulate returned it.* simulate\(law, q0, p0, t_span\)"):
            fl.verify(name, walk)


@pytest.mark.parametrize("name", ["rtol", "atol", "dt"])
@pytest.mark.parametrize("value", ["1e-3", -1, 0, np.nan, np.inf, True, [1e-3], 1j])
def test_the_facts_of_a_run_are_numbers_that_can_be(name, value):
    zeros = np.zeros((1, 2, 1))
    with pytest.raises(ArgumentError, match=rf"stats\['{name}'\] = .*: expected"):
        fl.Trajectory([0.0], zeros, zeros, zeros, LAW, stats={name: value})


def test_a_motion_along_a_mode_is_no_run_and_what_is_no_basin_decides_no_limit():
    pair = fl.linearise(LAW, EQUILIBRIUM)
    with pytest.raises(ArgumentError, match="was made or changed by hand"):
        fl.verify("energy", mode_motion(pair, pair.modes[0]))
    with pytest.raises(ArgumentError, match=r"basin = .*: expected a basin, as certify"):
        fl.verify("os-1", TUBE, basin=SimpleNamespace(law=LAW, holds=lambda q, p: True))
