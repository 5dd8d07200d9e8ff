"""Parts of a law that are linear in a gain, and alternative forms found in implementations."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.interactions import AlphaInteraction, Gains
from flockana.measures.nets import links

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
    """Part of a law: the name, symbol and stated value of its gain, and its acceleration for a gain of 1."""

    name: str
    symbol: str
    text: str
    stated: float
    acts: Part


def contributions(law: Any) -> tuple[Contribution, ...]:
    """Return the parts of a law, one for each gain, or the law as a whole."""
    gains = getattr(law, "gains", None)
    if not isinstance(gains, Gains):
        return (Contribution("law", law.title, "the law as a whole", 1.0, _acts(law)),)
    parts, gains_law = [], replace(law, **_other_terms(law))
    for name in _used_gains(law):
        (symbol, text), gain = SYMBOLS[name], getattr(gains, name)
        is_tuple = isinstance(gain, tuple)
        gain_action = _acts(replace(gains_law, gains=_single_gain(name, gain if is_tuple else 1.0)))
        label, stated_value = (f"{symbol} of each agent, times", 1.0) if is_tuple else (symbol, float(gain))
        parts.append(Contribution(name, label, text, stated_value, gain_action))
    return tuple(parts)


def remainder(law: Any) -> Part | None:
    """Return the acceleration of a law with all gains 0, such as drag or feedforward; None if zero."""
    if not isinstance(getattr(law, "gains", None), Gains) or not _other_terms(law):
        return None
    return _acts(replace(law, gains=_single_gain("", 0.0)))


def _other_terms(law: Any) -> dict[str, Any]:
    """Return the field values that switch off the parts of a law without a gain."""
    return {name: off_value for name, off_value in _NO_OTHERS.items() if getattr(law, name, off_value)}


def _used_gains(law: Any) -> list[str]:
    has_pairs = law.pair is not None
    is_used_gain = {"c1_alpha": has_pairs, "c2_alpha": has_pairs or getattr(law, "net", None) is not None}
    is_used_gain |= dict.fromkeys(("c1_beta", "c2_beta"), bool(law.obstacles))
    is_used_gain |= dict.fromkeys(("c1_gamma", "c2_gamma"), law.target is not None)
    return [name for name, is_used in is_used_gain.items() if is_used]


def _single_gain(name: str, value: Any) -> Gains:
    return Gains(**{symbol: value if symbol == name else 0.0 for symbol in SYMBOLS})


def _acts(law: Any) -> Part:
    return lambda t, q, p: law.flow(t, q, p)[0]


def over_samples(part: Part, t: FloatArray, q: FloatArray, p: FloatArray) -> FloatArray:
    """Return the acceleration by a part of a law at each recorded sample, shape (T, n, m)."""
    return np.array([part(float(t[k]), q[k], p[k]) for k in range(len(t))]).reshape(q.shape)


def over_steps(part: Part, t: FloatArray, q: FloatArray, p: FloatArray) -> FloatArray:
    """Return the mean acceleration by a part of a law between samples by Simpson's rule, shape (T - 1, n, m)."""
    h = np.diff(t)[:, None, None]
    middle_q = 0.5 * (q[:-1] + q[1:]) + h / 8.0 * (p[:-1] - p[1:])  # cubic through both ends
    middle_velocities = 1.5 / h * (q[1:] - q[:-1]) - 0.25 * (p[:-1] + p[1:])
    ends, middle = over_samples(part, t, q, p), over_samples(part, 0.5 * (t[:-1] + t[1:]), middle_q, middle_velocities)
    return (ends[:-1] + 4.0 * middle + ends[1:]) / 6.0


@dataclass(frozen=True)
class Variant:
    """Alternative form of a part of a law, with the finding it would indicate."""

    gain: str
    finding: str
    acts: Part


def variants(law: Any) -> tuple[Variant, ...]:
    """Return alternative forms of a law's parts."""
    if not hasattr(law, "gains"):
        return ()
    alpha = getattr(law, "alpha", None)
    pair_variants = _of_pairs(alpha) if isinstance(alpha, AlphaInteraction) else []
    return (*pair_variants, *(() if law.target is None else _of_pull(law)))


def _of_pairs(alpha: AlphaInteraction) -> list[Variant]:
    def action(s: FloatArray) -> FloatArray:
        return np.asarray(alpha.phi_alpha(alpha.sigma_norm(s)))[:, None]

    def per_axis(x: FloatArray, s: FloatArray, v: FloatArray) -> FloatArray:
        return action(s) * x / np.sqrt(1.0 + alpha.eps * x**2)

    def euclidean(x: FloatArray, s: FloatArray, v: FloatArray) -> FloatArray:
        force: FloatArray = np.asarray(alpha.phi_alpha(s)) * (s < alpha.r_alpha)
        return force[:, None] * x / np.sqrt(1.0 + alpha.eps * s**2)[:, None]

    def unit(x: FloatArray, s: FloatArray, v: FloatArray) -> FloatArray:
        return action(s) * x / np.maximum(s, 1e-300)[:, None]

    direction = "the pair force's direction n_ij is taken coordinate by coordinate, x_k/√(1 + ε x_k²)"
    farthest = max(alpha.r, alpha.r_alpha)
    equal_weights_text = "all neighbours within r count alike in the consensus, not by a_ij"
    return [
        Variant("c1_alpha", f"{direction}, not of the vector, x/√(1 + ε‖x‖²)", _pair_sum(alpha.r, per_axis)),
        Variant("c1_alpha", "φ_α is given the distance, not its σ-norm", _pair_sum(farthest, euclidean)),
        Variant("c1_alpha", "n_ij is the unit vector x/‖x‖, not x/√(1 + ε‖x‖²)", _pair_sum(alpha.r, unit)),
        Variant("c2_alpha", equal_weights_text, _pair_sum(alpha.r, lambda x, s, v: v * (s < alpha.r)[:, None])),
    ]


def _pair_sum(r: float, force: Callable[[FloatArray, FloatArray, FloatArray], FloatArray]) -> Part:
    """Return the acceleration function that sums pair forces, opposite on both agents, within distance r."""

    def acts(t: float, q: FloatArray, p: FloatArray) -> FloatArray:
        i, j = np.asarray(links(q, r)).T
        x = q[j] - q[i]
        forces = force(x, lengths(x), p[j] - p[i])
        u = np.zeros_like(q)
        np.add.at(u, i, forces)
        np.add.at(u, j, -forces)
        return u

    return acts


def _of_pull(law: Any) -> list[Variant]:
    unit = getattr(law.pair, "unit", 1.0)

    def pull(bend: Callable[[FloatArray], FloatArray]) -> Part:
        def acts(t: float, q: FloatArray, p: FloatArray) -> FloatArray:
            x = q - law.target.state(t)[0]
            return -x / bend(x / unit)

        return acts

    is_bounded = any(getattr(term, "target", None) is law.target and getattr(term, "unit", None) for term in law.terms)
    text, possessive = "the pull to the γ-agent is", "'s" if is_bounded else ""
    axis_text = f"{text} proportional to each coordinate's σ₁, not to the vector{possessive}"
    variant = Variant("c1_gamma", f"{text} linear, not bounded by σ₁", pull(np.ones_like))
    if not is_bounded:
        bend = pull(lambda x: np.sqrt(1.0 + np.sum(x**2, axis=1))[:, None])
        variant = Variant("c1_gamma", f"{text} bounded by σ₁ of the vector, not linear", bend)
    return [Variant("c1_gamma", axis_text, pull(lambda x: np.sqrt(1.0 + x**2))), variant]
