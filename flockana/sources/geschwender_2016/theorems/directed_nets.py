"""Directed nets, allowed but not treated in the slides: properties of Algorithms 1 to 3 that hold or fail."""

from functools import partial

import numpy as np

from flockana.environment.obstacles import Sphere
from flockana.environment.targets import LinearTarget
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.directed_algorithms import DirectedNet
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.sources.geschwender_2016.theorems.claims_on_energy import rises
from flockana.theorems.claims import erratum, judged, of_state
from flockana.theorems.theorem_toolkit import Claim, FloatArray, Observed, Tolerances, Trajectory, observed, stacked

_ROUNDING = 1e-12  # of the largest input; sums in another order differ by a few eps
_NUMERICAL = 1e-6  # of the energies that are compared: far more than the runs are off
_ENDS = 1e-3  # relative: as near as the end of the run is to the limit


def _undirected() -> Claim:
    """Return the claim that a directed net with equal ranges gives the forces of Algorithms 1 to 3."""
    generator, target = np.random.default_rng(0), LinearTarget((0.0, 0.0), (1.0, 0.0))
    q, p = generator.uniform(-20.0, 20.0, (40, 2)), generator.normal(0.0, 1.0, (40, 2))
    laws = Algorithm1(), Algorithm2(target=target), Algorithm3(target=target, obstacles=(Sphere((40.0, 0.0), 5.0),))
    deviations = []
    for law in laws:
        u, again = law.acceleration(0.0, q, p), DirectedNet(law, ranges=[law.alpha.range] * 40).acceleration(0.0, q, p)
        deviations.append(float(np.abs(u - again).max() / np.abs(u).max()))
    off = float(np.max(deviations))
    text = f"40 agents with one range for all: the input differs from that of Algorithms 1 to 3 by {off:.1g}"
    return of_state("undirected", _ROUNDING - off, 0.0).described(
        computed=off, stated=f"the same input to {_ROUNDING:g} of the largest", witness={"agents": 40}, detail=text
    )


def _pair() -> DirectedNet:
    """Return the law of a pair with ranges 8.4 and 3: at distance d agent 0 sees agent 1, not conversely."""
    return DirectedNet(Algorithm1(), ranges=(8.4, 3.0))


def _momentum() -> Claim:
    law = _pair()
    u = law.acceleration(0.0, [[0.0], [7.5]], [[0.0], [0.0]])
    total = abs(float(u.sum())) / (law.law.gains.c1_alpha * law.alpha.strength)
    return of_state("momentum-lost", total, _ROUNDING, computed=total).described(
        stated="momentum is not conserved: Σ u_i ≠ 0 of a pair of which one sees the other",
        witness={"q": [0.0, 7.5], "u": u.ravel().tolist()},
        detail=f"one of two agents 7.5 apart is attracted by the other, which does not react: "
        f"Σ u_i = {float(u.sum()):.4g}",
    )


def _own_energy(run: Trajectory) -> FloatArray:
    """Return the pair energy c1α ψ_α + ½‖p_0 − p_1‖² at each sample of a run."""
    displacement, velocity_difference = run.q[:, 1, 0] - run.q[:, 0, 0], run.p[:, 0, 0] - run.p[:, 1, 0]
    return run.law.law.gains.c1_alpha * run.law.alpha.energy(np.abs(displacement)) + 0.5 * velocity_difference**2


def _following() -> list[Claim]:
    """Return claims on a run: agent 0 starts at rest, d behind agent 1, which moves off at constant velocity."""
    return _claims_on(observed(_pair(), [[0.0], [7.0]], [[0.0], [1.0]], (0.0, 30.0), rtol=1e-10), 1.0)


def _claims_on(seen: Observed, speed: float) -> list[Claim]:
    law, run = seen.law, seen.run
    energy = seen.series(lambda run: list(map(partial(law.law.energy, 0.0), run.q, run.p)), floor=seen.floors.work)
    own_energy, rise = seen.series(_own_energy, floor=seen.floors.work), energy[-1] - energy[0]
    energy_rises, size = rises(own_energy), float(own_energy.mid[0])
    swerve = seen.series(lambda run: np.abs(run.p[:, 1, 0] - speed), floor=seen.floors.speed)
    slip = seen.series(lambda run: np.abs(run.p[:, 0, 0] - run.p[:, 1, 0]), floor=2.0 * seen.floors.speed)[-1]
    length = seen.distances([0], [1])[-1, 0] / law.alpha.d
    return [
        judged("energy-rises", rise, computed=float(rise.mid), stated="H = V + ½Σ‖p_i‖² can rise").described(
            witness={"H": [float(energy.mid[0]), float(energy.mid[-1])]},
            detail=f"agent 1 moves away at {speed:g}, agent 0 takes on its velocity: from start to end H changes by "
            f"{rise.mid:.6g}; ½v² = {0.5 * speed**2:g}",
        ),
        judged("follower", _NUMERICAL * size - energy_rises, computed=float(energy_rises.mid.max())).described(
            stated="c1α ψ_α + ½‖p_0 − p_1‖² of an agent and the one that it alone sees, which is not accelerated, "
            "falls by c2α a ‖p_0 − p_1‖²",
            witness={"from": size, "to": float(own_energy.mid[-1])},
            detail=f"the energy of the follower, relative to its leader, goes from {size:.4g} to "
            f"{float(own_energy.mid[-1]):.2g}, and rises by {energy_rises.mid.max():.2g} at most on the way",
        ),
        judged(
            "leader",
            stacked([_NUMERICAL - swerve.max(), _ENDS - slip / speed, _ENDS - abs(length - 1.0)]),
            computed={"swerve": float(swerve.mid.max()), "length over d": float(length.mid)},
            stated="the velocity of an agent that sees nobody is that of all who follow it, at the distance d",
            witness={"p": run.p[-1].ravel().tolist()},
            detail=f"agent 1 keeps its velocity to {swerve.mid.max():.1g}; agent 0 ends {length.mid * law.alpha.d:.6g} "
            f"behind it, at {float(run.p[-1, 0, 0]):.6g}",
        ),
    ]


@erratum(
    "directed-nets",
    title="Directed nets: what holds of Algorithms 1 to 3 and what fails",
    source="ours; the slides allow for directed nets, of agents with different ranges or a conic neighbourhood",
    expected={"verified": "undirected momentum-lost energy-rises follower leader"},
    author="flockana",
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Agents with different ranges, or with a conic neighbourhood, make the net directed. With one range for all, all
    round, the laws are Algorithms 1 to 3. Otherwise action is not reaction: momentum is not conserved and H may rise.
    An agent that sees only one other agent, which is not accelerated, still loses c1α ψ_α + ½‖p_i − p_j‖², and follows
    it.
    """
    return [_undirected(), _momentum(), *_following()]
