"""An agent that a γ-agent pulls stays near it, under every composition whose energy never rises."""

from __future__ import annotations

from math import inf

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.vectors import centres, lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.kernels.paths import bernstein
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm2
from flockana.laws.terms.navigation import Navigation
from flockana.theorems.claims import judged
from flockana.theorems.hypotheses import condition, law_is_or_composed
from flockana.theorems.meeting import least_is_known, meeting
from flockana.theorems.olfati_saber.energy import nothing_adds_energy
from flockana.theorems.rounding import EPS, energy_error, frame_error
from flockana.theorems.sampling import radius_between
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances, unmet


def gains_of(run: Trajectory) -> FloatArray:
    """c1γ of each agent, shape (n,)."""
    return np.broadcast_to(np.asarray(run.law.gains.c1_gamma, dtype=np.float64), (run.n,))


def bound(energy: float, gains: FloatArray, unit: float | None) -> FloatArray:
    """How far a potential of this height lets each agent go; infinitely far without a gain.

    Examples
    --------
    >>> bound(8.0, np.array([1.0, 4.0, 0.0]), None).tolist(), bound(2.0, np.array([1.0]), 3.0).round(6).tolist()
    ([4.0, 2.0, inf], [2.108185])
    """
    height = np.divide(max(energy, 0.0), gains, out=np.full(gains.shape, inf), where=gains > 0.0)
    bent = 0.0 if unit is None else (height / unit) ** 2
    far: FloatArray = np.sqrt(2.0 * height + bent)
    return far


def farthest(run: Trajectory, place: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Largest distance of each agent from a place, at the samples, and at most between them too."""
    seen = lengths(run.q - place).max(axis=0)
    most, path = seen.copy(), run.path
    there = np.zeros(3)  # as paths are, whatever the dimension
    there[: run.m] = place
    for k, h in enumerate(np.diff(path.t).tolist()):
        points, _, allowance = bernstein(h, *(x[k + side] for side in (0, 1) for x in (path.q, path.p, path.u)))
        off = allowance if path.slack is None else allowance + path.slack[k]
        most = np.maximum(most, lengths(points - there).max(axis=1) + off)
    return seen, most


def stays_within(run: Trajectory, needs: list[Hypothesis], *, name: str = "bound", proof: str | None = None) -> Claim:
    """The claim that each agent that is pulled stays within the distance that the energy at the start allows."""
    law, gains = run.law, gains_of(run)
    unit, pulled = law.term(Navigation).unit, gains > 0.0
    energy = float(run.energy()[0])
    error = float(energy_error(law, run.q[:1], run.p[:1], run.energy()[:1])[0])
    energy -= 0.0 if law.alpha is None else meeting(run).floor
    allowed, blurred = (bound(height, gains, unit)[pulled] for height in (energy, energy + error))
    if law.moving:
        seen = lengths(run.q - centres(run.q)[:, None]).max(axis=0)[pulled]
        least = float((allowed - seen).min())
        off = float(radius_between(run).max(initial=0.0)) - float(seen.max()) if least > 0.0 else 0.0
        slack, rounding = np.full(seen.shape, max(off, 0.0)), np.sqrt(run.m) * frame_error(run.q)
    else:
        place = law.target.position(float(run.t[0]))
        seen, most = (far[pulled] for far in farthest(run, place))
        slack, rounding = most - seen, 8.0 * EPS * float(np.abs(run.q).max() + np.abs(place).max())
    errors = blurred - allowed + slack + rounding
    worst = int(np.argmin(np.where(allowed - seen > 0.0, allowed - seen - errors, allowed - seen)))
    agent, whose = int(np.flatnonzero(pulled)[worst]), "the centre of mass" if law.moving else "the γ-agent"
    return judged(
        name,
        float((allowed - seen)[worst]),
        float(errors[worst]),
        needs,
        computed=float(seen[worst]),
        stated=f"agent {agent} stays within {allowed[worst]:.5g} of {whose}",
        witness={"agent": agent},
        proof=proof,
        detail=f"of {int(pulled.sum())} agents with c1γ > 0 the one nearest to its bound, agent {agent}, goes "
        f"{seen[worst]:.4g} from {whose}, and H(0) allows {allowed[worst]:.4g}",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    pulls = run.law.target is not None and bool(np.max(gains_of(run)) > 0.0)
    needs = [condition("c1γ > 0 of an agent", pulls, detail="" if pulls else "the γ-agent pulls nobody")]
    if unmet(needs):
        return needs, []
    needs += nothing_adds_energy(run) + ([] if run.law.alpha is None else least_is_known(run))
    return needs, [stays_within(run, needs)]


THEOREM = Theorem(
    id="cohesion",
    title="Agents that a γ-agent pulls stay near it",
    statement=(
        "Where no term adds energy, the potential of each agent's own pull is at most H(0) less the least energy of "
        "all pairs: with a linear pull ‖q_i − q_r‖ <= sqrt(2 H(0)/c1γ_i) of a γ-agent at rest, or of the centre of "
        "mass where one gain pulls all and the energy is that of the shape; with a bounded pull of length ℓ "
        "sqrt(2 H(0)/c1γ_i + (H(0)/(c1γ_i ℓ))²)."
    ),
    source="ours, on Olfati-Saber 2006, Theorem 3(i)",
    kind="trajectory",
    law=law_is_or_composed("Algorithm 2 or 3", Algorithm2, Algorithm3),
    check=_check,
    claims=("bound",),
    references=("olfati-saber-2006", "flockana"),
)
