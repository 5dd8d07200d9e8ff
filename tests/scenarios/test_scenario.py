"""The catalogue's entries: starts and parameters as printed, seeds, options. Their statuses: `flockana verify`."""

from dataclasses import replace
from math import pi, sqrt
from types import SimpleNamespace

import numpy as np
import pytest

from flockana import Tolerances, rescale, theorems
from flockana.base.errors import ArgumentError
from flockana.scenarios import Report, scenario
from flockana.scenarios.report_claims import finding, in_source_units
from flockana.sources.isola_2024.laws import MSNDiscretisation
from flockana.sources.notebook_r2.laws import PushedAlgorithm1, PushedAlgorithm2

OWN = [
    *("paper-flocking", "paper-dynamic-topology", "paper-fragmentation", "paper-rendezvous-3d"),
    *("collapse", "hexagon", "three-agents-1d", "notebook-algorithm1", "notebook-algorithm2", "msn-static"),
    *(f"msn-case{case}{suffix}" for case in (1, 2, 3, 4) for suffix in ("", "-printed")),
]


@pytest.mark.parametrize("name", OWN)
def test_starts_follow_from_the_seed(name):
    first, again, other = scenario(name, seed=5), scenario(name, seed=5), scenario(name, seed=6)
    assert np.array_equal(first.q0, again.q0)
    assert np.array_equal(first.p0, again.p0)
    assert np.array_equal(first.q0, other.q0) is (name == "three-agents-1d")
    assert first.seed == 5
    assert first.law == other.law
    assert first.title
    assert first.references
    assert all(key.split(":")[0] in {*theorems(), "source", "E11"} for key in first.expected)


def test_the_papers_start():
    entry = scenario("paper-flocking", seed=1)
    # standard deviation 50 over 300 normal draws: its own standard error is 2
    assert entry.q0.std() == pytest.approx(50.0, abs=8.0)
    assert entry.p0.min() >= -2.0
    assert entry.p0.max() <= -1.0
    np.testing.assert_array_equal(entry.law.target.position(2.0), (210.0, 30.0))


@pytest.mark.parametrize("suffix", ["", "-printed"])
def test_the_msn_cases_are_as_printed(suffix):
    gains = {}
    for case, side in ((1, 50.0), (2, 50.0), (3, 150.0), (4, 150.0)):
        entry = scenario(f"msn-case{case}{suffix}", seed=2)
        assert entry.q0.shape == (100, 2)
        assert 0.9 * side < entry.q0.max() < side
        assert not entry.p0.any()
        assert entry.t_span == (0.0, pytest.approx(4.851))  # range(540), of which i = 0 only draws
        assert entry.instants == tuple(i * 0.009 for i in (0, 90, 180, 270, 360, 450))
        alpha = entry.law.alpha
        assert (alpha.d, alpha.r, alpha.eps, alpha.h, alpha.a, alpha.b) == (15.0, 18.0, 0.1, 0.1, 3.0, 3.0)
        gains[case] = entry.law.gains
        if suffix:
            assert isinstance(entry.law, MSNDiscretisation)
            assert (entry.law.dt, entry.law.in_place, entry.law.position_factor) == (0.009, True, 1.5)
    assert (gains[1].c1_alpha, gains[1].c2_alpha) == (50.0, 2 * sqrt(50))
    assert (gains[2].c1_alpha, gains[2].c1_gamma, gains[2].c2_gamma) == (1.0, 1.0, 0.0)
    for case in (3, 4):
        g = gains[case]
        assert (g.c1_alpha, g.c2_alpha, g.c1_gamma, g.c2_gamma) == (100.0, 20.0, 70.0, 2 * sqrt(70))


@pytest.mark.parametrize("i", [0, 1, 77])
def test_the_msn_gamma_agents_at_iteration_i(i):
    angle = 2 * pi * 0.025 * i / 5
    q, p = scenario("msn-case3").law.target.state(0.009 * i)
    np.testing.assert_allclose(q, (50 + i / 5, 50 + 100 * np.sin(angle)), atol=1e-9)
    np.testing.assert_allclose(p, (1 / 5, 100 * 2 * pi * 0.025 / 5 * np.cos(angle)), atol=1e-9)
    q, p = scenario("msn-case4").law.target.state(0.009 * i)
    np.testing.assert_allclose(q, (50 + 100 * np.cos(angle), 50 + 100 * np.sin(angle)), atol=1e-9)
    np.testing.assert_allclose(p, 100 * 2 * pi * 0.025 / 5 * np.array((-np.sin(angle), np.cos(angle))), atol=1e-9)


def test_the_projects_map_makes_539_updates():
    run = scenario("msn-case2-printed").run()
    assert len(run.t) == 540
    np.testing.assert_allclose(run.t, 0.009 * np.arange(540), rtol=1e-14)


def test_instants_lie_within_the_run_and_follow_its_unit_of_time():
    entry = replace(scenario("hexagon"), t_span=(0.0, 2.0), instants=(0.0, 2.0))
    assert rescale(entry, time=1000.0).instants == (0.0, 2000.0)
    with pytest.raises(ArgumentError, match=r"instants = \(0.0, 2.5\): expected times within t_span = \(0.0, 2.0\)"):
        replace(entry, instants=(0.0, 2.5))


def test_three_agents_have_the_energy_of_the_erratum():
    entry = scenario("three-agents-1d")
    c_star = entry.law.alpha.c_star
    assert entry.law.energy(0.0, entry.q0, entry.p0) / c_star == pytest.approx(1.909, abs=5e-4)


def test_the_hexagon_starts_below_the_energy_of_a_collision():
    for seed in range(5):
        entry = scenario("hexagon", seed=seed)
        assert entry.law.structural_energy(entry.q0, entry.p0) < entry.law.gains.c1_alpha * entry.law.alpha.c_star


def test_the_push_is_an_option_of_the_notebook_alone():
    assert isinstance(scenario("notebook-algorithm1", push=True).law, PushedAlgorithm1)
    assert isinstance(scenario("notebook-algorithm2", push=True).law, PushedAlgorithm2)
    with pytest.raises(ArgumentError, match="hexagon has no option push; it has none"):
        scenario("hexagon", push=True)
    with pytest.raises(ArgumentError, match="notebook-algorithm1 has no option pushed; it has push"):
        scenario("notebook-algorithm1", pushed=True)
    with pytest.raises(ArgumentError, match="paper-flocking has no option n; it has none"):
        scenario("paper-flocking", n=3)


@pytest.mark.slow
def test_the_push_holds_a_squeezed_pair_apart():
    """Seed 0: agents 20 and 21 all but coincide without the push, and slide along its edge at 0.05 with it."""
    plain, pushed = (scenario("notebook-algorithm1", push=push) for push in (False, True))
    runs = plain.run(), pushed.run()
    pair = [float(np.linalg.norm(run.q[-1, 20] - run.q[-1, 21])) for run in runs]
    assert pair[0] < 1e-4
    assert 0.04 < pair[1] < 0.051
    for entry, run in zip((plain, pushed), runs, strict=True):
        report = next(report for report in entry.reports if report.name == "push")
        assert report.check(run, Tolerances()).status == "verified"


def test_a_scenario_in_other_units_is_the_same_flight():
    """But for the integrator's error."""
    case = scenario("paper-squeezing")
    case = replace(case, t_span=(0.0, 0.5), options={**case.options, "t_eval": np.linspace(0.0, 0.5, 6)})
    there = rescale(case, length=4.0, time=0.5)
    assert (there.t_span, there.options["rtol"], there.options["atol"]) == ((0.0, 0.25), 1e-7, 4e-9)
    one, two = case.run(), there.run()
    np.testing.assert_array_equal(two.t, 0.5 * one.t)
    np.testing.assert_allclose(two.q, 4.0 * one.q, rtol=0.0, atol=1e-6 * np.abs(two.q).max())
    np.testing.assert_allclose(two.p, 8.0 * one.p, rtol=0.0, atol=1e-5 * np.abs(two.p).max())


def test_a_report_judges_a_run_in_other_units_in_those_of_its_source():
    item = scenario("hexagon")
    seen = []

    def check(run, tolerances):
        seen.append(run)
        return finding(0.5, "")

    (report,) = in_source_units(lambda: item.law.scales, [Report("seen", "it was seen", check)])
    run = item.run()
    report.check(run, Tolerances())
    report.check(rescale(run, length=1000.0, time=60.0), Tolerances())
    assert seen[0] is run
    assert report.text == "it was seen"
    np.testing.assert_allclose(seen[1].q, run.q, rtol=1e-12)
    np.testing.assert_allclose(seen[1].t, run.t, rtol=1e-12)


def test_a_tube_that_was_interrupted_ends_its_verdict(monkeypatch):
    """Ctrl-C during the enclosure of proved-flock once left verdicts that differ from the expected."""
    entry = scenario("proved-flock")
    run = entry.run()
    monkeypatch.setattr(
        "flockana.certified.enclose_run.enclose", lambda *_, **__: SimpleNamespace(status="interrupted")
    )
    with pytest.raises(KeyboardInterrupt):
        entry.verdict(next(iter(entry.enclosed.theorems)), run)
