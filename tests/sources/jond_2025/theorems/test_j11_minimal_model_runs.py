import numpy as np

from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.sources.jond_2025.theorems.j11_minimal_model_runs import perceived_components


def test_an_agent_out_of_sight_is_a_component_of_its_own():
    assert perceived_components(MinimalFlocking(1.5), np.array([[0.0], [1.0], [3.0]])) == 2
