import numpy as np
import pytest

import flockana as fl
from flockana.course import figures
from flockana.plots import subplots

ALPHA = fl.AlphaInteraction()


@pytest.fixture(autouse=True)
def closed():
    """Close the figures of a test."""
    yield
    import matplotlib.pyplot as plt

    plt.close("all")


def curves(ax):
    return {line.get_label(): np.asarray(line.get_xydata(), float) for line in ax.lines}


def test_the_vector_of_a_pair_is_shorter_than_their_difference_and_bounded():
    axes = figures.pair_vector(eps=0.1, axes=subplots(1, 2)[1])
    lengths = curves(axes[1])
    whole, short = (next(c for name, c in lengths.items() if key in name) for key in ("q_j", "n_{ij}"))
    assert np.all(short[1:, 1] < whole[1:, 1])
    assert np.allclose(short[:, 1], whole[:, 1] / np.sqrt(1.0 + 0.1 * whole[:, 1] ** 2))
    assert short[:, 1].max() < 10.0**0.5


def test_the_norms_and_bumps_are_the_librarys():
    x, drawn = np.linspace(-4.0, 4.0, 401), curves(figures.norms(eps=(0.1, 1.0)))
    assert np.allclose(drawn["σ-norm, ε = 0.1"][:, 1], ALPHA.sigma_norm(np.abs(x)))
    bumps = curves(figures.bumps(h=(0.2, 0.9)))
    for h in (0.2, 0.9):
        z, values = bumps[f"h = {h:g}"].T
        assert np.allclose(values, fl.AlphaInteraction(h=h).bump(z), atol=1e-12)


def test_three_orbits_keep_their_energies():
    curves = [np.asarray(line.get_xydata(), float).T for line in figures.three_orbits(ALPHA).lines[:3]]
    for share, (y, rate) in zip((0.5, 1.0, 1.6), curves, strict=True):
        energy = ALPHA.psi_alpha(ALPHA.sigma_norm(y)) + rate**2 / 4.0
        assert np.allclose(energy, share * ALPHA.psi_alpha(ALPHA.r_alpha), rtol=1e-9)
        assert abs(rate[len(rate) // 2]) < 1e-4  # it turns where it is nearest
    (swinging, stays), (edge, _), (leaving, goes) = curves
    assert stays[0] == stays[-1] == 0.0  # closed
    assert swinging.max() < ALPHA.r == edge.max() < leaving.max()
    assert goes[-1] > 1.0


def test_two_links_of_length_1_cross_and_two_ends_are_near():
    ax = figures.crossing_links()
    links = [np.asarray(line.get_xydata(), float) for line in ax.lines[:2]]
    assert np.allclose([np.hypot(*(link[1] - link[0])) for link in links], 1.0, atol=0.01)
    ends = [np.hypot(*(a - b)) for a in links[0] for b in links[1]]
    assert min(ends) <= 2.0**-0.5
    assert f"{min(ends):.2f}" in {text.get_text() for text in ax.texts}


def test_the_velocity_of_a_beta_agent_is_the_projection():
    sphere, wall = figures.projections(axes=subplots(1, 2)[1])
    law = fl.Algorithm3(target=fl.StaticTarget((0.0, 0.0)), obstacles=(fl.Sphere((0.0, 0.0), 1.0),))
    q, image = (np.asarray(line.get_xydata(), float)[0] for line in sphere.lines[:2])
    assert np.allclose(image, q / np.hypot(*q))
    assert law.obstacles[0].radius == 1.0
    assert np.asarray(wall.lines[1].get_xydata(), float)[0].tolist() == [0.0, 0.0]


def test_the_tails_of_an_interval_are_two_and_a_half_per_cent():
    ends = tuple(map(float, fl.clopper_pearson(57, 60)))
    for ax in figures.interval_tails(57, 60, ends, axes=subplots(1, 2)[1]):
        whole, tail = ax.containers
        assert sum(bar.get_height() for bar in whole) == pytest.approx(1.0, rel=1e-9)
        assert sum(bar.get_height() for bar in tail) == pytest.approx(0.025, rel=1e-6)
        assert "2.5%" in ax.texts[0].get_text()


def test_a_held_pair_turns_about_the_jump_and_dies_out():
    force, plane = figures.held_at_a_jump(axes=subplots(1, 2)[1]).figure.axes
    y, rate = np.asarray(plane.lines[0].get_xydata(), float).T
    energy = rate**2 / 2.0 + np.where(y < 0.0, -y, 0.4 * y)
    crossings = np.flatnonzero(np.diff(np.sign(y)))
    assert len(crossings) > 20
    assert np.all(np.diff(energy[crossings]) < 0.0)
    assert force.lines[4].get_ydata().tolist() == [-0.4, 1.0]


def test_zones_are_nested_and_named_once():
    ax = figures.zones({"near": 1.0, "far": 3.0, "middle": 2.0})
    sizes = [np.abs(patch.get_xy()).max() for patch in ax.patches]
    assert np.allclose(sizes, [3.0, 2.0, 1.0], rtol=1e-3)
    assert sorted(text.get_text() for text in ax.texts) == ["far = 3", "middle = 2", "near = 1"]


def arrows(ax):
    """Return tail and head of each arrow of a figure."""
    found = [each for each in ax.texts if getattr(each, "arrow_patch", None) is not None and not each.get_text()]
    return [np.array([each.xyann, each.xy], float) for each in found]


def test_the_pull_of_a_target_grows_with_the_distance_from_it():
    ax = figures.target_pull()
    target = np.asarray(ax.lines[1].get_xydata(), float)[0]
    pulls = arrows(ax)[:5]
    shares = [(head - tail) / (target - tail) for tail, head in pulls]
    assert np.allclose(shares, 0.3)
    assert np.allclose(np.asarray(ax.lines[0].get_xydata(), float)[0], np.mean([tail for tail, _ in pulls], axis=0))


def test_wall_well_and_rim_are_the_potentials():
    ax = figures.wall_and_well(ALPHA)
    inset = ax.child_axes[0]
    x, psi = np.asarray(ax.lines[0].get_xydata(), float).T
    assert psi[0] == pytest.approx(ALPHA.c_star, rel=1e-12)
    assert x[np.argmin(psi)] == pytest.approx(7.0, abs=0.02)
    assert [text.get_text() for text in ax.texts] == ["wall: $c^* = 52.4$"]
    assert [text.get_text() for text in inset.texts] == ["well", "rim: 0.736"]
    assert inset.get_ylim()[1] < 2.0  # enlarged: the wall is 52 high


def test_a_solution_stays_inside_the_level_set_and_ends_on_the_orbit():
    level, _, orbit, solution = (
        np.hypot(*np.asarray(line.get_xydata(), float).T) for line in figures.orbit_ball_level().lines
    )
    assert np.allclose(orbit, 1.0)
    assert np.abs(solution - 1.0).max() < level[0] - 1.0 < 0.45  # of the ball
    assert abs(solution[-1] - 1.0) < 0.01


def test_kinds_of_equilibria_are_told_by_eigenvalues():
    axes = figures.equilibria(axes=subplots(1, 3)[1])
    assert [ax.get_title(loc="left").split(":")[0] for ax in axes] == ["minimum", "saddle", "degenerate"]
    ends = [np.asarray(ax.lines[0].get_xydata(), float)[-1] for ax in axes]
    assert np.abs(ends[0]).max() < 0.01  # it arrives
    assert ends[1][1] > 1.5  # it leaves
    assert np.allclose(ends[2], [0.0, 0.3], atol=0.01)  # it arrives somewhere in the valley


def test_a_net_draws_its_links_and_numbers():
    ax = figures.net(3, [(0, 1), (1, 2)], title="path")
    assert len(ax.lines) == 2
    assert [text.get_text() for text in ax.texts] == ["1", "2", "3"]
