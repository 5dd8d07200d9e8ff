"""Certificates of limits, and claims by the best of several certificates.

A claim about t → ∞ is verified by a certificate alone: a state in the basin of a strict minimum
(`flockana.theorems.energy_basins`), an exact solution, or a proof. It is refuted by an escape: something that is
certain at all later times, such as two groups that part. A run that decays is evidence, which the text tells, and
decides nothing.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from math import isnan
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.theorems.claims import conclude
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.theorem import Claim, Hypothesis, Needs, Status

_ROUNDING = 1e-12  # of a ratio of two energies
_LAST = 8  # the last eighth of a run is its end
_LEAST = 1e-300  # below it an amplitude is 0


@dataclass(frozen=True)
class Certificate:
    """Evidence for a limit as t → ∞, certain if the margin exceeds its error."""

    margin: float  # Between -1 and 1
    text: str  # In words
    error: float = _ROUNDING  # Rounding of the margin

    @property
    def certain(self) -> bool:
        """Whether the certificate's margin exceeds its error."""
        return self.margin > self.error


def best_of(certificates: Iterable[Certificate]) -> Certificate:
    """Return the certificate with the largest margin less error; an undecided one if there is none."""
    certificates_given = [each for each in certificates if not isnan(each.margin)]
    return max(certificates_given, key=lambda each: each.margin - each.error, default=Certificate(-1.0, ""))


def evidence(t: npt.ArrayLike, amplitude: npt.ArrayLike, name: str) -> str:
    """Return in words how far an amplitude decays from its maximum to the last eighth of a run."""
    times, values = np.asarray(t, dtype=np.float64), np.maximum(np.asarray(amplitude, dtype=np.float64), _LEAST)
    late_maximum = values[times >= times[-1] - (times[-1] - times[0]) / _LAST].max()
    factor = float(values.max() / late_maximum)
    return f"in this run {name} falls by a factor of {factor:.2g}" if factor > 2.0 else f"{name} does not fall"


def limit_claim(
    name: str,
    needs: Needs,
    certificates: Iterable[Certificate] = (),
    *,
    escape: Certificate | None = None,
    proof: str | None = None,
    evidence: str = "",
    detail: str = "",
    **fields: Any,
) -> Claim:
    """Return a claim about a limit: verified by a certificate or a proof, refuted by an escape, else inconclusive."""
    best_certificate = best_of(certificates)
    numeric_status: Status = "verified" if best_certificate.certain else "inconclusive"
    margin = Enclosure.around(best_certificate.margin, best_certificate.error)
    if escape is not None and escape.certain:
        best_certificate, numeric_status, margin = escape, "refuted", Enclosure.around(-escape.margin, escape.error)
    claim = conclude(name, numeric_status, margin, needs, about="limit", proof=proof, **fields)
    proved = claim.status == "verified" and not best_certificate.certain
    if proved:  # no number of this run says how far it holds
        detail = "; ".join(filter(None, (detail, "proved for every start")))
        return replace(claim, margin=None, error=None, detail=detail)
    parts = (detail, best_certificate.text, "" if best_certificate.certain else evidence)
    return replace(claim, detail="; ".join(filter(None, parts)))


def decays_to_zero(
    seen: Any,
    name: str,
    needs: Needs,
    certificates: Iterable[Certificate] = (),
    *,
    series: Any,
    what: str,
    of: str = "",
    start: str = "",
    **fields: Any,
) -> Claim:
    """Return the claim that a series of a run tends to 0, with symbol `of` and name `start` of its first value."""
    t = seen.t
    text = evidence(t, series, of) if of else ""
    return limit_claim(name, needs, certificates, evidence=text, **fields).described(
        computed=float(series[-1]),
        witness={"time": float(t[-1])} | ({start: float(series[0])} if start else {}),
        detail=f"{what} goes from {series[0]:.3g} to {series[-1]:.3g} at t = {t[-1]:g}",
    )


def without_assumed(needs: Needs, make: Callable[[list[Hypothesis]], Claim]) -> Claim:
    """Return a claim under met hypotheses alone if certified so, else under all hypotheses.

    A certificate of the limit itself does not rest on what is only assumed; a refutation would.
    """
    needs = list(needs)
    sure_claim = make([requirement for requirement in needs if requirement.status != "assumed"])
    return sure_claim if sure_claim.status == "verified" else make(needs)
