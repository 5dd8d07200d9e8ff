"""Erratum E3: limits that are no α-lattice have open basins."""

from dataclasses import replace
from itertools import product
from math import inf, sqrt
from typing import NamedTuple

import numpy as np

from flockana.base.progress import show_part
from flockana.environment.targets import StaticTarget
from flockana.equilibria.coincidence import least_with_coincidence
from flockana.equilibria.equilibrium_files import smallest_strained
from flockana.equilibria.final_state import TerminalState, terminal_state
from flockana.equilibria.gradient_flow import gradient_flow
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.measures.nets import components, links
from flockana.theorems.attraction_basin import attraction
from flockana.theorems.random_start_shares import CONFIDENCE
from flockana.theorems.theorem_toolkit import (
    Claim,
    Enclosure,
    FloatArray,
    Tolerances,
    always,
    erratum,
    judged,
    of_state,
)

_SIZES, _STARTS = (10, 20, 40), 20
_STRAINED = (40, 14)  # (n, seed) of a start whose limit is strained and holds no coincident agents


def random_disc(n: int, seed: int, *, d: float) -> FloatArray:
    """Return a random start, uniform in a disc of radius 0.45 d √n: about a third denser than the lattice."""
    rng = np.random.default_rng([n, seed])
    angle, radius = rng.uniform(0.0, 2.0 * np.pi, n), 0.45 * d * sqrt(n) * np.sqrt(rng.uniform(size=n))
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def rhombus_with_double_agent(d: float) -> FloatArray:
    """Return positions of five agents on a rhombus of two triangles, two of them at one end of the common side."""
    height = 0.5 * sqrt(3.0)
    return d * np.array([[0.0, 0.0], [1.0, 0.0], [0.5, height], [0.5, -height], [0.0, 0.0]])


class _Limit(NamedTuple):
    """Limit of a random start: positions and final state of each component of its net, and convergence."""

    parts: tuple[tuple[FloatArray, TerminalState], ...]
    converged: bool


def _limit(law: Algorithm1, n: int, seed: int) -> _Limit:
    descent = gradient_flow(law, random_disc(n, seed, d=law.alpha.length))
    labels = components(n, links(descent.q, law.alpha.range))
    groups = [np.ascontiguousarray(descent.q[labels == label]) for label in range(labels.max() + 1)]
    parts = tuple((q, terminal_state(law, q, 0.0 * q)) for q in groups if len(q) > 1)
    return _Limit(parts, descent.converged)


def _certain_strain(law: Algorithm1 | Algorithm2, q: FloatArray) -> Enclosure:
    """Return the largest |link − d|/d at the strict minimum near a state; infinite without a certificate."""
    basin, strain = attraction(law, q, 0.0 * q), terminal_state(law, q, 0.0 * q).strain
    is_certain = basin.certificate.certain
    return Enclosure.around(strain, sqrt(2.0) * basin.distance / law.alpha.length if is_certain else inf)


def _is_lattice(law: Algorithm1, limit: _Limit, tolerances: Tolerances) -> bool | None:
    """Return whether a limit is an α-lattice; None if undecided."""
    if not limit.converged:
        return None
    strained_states = [q for q, end in limit.parts if end.strain > tolerances.lattice]
    if not strained_states:
        return True
    return False if any(_certain_strain(law, q).lo > tolerances.lattice for q in strained_states) else None


def _shares(law: Algorithm1, limits: dict[int, list[_Limit]], tolerances: Tolerances) -> Claim:
    """Return the claim that almost every random start ends as a lattice, refuted by one flock size."""
    claims = {
        n: always("share", [_is_lattice(law, limit, tolerances) for limit in of_n], f"n = {n}: a lattice", "share 1")
        for n, of_n in limits.items()
    }
    worst = min(claims.values(), key=lambda claim: claim.computed["share"][1])
    return replace(
        worst,
        computed={n: claim.computed for n, claim in claims.items()},
        stated="almost every gradient-flow limit of a random start is an α-lattice (share 1)",
        witness=f"exact Clopper-Pearson intervals of {CONFIDENCE:.0%}",
        detail="; ".join(claim.detail for claim in claims.values()),
    )


def _double_agent(law: Algorithm1) -> Claim:
    """Return the claim that strict minima of V are α-lattices, judged at a pair of agents held by three others."""
    q = rhombus_with_double_agent(law.alpha.length)
    end, caught = terminal_state(law, q, 0.0 * q), attraction(law, q, 0.0 * q).certificate
    return of_state("double-agent", -caught.margin, caught.error, about="all", disproof="double-agent").described(
        computed=end.curvature,
        stated="every strict local minimum of V is an α-lattice of distinct agents",
        witness=q,
        detail=f"n = 5: two agents on one corner of a rhombus are a strict minimum of V (least curvature "
        f"{end.curvature:.3g} of the largest, off rigid motions), with an open basin and a coincident pair",
    )


def _strained(law: Algorithm1, limit: _Limit, tolerances: Tolerances) -> Claim:
    """Return the claim that limits have link lengths d, judged by the limit of one random start."""
    q, end = max(limit.parts, key=lambda part: part[1].strain)
    is_distinct = end.coincident == 0
    margin = tolerances.lattice - _certain_strain(law, q) if is_distinct else Enclosure.around(0.0, inf)
    return judged("strained", margin, about="all", computed=end.strain).described(
        stated="|link - d|/d = 0 in the limit of every solution but a null set",
        witness={"start": f"random_disc{_STRAINED}", "agents": len(q), "links": end.links},
        detail=f"{len(q)} distinct agents end in a strict minimum with links of {end.shortest:.4g} to "
        f"{end.longest:.4g}; least curvature {end.curvature:.2g} of the largest",
    )


def _smallest(tolerances: Tolerances) -> Claim:
    """Return the claim that strict minima of distinct agents are α-lattices, judged at a strained minimum."""
    strain = smallest_strained()
    end = terminal_state(strain.law, strain.q, 0.0 * strain.q)
    margin = tolerances.lattice - _certain_strain(strain.law, strain.q)
    return judged("smallest", margin, about="all", disproof="strained-thirteen").described(
        computed={"strain": end.strain, "curvature": strain.curvature, "agents": len(strain.q)},
        stated="every strict local minimum of V with distinct agents is an α-lattice",
        witness=strain.q,
        detail=f"{len(strain.q)} distinct agents in a connected strict minimum with {len(strain.links)} links, off d "
        f"by up to {100.0 * end.strain:.2g} %; least curvature {strain.curvature:.3g} of the largest. With coincident "
        f"agents at least {least_with_coincidence(strain.law.alpha)} are needed",
    )


def _compressed(tolerances: Tolerances) -> Claim:
    """Return the claim that Algorithm 2 converges to an α-lattice, tested on a compressed hexagon at rest."""
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    limit = gradient_flow(law, hexagonal_patch(1, law.alpha.length))
    end = terminal_state(law, limit.q, 0.0 * limit.q)
    margin = tolerances.lattice - _certain_strain(law, limit.q)
    return judged("algorithm-2", margin, about="all", disproof="compressed-patches", computed=end.strain).described(
        stated="Algorithm 2 converges to an α-lattice (slides' summary of Theorem 3)",
        witness={"links": [end.shortest, end.longest]},
        detail=f"a hexagon of 7 under Algorithm 2 rests with links of {end.shortest:.5g} to {end.longest:.5g}, not 7",
    )


@erratum("E3", expected={"refuted": "double-agent smallest strained algorithm-2"})
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Theorem 1(i) and the slides' summaries say that almost every solution converges to an α-lattice. But a strict
    local minimum of V, modulo rigid motions, attracts an open set of starts even where it is not an α-lattice; and
    Algorithm 2's λJ strains every lattice. (Theorem 1 assumes in addition that all of Ω_c stays connected, which such
    starts do not guarantee.)
    """
    law, (n, seed) = Algorithm1(), _STRAINED
    limits: dict[int, list[_Limit]] = {agent_count: [] for agent_count in _SIZES}
    for agent_count, start in product(_SIZES, range(_STARTS)):
        show_part(f"flow {start + 1} of {_STARTS} of {agent_count} agents")
        limits[agent_count].append(_limit(law, agent_count, start))
    return [
        _shares(law, limits, tolerances),
        _double_agent(law),
        _smallest(tolerances),
        _strained(law, limits[n][seed], tolerances),
        _compressed(tolerances),
    ]
