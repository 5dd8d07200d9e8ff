"""Pairs and a drag: a law of one file, with a term, a measure and a reference of its own."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from flockana import PairInteraction, PairTerm, SumOfTerms, Term


@dataclass(frozen=True)
class ToyDrag(Term):
    """u_i = −k p_i."""

    k: float

    def act(self, t, q, p, u):
        u -= self.k * p
        return -self.k * float(np.sum(p * p))

    def derivatives(self, t, q, p):
        eye = np.broadcast_to(np.eye(q.shape[1]), (*q.shape, q.shape[1]))
        return 0.0 * eye, -self.k * eye

    def hessian(self, t, q):
        return np.zeros((*q.shape, q.shape[1]))


@dataclass(frozen=True)
class ToySwarm(SumOfTerms):
    """Pairs of any interaction, and −k p_i."""

    pair: PairInteraction
    k: float = 1.0

    units = {"k": (0, -1)}  # noqa: RUF012

    references = ("toy-2026",)

    @cached_property
    def terms(self):
        return (PairTerm(self.pair, 1.0, 0.0), ToyDrag(self.k))

    def measures(self, t, q, p, extra):
        return {"toy_speed": ("largest speed", np.linalg.norm(p, axis=2).max(axis=1))}
