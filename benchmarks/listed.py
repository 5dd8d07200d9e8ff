"""A right-hand side over a list of pairs that is kept, as compiled integrators evaluate it, seen from Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.flocks import R
from flockana.base.checks import FloatArray
from flockana.kernels.verlet import SKIN, list_pairs, spatial_order
from flockana.laws.olfati_saber import Algorithm2


def listed_evaluation(
    law: Algorithm2, q: FloatArray, p: FloatArray
) -> tuple[Callable[[], tuple[FloatArray, float]], Any]:
    """An evaluation over a list that is kept, as within a run: agents in the order of cells, which is given too."""
    compiled = law.compiled(2)
    assert compiled is not None
    order, few = spatial_order(q, (1.0 + SKIN) * R), np.empty(1, np.uint32)
    x, v, own = q[order].copy(), p[order].copy(), np.arange(len(q), dtype=np.uint64)
    first, second, count, _ = list_pairs(x, (1.0 + SKIN) * R, few, few)
    still, terms = (
        np.zeros((2, 2)),
        [(term.act, np.array(term.numbers), np.array(term.panels)) for term in compiled.terms],
    )

    def call() -> tuple[FloatArray, float]:
        u = np.zeros(x.shape)
        return u, sum(act(0.0, x, v, u, still, *given, first, second, count, own) for act, *given in terms)

    return call, order
