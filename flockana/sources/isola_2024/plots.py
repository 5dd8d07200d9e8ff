"""Connectivity of the MSN project, rank(A)/n, over time beside the correct rank(L)/(n − 1)."""

from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.dynamics.trajectory import Trajectory
from flockana.measures.nets import links, printed_rank_connectivity
from flockana.plots.palette import BLUE, INK, VERMILLION
from flockana.plots.style import over_time

_SAMPLES = 271  # every other of the project's 540 iterations


@over_time("connectivity, three ways")
def rank_connectivity(trajectory: Trajectory, ax: Any) -> None:
    """Draw rank(A)/n over time, with a zero diagonal and as typeset, and C = rank(L)/(n − 1) (erratum E8)."""
    pair = trajectory.law.pair
    if pair is None or not np.isfinite(pair.range):
        raise ArgumentError(f"law = {trajectory.law!r}: expected one whose agents interact within a range")
    t = trajectory.t
    picked_samples = np.unique(np.linspace(0, len(t) - 1, min(len(t), _SAMPLES)).round().astype(int))
    nets = [links(trajectory.q[k], pair.range) for k in picked_samples]
    for is_typeset, colour, name in ((False, BLUE, "rank(A)/n"), (True, VERMILLION, "rank(A)/n as typeset")):
        ranks = [printed_rank_connectivity(trajectory.n, net, typeset=is_typeset) for net in nets]
        ax.plot(t[picked_samples], ranks, color=colour, linewidth=1.0, label=name)
    ax.plot(t, trajectory.metric("connectivity"), color=INK, linestyle="--", label="C = rank(L)/(n − 1)")
    ax.set_ylim(-0.03, 1.05)
