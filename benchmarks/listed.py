"""A right-hand side over a list of pairs that is kept, as compiled integrators evaluate it, seen from Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.flocks import R
from flockana.base.checks import FloatArray
from flockana.kernels.verlet import SKIN, empty_list, list_pairs, listed_anew, outdated, spatial_order
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


def flight(law: Algorithm2, q: FloatArray, p: FloatArray, dt: float, evaluations: int) -> Callable[[], FloatArray]:
    """Evaluations along the straight ways of the agents, from where the last turn ended, over a list that is kept up.

    As in a run: agents are sorted when a turn begins, pairs are listed anew when the list may lack one.
    """
    reach = (1.0 + SKIN) * R
    compiled, moved, own = law.compiled(2), q.copy(), np.arange(len(q), dtype=np.uint64)
    assert compiled is not None
    still, terms = (
        np.zeros((2, 2)),
        [(term.act, np.array(term.numbers), np.array(term.panels)) for term in compiled.terms],
    )

    def turn() -> FloatArray:
        order = spatial_order(moved, reach)
        x, v, u, pairs = moved[order], p[order], np.empty(q.shape), empty_list(len(q))
        for _ in range(evaluations):
            x += dt * v
            if outdated(x, SKIN * R, pairs):
                pairs = listed_anew(x, reach, pairs, list_pairs)
            u[:] = 0.0
            for act, *given in terms:
                act(0.0, x, v, u, still, *given, pairs[0], pairs[1], pairs[2], own)
        moved[order], felt[order] = x, u
        return felt

    felt = np.empty(q.shape)
    np.testing.assert_allclose(turn(), law.flow(0.0, moved, p)[0], rtol=0.0, atol=1e-12 * np.abs(felt).max())
    return turn
