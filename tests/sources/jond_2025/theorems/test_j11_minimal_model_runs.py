import numpy as np

from flockana.laws.minimal import MinimalFlocking
from flockana.theorems.bearing_distance.j11 import perceived_components


def test_an_agent_out_of_sight_is_a_component_of_its_own():
    assert perceived_components(MinimalFlocking(1.5), np.array([[0.0], [1.0], [3.0]])) == 2
