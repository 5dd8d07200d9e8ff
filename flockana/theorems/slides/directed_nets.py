"""Directed nets, which the slides allow for and leave: what of Algorithms 1 to 3 still holds, and what fails."""

from __future__ import annotations

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.simulate import simulate
from flockana.environment.obstacles import Sphere
from flockana.environment.targets import LinearTarget
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.directed import DirectedNet
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.theorems.claims import erratum, of_state
from flockana.theorems.theorem import Claim, Tolerances

_ROUNDING = 1e-12  # of the largest input; sums in another order differ by a few eps
_NUMERICAL = 1e-6  # of the energies that are compared: far more than the runs are off


def _check(tolerances: Tolerances) -> list[Claim]:
    return [_undirected(), _momentum(), *_following()]


def _undirected() -> Claim:
    """Forces with all ranges alike against those of the laws, in the plane, from one fixed random state."""
    generator, target = np.random.default_rng(0), LinearTarget((0.0, 0.0), (1.0, 0.0))
    q, p = generator.uniform(-20.0, 20.0, (40, 2)), generator.normal(0.0, 1.0, (40, 2))
    laws = Algorithm1(), Algorithm2(target=target), Algorithm3(target=target, obstacles=(Sphere((40.0, 0.0), 5.0),))
    each = []
    for law in laws:
        u, again = law.acceleration(0.0, q, p), DirectedNet(law, ranges=[law.alpha.range] * 40).acceleration(0.0, q, p)
        each.append(float(np.abs(u - again).max() / np.abs(u).max()))
    off = float(np.max(each))
    return of_state(
        "undirected",
        _ROUNDING - off,
        0.0,
        computed=off,
        stated=f"the same input to {_ROUNDING:g} of the largest",
        witness={"agents": 40},
        detail=f"40 agents with one range for all: Algorithms 1 to 3, to {off:.1g}",
    )


def _pair() -> DirectedNet:
    """Agent 0 sees agent 1, which is short-sighted and does not see agent 0 at the distance d."""
    return DirectedNet(Algorithm1(), ranges=(8.4, 3.0))


def _momentum() -> Claim:
    law = _pair()
    u = law.acceleration(0.0, [[0.0], [7.5]], [[0.0], [0.0]])
    total = abs(float(u.sum())) / (law.law.gains.c1_alpha * law.alpha.strength)
    return of_state(
        "momentum",
        -total,
        _ROUNDING,
        computed=total,
        stated="Σ u_i = 0",
        witness={"q": [0.0, 7.5], "u": u.ravel().tolist()},
        detail=f"one of two agents 7.5 apart is drawn to the other, unanswered: Σ u_i = {float(u.sum()):.4g}",
    )


def _following() -> list[Claim]:
    """Agent 0 at rest at the distance d from agent 1, which moves away at a constant velocity and is followed."""
    law, speed = _pair(), 1.0
    run = simulate(law, [[0.0], [7.0]], [[0.0], [speed]], (0.0, 30.0))
    alpha, gains = law.alpha, law.law.gains
    energy: FloatArray = np.array([law.law.energy(0.0, q, p) for q, p in zip(run.q, run.p, strict=True)])
    rise = float(energy[-1] - energy[0])
    lengths, slip = np.abs(run.q[:, 1, 0] - run.q[:, 0, 0]), run.p[:, 0, 0] - run.p[:, 1, 0]
    own = gains.c1_alpha * alpha.energy_at(lengths) + 0.5 * slip**2
    climbed, size = float(np.diff(own).max()), float(own[0])
    swerve, off = float(np.abs(run.p[:, 1, 0] - speed).max()), abs(float(lengths[-1]) / alpha.d - 1.0)
    return [
        of_state(
            "energy",
            -rise,
            _NUMERICAL * float(energy.max()),
            computed=rise,
            stated="H = V + ½Σ‖p_i‖² never rises",
            witness={"H": [float(energy[0]), float(energy[-1])]},
            detail=f"agent 1 moves away at {speed:g}, agent 0 takes on its velocity: H rises by {rise:.6g} = ½v²",
        ),
        of_state(
            "follower",
            _NUMERICAL * size - climbed,
            0.0,
            computed=climbed,
            stated="c1α ψ_α + ½‖p_0 − p_1‖² of an agent and the one that it alone sees, which is not accelerated, "
            "falls by c2α a ‖p_0 − p_1‖²",
            witness={"from": size, "to": float(own[-1])},
            detail=f"it falls from {size:.4g} to {float(own[-1]):.2g} and between no two samples rises",
        ),
        of_state(
            "leader",
            float(np.minimum(_NUMERICAL - swerve, 1e-3 - off)),
            0.0,
            computed={"swerve": swerve, "length over d": float(lengths[-1]) / alpha.d},
            stated="the velocity of an agent that sees nobody is that of all who follow it, at the distance d",
            witness={"p": run.p[-1].ravel().tolist()},
            detail=f"agent 1 keeps its velocity to {swerve:.1g}; agent 0 ends {float(lengths[-1]):.6g} behind it, "
            f"at {float(run.p[-1, 0, 0]):.6g}",
        ),
    ]


THEOREM = erratum(
    "directed-nets",
    title="Directed nets: what holds of Algorithms 1 to 3 and what fails",
    statement=(
        "Agents with ranges of their own, or a conic neighbourhood, make the net directed. With one range for all, all "
        "round, the laws are Algorithms 1 to 3. Else action is not reaction: momentum is not conserved and H may rise. "
        "An agent that sees one other alone, which is not accelerated, still loses c1α ψ_α + ½‖p_i − p_j‖², and "
        "follows it."
    ),
    source="slides, nets: 'directed nets may be used if agents have different ranges or a conic neighbourhood'",
    check=_check,
    expected={
        "undirected": "verified",
        "momentum": "refuted",
        "energy": "refuted",
        "follower": "verified",
        "leader": "verified",
    },
)
