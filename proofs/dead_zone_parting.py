"""L4: when a pair of the dead-zone law that is in range parts for ever, for all of its parameters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import sympy as sp
import z3
from flint import arb, ctx

from flockana.certified.decimal_rounding import interval
from flockana.sources.li_dead_zone.symbolic import K_1, K_2, K_DELTA, K_R, R_D, R, attraction, direction, jumps
from proofs.dead_zone_pairs import DIGITS, defaults, root, terms
from proofs.evaluate import enclosed
from proofs.proof import Step
from proofs.smt import implication, lemma, real

FROM, LEAVING, KEPT = 14, 12, 9  # m, m/s: a pair that leaves so fast, by default, keeps so much


def separation_steps() -> Iterator[Step]:
    """L4: when a pair in range parts for ever, for all parameters."""
    near, far = terms("s"), terms("r")
    (s, w_s), (r, w_r) = (list(one.values())[:2] for one in (near, far))
    kr, kd, k1, pole = (near[symbol] for symbol in (K_R, K_DELTA, K_1, R_D))
    turn = lemma("ρ/√(1 + ηρ²) rises", s / w_s <= r / w_r, *root("s"), *root("r"), s <= r)
    yield turn.step
    pull_s, pull_r = real(attraction(), near), real(attraction(), far)
    grows = lemma(
        "2k_r/(r_d - ρ)² + k_δ rises below r_d, and is not negative",
        z3.And(pull_s <= pull_r, pull_s >= 0),
        *(s > 0, s <= r, r < pole, kr > 0, kd >= 0),
        latex=sp.latex(attraction()),
    )
    yield grows.step
    theta, f, p, n, p_r, n_r = z3.Reals("θ F P N P_r N_r")
    capped = lemma(
        "so F <= F_max on (0, r): within r, F is k₁ρ and what repels, nothing, or θ times the attraction, θ <= 1",
        f <= p_r * n_r + k1 * r,
        *(
            theta >= 0,
            theta <= 1,
            p >= 0,
            p <= p_r,
            n >= 0,
            n <= n_r,
            k1 >= 0,
            s >= 0,
            s <= r,
            f <= theta * p * n + k1 * s,
        ),
        latex=r"F(\rho) \le F_{\max} = \frac{(2k_r/(r_d - r)^2 + k_\delta)\, r}{\sqrt{1 + \eta r^2}} + k_1 r",
    )
    yield capped.step
    most = jumps()["r"][0]
    yield Step(
        "F_max is the library's F just below r, of d₂ < r; with d₂ >= r it is less, k₁r",
        sp.simplify(most - (attraction(R) * direction(R) + K_1 * R)) == 0,
        sp.latex(most),
    )
    speed, least, damping, bound, loss = z3.Reals("ρ' u k₂ F_max loss")
    brakes = lemma(
        "while two part faster than u, ρ' falls by at most 2F_max/u + 2k₂ per metre",
        loss * least <= 2 * bound + 2 * damping * least,
        *(
            least > 0,
            speed >= least,
            z3.substitute(capped.goal, (p_r * n_r + k1 * r, bound)),
            bound >= 0,
            damping >= 0,
            loss * speed == 2 * f + 2 * damping * speed,
        ),
        latex=r"\ddot\rho = -2F(\rho) - 2k_2\dot\rho,\quad \frac{d\dot\rho}{d\rho} = -\frac{2F}{\dot\rho} - 2k_2",
    )
    yield brakes.step
    reach, way, start = z3.Reals("r-ρ(0) way ρ'(0)")
    yield implication(
        "L4: leaving with ρ'(0) >= u + (2F_max/u + 2k₂)(r - ρ(0)), of any u > 0, they are faster than u up to r, "
        "and keep "
        "that speed: they separate for ever, for all parameters, and neither distances nor velocities converge",
        start - loss * way >= least,
        *(brakes.at(), *brakes.given, reach > 0, way >= 0, way <= reach),
        start * least >= least**2 + (2 * bound + 2 * damping * least) * reach,
        latex=r"\dot\rho(0) \ge u + \left(\frac{2F_{\max}}{u} + 2k_2\right)(r - \rho(0)) \implies \dot\rho \ge u > 0",
    )
    with ctx.workdps(DIGITS):
        enough = parting_speed(defaults(), FROM, KEPT)
        yield Step(
            f"L4: by default, from {FROM} m, u = {KEPT} m/s: {LEAVING} m/s is enough",
            bool(enough <= LEAVING),
            evidence=f"{interval(enough, 3)} m/s is",
        )


def parting_speed(values: Mapping[sp.Symbol, sp.Rational], start: int, kept: int) -> arb:
    """u + (2F_max/u + 2k₂)(r - ρ(0))."""
    way = values[R] - start
    return enclosed((kept + (2 * jumps()["r"][0] / kept + 2 * K_2) * way).subs({**values})).real
