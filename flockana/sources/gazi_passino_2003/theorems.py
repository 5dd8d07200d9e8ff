"""Gazi and Passino (2003): a swarm keeps its centroid and ends within a ball about it."""

from math import log, sqrt

import numpy as np

from flockana.sources.gazi_passino_2003.laws import GaziPassino
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances
from flockana.theorems.theorem_toolkit import Enclosure, Observed, condition, judged, law_is, limit_claim, run_theorem

_PROOF = "gazi-passino"


def _centroid(seen: Observed, size: float, tolerances: Tolerances) -> Claim:
    """Return the claim that the centroid stays where it starts."""
    deviation = Enclosure.around(
        np.linalg.norm(seen.run.q.mean(axis=1) - seen.run.q[0].mean(axis=0), axis=1), seen.centre_error
    )
    deviation, energy_tolerance = deviation.clip(0.0) / size, tolerances.energy
    k = int(deviation.mid.argmax())
    return judged("centroid", energy_tolerance - deviation, proof=_PROOF, computed=float(deviation.mid[k])).described(
        stated=f"the centroid stays, to {energy_tolerance:g} of the size",
        witness={"time": float(seen.t[k])},
        detail=f"the centroid moves by {deviation.mid[k]:.2g} of the size at most",
    )


def _rate(seen: Observed, size: float, bound: float) -> Claim:
    """Return the claim that the swarm's radius decays to its bound at least exponentially, at the rate aM."""
    law: GaziPassino = seen.law
    left = max(float(seen.radius.mid[0]) - bound, 0.0)
    limits = bound + left * np.exp(-law.attraction * seen.n * (seen.t - seen.t[0]))
    margin = (limits - seen.radius) / size
    k = margin.worst_index
    return judged("rate", margin, proof=_PROOF, computed=float(seen.radius.mid[k])).described(
        stated=f"R <= {bound:.6g} + {left:.6g} exp(-{law.attraction * seen.n:g} t) at each sample",
        witness={"time": float(seen.t[k])},
        detail=f"R ends at {seen.radius.mid[-1]:.6g}",
    )


def _limit(name: str, seen: Observed, needs: list[Hypothesis], stated: str) -> Claim:
    distance = float(np.linalg.norm(np.ptp(seen.run.q[-1], axis=0)))
    return limit_claim(name, needs, proof=_PROOF).described(
        computed=float(seen.radius.mid[-1]), stated=stated, detail=f"the flock is {distance:.6g} wide at the end"
    )


@run_theorem(
    "gazi-passino",
    title="A swarm with linear attraction and Gaussian repulsion ends in a ball about its fixed centroid",
    source="Gazi and Passino 2003, in our words",
    law=law_is("the law of Gazi and Passino", GaziPassino),
    claims=("centroid", "bounded", "rest", "sharp", "rate", "collapse", "apart"),
    ours=("sharp", "rate", "collapse", "apart"),
    references=("gazi-passino-2003", "flockana"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let M agents move by q_i' = Σ_j (a - b exp(-‖q_j - q_i‖²/c))(q_j - q_i), a, b, c > 0. The centroid never moves,
    all come to rest as t → ∞, and in the end no agent is farther from the centroid than ρ = (b/a) √(c/2) e^-½. Ours:
    not farther than (M - 1)/M ρ, which two agents attain if b = a √e, and what exceeds it dies out at the rate aM; if
    b <= a all end at one point; if b > a and not all start at one, they never do: the lim sup of the largest distance
    is √(c ln(b/a)) at least.
    """
    law: GaziPassino = seen.law
    ratio, n, radius = law.repulsion / law.attraction, seen.n, law.radius
    bound, size = (n - 1) / n * radius, radius + float(seen.radius.mid[0])
    text = f"b/a = {ratio:.6g}"
    weak_claim = condition("b <= a", ratio <= 1.0, 1.0 - ratio, text, remedy="lower the repulsion b or raise a")
    strong = condition("b > a", ratio > 1.0, ratio - 1.0, text, remedy="raise the repulsion b or lower a")
    wide = float(np.ptp(seen.run.q[0], axis=0).max())
    apart_claim = condition("not all agents start at one place", wide > 0.0, wide, remedy="move one agent")
    rest = sqrt(law.c * log(ratio)) if ratio > 1.0 else 0.0
    return [], [
        _centroid(seen, size, tolerances),
        _limit("bounded", seen, [], f"in the end ‖q_i - q_c‖ <= (b/a) √(c/2) e^-½ = {radius:.6g}"),
        _limit("rest", seen, [], "velocities tend to 0"),
        _limit("sharp", seen, [], f"in the end ‖q_i - q_c‖ <= {n - 1}/{n} of that, {bound:.6g}"),
        _rate(seen, size, bound),
        _limit("collapse", seen, [weak_claim], "all tend to their centroid"),
        _limit("apart", seen, [strong, apart_claim], f"the lim sup of the largest distance is at least {rest:.6g}"),
    ]
