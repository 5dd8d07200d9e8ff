import numpy as np
import pytest

from benchmarks.flocks import gas
from benchmarks.numpy_laws import by_agents, by_all_pairs
from flockana import Algorithm2, AlphaInteraction, StaticTarget


@pytest.mark.parametrize("baseline", [by_agents, by_all_pairs])
def test_a_baseline_is_the_law(baseline):
    law = Algorithm2(alpha=AlphaInteraction(a=3.0, b=5.0, h=0.4), target=StaticTarget((0.0, 0.0)))
    q, p = gas(60)
    u = law.acceleration(0.0, q, p)
    np.testing.assert_allclose(baseline(law, q, p), u, rtol=0.0, atol=1e-11 * np.abs(u).max())
