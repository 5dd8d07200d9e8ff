"""Certificates that a quantity tends to a limit, each with a margin, and the claim that the best of them makes.

A claim about t → ∞ is verified only by a certificate, and inconclusive without one: no run is long enough to refute a
limit. (A theorem refutes its limit where something is certain for ever, as that two groups part.) There are two kinds:

* a state that is caught in the basin of a minimum (`flockana.theorems.basin`), which one instant shows, without a
  tolerance;
* `Decay`: a quantity that falls steadily, through several time constants, until it is below what counts as 0, and
  stays there. One instant never suffices: not the turning point of an oscillation, and no start from rest.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import e, inf, isnan, log
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.theorems.claims import judged
from flockana.theorems.theorem import Claim, Hypothesis

TIME_CONSTANTS = 5.0  # e-foldings: a factor 148
REBOUND = 3.0  # e-foldings: a factor 20, more than the noise of an integration that has come to rest varies by
_WINDOWS = 8  # into which the last part of the fall is divided
_LAST = (0.5, 0.25, 0.125)  # of the time until the fall ends: what came before it fell does not count
_UNEVEN = 4.0  # times the slowest window's pace: what a swing, or several modes, may make of a steady fall
_CUTS = 4  # levels down to which the fall is measured
_ROUNDING = 1e-12  # of a logarithm of two amplitudes, or a ratio of two energies
_LEAST = 1e-300  # below it an amplitude is 0


@dataclass(frozen=True)
class Certificate:
    """Evidence for a limit: it is certain if the margin is positive.

    Attributes
    ----------
    margin : float
        Between -1 and 1, so that how far one run exceeds what is asked does not count.
    text : str
        In words.
    error : float
        Rounding of the margin.
    """

    margin: float
    text: str
    error: float = _ROUNDING


@dataclass(frozen=True)
class Decay:
    """How steadily, how far and how late a series falls that should go to 0.

    Attributes
    ----------
    time_constants : float
        E-foldings over the last part of the fall, at most four times what its slowest eighth makes of them; negative
        where it rises there.
    depth : float
        E-foldings by which it ends below what counts as 0; negative while above.
    growth : float
        E-foldings by which it has risen again from its least.
    level : float
        Largest value in the last eighth of the time.

    Notes
    -----
    The envelope, the largest value in each of eight equal windows, is what falls: a mode that swings does not look
    like one that decays wherever the run is cut. A power (T - t)^k that happens to end at its zero T falls by k log 8,
    so that k > 2 would be needed to deceive; a turning point or the node of a beat has k = 1. A decay like t^(-k)
    falls by less than k log 2 over the last half. A constant, and what grows, do not fall. A plateau above the floor
    keeps `depth` negative; one below it counts as 0, which is what the floor is for: there an integration ends in its
    own noise, so the fall is measured down to several levels between the floor and that noise, and the best counts.
    """

    time_constants: float
    depth: float
    growth: float
    level: float

    @property
    def certificate(self) -> Certificate:
        """It fell through five time constants, ended below what counts as 0, and did not rise on the way."""
        margin = min(self.depth, self.time_constants - TIME_CONSTANTS, REBOUND - self.growth)  # all in e-foldings
        text = f"it falls steadily through {max(self.time_constants, 0.0):.2g} time constants"
        text += f", rises again by {self.growth:.2g}" if self.growth > 1.0 else ""
        below = f" and ends {'below' if self.depth > 0.0 else 'above'} what counts as 0"
        return Certificate(float(np.clip(margin, -1.0, 1.0)), text + below)


def decay(t: npt.ArrayLike, amplitude: npt.ArrayLike, *, floor: float) -> Decay:
    """How a series falls towards 0; one with a value that is not finite certifies nothing.

    Examples
    --------
    >>> t = np.linspace(0.0, 40.0, 400)
    >>> decay(t, np.exp(-t), floor=1e-6).certificate.margin > 0.0
    True
    >>> decay(t, np.abs(np.cos(t)), floor=1e-6).certificate.margin > 0.0
    False
    """
    times, values = np.asarray(t, dtype=np.float64), np.asarray(amplitude, dtype=np.float64)
    if not np.isfinite(values).all():
        return Decay(-inf, -inf, 0.0, float("nan"))
    values = np.maximum(values, _LEAST)
    start, end = float(times[0]), float(times[-1])
    level = float(np.nanmax(_envelope(times, values, end - (end - start) / _WINDOWS, end)))
    least = float(np.nanmin(_envelope(times, values, start, end)))
    cuts = np.geomspace(e * level, max(floor, e * level), _CUTS)
    fall = max(_fall(times, values, float(cut)) for cut in cuts)
    return Decay(fall, log(floor / level), max(0.0, log(level / least)), level)


def _fall(t: npt.NDArray[np.float64], values: npt.NDArray[np.float64], until: float) -> float:
    """E-foldings of the fall to a level, in windows of which none lags far behind, over the part that shows most."""
    above = np.flatnonzero(values > until)
    if above.size == 0:  # it was never seen to fall
        return 0.0
    start, end = float(t[0]), float(t[above[-1]])
    most = -inf
    for share in _LAST:
        windows = _envelope(t, values, end - share * (end - start), end)
        if np.isfinite(windows).all():
            falls = np.log(windows[:-1] / windows[1:])
            most = max(most, float(min(falls.sum(), _UNEVEN * falls.size * falls.min())))
    return most


def _envelope(
    t: npt.NDArray[np.float64], values: npt.NDArray[np.float64], start: float, end: float
) -> npt.NDArray[np.float64]:
    """The largest value in each of `_WINDOWS` equal windows; NaN in one that holds no sample."""
    edges = np.linspace(start, end, _WINDOWS + 1)
    largest = np.full(_WINDOWS, np.nan)
    for k in range(_WINDOWS):
        inside = values[(t >= edges[k]) & (t <= edges[k + 1])]
        if inside.size:
            largest[k] = inside.max()
    return largest


def limit_claim(
    name: str,
    needs: Iterable[Hypothesis],
    certificates: Iterable[Certificate],
    *,
    computed: Any,
    stated: str,
    witness: Any = None,
    proof: str | None = None,
    detail: str,
) -> Claim:
    """A claim about a limit, by its best certificate: verified, or open.

    Examples
    --------
    >>> limit_claim("i", [], [Certificate(-1.0, "it does not fall")], computed=1.0, stated="0", detail="x").status
    'inconclusive'
    """
    best = max(certificates, key=lambda certificate: -inf if isnan(certificate.margin) else certificate.margin)
    text = f"{detail}; {best.text}"
    return judged(
        name,
        best.margin,
        best.error,
        needs,
        refutes=False,
        computed=computed,
        stated=stated,
        witness=witness,
        proof=proof,
        detail=text,
    )
