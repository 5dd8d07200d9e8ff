"""Parts of a law that are proportional to one number each: what each of them contributes to an acceleration."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.interactions import Gains

Part = Callable[[float, FloatArray, FloatArray], FloatArray]

SYMBOLS = {
    "c1_alpha": ("c1α", "pair force"),
    "c2_alpha": ("c2α", "velocity consensus"),
    "c1_beta": ("c1β", "repulsion of obstacles"),
    "c2_beta": ("c2β", "damping at obstacles"),
    "c1_gamma": ("c1γ", "pull to the γ-agent"),
    "c2_gamma": ("c2γ", "velocity feedback to the γ-agent"),
}
_NO_OTHERS = {"thrust": 0.0, "brake": 0.0, "feedforward": False}


@dataclass(frozen=True)
class Contribution:
    """Part of a law: its gain, name, value, and its acceleration for a gain of 1."""

    name: str
    symbol: str
    text: str
    stated: float
    acts: Part


def contributions(law: Any) -> tuple[Contribution, ...]:
    """Return the parts of a law: one for each gain, or the law as a whole."""
    gains = getattr(law, "gains", None)
    if not isinstance(gains, Gains):
        return (Contribution("law", type(law).__name__, "the law as a whole", 1.0, _acts(law)),)
    parts, gained = [], replace(law, **_other_terms(law))
    for name in _used_gains(law):
        (symbol, text), own = SYMBOLS[name], getattr(gains, name)
        each = isinstance(own, tuple)
        acts = _acts(replace(gained, gains=_single_gain(name, own if each else 1.0)))
        label, stated = (f"{symbol} of each agent, times", 1.0) if each else (symbol, float(own))
        parts.append(Contribution(name, label, text, stated, acts))
    return tuple(parts)


def remainder(law: Any) -> Part | None:
    """Return the acceleration of a law with all gains 0, such as drag or a feedforward; None if it is 0."""
    if not isinstance(getattr(law, "gains", None), Gains) or not _other_terms(law):
        return None
    return _acts(replace(law, gains=_single_gain("", 0.0)))


def _other_terms(law: Any) -> dict[str, Any]:
    """Return the values at which the accelerations of a law that no gain scales vanish, by their fields."""
    return {name: none for name, none in _NO_OTHERS.items() if getattr(law, name, none)}


def _used_gains(law: Any) -> list[str]:
    paired = law.pair is not None
    used = {"c1_alpha": paired, "c2_alpha": paired or getattr(law, "net", None) is not None}
    used |= dict.fromkeys(("c1_beta", "c2_beta"), bool(law.obstacles))
    used |= dict.fromkeys(("c1_gamma", "c2_gamma"), law.target is not None)
    return [name for name, is_used in used.items() if is_used]


def _single_gain(name: str, value: Any) -> Gains:
    return Gains(**{each: value if each == name else 0.0 for each in SYMBOLS})


def _acts(law: Any) -> Part:
    return lambda t, q, p: law.flow(t, q, p)[0]


def over_samples(part: Part, t: FloatArray, q: FloatArray, p: FloatArray) -> FloatArray:
    """Return the acceleration of a part at each sample, shape (T, n, m)."""
    return np.array([part(float(t[k]), q[k], p[k]) for k in range(len(t))]).reshape(q.shape)


def over_steps(part: Part, t: FloatArray, q: FloatArray, p: FloatArray) -> FloatArray:
    """Return the mean acceleration of a part from each sample to the next by Simpson's rule, shape (T - 1, n, m)."""
    h = np.diff(t)[:, None, None]
    middle_q = 0.5 * (q[:-1] + q[1:]) + h / 8.0 * (p[:-1] - p[1:])  # cubic through both ends
    middle_p = 1.5 / h * (q[1:] - q[:-1]) - 0.25 * (p[:-1] + p[1:])
    ends, middle = over_samples(part, t, q, p), over_samples(part, 0.5 * (t[:-1] + t[1:]), middle_q, middle_p)
    return (ends[:-1] + 4.0 * middle + ends[1:]) / 6.0
