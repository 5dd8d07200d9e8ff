"""Comparison of a recorded flock with a law: what the law explains, contributions of its parts, findings."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.base.shown import ShortRepr
from flockana.base.vectors import lengths
from flockana.laws.discrete import ensure_law
from flockana.recorded.accelerations import accelerations
from flockana.recorded.findings import Share, explained
from flockana.recorded.recording import Recording, ensure_recording
from flockana.recorded.steps import scheme_by_law

_WORST = 5  # places that are named
_OFF_CLOCK = 0.05  # relative difference of steps from velocities, from which on it is reported
_ROUGH = 0.1  # of the recorded accelerations: noise beyond which shares and gains are only rough


@dataclass(frozen=True, eq=False)
class Comparison(ShortRepr):
    """Comparison of a recording with a law.

    Attributes
    ----------
    law : Law
        The law.
    basis : {"accelerations", "steps", "splines"}
        What is compared: recorded accelerations, mean accelerations from sample to sample, or those of splines.
    t : ndarray, shape (K,)
        Times.
    recorded, residual : ndarray, shape (K, n, m)
        Recorded accelerations, and these less the law's.
    explained : float
        1 - Σ‖residual‖²/Σ‖recorded‖², each weighted by its accuracy.
    explained_refitted : float
        The same with the law's gains as the recording has them.
    shares : tuple of Share
        The parts of the law.
    findings : tuple of str
        What differs, in words.
    noise : float
        Typical error of an acceleration, from the accuracy of the samples; 0 if none is stated. See `caution`.
    """

    law: Any
    basis: str
    t: FloatArray
    recorded: FloatArray
    residual: FloatArray
    explained: float
    explained_refitted: float
    shares: tuple[Share, ...]
    findings: tuple[str, ...] = ()
    noise: float = 0.0
    ids: tuple[str, ...] = field(default=(), repr=False)

    @property
    def share(self) -> str:
        """Explained share in words; a residual larger than the accelerations explains nothing."""
        return f"{self.explained:.4%}" if self.explained > 0.0 else "nothing"

    @property
    def share_of_own(self) -> str:
        """Explained share to a hundredth of a percent, with the law's own gains; "nothing" below 0."""
        return f"{self.explained:.2%}" if self.explained > 0.0 else "nothing"

    @property
    def caution(self) -> str:
        """Effect of noise on the comparison, in words; empty if the accelerations are known well enough."""
        usual = float(np.nanmedian(lengths(self.recorded)))  # the ends of splines can be far off
        if self.noise <= _ROUGH * usual:
            return ""
        return (
            f"accelerations (from {self.basis}) are known to {self.noise:.2g}, where their usual size is {usual:.2g}: "
            "shares and gains are rough; fit(recording, law) rests on positions"
        )

    @property
    def by_agent(self) -> FloatArray:
        """Root mean square of each agent's residual, shape (n,)."""
        return np.sqrt(np.nanmean(lengths(self.residual) ** 2, axis=0))

    @property
    def by_time(self) -> FloatArray:
        """Root mean square of the residual at each time, shape (K,)."""
        return np.sqrt(np.nanmean(lengths(self.residual) ** 2, axis=1))

    @property
    def worst(self) -> tuple[tuple[float, str, float], ...]:
        """Largest residuals: time, agent, size."""
        size = np.nan_to_num(lengths(self.residual))
        order = np.argsort(-size, axis=None)[:_WORST]
        at = [np.unravel_index(k, size.shape) for k in order]
        return tuple((float(self.t[k]), self.ids[i], float(size[k, i])) for k, i in at)

    def __str__(self) -> str:
        name = self.law.title
        lines = [f"{name} explains {self.share} of the recorded accelerations (from {self.basis})"]
        for one in self.shares:
            known = "" if one.error == 0.0 else f" ± {2.0 * one.error:.2g}"
            lines.append(
                f"  {one.share:8.2%}  {one.text}: {one.symbol} = {one.found:.5g}{known}, {one.stated:.5g} in the law"
            )
        lines += [f"  finding: {text}" for text in self.findings]
        lines += [f"  caution: {self.caution}"] if self.caution else []
        t, agent, size = self.worst[0]
        lines.append(f"  off most by {size:.3g}, agent {agent} at t = {t:.4g}")
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        kept = ("basis", "explained", "explained_refitted", "caution")
        return {
            "law": self.law.title,
            "shares": [one._asdict() for one in self.shares],
            "findings": list(self.findings),
            "worst": [{"time": t, "agent": agent, "size": size} for t, agent, size in self.worst],
        } | {name: getattr(self, name) for name in kept}


def compare(rec: Recording, law: Any) -> Comparison:
    """Return a comparison of a recording with a law.

    Recorded accelerations are compared if there are any; else the mean ones from sample to sample, if velocities were
    recorded, or those of a scheme that positions and velocities tell; else those of smoothing splines. Where noise is
    stated, the one of the two that is known better is compared; under strong noise `Comparison.caution` says so.

    Parameters
    ----------
    rec : Recording
        The recording; the accuracy that it states gives the weights.
    law : Law or Scheme
        The law; of a scheme, the law that it steps.

    Raises
    ------
    ArgumentError
        If the recording has gaps (except where splines carry them), or the law is not for such a flock.

    Examples
    --------
    >>> from flockana.dynamics.simulate import simulate
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.recorded.recording import recording_of
    >>> run = simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    >>> compare(recording_of(run), Algorithm1()).explained > 0.999999
    True
    """
    ensure_recording(rec)
    given = ensure_law(law)
    continuous = given.continuous
    if continuous is None:
        raise ArgumentError(f"{law.title} steps no continuous law: expected a law, or a scheme such as TaylorStep")
    continuous.check_dimension(rec.m)
    continuous.check_agents(rec.n)
    data = accelerations(rec)
    found = explained(data, continuous)
    scheme = data.scheme
    if scheme is None and data.basis == "steps" and found.left < 0.5 * found.total:
        scheme = scheme_by_law(rec, continuous)
    steps = () if scheme is None else (f"steps are {scheme} of {rec.interval:.6g}",)
    own, refitted = (1.0 - left / (found.total or 1.0) for left in (found.left, found.left_refitted))
    clock = _clock_finding(rec)
    texts, noise = (clock,) if clock else (*steps, *found.findings), float(np.nanmedian(data.error))
    return Comparison(
        law, data.basis, data.t, data.u, found.residual, own, refitted, found.shares, texts, noise, tuple(rec.ids)
    )


def _clock_finding(rec: Recording) -> str:
    """Return by which factor positions move otherwise than with velocities and clock; empty if they move with them."""
    if rec.p is None or rec.smoothed or len(rec.t) < 3:
        return ""
    moved = np.diff(rec.q, axis=0)
    led = 0.5 * (rec.p[1:] + rec.p[:-1]) * np.diff(rec.t)[:, None, None]
    known = ~np.isnan(moved + led)
    moved, led = moved[known], led[known]
    if not (moved @ moved > 0.0 and led @ led > 0.0):
        return ""
    factor = float(moved @ led / (led @ led))
    left = float(np.sum((moved - factor * led) ** 2) / (moved @ moved))
    if abs(factor - 1.0) <= max(_OFF_CLOCK, 3.0 * np.sqrt(left)) * max(1.0, abs(factor)):
        return ""
    return (
        f"positions move by {factor:.4g} times what velocities and times say: expected 1; mend units of times or "
        "velocities first, then compare terms"
    )
