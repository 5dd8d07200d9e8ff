"""What IPOPT is handed: a value, its gradient and its Hessian, each the derivative of the one before."""

import casadi as ca
import numpy as np
import pytest

from flockana.environment.capsule import Capsule
from flockana.environment.obstacles import Sphere, Wall
from flockana.environment.targets import StaticTarget
from flockana.equilibria.ipopt_program import Program
from flockana.equilibria.potential import Potential
from flockana.equilibria.solve import all_pairs
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.sources.li_dead_zone import DeadZoneInteraction
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking

SOME = Gains(c1_gamma=(1.0, 2.0, 0.5, 1.0, 3.0, 1.0, 1.0, 2.0, 0.1))
OBSTACLES = Sphere((-3.0, 0.0), 2.0), Wall((0.0, -2.0), (0.0, 1.0)), Capsule((16.0, 0.0), (16.0, 20.0), 1.0)
LAWS = (
    (Algorithm1(), 2),
    (Algorithm1(AlphaInteraction(1.7, 2.5, 0.01, 0.9, 7.0, 15.0)), 1),
    (Algorithm2(target=StaticTarget((1.0, 2.0, 3.0))), 3),
    (Algorithm2(gains=SOME, target=StaticTarget((1.0, 2.0))), 2),
    (Algorithm3(target=StaticTarget((10.0, 2.0)), obstacles=OBSTACLES), 2),
    (DeadZoneFlocking(DeadZoneInteraction(k1=0.03)), 2),
)


@pytest.mark.parametrize(("law", "m"), LAWS)
def test_gradient_and_hessian_are_differences_of_value_and_gradient(law, m):
    q = np.random.default_rng(3).uniform(0.2, 14.0, (9, m))
    potential = Potential(law)
    program = Program(potential, q.shape, all_pairs(9), potential.symmetries(q).shape[1])
    x, step = q.ravel() / program.d, 1e-6
    gradient, upper = program.derivatives(x)
    full = np.array(ca.triu2symm(upper))
    free = np.eye(q.size)  # of Algorithm 2 with one c1γ the centre is held, and the pull on it left out
    if not potential.pinned:
        free -= np.kron(np.ones((9, 9)) / 9, np.eye(m))
    for k in range(0, q.size, 4):
        nudge = step * free[k]
        slope = (program.value(x + nudge) - program.value(x - nudge)) / (2.0 * step)
        assert slope == pytest.approx(float(free[k] @ np.array(gradient).ravel()), rel=1e-6, abs=1e-7)
        ahead, behind = (np.array(program.derivatives(x + way * nudge)[0]).ravel() for way in (1.0, -1.0))
        np.testing.assert_allclose((ahead - behind) / (2.0 * step), free @ full @ free[k], rtol=1e-5, atol=1e-5)
