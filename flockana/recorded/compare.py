"""Comparison of a recorded flock with a law: explained share, contributions of the law's parts, findings."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.laws.discrete import DiscreteLaw, ensure_law
from flockana.recorded.accelerations import accelerations, noisy_twins
from flockana.recorded.map_predictions import map_steps, noisy_map_twins
from flockana.recorded.one_step_predictions import scheme_by_law
from flockana.recorded.recording import Recording, ensure_recording
from flockana.recorded.regression_findings import Share, explained

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
    basis : {"accelerations", "steps", "map", "splines"}
        What is compared: recorded accelerations, mean accelerations from sample to sample, those of the steps of a map,
        or those of splines.
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
    def caution(self) -> str:
        """Effect of noise on the comparison, in words; empty if the accelerations are accurate enough."""
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
        """Largest residual accelerations, each as (time, agent, size)."""
        residual_norms = np.nan_to_num(lengths(self.residual))
        order = np.argsort(-residual_norms, axis=None)[:_WORST]
        worst_indices = [np.unravel_index(k, residual_norms.shape) for k in order]
        return tuple((float(self.t[k]), self.ids[i], float(residual_norms[k, i])) for k, i in worst_indices)

    def __str__(self) -> str:
        name = self.law.title
        lines = [f"{name} explains {share_text(self.explained)} of the recorded accelerations (from {self.basis})"]
        for share in self.shares:
            error_text = "" if share.error == 0.0 else f" ± {2.0 * share.error:.2g}"
            lines.append(
                f"  {_percent(share.share):>8}  {share.text}: {share.symbol} = {share.found:.4g}{error_text}, "
                f"{share.stated:.4g} in the law"
            )
        lines += [f"  finding: {text}" for text in self.findings]
        lines += [f"  caution: {self.caution}"] if self.caution else []
        t, agent, residual_norm = self.worst[0]
        lines.append(f"  off most by {residual_norm:.3g}, agent {agent} at t = {t:.4g}")
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """Return the comparison as a dictionary of plain data."""
        names = ("basis", "explained", "explained_refitted", "caution")
        return {
            "law": self.law.title,
            "shares": [share._asdict() for share in self.shares],
            "findings": list(self.findings),
            "worst": [{"time": t, "agent": agent, "size": residual_norm} for t, agent, residual_norm in self.worst],
        } | {name: getattr(self, name) for name in names}


def _percent(share: float) -> str:
    return f"{100.0 * share:.4g}%"


def share_text(explained: float) -> str:
    """Return the explained share of accelerations in per cent, or 'nothing' where the residual is larger.

    Examples
    --------
    >>> share_text(0.98765432), share_text(-4e7), share_text(1.0 - 1e-9)
    ('98.77%', 'nothing', '100%')
    """
    return _percent(explained) if explained > 0.0 else "nothing"


def compare(rec: Recording, law: Any) -> Comparison:
    """Return a comparison of a recording with a law.

    Recorded accelerations are compared if there are any; else the mean ones from sample to sample, if velocities were
    recorded, or those of a scheme that positions and velocities tell; else those of smoothing splines. Where noise is
    stated, the one of the two that is known better is compared; under strong noise `Comparison.caution` says so. A map,
    such as Vicsek's, is led on from each sample to the next, which must be whole steps of it apart.

    Parameters
    ----------
    rec : Recording
        The recording; the accuracy that it states gives the weights.
    law : Law, Scheme or DiscreteLaw
        The law; of a scheme, the law that it steps; or a map.

    Raises
    ------
    ArgumentError
        If the recording has gaps (except where splines carry them), or the law is not for such a flock; under a map if
        velocities are lacking, or the interval between samples is not its dt or a multiple.

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
    checked_law, states, scheme, notes = ensure_law(law), rec.measured, None, list[str]()
    checked_law.check_dimension(rec.m)
    checked_law.check_agents(rec.n)
    continuous = checked_law.continuous
    of_own = isinstance(checked_law, DiscreteLaw) and not checked_law.approximates and states.p is not None
    if continuous is None or of_own:
        data, steps, led, remark = map_steps(states, checked_law)
        result = explained(data, steps, noisy_map_twins(states, checked_law, steps))
        off = _position_finding(states, led, f"steps of {checked_law.title}")
        notes += [remark] if remark else []
        result = result._replace(findings=()) if remark else result  # what is left may be the noise
    else:
        data = accelerations(rec)
        result, off = explained(data, continuous, noisy_twins(rec, data, continuous)), ""
        scheme = data.scheme
        if scheme is None and data.basis == "steps" and result.left < 0.5 * result.total:
            scheme = scheme_by_law(rec, continuous)
        notes += [] if scheme is None else [f"steps are {scheme} of {rec.interval:.4g}"]
        if states.p is not None and len(rec.t) > 2:
            led = 0.5 * (states.p[1:] + states.p[:-1]) * np.diff(rec.t)[:, None, None]
            off = _position_finding(states, led, "velocities and times")
    by_law, refitted = (1.0 - left / (result.total or 1.0) for left in (result.left, result.left_refitted))
    texts, noise = (off,) if off else (*notes, *result.findings), float(np.nanmedian(data.error))
    return Comparison(
        law, data.basis, data.t, data.u, result.residual, by_law, refitted, result.shares, texts, noise, tuple(rec.ids)
    )


def _position_finding(rec: Recording, led: FloatArray, by: str) -> str:
    """Return a finding on the ratio of recorded to predicted displacements; empty if they agree.

    One agent, one axis or one stretch of time is named if it is off and all the rest agrees.
    """
    steps = np.diff(rec.q, axis=0)
    is_known = ~np.isnan(steps + led)

    def factor(part: Any) -> float | None:
        """Return the ratio of recorded to predicted displacements in a selection; 1 if near, None if undefined."""
        x, y = steps[is_known & part], led[is_known & part]
        if not (x @ x > 0.0 and y @ y > 0.0):
            return None
        ratio = float(x @ y / (y @ y))
        left = float(np.sum((x - ratio * y) ** 2) / (x @ x))
        is_right = abs(ratio - 1.0) <= max(_OFF_CLOCK, 3.0 * np.sqrt(left)) * max(1.0, abs(ratio))
        return 1.0 if is_right else ratio

    def agrees(part: Any) -> bool:
        """Return whether displacements in a selection are as predicted, up to a tenth of their squares."""
        x, y = steps[is_known & part], led[is_known & part]
        return bool(np.sum((x - y) ** 2) <= 0.1 * (x @ x) > 0.0)

    parts = [(f" of agent {name}", np.arange(rec.n)[:, None] == i) for i, name in enumerate(rec.ids)]
    parts += [(f" along {axis}", np.arange(rec.m) == i) for i, axis in enumerate("xyz"[: rec.m])]
    sizes = [np.sum(np.where(is_known, x, 0.0) ** 2, axis=(1, 2)) for x in (steps - led, steps)]
    off_rows = np.flatnonzero(sizes[0] > 0.25 * sizes[1])
    if 0 < len(off_rows) == np.ptp(off_rows) + 1:
        text = f" from t = {rec.t[off_rows[0]]:.4g} to {rec.t[off_rows[-1] + 1]:.4g}"
        parts.append((text, np.isin(np.arange(len(steps)), off_rows)[:, None, None]))
    for text, part in (*((text, part) for text, part in parts if agrees(~part)), ("", True)):
        ratio = factor(part)
        if ratio not in (None, 1.0):
            rest = "; all others agree" if text else ""
            return (
                f"positions{text} move by {ratio:.4g} times what {by} say: expected 1{rest}; mend units, times or "
                "speeds first, then compare terms"
            )
    return ""
