"""Verdicts on tubes: rigorous for every enclosed start."""

from typing import Any

from flockana.base.errors import ArgumentError, format_value
from flockana.certified.basin import Basin
from flockana.certified.tube import Tube
from flockana.theorems.catalogue import catalogue
from flockana.theorems.evidence import Evidence
from flockana.theorems.theorem import Known, Theorem, Tolerances


class TubeEvidence(Evidence):
    """Tube with a certified basin at its end, if any."""

    def __init__(self, tube: Tube, basin: Any = None) -> None:
        self.tube, self.basin, self.law, self.until = tube, basin, tube.law, float(tube.t[-1])

    def examine(self, item: Theorem, tolerances: Tolerances) -> Known:  # noqa: D102
        if item.enclosed is None:
            able = ", ".join(name for name, entry in catalogue().items() if entry.enclosed is not None)
            raise ArgumentError(f"{item.id} is not decided from a tube: expected a Trajectory, or one of {able}")
        self.tube.ensure_unedited()
        if self.basin is not None:
            if not isinstance(self.basin, Basin):
                basin_text = format_value(self.basin)
                raise ArgumentError(f"basin = {basin_text}: expected a basin, as certify(...) returns it, or None")
            self.basin.ensure_unedited()
        return item.examine(self.tube, self.basin, tolerances, check=item.enclosed)
