"""Poles with damping ratio, natural frequency, time constant and settling time, as in control textbooks."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf, log, nan
from typing import Any

import numpy as np
import pandas as pd

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_positive


class DampTable(pd.DataFrame):  # type: ignore[misc]  # pandas has no types here
    """Table of poles, printed with all its columns."""

    def __repr__(self) -> str:
        formats: Any = dict.fromkeys(self.columns, "{:.5g}".format)
        return self.to_string(formatters=formats, max_rows=pd.get_option("display.max_rows"))


def damp_table(poles: Iterable[tuple[str, complex]], *, settled: float = 0.02, dt: float | None = None) -> DampTable:
    """Return a pandas table of poles by rising natural frequency, one row each, as MATLAB's `damp`."""
    settled = ensure_positive("settled", settled)
    if settled >= 1.0:
        raise ArgumentError(f"settled = {settled:g}: expected a share of the deviation, below 1")
    rows = []
    for name, pole in poles:
        s = pole if dt is None else np.log(pole) / dt if pole else complex(-inf)
        size, rate = abs(s), -s.real
        times = (1.0 / rate, log(1.0 / settled) / rate) if rate > 0.0 else (inf, inf)
        rows.append(
            (name, complex(pole), rate / size if 0.0 < size < inf else nan if size == 0.0 else 1.0, size, *times)
        )
    rows.sort(key=lambda row: row[3])
    columns = ["pole", "damping ratio", "natural frequency", "time constant", "settling time"]
    return DampTable([row[1:] for row in rows], index=[row[0] for row in rows], columns=columns)
