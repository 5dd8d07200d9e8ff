"""Erratum J5: agents with different numbers of neighbours want two lengths of one edge, and the flock runs away."""

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.measures.perception import both_ways, incidence
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.theorems.theorem_toolkit import Claim, Enclosure, Tolerances, erratum, judged, lengths, observed, stacked

_STARTS, _END = 20, 60.0
_RUNAWAY, _THRUST = np.array([0.0, 5.0 / 3.0, 5.0 / 3.0]), 2.0 / 3.0  # distances of ends and middle; all |u|
_PROOF = "bearing-distance-printed"


def _desired_lengths(law: MinimalFlocking) -> FloatArray:
    """Return the two lengths that an end agent and the middle agent of a path of three desire of their edge."""
    head, tail, _, rho, _ = law.edge_data(np.empty((3, 1)))
    spacing = {(int(j), int(i)): float(distance) for i, j, distance in zip(head, tail, rho, strict=True)}
    return np.array([spacing[1, 0], spacing[0, 1]])


def _error(law: MinimalFlocking, seed: int) -> Enclosure:
    """Return the distance of a run's end from the predicted equilibrium: edges of length 5/3, |u| = 2/3."""
    rng = np.random.default_rng(seed)
    q, p = rng.uniform(-2.0, 2.0, (3, 2)), rng.uniform(-1.0, 1.0, (3, 2))
    observation = observed(law, q, p, (0.0, _END), t_eval=(0.0, _END), rtol=1e-11)
    u = observation.series(lambda run: lengths(run.u), floor=8.0 * float(observation.shape_error.max()))[-1]
    final_distances = observation.distances([0, 0, 1], [2, 1, 2])[-1]
    return stacked([abs(final_distances - _RUNAWAY).max(), abs(u - _THRUST).max()]).max()


def _rate(law: MinimalFlocking) -> float:
    """Return the slowest decay rate of perturbations of the accelerating flock, its zero mode left out."""
    q = np.array([[-5.0 / 3.0, 0.0], [0.0, 0.0], [-5.0 / 3.0, 0.0]])
    T = np.kron(np.eye(2), np.kron(-incidence(3, ((0, 1), (1, 2))).T, np.eye(2)))  # (q, p) to edges and their rates
    modes = np.linalg.eigvals(T @ np.asarray(law.jacobian(0.0, q, 0.0 * q)) @ np.linalg.pinv(T))
    return -float(np.sort(modes.real)[-2])  # the last is 0


@erratum("J5", expected={"refuted": "printed", "verified": "runaway"}, ours=("runaway",))
def theorem(tolerances: Tolerances) -> list[Claim]:
    """With α_i r_i = |N_i| neighbours of different degree desire different lengths of their edge, and with equal radii
    perception is mutual, so that no graph is a directed tree. On a fixed path of three agents the ends come to coincide
    5/3 behind the middle, and all accelerate by 2/3 without end.
    """
    # The ends of an undirected path of three want their edges at length 1, the middle at 2: both become 5/3.
    law = MinimalFlocking(edges=both_ways([(0, 1), (1, 2)]))
    lengths_wanted, deviation = _desired_lengths(law), stacked([_error(law, seed) for seed in range(_STARTS)])
    worst, rate = float(deviation.mid.max()), _rate(law)
    return [
        judged(
            "printed",
            -0.5 * abs(Enclosure.of(lengths_wanted[1]) - lengths_wanted[0]),  # no edge is nearer to both
            about="all",
            computed={"wanted by the ends": lengths_wanted[0], "wanted by the middle": lengths_wanted[1]},
            stated="| |x_e| - α_i r_i | -> 0 for all agents, with α_i r_i = |N_i|",
            witness={"graph": "frozen undirected path of three"},
            disproof=_PROOF,
            detail=(
                "the two agents of an edge desire different lengths if their degrees differ: whatever its length, it "
                f"differs from one of the two by {0.5 * abs(lengths_wanted[1] - lengths_wanted[0]):g} or more"
            ),
        ),
        judged("runaway", tolerances.lattice - deviation).described(
            computed={"largest error": worst, "attracts at the rate": rate},
            stated=f"at t = {_END:g} ends together, 5/3 behind the middle, all with the acceleration 2/3",
            witness={"starts": _STARTS, "t": _END},
            detail=f"from {_STARTS} starts the ends come to coincide 5/3 behind the middle, where all accelerate by "
            f"2/3, to {worst:.1g} at t = {_END:g}; linearised, that motion attracts at the rate {rate:.3g}",
        ),
    ]
