"""The swarm's velocities, slopes and rests against formulas of their own."""

from math import exp, log, sqrt

import numpy as np
import pytest

import flockana as fl
from flockana.laws.first_order_law import VelocityLaw
from tests.refused import refused

LAW = fl.GaziPassino(0.8, 3.0, 0.7)
Q = np.random.default_rng(2).normal(size=(5, 3))


def test_velocities_and_slopes_are_those_written_out_agent_by_agent():
    own = [sum((0.8 - 3.0 * exp(-float(np.sum((b - a) ** 2)) / 0.7)) * (b - a) for b in Q if b is not a) for a in Q]
    np.testing.assert_allclose(LAW.velocity(0.0, Q), own, rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(LAW.jacobian(0.0, Q), VelocityLaw.slopes(LAW, 0.0, Q).toarray(), atol=1e-9)


@pytest.mark.parametrize("repulsion", [exp(0.5), 20.0])
def test_two_agents_rest_where_attraction_and_repulsion_cancel(repulsion):
    law = fl.GaziPassino(1.0, repulsion, 0.2)
    run = fl.simulate(law, [[0.0, 0.0], [0.4, 0.3]], None, (0.0, 20.0), rtol=1e-10)
    rest = sqrt(0.2 * log(repulsion))
    assert np.linalg.norm(run.q[-1, 1] - run.q[-1, 0]) == pytest.approx(rest, rel=1e-8)
    assert (rest == pytest.approx(law.radius, rel=1e-12)) == (repulsion < 2.0)
    assert rest <= law.radius * (1.0 + 1e-12)
    about = fl.linearise(law, run.q[-1], force_tolerance=1e-7)
    # along the pair 2 (a − b e^{−s²/c})' s = −4 a s²/c; across it and of the centre nothing
    np.testing.assert_allclose(about.eigenvalues.real, [0.0, 0.0, 0.0, -4.0 * log(repulsion)], rtol=1e-6, atol=1e-12)


def test_other_units_and_files_keep_it(tmp_path):
    other = fl.rescale(LAW, length=3.0, time=0.25)
    np.testing.assert_allclose(other.velocity(0.0, 3.0 * Q), 12.0 * LAW.velocity(0.0, Q), rtol=1e-12)
    assert other.radius == pytest.approx(3.0 * LAW.radius, rel=1e-12)
    run = fl.simulate(LAW, Q, None, (0.0, 0.2))
    run.save(tmp_path / "run.nc")
    assert fl.Trajectory.load(tmp_path / "run.nc").law == LAW


test_what_is_refused = refused(
    (lambda: fl.GaziPassino(attraction=0.0), "attraction = 0"), (lambda: fl.GaziPassino(c=-1.0), "c = -1")
)
