"""Carrillo, Choi, Mucha and Peszek (2017): contact of agents under a singular alignment weight."""

import numpy as np

from flockana.sources.carrillo_2017.laws import SingularAlignment
from flockana.theorems.claims import judged, run_theorem, vacuous
from flockana.theorems.collisions import least_distance
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Needs, Tolerances, unmet
from flockana.theorems.theorem_toolkit import EPS, Enclosure, Observed, condition, law_is, positive_room

_LAW = law_is("alignment with a singular weight", SingularAlignment)
_PAIR = "singular-pair"
_CONTACT = 1e-3  # of the time of a contact, which steps approach: so much later a run may end


@run_theorem(
    "singular-alignment",
    title="Under a singular alignment weight no two agents meet from any start, exactly if α >= 1",
    source="Carrillo, Choi, Mucha and Peszek 2017, in our words; some-start ours",
    law=_LAW,
    claims=("apart", "some-start"),
    ours=("some-start",),
    references=("carrillo-2017", "flockana"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let u_i = Σ_j K (ℓ/s_ij)^α (p_j - p_i) from distinct positions. If α >= 1, no two agents ever meet. If 0 < α < 1,
    two of any number of agents meet from some distinct start.
    """
    alpha = seen.law.weight.decay
    strong_claim = condition("α >= 1", alpha >= 1.0, alpha - 1.0, f"α = {alpha:g}", remedy="raise α to 1")
    weak = condition("α < 1", alpha < 1.0, 1.0 - alpha, f"α = {alpha:g}")
    count_claim = condition("two agents or more", seen.n > 1, detail=f"n = {seen.n}")
    margin = least_distance(seen) if seen.n > 1 else Enclosure.of(np.inf)
    separation_claim = judged("apart", margin, [strong_claim], proof="singular-alignment").described(
        computed=float(margin.mid), stated="no two agents ever meet", detail=f"the least distance is {margin.mid:.6g}"
    )
    some_claim = judged(
        "some-start", Enclosure.of(0.0), [weak, count_claim], about="all", proof="singular-alignment"
    ).described(stated="from some distinct start two agents meet")
    return [count_claim], [separation_claim, vacuous("some-start", weak) if weak.status == "unmet" else some_claim]


def _duration(excess: float, factor: float, alpha: float, x: float) -> float:
    """Return the contact time ∫ ds/(excess + factor s^(1−α)) over (0, x), with y = s^(1−α)."""
    from scipy.integrate import quad

    rest = 1.0 - alpha
    return quad(lambda y: y ** (alpha / rest) / (rest * (excess + factor * y)), 0.0, x**rest)[0]


def _exact_sign(w: float, factor: tuple[float, float, float], x: float) -> int | None:
    """Return the exact sign of w + 2K ℓ^α x^(1−α)/(1−α), floats taken as rationals; None if unknown."""
    import sympy as sp

    strength, length, alpha, start, speed = map(sp.Rational, (*factor, x, w))
    value = speed + 2 * strength * length**alpha * start ** (1 - alpha) / (1 - alpha)
    return 0 if value.is_zero else 1 if value.is_positive else -1 if value.is_negative else None


def _sides(seen: Observed, x: float, w: float, integral: float) -> tuple[Hypothesis, Hypothesis]:
    """Return the hypotheses that a pair is fast enough for contact, w <= -integral, and that it is slower."""
    weight, error = seen.law.weight, 16.0 * EPS * (abs(w) + integral)
    margin_enclosure, text = Enclosure.around(w + integral, error), f"w(0) = {w:.6g}, the integral {integral:.6g}"
    name = "w(0) > -∫2a from 0 to x(0)"
    slower_claim = positive_room(name, margin_enclosure, text, remedy="start slower or farther apart")
    if slower_claim.status == "assumed":
        sign = _exact_sign(w, (weight.strength, weight.length, weight.decay), x)
        if sign is not None:
            slower_claim = condition(name, sign > 0, w + integral, f"{text}, decided exactly")
    opposite = {"met": "unmet", "unmet": "met", "assumed": "assumed"}[slower_claim.status]
    return Hypothesis(f"not: {name}", opposite, detail=slower_claim.detail), slower_claim  # type: ignore[arg-type]


@run_theorem(
    _PAIR,
    title="For α < 1 two agents on a line meet exactly if they approach at no less than an integral of the weight",
    source="Ours, on Ahn, Choi, Ha and Lee 2012",
    law=_LAW,
    claims=("meet", "apart"),
    references=("ahn-2012", "carrillo-2017", "flockana"),
    author="flockana",
)
def pair(seen: Observed, tolerances: Tolerances) -> Checked:
    """Of two agents on a line, x > 0 apart, x' = w, under u_i = Σ_j a (p_j - p_i), a(s) = K (ℓ/s)^α, 0 < α < 1, the sum
    w + 2K ℓ^α x^(1-α)/(1-α) never changes. They meet, in a finite time, exactly if w(0) <= -2K ℓ^α x(0)^(1-α)/(1-α), at
    the relative speed by which -w(0) exceeds it; else x stays between x(0) and a limit > 0. For α = ½, K = ℓ = x(0) = 1
    they meet if w(0) <= -4.
    """
    weight, start = seen.law.weight, (seen.given.q[0], seen.given.p[0])
    needs = [
        condition("two agents on a line", (seen.n, seen.m) == (2, 1), detail=f"n = {seen.n}, m = {seen.m}"),
        condition("α < 1", weight.decay < 1.0, 1.0 - weight.decay, f"α = {weight.decay:g}"),
    ]
    if unmet(needs):
        return needs, []
    x, w = (float(series[1, 0] - series[0, 0]) for series in start)
    x, w = abs(x), w if x > 0.0 else -w
    rest = 1.0 - weight.decay
    factor = 2.0 * weight.strength * weight.length**weight.decay / rest
    integral = factor * x**rest
    fast, slower_claim = _sides(seen, x, w, integral)
    return needs, [
        vacuous("meet", fast) if fast.status == "unmet" else _meet(seen, [*needs, fast], x, -w - integral, factor),
        vacuous("apart", slower_claim)
        if slower_claim.status == "unmet"
        else _apart(seen, [*needs, slower_claim], x, (w + integral) / factor),
    ]


def _meet(seen: Observed, needs: Needs, x: float, excess: float, factor: float) -> Claim:
    excess = max(excess, 0.0)
    time = float(seen.t[0]) + _duration(excess, factor, seen.law.weight.decay, x)
    left = Enclosure.around(time - float(seen.t[-1]), _CONTACT * time)
    return judged("meet", left, needs, about="all", proof=_PAIR, computed=float(seen.t[-1])).described(
        stated=f"they meet at t = {time:.6g}, at a relative speed of {excess:.6g}",
        witness={"pair": (0, 1), "time": time},
        detail=f"the run ends at t = {seen.t[-1]:.6g}",
    )


def _apart(seen: Observed, needs: Needs, x: float, level: float) -> Claim:
    """Return the claim that a pair's distance stays at least min(x(0), x_∞), where x_∞^(1−α) = level."""
    limit = max(level, 0.0) ** (1.0 / (1.0 - seen.law.weight.decay))
    distance, end = least_distance(seen), float(np.ptp(seen.run.q[-1]))
    margin = distance / min(x, limit) - 1.0 if limit > 0.0 else distance
    return judged("apart", margin, needs, proof=_PAIR, computed=float(distance.mid)).described(
        stated=f"x never is below {min(x, limit):.6g}, and tends to {limit:.6g}",
        witness={"time": float(seen.t[-1])},
        detail=f"the least distance is {distance.mid:.6g}, the last {end:.6g}",
    )
