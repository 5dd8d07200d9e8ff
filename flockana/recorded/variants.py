"""Forms of Algorithms 1 to 3 that implementations have in place of the paper's, to be tried on a recording."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.vectors import lengths
from flockana.interactions import AlphaInteraction
from flockana.measures.nets import links
from flockana.recorded.contributions import Part


@dataclass(frozen=True)
class Variant:
    """Alternative form of a part of a law, and the finding that it stands for."""

    gain: str
    finding: str
    acts: Part


def variants(law: Any) -> tuple[Variant, ...]:
    """Return the forms to try in place of a law's own."""
    if not hasattr(law, "gains"):
        return ()
    alpha = getattr(law, "alpha", None)
    of_pairs = _of_pairs(alpha) if isinstance(alpha, AlphaInteraction) else []
    return (*of_pairs, *(() if law.target is None else _of_pull(law)))


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
    alike = "all neighbours within r count alike in the consensus, not by a_ij"
    return [
        Variant("c1_alpha", f"{direction}, not of the vector, x/√(1 + ε‖x‖²)", _pair_sum(alpha.r, per_axis)),
        Variant("c1_alpha", "φ_α is given the distance, not its σ-norm", _pair_sum(farthest, euclidean)),
        Variant("c1_alpha", "n_ij is the unit vector x/‖x‖, not x/√(1 + ε‖x‖²)", _pair_sum(alpha.r, unit)),
        Variant("c2_alpha", alike, _pair_sum(alpha.r, lambda x, s, v: v * (s < alpha.r)[:, None])),
    ]


def _pair_sum(r: float, force: Callable[[FloatArray, FloatArray, FloatArray], FloatArray]) -> Part:
    """Sum over pairs within r of a force that is odd in the pair."""

    def acts(t: float, q: FloatArray, p: FloatArray) -> FloatArray:
        i, j = np.asarray(links(q, r)).T
        x = q[j] - q[i]
        given = force(x, lengths(x), p[j] - p[i])
        u = np.zeros_like(q)
        np.add.at(u, i, given)
        np.add.at(u, j, -given)
        return u

    return acts


def _of_pull(law: Any) -> list[Variant]:
    unit = getattr(law.pair, "unit", 1.0)

    def pull(bend: Callable[[FloatArray], FloatArray]) -> Part:
        def acts(t: float, q: FloatArray, p: FloatArray) -> FloatArray:
            x = q - law.target.state(t)[0]
            return -x / bend(x / unit)

        return acts

    bounded = any(getattr(term, "target", None) is law.target and getattr(term, "unit", None) for term in law.terms)
    text, whole = "the pull to the γ-agent is", "'s" if bounded else ""
    per_axis = f"{text} proportional to each coordinate's σ₁, not to the vector{whole}"
    other = Variant("c1_gamma", f"{text} linear, not bounded by σ₁", pull(np.ones_like))
    if not bounded:
        bend = pull(lambda x: np.sqrt(1.0 + np.sum(x**2, axis=1))[:, None])
        other = Variant("c1_gamma", f"{text} bounded by σ₁ of the vector, not linear", bend)
    return [Variant("c1_gamma", per_axis, pull(lambda x: np.sqrt(1.0 + x**2))), other]
