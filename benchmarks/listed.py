"""A right-hand side over a list of pairs that is kept, as compiled integrators evaluate it, seen from Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.flocks import R
from flockana.base.value_checks import FloatArray
from flockana.jit import njit
from flockana.kernels.large_flocks import fill
from flockana.kernels.listed_pairs import Listed
from flockana.kernels.pair_helpers import BLOCK
from flockana.kernels.verlet_list import COUNT, SKIN, Pairs, covers, no_pairs, spatial_order
from flockana.laws.olfati_saber import Algorithm2

REACH = (1.0 + SKIN) * R


def listed_evaluation(
    law: Algorithm2, q: FloatArray, p: FloatArray
) -> tuple[Callable[[], tuple[FloatArray, float]], Any]:
    """An evaluation over a list that is kept, in one call: agents in the order of cells, which is given too."""
    order = spatial_order(q, REACH)
    x, v, own = q[order].copy(), p[order].copy(), np.arange(len(q), dtype=np.uint64)
    pairs = fill(no_pairs(*x.shape), x, REACH)
    rate = _rate(law)

    def call() -> tuple[FloatArray, float]:
        u = np.empty(x.shape)
        return u, rate(x, v, u, pairs, own)

    return call, order


def _rate(law: Algorithm2) -> Callable[..., float]:
    """All terms of the law in one compiled call, as a run evaluates them."""
    form = law.compiled(2)
    assert form is not None
    pairs, pull = form.terms
    force, follow = pairs.act, pull.act

    @njit(error_model="numpy")
    def rate(x, v, u, listed, one, panels, other, none):  # type: ignore[no-untyped-def]
        u[:] = 0.0
        return force(0.0, x, v, u, one, panels, listed) + follow(0.0, x, v, u, other, none, listed)

    def rate_of(x: FloatArray, v: FloatArray, u: FloatArray, pairs: Pairs, own: Any) -> float:
        slabs = int(pairs.cuts[0])
        room = np.empty((2 * slabs, BLOCK), np.uint64), np.empty((3 * slabs, BLOCK))
        listed = Listed(
            still, pairs.first, pairs.second, int(pairs.counts[COUNT]), pairs.cuts[1 : slabs + 2], own, *room
        )
        return float(rate(x, v, u, listed, *arrays))

    arrays = [np.array(array) for term in form.terms for array in (term.numbers, term.panels)]
    still = np.zeros((2, 2))
    return rate_of


def flight(law: Algorithm2, q: FloatArray, p: FloatArray, dt: float, evaluations: int) -> Callable[[], FloatArray]:
    """Evaluations along the straight ways of the agents, from where the last turn ended, over a list that is kept up.

    As in a run: agents are sorted when a turn begins, pairs are listed anew when the list may lack one.
    """
    moved, own, rate = q.copy(), np.arange(len(q), dtype=np.uint64), _rate(law)

    def turn() -> FloatArray:
        order = spatial_order(moved, REACH)
        x, v, u, pairs = moved[order], p[order], np.empty(q.shape), no_pairs(*q.shape)
        for _ in range(evaluations):
            x += dt * v
            if not covers(pairs, x, R):
                pairs = fill(pairs, x, REACH)
            rate(x, v, u, pairs, own)
        moved[order], felt[order] = x, u
        return felt

    felt = np.empty(q.shape)
    np.testing.assert_allclose(turn(), law.flow(0.0, moved, p)[0], rtol=0.0, atol=1e-12 * np.abs(felt).max())
    return turn
