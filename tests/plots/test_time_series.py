from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

import flockana
from flockana import Algorithm1, AlphaInteraction, Law, RationalWeight, pair_law, plots, simulate
from flockana.base.errors import ArgumentError
from flockana.plots.time_series import velocities_between
from tests.plots.artists import Halving, a_run, axes


@dataclass(frozen=True)
class Drag(Law):
    """No interaction range, no energy, no target."""

    def flow(self, t, q, p):
        return -p, float("nan")


def line(ax, label):
    return next(one for one in ax.get_lines() if one.get_label() == label)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_everything_draws_in_every_dimension_and_labels_its_units(m):
    run = a_run(m)
    for draw in (plots.snapshot, plots.trajectories, plots.centre_path):
        ax = draw(run, ax=axes(m))
        ax.get_figure().canvas.draw()
        assert "length" in ax.get_xlabel() + ax.get_ylabel()
    for draw in (plots.energy, plots.energy_residual, plots.distances, plots.speeds, plots.centre_of_mass):
        ax = draw(run, ax=axes())
        ax.get_figure().canvas.draw()
        assert ax.get_xlabel() == "$t$ (time)"


def test_series_show_the_numbers_of_the_run():
    run = a_run()
    np.testing.assert_array_equal(plots.energy(run, ax=axes()).get_lines()[0].get_ydata(), run.energy())
    residual = plots.energy_residual(run, ax=axes()).get_lines()[1]
    np.testing.assert_array_equal(residual.get_ydata(), run.energy_residual)
    speeds = plots.speeds(run, ax=axes())
    drawn = [speeds.get_lines()[2], line(speeds, "centre of mass")]  # curves, through the samples
    agent, centre = (np.interp(run.t, *one.get_data()) for one in drawn)
    np.testing.assert_allclose(agent, np.hypot(*run.p[:, 2].T))
    np.testing.assert_allclose(centre, np.hypot(*run.p.mean(axis=1).T))
    np.testing.assert_allclose(line(speeds, "γ-agent's ‖p_r‖").get_ydata(), np.sqrt(8.0))
    centre = plots.centre_of_mass(run, ax=axes())
    np.testing.assert_allclose(line(centre, "y of the centre").get_ydata(), run.q[:, :, 1].mean(axis=1))
    np.testing.assert_allclose(line(centre, "y of the γ-agent").get_ydata(), 1.0 + 2.0 * run.t)


def test_distances_show_samples_bound_and_the_law_s_lengths():
    run = a_run()
    ax = plots.distances(run, ax=axes())
    np.testing.assert_array_equal(line(ax, "at the samples").get_ydata(), run.metrics().min_distance)
    stairs = next(p for p in ax.patches if p.get_label() == "lower bound between samples")
    np.testing.assert_array_equal(stairs.get_data().values, run.closest_approach().lower_by_interval)
    assert set(line(ax, "d").get_ydata()) == {7.0}
    assert set(line(ax, "r").get_ydata()) == {8.4}


def test_the_panel_draws_four_measures_and_what_spans_decades_is_logarithmic():
    run = a_run()
    drawn = plots.panel(run, ax=Figure().subplots(2, 2))
    names = ("connectivity", "cohesion_radius", "normalised_deviation_energy", "normalised_velocity_mismatch")
    for ax, name in zip(drawn, names, strict=True):
        np.testing.assert_array_equal(ax.get_lines()[0].get_ydata(), run.metrics()[name])
    assert [ax.get_yscale() for ax in drawn] == ["linear", "linear", "log", "log"]


@pytest.mark.parametrize("law", [Drag(), Halving()])
def test_laws_without_range_energy_or_target_draw_what_there_is(law):
    run = simulate(law, [[0.0, 0.0], [4.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]], (0.0, 2.0))
    assert "not defined" in plots.measure(run, "connectivity", ax=axes()).texts[0].get_text()
    assert "no energy" in plots.energy(run, ax=axes()).texts[0].get_text()
    assert "no energy" in plots.energy_residual(run, ax=axes()).texts[0].get_text()
    plots.snapshot(run, ax=axes())
    plots.centre_path(run, ax=axes())
    bounded = any(p.get_label() == "lower bound between samples" for p in plots.distances(run, ax=axes()).patches)
    assert bounded == isinstance(law, Law)  # between the steps of a map there is nothing to bound


def test_the_force_of_a_formula_is_drawn_with_its_sign_changes():
    pair = pair_law("k*((r**2 - s**2)**4/8 - (r**2 - d**2)*(r**2 - s**2)**3/6)", adjacency=0, range=3.0, length=2.0,
                       parameters={"k": 0.01})  # fmt: skip
    ax = axes()
    x, force = plots.force(pair, ax=ax).get_lines()[0].get_data()
    np.testing.assert_allclose(force, np.where(x < 3.0, -0.01 * x * (x**2 - 4.0) * (9.0 - x**2) ** 2, 0.0), atol=1e-13)
    assert "2" in [text.get_text() for text in ax.texts]
    with pytest.raises(ArgumentError, match="has no range: expected a pair law of finite range"):
        plots.force(RationalWeight())


def test_pair_curves_pass_through_their_known_points():
    alpha = AlphaInteraction()
    potential = plots.potential(alpha, ax=axes()).get_lines()[0]
    assert potential.get_ydata()[0] == pytest.approx(alpha.c_star)
    x, phi = plots.action(alpha, ax=axes()).get_lines()[0].get_data()
    assert np.all(phi[x < 7.0 - 0.02] < 0.0)
    assert np.all(phi[(x > 7.02) & (x < 8.38)] > 0.0)
    assert np.all(phi[x > 8.4] == 0.0)


def test_a_backend_that_turns_interactive_mode_on_inside_the_style_keeps_it():
    before = mpl.is_interactive()
    try:
        mpl.interactive(False)
        with plots.style():
            mpl.interactive(True)  # what a notebook's backend does when the first figure loads it
        assert mpl.is_interactive()
    finally:
        mpl.interactive(before)


def test_the_profile_of_all_pairs_holds_their_distances():
    run = a_run()
    ax = plots.pair_distances(run, ax=axes())
    least, middle = line(ax, "least (D)").get_ydata(), line(ax, "median").get_ydata()
    np.testing.assert_allclose(least, run.metric("min_distance"), rtol=1e-12)
    i, j = np.triu_indices(4, 1)
    apart = np.linalg.norm(run.q[:, i] - run.q[:, j], axis=2)
    np.testing.assert_allclose(middle, np.median(apart, axis=1), rtol=1e-12)
    heights = ax.collections[0].get_paths()[0].vertices[:, 1]
    assert heights.max() == pytest.approx(apart.max())
    lone = simulate(Algorithm1(), [[0.0, 0.0]], [[1.0, 0.0]], (0.0, 1.0))
    assert "one agent" in plots.pair_distances(lone, ax=axes()).texts[0].get_text()


def test_an_undamped_swing_is_drawn_as_a_cosine_between_the_solvers_steps():
    """One agent on a spring of rate 1: p = −sin t, which steps of the solver sample a few times a period."""
    law = flockana.Algorithm2(
        gains=flockana.Gains(c1_gamma=1.0, c2_gamma=0.0), target=flockana.StaticTarget((0.0, 0.0))
    )
    run = flockana.simulate(law, [[1.0, 0.0]], [[0.0, 0.0]], (0.0, 12.0), rtol=1e-6, atol=1e-8)
    t, p = velocities_between(run)
    assert len(t) > 10 * len(run.t)
    assert np.all(np.diff(t) > 0.0)
    longest = np.diff(run.path.t).max()
    assert np.abs(p[:, 0, 0] + np.sin(t)).max() < longest**4 / 384.0 + 1e-5  # Hermite's remainder, and the run's error
    polygon = np.interp(t, run.t, run.p[:, 0, 0])
    assert np.abs(polygon + np.sin(t)).max() > 20.0 * np.abs(p[:, 0, 0] + np.sin(t)).max()
    np.testing.assert_array_equal(p[np.isin(t, run.path.t)], run.path.p)
    assert {t[0], t[-1]} == {0.0, 12.0}


def test_a_map_has_nothing_between_its_steps():
    run = flockana.scenario("headings-part").run().window(0.0, 5.0)
    t, p = velocities_between(run)
    np.testing.assert_array_equal(t, run.t)
    np.testing.assert_array_equal(p, run.p)
