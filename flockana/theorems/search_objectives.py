"""Surrogate objectives for counterexample searches, for claims with flat margins."""

from math import isfinite

import numpy as np

from flockana.measures.nets import links
from flockana.theorems.collisions import contacts_of
from flockana.theorems.theorem_toolkit import Claim, Tolerances, Trajectory, lengths


def squash(x: float) -> float:
    """Return x/(1 + |x|) of a number, which increases and is finite at infinity."""
    return x / (1.0 + abs(x)) if isfinite(x) else (1.0 if x > 0.0 else -1.0)


def pairs_apart(run: Trajectory, claim: Claim) -> float:
    """Return a search objective for collisions: the least distance of pairs not yet met, over d."""
    i, j = np.triu_indices(run.n, 1)
    apart = lengths(run.q[:, i] - run.q[:, j]).min(axis=0)
    touched = {(contact.i, contact.j) for contact in contacts_of(run, Tolerances())}
    separations = [x for x, a, b in zip(apart.tolist(), i.tolist(), j.tolist(), strict=True) if (a, b) not in touched]
    return squash(min(separations, default=0.0) / run.law.lattice[0])


def bridge(run: Trajectory, claim: Claim) -> float:
    """Return a search objective for disconnection, from the longest link needed to connect the net."""
    from scipy.sparse.csgraph import minimum_spanning_tree
    from scipy.spatial.distance import pdist, squareform

    longest = max(float(minimum_spanning_tree(squareform(pdist(q))).max()) for q in run.q) if run.n > 1 else 0.0
    return 1.0 - squash(longest / run.law.lattice[1])


def strained(run: Trajectory, claim: Claim) -> float:
    """Return a search objective for lattice limits: 1 less the mean over time of the largest strain."""
    # Runs that pass by a strained equilibrium linger there: the longer they do, the nearer they are to its basin.
    (d, r), series = run.law.lattice, []
    for q in run.q:
        pairs = links(q, r)
        link_lengths = np.linalg.norm(q[pairs[:, 0]] - q[pairs[:, 1]], axis=1)
        series.append(float(np.abs(link_lengths / d - 1.0).max(initial=0.0)))
    return 1.0 - float(np.trapezoid(np.minimum(series, 1.0), run.t)) / float(run.t[-1] - run.t[0])
