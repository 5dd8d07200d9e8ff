"""Pavone and Frazzoli (2007): agents in cyclic pursuit meet, circle or spread, by the offset angle."""

from math import pi, sin

import numpy as np

from flockana.certified.balls import exact
from flockana.sources.pavone_frazzoli_2007.laws import CyclicPursuit
from flockana.theorems.claims import judged, run_theorem
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Needs, Tolerances
from flockana.theorems.theorem_toolkit import EPS, Enclosure, Observed, condition, law_is, limit_claim, positive_room

_PROOF = "cyclic-pursuit"


def _growing_part(seen: Observed) -> Hypothesis:
    """Return the hypothesis that the start excites a growing mode."""
    law, n = seen.law, seen.n
    angles = [(exact(law.angle) * n + 180 * j) / n for j in range(1, n)]  # degrees: those of which the sine is < 0 grow
    growing_modes = [j for j, angle in enumerate(angles, 1) if 180 < angle < 360 or angle < 0]
    z = seen.run.q[0] @ np.array([1.0, 1j])
    parts = np.abs(np.fft.fft(z - z.mean())[growing_modes]) / n
    part, magnitude = float(parts.max(initial=0.0)), float(np.abs(z).max())
    margin = Enclosure.around(part, 8.0 * n * EPS * magnitude)
    return positive_room(
        "the start has a part in a mode that grows", margin, f"the largest is {part:.6g}", remedy="move one agent"
    )


def _motion(seen: Observed, tolerances: Tolerances) -> list[Claim]:
    """Return the claims that the centroid is fixed, and that the motion is the sum of the start's modes."""
    law: CyclicPursuit = seen.law
    z = seen.run.q @ np.array([1.0, 1j])
    motion = np.fft.ifft(np.fft.fft(z[0] - z[0].mean()) * np.exp(np.outer(seen.t - seen.t[0], law.eigenvalues(seen.n))))
    magnitude = float(max(np.abs(motion).max(), np.abs(z[0] - z[0].mean()).max())) or 1.0
    rounding = 64.0 * seen.n * EPS * float(np.abs(z).max() + law.gain * (seen.t[-1] - seen.t[0]) * magnitude)
    deviations = {
        "centroid": Enclosure.around(np.abs(z.mean(axis=1) - z[0].mean()), seen.centre_error + rounding),
        "motion": Enclosure.around(
            np.abs(z - z.mean(axis=1, keepdims=True) - motion).max(axis=1), seen.shape_error.max(axis=1) + rounding
        ),
    }
    stated_texts = {"centroid": "the centroid stays", "motion": "the motion is Σ_j c_j e^{λ_j t} v_j, c of the start"}
    claims = []
    for name, series in deviations.items():
        share = series.clip(0.0) / magnitude
        k = int(share.mid.argmax())
        claims.append(
            judged(name, tolerances.energy - share, proof=_PROOF, computed=float(share.mid[k])).described(
                stated=f"{stated_texts[name]}, to {tolerances.energy:g} of the size",
                witness={"time": float(seen.t[k])},
                detail=f"off by {share.mid[k]:.2g} of the size at most",
            )
        )
    return claims


def _limit(name: str, seen: Observed, needs: Needs, stated: str) -> Claim:
    end = float(seen.radius.mid[-1])
    return limit_claim(name, needs, proof=_PROOF).described(
        computed=end, stated=stated, detail=f"R goes from {seen.radius.mid[0]:.6g} to {end:.6g}"
    )


@run_theorem(
    "cyclic-pursuit",
    title="Cyclic pursuit with an offset angle: agents meet below 180°/n, circle at it, spread beyond",
    source="Pavone and Frazzoli 2007, in our words",
    law=law_is("cyclic pursuit", CyclicPursuit),
    claims=("centroid", "motion", "meet", "circle", "spread"),
    ours=("motion",),
    references=("pavone-frazzoli-2007", "flockana"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let n >= 2 agents in the plane move by q_i' = k R(θ)(q_{i+1} - q_i), k > 0, the last one pursuing the first. The
    centroid never moves, and the poles are λ_j = k e^{iθ}(e^{2πij/n} - 1), Re λ_j = -2k sin(πj/n) sin(θ + πj/n), and
    their conjugates. If |θ| < π/n all meet at the centroid; if |θ| = π/n they tend to one circle about it, evenly
    spaced, at the angular speed 2k sin(π/n); if |θ| is more (up to π), distances from the centroid grow without bound
    from every start that has a part in a mode that grows.
    """
    law: CyclicPursuit = seen.law
    critical, angle = 180.0 / seen.n, abs(law.angle)
    slack, text = 180 - abs(exact(law.angle)) * seen.n, f"|θ| = {angle:.9g}°, 180°/n = {critical:.9g}°"
    margin = float(slack.p) / float(slack.q) / seen.n
    below = condition("|θ| < π/n", bool(slack > 0), margin, text, remedy="turn the lines of sight less")
    at = condition("|θ| = π/n", bool(slack == 0), -abs(margin), text, remedy=f"choose the angle {critical:.9g}")
    beyond = [condition("|θ| > π/n", bool(slack < 0), -margin, text, remedy="turn the lines of sight more")]
    if slack < 0:
        beyond.append(_growing_part(seen))
    z = seen.run.q[0] @ np.array([1.0, 1j])
    circling = float(np.abs(np.fft.fft(z)[seen.n - 1 if law.angle > 0.0 else 1]) / seen.n)
    turning = f"agents tend to a circle of radius {circling:.6g}, at {2.0 * law.gain * sin(pi / seen.n):.6g} per time"
    return [], [
        *_motion(seen, tolerances),
        _limit("meet", seen, [below], "all agents tend to the centroid"),
        _limit("circle", seen, [at], turning),
        _limit("spread", seen, beyond, "distances from the centroid grow without bound"),
    ]
