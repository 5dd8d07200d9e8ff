"""Accuracy of recorded numbers: a strict bound, or a band for all samples at once."""

from dataclasses import dataclass
from math import sqrt
from typing import Any, Literal

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, ensure_nonnegative

Kind = Literal["bound", "sd", "estimated", "unknown"]

CONFIDENCE = 0.99  # of the band that holds of all samples at once


@dataclass(frozen=True, eq=False)
class Accuracy:
    """Error bounds (half widths) of recorded positions and velocities, and whether stated or estimated.

    Parameters
    ----------
    place, speed : float or ndarray, shape (T, n)
        Largest distance of a recorded position, and of a velocity, from the true one.
    kind : {"bound", "sd", "estimated", "unknown"}
        A bound; a simultaneous 0.99 band from a stated or an estimated standard deviation; nothing.
    """

    place: Any
    speed: Any
    kind: Kind

    @property
    def decides(self) -> bool:
        """Whether verdicts may rely on the accuracy: true if stated, false if estimated."""
        return self.kind in ("bound", "sd")

    def __str__(self) -> str:
        if self.kind == "unknown":
            return "an accuracy that is not stated"
        word = {"bound": "bound", "sd": "0.99 band", "estimated": "estimated 0.99 band"}[self.kind]
        return f"positions to {np.nanmax(self.place):.3g}, velocities to {np.nanmax(self.speed):.3g} ({word})"


def band(samples: int, m: int) -> float:
    """Return the radius, in standard deviations, of a band that contains all samples with probability 0.99."""
    from scipy.stats import chi2

    return float(sqrt(chi2.isf((1.0 - CONFIDENCE) / samples, m)))


def ensure_error(name: str, value: Any, shape: tuple[int, int]) -> float | FloatArray | None:
    """Return a stated error: None, one number >= 0, or one for each sample of each agent, shape (T, n)."""
    if value is None:
        return None
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        array = np.array(np.nan)
    if array.ndim == 0:
        return ensure_nonnegative(name, value)
    if array.shape != shape or not (np.isfinite(array) & (array >= 0.0)).all():
        raise ArgumentError(
            f"{name} has shape {array.shape}: expected a finite number >= 0, or an array of them of {shape}"
        )
    array.setflags(write=False)
    return array
