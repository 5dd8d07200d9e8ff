from __future__ import annotations

from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from flockana import plots
from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.dynamics.simulate import simulate
from flockana.environment.targets import LinearTarget, StaticTarget
from flockana.interactions import AlphaInteraction
from flockana.laws.discrete import DiscreteLaw
from flockana.laws.law import Law
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from tests.plots.artists import axes, points


@dataclass(frozen=True)
class Drag(Law):
    """No interaction range, no energy, no target."""

    def flow(self, t, q, p):
        return -p, float("nan")


@dataclass(frozen=True)
class Halving(DiscreteLaw):
    dt: float = 0.5

    def step(self, t, q, p, memory):
        return 0.5 * q, p, 0.0 * q, memory


@pytest.fixture(autouse=True)
def _nothing_left_open():
    import matplotlib.pyplot as plt

    before = dict(mpl.rcParams)
    yield
    plt.close("all")
    assert dict(mpl.rcParams) == before, "a figure changed matplotlib's global settings"


def a_run(m=2, n=4):
    target = LinearTarget((1.0,) * m, (2.0,) * m)
    q = np.random.default_rng(0).uniform(0.0, 12.0, (n, m))
    return simulate(Algorithm2(target=target), q, 0.0 * q, (0.0, 1.0), t_eval=np.linspace(0.0, 1.0, 11))


def line(ax, label):
    return next(one for one in ax.get_lines() if one.get_label() == label)


def test_links_are_coloured_by_strain():
    q = np.array([[0.0, 0.0], [7.0, 0.0], [7.0, 7.7], [100.0, 0.0]])
    ax = plots.configuration(q, d=7.0, r=8.4, ax=axes())
    links = next(c for c in ax.collections if isinstance(c, LineCollection))
    np.testing.assert_allclose(links.get_array(), [0.0, 0.1], atol=1e-12)
    np.testing.assert_allclose(links.get_segments()[1], q[[1, 2]])
    assert (links.norm.vmin, links.norm.vmax) == pytest.approx((-0.2, 0.2))


def test_without_a_desired_distance_links_are_plain_and_without_a_range_there_are_none():
    q = np.array([[0.0, 0.0], [1.0, 0.0]])
    plain = plots.configuration(q, r=2.0, ax=axes())
    assert next(c for c in plain.collections if isinstance(c, LineCollection)).get_array() is None
    assert not any(isinstance(c, LineCollection) for c in plots.configuration(q, ax=axes()).collections)


def test_the_longest_arrow_is_labelled_with_the_largest_speed_and_rest_has_no_arrows():
    q, p = np.zeros((2, 2)), np.array([[3.0, 4.0], [1.0, 0.0]])
    assert "longest arrow: 5 length/time" in plots.configuration(q, p, ax=axes()).get_title(loc="left") + (
        plots.configuration(q, p, ax=axes()).get_title()
    )
    assert "arrow" not in plots.configuration(q, 0.0 * p, ax=axes()).get_title()


@pytest.mark.parametrize("m", [1, 2, 3])
def test_a_snapshot_shows_the_nearest_sample_and_the_target_then(m):
    run = a_run(m)
    ax = plots.snapshot(run, 0.52, ax=axes(m))
    assert "t = 0.5" in ax.get_title(loc="left") + ax.get_title()
    dots, star = (next(c for c in ax.collections if c.get_label() == name) for name in ("agents", "γ-agent"))
    if m == 3:
        np.testing.assert_allclose(points(dots), run.q[5])
        np.testing.assert_allclose(points(star), [[2.0, 2.0, 2.0]])
    else:
        np.testing.assert_allclose(dots.get_offsets()[:, :m], run.q[5])
        np.testing.assert_allclose(star.get_offsets()[:, :m], [[2.0] * m])


def test_snapshot_of_bad_time_is_refused():
    with pytest.raises(ArgumentError, match="time = nan: expected a finite number"):
        plots.snapshot(a_run(), float("nan"), ax=axes())


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
        assert ax.get_xlabel() == "t (time)"


def test_series_show_the_numbers_of_the_run():
    run = a_run()
    np.testing.assert_array_equal(plots.energy(run, ax=axes()).get_lines()[0].get_ydata(), run.energy())
    residual = plots.energy_residual(run, ax=axes()).get_lines()[1]
    np.testing.assert_array_equal(residual.get_ydata(), run.energy_residual)
    speeds = plots.speeds(run, ax=axes())
    np.testing.assert_allclose(speeds.get_lines()[2].get_ydata(), np.hypot(*run.p[:, 2].T))
    np.testing.assert_allclose(line(speeds, "centre of mass").get_ydata(), np.hypot(*run.p.mean(axis=1).T))
    np.testing.assert_allclose(line(speeds, "γ-agent's ‖p_r‖").get_ydata(), np.full(11, np.sqrt(8.0)))
    centre = plots.centre_of_mass(run, ax=axes())
    np.testing.assert_allclose(line(centre, "y of the centre").get_ydata(), run.q[:, :, 1].mean(axis=1))
    np.testing.assert_allclose(line(centre, "y of the γ-agent").get_ydata(), 1.0 + 2.0 * run.t)


def test_distances_show_samples_bound_and_the_law_s_lengths():
    run = a_run()
    ax = plots.distances(run, ax=axes())
    np.testing.assert_array_equal(line(ax, "at the samples").get_ydata(), run.metrics().min_distance)
    stairs = next(p for p in ax.patches if p.get_label() == "lower bound between")
    np.testing.assert_array_equal(stairs.get_data().values, run.closest_approach().lower_by_interval)
    assert set(line(ax, "d").get_ydata()) == {7.0}
    assert set(line(ax, "r").get_ydata()) == {8.4}


def test_the_panel_draws_four_measures_and_only_the_mismatch_is_logarithmic():
    run = a_run()
    drawn = plots.panel(run, axes=Figure().subplots(2, 2))
    for ax, name in zip(
        drawn, ("connectivity", "cohesion_radius", "deviation_energy", "velocity_mismatch"), strict=True
    ):
        np.testing.assert_array_equal(ax.get_lines()[0].get_ydata(), run.metrics()[name])
    assert [ax.get_yscale() for ax in drawn] == ["linear", "linear", "linear", "log"]


def test_an_unknown_measure_is_refused():
    with pytest.raises(UnknownNameError, match="unknown metric 'cohesion'; did you mean 'cohesion_radius'"):
        plots.measure(a_run(), "cohesion", ax=axes())


@pytest.mark.parametrize("law", [Drag(), Halving()])
def test_laws_without_range_energy_or_target_draw_what_there_is(law):
    run = simulate(law, [[0.0, 0.0], [4.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]], (0.0, 2.0))
    assert "not defined" in plots.measure(run, "connectivity", ax=axes()).texts[0].get_text()
    assert "no energy" in plots.energy(run, ax=axes()).texts[0].get_text()
    assert "no energy" in plots.energy_residual(run, ax=axes()).texts[0].get_text()
    plots.snapshot(run, ax=axes())
    plots.centre_path(run, ax=axes())
    bounded = any(p.get_label() == "lower bound between" for p in plots.distances(run, ax=axes()).patches)
    assert bounded == isinstance(law, Law)  # between the steps of a map there is nothing to bound


def test_one_agent_has_no_distances():
    run = simulate(Algorithm2(target=StaticTarget((0.0,))), [[1.0]], [[0.0]], (0.0, 1.0))
    assert "one agent" in plots.distances(run, ax=axes()).texts[0].get_text()
    plots.snapshot(run, ax=axes())


def test_pair_curves_pass_through_their_known_points():
    alpha = AlphaInteraction()
    potential = plots.potential(alpha, ax=axes()).get_lines()[0]
    assert potential.get_ydata()[0] == pytest.approx(alpha.c_star)
    x, phi = plots.action(alpha, ax=axes()).get_lines()[0].get_data()
    assert np.all(phi[x < 7.0 - 0.02] < 0.0)
    assert np.all(phi[(x > 7.02) & (x < 8.38)] > 0.0)
    assert np.all(phi[x > 8.4] == 0.0)


def test_without_axes_new_ones_are_made_for_the_dimension():
    assert plots.trajectories(a_run(3)).name == "3d"
    assert plots.trajectories(a_run(2)).name == "rectilinear"
    run = simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 0.1))
    assert plots.energy(run).get_ylabel() == "H, energy"
    assert plots.panel(run).shape == (4,)


def test_a_backend_that_turns_interactive_mode_on_inside_the_style_keeps_it():
    before = mpl.is_interactive()
    try:
        mpl.interactive(False)
        with plots.style():
            mpl.interactive(True)  # what a notebook's backend does when the first figure loads it
        assert mpl.is_interactive()
    finally:
        mpl.interactive(before)
