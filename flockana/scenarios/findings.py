"""What scenario reports are made of: claims judged by a margin alone, and counts of components."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.interactions.pair import pair_interaction
from flockana.nets import components, links
from flockana.theorems.theorem import Claim, judge
from flockana.trajectory import Trajectory


def finding(
    name: str,
    margin: float,
    detail: str,
    *,
    computed: Any = None,
    stated: Any = None,
    error: float = 0.0,
    witness: Any = None,
) -> Claim:
    """A claim that is judged by its margin, without hypotheses.

    Parameters
    ----------
    name, detail : str
        As in `Claim`.
    margin : float
        Positive where the source's report agrees with the run.
    computed, stated, witness : object
        As in `Claim`.
    error : float
        Error of the margin.

    Examples
    --------
    >>> finding("connected", 0.5, "one component").status
    'verified'
    """
    status = judge(margin, error, [])
    return Claim(name, status, "numeric", computed, stated, margin, error, witness, None, detail)


def component_count(run: Trajectory, k: int = -1) -> int:
    """Number of components of the net at sample k of a run.

    Parameters
    ----------
    run : Trajectory
        A run of a law with an interaction range.
    k : int
        Which sample; the last by default.
    """
    pair = pair_interaction(run.law)
    assert pair is not None
    return int(components(run.n, links(run.q[k], pair.range)).max()) + 1


def component_counts(run: Trajectory) -> npt.NDArray[np.int64]:
    """Number of components of the net at each sample of a run, shape (T,).

    Parameters
    ----------
    run : Trajectory
        A run of a law with an interaction range.
    """
    counts: npt.NDArray[np.int64] = np.rint(run.n - run.metric("connectivity") * (run.n - 1)).astype(np.int64)
    return counts
