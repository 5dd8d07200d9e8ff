import numpy as np

import flockana as fl
from flockana.plots.dense import velocities_between


def test_an_undamped_swing_is_drawn_as_a_cosine_between_the_solvers_steps():
    """One agent on a spring of rate 1: p = −sin t, which steps of the solver sample a few times a period."""
    law = fl.Algorithm2(gains=fl.Gains(c1_gamma=1.0, c2_gamma=0.0), target=fl.StaticTarget((0.0, 0.0)))
    run = fl.simulate(law, [[1.0, 0.0]], [[0.0, 0.0]], (0.0, 12.0), rtol=1e-6, atol=1e-8)
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
    run = fl.scenario("headings-part").run().window(0.0, 5.0)
    t, p = velocities_between(run)
    np.testing.assert_array_equal(t, run.t)
    np.testing.assert_array_equal(p, run.p)
