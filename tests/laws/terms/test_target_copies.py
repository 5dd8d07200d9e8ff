import numpy as np

from flockana import Copies, Gains, Spring
from flockana.laws.terms.target_copies import CopiesTerm


def test_an_agent_is_pulled_to_its_own_copy():
    copies, u = Copies([[3.0]], [[1.0]], Spring((0.0,), 0.0)), np.zeros((1, 1))
    term = CopiesTerm(copies, Gains(c1_gamma=2.0, c2_gamma=1.0))
    assert (term.act(0.0, np.zeros((1, 1)), np.zeros((1, 1)), u), u.tolist()) == (6.0, [[7.0]])
