"""Joint connectivity: time windows in which the union of the nets connects all agents."""

from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_count, ensure_fits, ensure_links
from flockana.kernels.connected_components import labelled, unite
from flockana.measures.measure import Measure
from flockana.measures.nets import LinkArray, links


def joint_windows(n: int, nets: Iterable[LinkArray]) -> tuple[tuple[int, int], ...]:
    """Return the shortest consecutive windows [start, stop) of a series of nets with connected unions.

    A window ends as soon as the links seen in it connect all agents, and the next begins there: no other division into
    contiguous windows has more of them. What is left over at the end is in none.

    Parameters
    ----------
    nets : iterable of int array, shape (M, 2)
        Links at each instant.

    Returns
    -------
    tuple of (int, int)
        First instant of each window and the first after it.

    Examples
    --------
    >>> one, other, none = [[0, 1]], [[1, 2]], []
    >>> joint_windows(3, [one, other, none, other, one, none])
    ((0, 2), (2, 5))
    """
    n = ensure_count("n", n)
    ensure_fits(f"what is told of n = {n} agents,", (5, n), "ask for fewer agents")
    if not isinstance(nets, Iterable) or isinstance(nets, str | bytes) or getattr(nets, "ndim", 1) == 0:
        raise ArgumentError(f"nets = {nets!r}: expected the links at each instant, such as [[[0, 1]], [[1, 2]]]")
    window_ends, agents = [0], np.arange(n)
    for k, net in enumerate(nets, start=1):
        unite(agents, *ensure_links(net, n).T)
        if not labelled(agents).any():
            window_ends.append(k)
            agents = np.arange(n)
    return tuple(pairwise(window_ends))


def windows_of(run: Any) -> tuple[tuple[int, int], ...]:
    """Return the windows of a run's samples with a jointly connected net."""
    # A net is that of the law's pair interaction, or what a law without one tells by its own ``links(q)``.
    if not hasattr(run.law, "links") and run.law.pair is None:
        raise ArgumentError(f"{run.law.title} has no net: expected a run of a law with a range")
    net = getattr(run.law, "links", None)
    return joint_windows(run.n, (links(q, run.law.pair.range) if net is None else net(q) for q in run.q))


MEASURES = (
    Measure(
        "joint_windows",
        "windows of time over which the net is jointly connected",
        of_run=lambda run: len(windows_of(run)),
        of_run_text="contiguous windows of samples, each with a connected union of its nets",
        defined=lambda law: hasattr(law, "links"),
    ),
)
