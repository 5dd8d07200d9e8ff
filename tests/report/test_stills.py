"""Stills: agents, links by their strain, obstacles and targets, all on one scale."""

from __future__ import annotations

import re

import numpy as np

from flockana.dynamics.simulate import simulate
from flockana.environment.obstacles import Sphere, Wall
from flockana.environment.targets import StaticTarget
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm1
from flockana.report.stills import stills


def test_links_have_the_colour_of_their_strain():
    q = np.array([[0.0, 0.0], [5.0, 0.0], [12.0, 0.0], [20.0, 0.0], [40.0, 0.0]])  # 5: short; 7: as desired; 8: long
    text = stills(simulate(Algorithm1(), q, 0.0 * q, (0.0, 0.01)), [0.0])
    assert [text.count(f'class="link {kind}"') for kind in ("short", "even", "long")] == [1, 1, 1]
    dots = re.search(r'class="agents"[^>]*d="([^"]*)"', text)[1]
    x = [float(pair.split()[0]) for pair in dots.replace("h0", "").split("M")[1:]]
    np.testing.assert_allclose(np.diff(x) / (x[-1] - x[0]), np.diff(q[:, 0]) / 40.0, atol=0.005)


def test_obstacles_and_target_are_drawn():
    law = Algorithm3(
        target=StaticTarget((5.0, 0.0)), obstacles=(Sphere((20.0, 0.0), 4.0), Wall((0.0, -9.0), (0.0, 1.0)))
    )
    q = np.array([[0.0, 0.0], [7.0, 0.0]])
    text = stills(simulate(law, q, 0.0 * q, (0.0, 0.1)), [0.0, 0.1])
    assert text.count("<circle") == text.count('class="target"') == text.count("<svg") == 2
    assert text.count('class="solid"') == 4
