import numpy as np

from flockana.interactions import AlphaInteraction
from flockana.laws.terms.fixed_links import LinkTerm


def test_linked_agents_alone_act_on_each_other():
    u, q = np.zeros((3, 1)), np.array([[0.0], [8.0], [7.0]])
    assert LinkTerm(AlphaInteraction(), ((0, 1),), 1.0, 1.0).act(0.0, q, np.zeros((3, 1)), u) == 0.0
    assert u[0, 0] == -u[1, 0] > 0.0
    assert u[2, 0] == 0.0
