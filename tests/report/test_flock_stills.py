import re

import numpy as np

from flockana import Algorithm1, Algorithm3, Sphere, StaticTarget, Trajectory, Wall
from flockana.report.flock_stills import stills


def at_rest(law, q):
    return Trajectory(np.array([0.0, 0.1]), np.stack([q, q]), *np.zeros((2, 2, *q.shape)), law)


def test_links_have_the_colour_of_their_strain():
    q = np.array([[0.0, 0.0], [5.0, 0.0], [12.0, 0.0], [20.0, 0.0], [40.0, 0.0]])  # 5: short; 7: as desired; 8: long
    text = stills(at_rest(Algorithm1(), q), [0.0])
    assert [text.count(f'class="link {kind}"') for kind in ("short", "even", "long")] == [1, 1, 1]
    dots = re.search(r'class="agents"[^>]*d="([^"]*)"', text)[1]
    x = [float(pair.split()[0]) for pair in dots.replace("h0", "").split("M")[1:]]
    np.testing.assert_allclose(np.diff(x) / (x[-1] - x[0]), np.diff(q[:, 0]) / 40.0, atol=0.005)


def test_obstacles_and_target_are_drawn():
    law = Algorithm3(
        target=StaticTarget((5.0, 0.0)), obstacles=(Sphere((20.0, 0.0), 4.0), Wall((0.0, -9.0), (0.0, 1.0)))
    )
    q = np.array([[0.0, 0.0], [7.0, 0.0]])
    text = stills(at_rest(law, q), [0.0, 0.1])
    assert text.count("<circle") == text.count('class="target"') == text.count("<svg") == 2
    assert text.count('class="solid"') == 4


def test_in_space_a_wall_is_a_grid_in_its_plane():
    law = Algorithm3(target=StaticTarget((5.0, 0.0, 0.0)), obstacles=(Wall((0.0, 0.0, -9.0), (0.0, 0.0, 1.0)),))
    q = np.array([[0.0, 0.0, 0.0], [7.0, 0.0, 0.0], [0.0, 7.0, 0.0]])
    text = stills(at_rest(law, q), [0.0])
    path = re.search(r'class="box" d="([^"]*)"', text)[1]
    ends = np.array(re.findall(r"-?[0-9]+", path), dtype=float).reshape(-1, 2, 2)
    assert len(ends) == 10
    x, y = np.array(re.findall(r"M([0-9]+) ([0-9]+)h0", text), dtype=float).T  # first two are 7 apart along x
    scale = (x[1] - x[0]) / 7.0 / np.cos(0.6)
    middle = ends.mean(axis=(0, 1)) - (x[0], y[0])
    foot = 3.5 * np.array([np.cos(0.6) - np.sin(0.6), -np.sin(0.5) * (np.cos(0.6) + np.sin(0.6))])
    np.testing.assert_allclose(middle / scale, np.add(foot, (0.0, 9.0 * np.cos(0.5))), atol=0.15)
    slopes = (ends[:, 1, 1] - ends[:, 0, 1]) / (ends[:, 1, 0] - ends[:, 0, 0])
    cos, sin, tilt = np.cos(0.6), np.sin(0.6), np.sin(0.5)  # as lines along x and along y of a level plane are seen
    seen = sorted({round(slope, 1) for slope in slopes.tolist()})
    np.testing.assert_allclose(seen, sorted([-tilt * sin / cos, tilt * cos / sin]), atol=0.07)
