"""Shares of random starts for which something holds, with exact intervals: what ensembles of errata are made of."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from flockana.base.binomial import clopper_pearson
from flockana.theorems.theorem import Claim, judge

CONFIDENCE = 0.95
_ROUNDING = 1e-9  # of the ends of an interval, which are quantiles of a beta distribution


def share(holds: Iterable[Any]) -> tuple[int, int, tuple[float, float]]:
    """(how often, of how many, exact Clopper-Pearson interval of the share).

    Examples
    --------
    >>> share([True] * 20)[2][1], share([False] * 20)[0]
    (1.0, 0)
    """
    found = np.array(list(holds), dtype=bool)
    low, high = clopper_pearson(found.sum(), found.size, level=CONFIDENCE)
    return int(found.sum()), found.size, (float(low), float(high))


def always(name: str, holds: Iterable[Any], what: str, stated: str, *, witness: Any = None) -> Claim:
    """A claim about every start: refuted if the share is below 1 for certain, never verified by a sample."""
    count, size, interval = share(holds)
    return Claim(
        name,
        "refuted" if interval[1] < 1.0 - _ROUNDING else "inconclusive",
        computed={"holds": count, "of": size, "share": interval},
        stated=stated,
        margin=interval[1] - 1.0,
        error=_ROUNDING,
        witness=witness,
        detail=f"{what} in {count} of {size} seeds: a share of {interval[1]:.2f} at most ({CONFIDENCE:.0%})",
    )


def mostly(
    name: str, holds: Iterable[Any], what: str, stated: str, *, least: float = 0.5, witness: Any = None
) -> Claim:
    """A claim about a share, judged by the lower end of its interval."""
    count, size, interval = share(holds)
    status = judge(interval[0] - least, _ROUNDING, [])
    return Claim(
        name,
        "inconclusive" if status == "refuted" and interval[1] > least - _ROUNDING else status,
        computed={"holds": count, "of": size, "share": interval},
        stated=stated,
        margin=interval[0] - least,
        error=_ROUNDING,
        witness=witness,
        detail=f"{what} in {count} of {size} seeds: a share of {interval[0]:.2f} at least ({CONFIDENCE:.0%})",
    )
