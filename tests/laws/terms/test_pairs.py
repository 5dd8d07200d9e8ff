import numpy as np
import pytest

from flockana.base.errors import ArgumentError
from flockana.laws.terms.pairs import ensure_apart


def test_agents_that_coincide_are_refused_where_the_force_has_no_limit():
    with pytest.raises(ArgumentError, match="agents 0 and 1 coincide: the pair force has no limit there"):
        ensure_apart(np.array([[0.0], [0.0]]))
