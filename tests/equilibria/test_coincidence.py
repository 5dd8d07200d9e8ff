"""How many agents a flock needs to hold two at one place."""

import numpy as np
import pytest

from flockana import Algorithm1, AlphaInteraction, find_equilibrium
from flockana.equilibria.coincidence import hessian_trace, least_with_coincidence
from flockana.lattice import hexagonal_spiral
from flockana.sources.geschwender_2016.theorems.e03_strained_limits import rhombus_with_double_agent

LAW = Algorithm1()


def test_coincident_agents_need_enough_neighbours():
    alpha = AlphaInteraction()
    for m in (1, 2, 3):
        for length in (0.0, 2.0, 6.5, 8.0):
            pair = np.zeros((2, m))
            pair[1, 0] = length
            trace = float(np.trace(alpha.hessian(pair).toarray()[:m, :m]))
            assert float(hessian_trace(alpha, np.array([length]), m)[0]) == pytest.approx(trace, abs=1e-11)
    assert [least_with_coincidence(alpha, m) for m in (1, 2, 3)] == [4, 5, 6]
    # five is reached in the plane, four on a line: a pair between two others
    assert find_equilibrium(LAW, rhombus_with_double_agent(7.0), method="root").kind == "minimum"
    line = find_equilibrium(LAW, [[-7.0], [0.0], [0.0], [7.0]], method="root")
    assert (line.kind, line.curvature > 0.01) == ("minimum", True)
    triangle = np.vstack([hexagonal_spiral(3, 7.0), hexagonal_spiral(1, 7.0)])
    assert find_equilibrium(LAW, triangle, method="root").kind == "saddle"
