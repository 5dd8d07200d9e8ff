"""An array written to the front of another, whatever their shapes."""

from __future__ import annotations

import numpy as np

from flockana.kernels.copies import put


def test_the_front_is_written_and_nothing_else():
    into = np.full((3, 2), 9.0)
    put(np.array([[1.0, 2.0]]), into)
    assert into.tolist() == [[1.0, 2.0], [9.0, 9.0], [9.0, 9.0]]
    put(np.arange(6, dtype=np.uint32), whole := np.zeros(6, dtype=np.uint32))
    assert whole.tolist() == [0, 1, 2, 3, 4, 5]
