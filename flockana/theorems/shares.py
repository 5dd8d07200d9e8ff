"""Claims about the share of random starts for which something holds, with exact confidence intervals."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from flockana.base.binomial import clopper_pearson
from flockana.theorems.claims import judged
from flockana.theorems.theorem import Claim

CONFIDENCE = 0.95
INTERVAL_ERROR = 1e-9  # of the ends of an interval, which are quantiles of a beta distribution


def interval(count: int, size: int) -> tuple[float, float]:
    """Exact Clopper-Pearson interval of the share of which `count` among `size` is a sample.

    Examples
    --------
    >>> interval(20, 20)[1], interval(0, 20)[0]
    (1.0, 0.0)
    """
    low, high = clopper_pearson(count, size, level=CONFIDENCE)
    return float(low), float(high)


def share(holds: Iterable[Any]) -> tuple[int, int, tuple[float, float]]:
    """(how often, of how many, exact interval of the share).

    Examples
    --------
    >>> share([True] * 20)[2][1], share([False] * 20)[0]
    (1.0, 0)
    """
    outcomes = np.array(list(holds), dtype=bool)
    return int(outcomes.sum()), outcomes.size, interval(outcomes.sum(), outcomes.size)


def always(name: str, holds: Iterable[Any], what: str, stated: str, *, witness: Any = None) -> Claim:
    """A claim about every start: refuted if the share is below 1 for certain, never verified by a sample."""
    count, size, (low, high) = share(holds)
    return judged(
        name,
        high - 1.0,
        INTERVAL_ERROR,
        verifies=False,
        computed={"holds": count, "of": size, "share": (low, high)},
        stated=stated,
        witness=witness,
        detail=f"{what} in {count} of {size} seeds: a share of {high:.2f} at most ({CONFIDENCE:.0%})",
    )


def mostly(
    name: str, holds: Iterable[Any], what: str, stated: str, *, least: float = 0.5, witness: Any = None
) -> Claim:
    """A claim about a share, judged by the lower end of its interval, and refuted by the upper one alone."""
    count, size, (low, high) = share(holds)
    return judged(
        name,
        low - least,
        INTERVAL_ERROR,
        refutes=high <= least - INTERVAL_ERROR,
        computed={"holds": count, "of": size, "share": (low, high)},
        stated=stated,
        witness=witness,
        detail=f"{what} in {count} of {size} seeds: a share of {low:.2f} at least ({CONFIDENCE:.0%})",
    )
