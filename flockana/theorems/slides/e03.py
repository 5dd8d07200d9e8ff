"""Erratum E3: limits that are no α-lattice have open basins."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.environment.targets import StaticTarget
from flockana.equilibria.coincidence import least_with_coincidence
from flockana.equilibria.gradient_flow import gradient_flow
from flockana.equilibria.record import smallest_strained
from flockana.equilibria.terminal import TerminalState, terminal_state
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.measures.nets import components, links
from flockana.theorems.claims import erratum, of_state
from flockana.theorems.olfati_saber.attraction import attraction
from flockana.theorems.shares import CONFIDENCE, INTERVAL_ERROR, interval
from flockana.theorems.theorem import Claim, Tolerances

_SIZES, _STARTS = (10, 20, 40), 20
_STRAINED = (40, 19)  # (n, seed) of a start whose limit holds a strained component of distinct agents


def random_disc(n: int, seed: int, *, d: float) -> FloatArray:
    """A random start, uniform in a disc of radius 0.6 d √n: about a third denser than the lattice.

    Examples
    --------
    >>> random_disc(3, 0, d=7.0).shape
    (3, 2)
    """
    rng = np.random.default_rng([n, seed])
    angle, radius = rng.uniform(0.0, 2.0 * np.pi, n), 0.6 * d * sqrt(n) * np.sqrt(rng.uniform(size=n))
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def rhombus_with_double_agent(d: float) -> FloatArray:
    """Five agents: two triangles on a common side, and a second agent on one of that side's ends.

    Examples
    --------
    >>> rhombus_with_double_agent(2.0)[4].tolist()
    [0.0, 0.0]
    """
    height = 0.5 * sqrt(3.0)
    return d * np.array([[0.0, 0.0], [1.0, 0.0], [0.5, height], [0.5, -height], [0.0, 0.0]])


def _shares(law: Algorithm1, tolerances: Tolerances) -> Claim:
    """The share of random starts whose limit is a lattice, by the number of agents."""
    rows: dict[int, dict[str, Any]] = {}
    for n in _SIZES:
        limits = [gradient_flow(law, random_disc(n, seed, d=law.alpha.length)) for seed in range(_STARTS)]
        ends = [terminal_state(law, limit.q, 0.0 * limit.q) for limit in limits if limit.converged]
        exact = sum(end.strain <= tolerances.lattice for end in ends)
        rows[n] = {"exact": exact, "of": len(ends), "share": list(interval(exact, len(ends)))}
    highest = min(row["share"][1] for row in rows.values())
    table = ", ".join(f"n = {n}: {row['exact']} of {row['of']}" for n, row in rows.items())
    return of_state(
        "share",
        highest - 1.0,
        INTERVAL_ERROR,
        about="all",  # a sample verifies no share of 1
        computed=rows,
        stated="almost every gradient-flow limit of a random start is an α-lattice (share 1)",
        witness=f"exact Clopper-Pearson intervals of {CONFIDENCE:.0%}",
        detail=f"exact limits of random starts: {table}; at worst the share is below {highest:.3f}",
    )


def _double_agent(law: Algorithm1) -> Claim:
    """The smallest known strict minimum that is no lattice: a coincident pair, kept by its three common neighbours."""
    q = rhombus_with_double_agent(law.alpha.length)
    end, caught = terminal_state(law, q, 0.0 * q), attraction(law, q, 0.0 * q).certificate
    return of_state(
        "double-agent",
        -caught.margin,
        caught.error,
        about="all",
        refutes=end.coincident > 0,
        computed=end.curvature,
        stated="every strict local minimum of V is an α-lattice of distinct agents",
        witness=q,
        proof="double-agent",
        detail=f"n = 5: two agents on one corner of a rhombus are a strict minimum of V (least curvature "
        f"{end.curvature:.3g} of the largest, off rigid motions), with an open basin and a coincident pair",
    )


def _strained(law: Algorithm1, tolerances: Tolerances) -> Claim:
    """A limit of distinct agents whose links differ from d, with no direction in which V falls."""
    limit = gradient_flow(law, random_disc(*_STRAINED, d=law.alpha.length))
    labels = components(len(limit.q), links(limit.q, law.alpha.range))
    groups = [np.ascontiguousarray(limit.q[labels == label]) for label in range(labels.max() + 1)]
    ends = [terminal_state(law, group, 0.0 * group) for group in groups]
    worst = max(range(len(groups)), key=lambda k: np.nan_to_num(ends[k].strain))
    end = ends[worst]
    return of_state(
        "strained",
        tolerances.lattice - end.strain,
        limit.force / tolerances.curvature,  # what moves under the residual force gives way by its curvature
        about="all",
        refutes=limit.converged and end.coincident == 0 and end.curvature > -tolerances.curvature,
        computed=end.strain,
        stated="|link - d|/d = 0 in the limit of every solution but a null set",
        witness={"start": f"random_disc{_STRAINED}", "agents": len(groups[worst]), "links": end.links},
        detail=f"{len(groups[worst])} distinct agents at rest with links of {end.shortest:.4g} to {end.longest:.4g}; "
        f"least curvature {end.curvature:.1g}: not negative",
    )


def _no_lattice(
    name: str, law: Algorithm1 | Algorithm2, q: FloatArray, end: TerminalState, tolerances: Tolerances, **fields: Any
) -> Claim:
    """The claim that a limit is an α-lattice, which a strained strict minimum refutes, and nothing else."""
    basin = attraction(law, q, 0.0 * q)
    error = sqrt(2.0) * basin.distance / law.alpha.length + basin.certificate.error
    strict = basin.certificate.margin > basin.certificate.error
    return of_state(name, tolerances.lattice - end.strain, error, about="all", refutes=strict, **fields)


def _smallest(tolerances: Tolerances) -> Claim:
    """The smallest known strained minimum of distinct agents, verified anew from its file."""
    known = smallest_strained()
    end = terminal_state(known.law, known.q, 0.0 * known.q)
    return _no_lattice(
        "smallest",
        known.law,
        known.q,
        end,
        tolerances,
        computed={"strain": end.strain, "curvature": known.curvature, "agents": len(known.q)},
        stated="every strict local minimum of V with distinct agents is an α-lattice",
        witness=known.q,
        proof="strained-thirteen",
        detail=f"{len(known.q)} distinct agents in a connected strict minimum with {len(known.links)} links, off d by "
        f"up to {100.0 * end.strain:.2g} %; least curvature {known.curvature:.3g} of the largest. With coincident "
        f"agents it takes {least_with_coincidence(known.law.alpha)} at least",
    )


def _compressed(tolerances: Tolerances) -> Claim:
    """The hexagon under Algorithm 2, whose λJ presses on every link."""
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    limit = gradient_flow(law, hexagonal_patch(1, law.alpha.length))
    end = terminal_state(law, limit.q, 0.0 * limit.q)
    return _no_lattice(
        "algorithm-2",
        law,
        limit.q,
        end,
        tolerances,
        computed=end.strain,
        stated="Algorithm 2 converges to an α-lattice (slides' summary of Theorem 3)",
        witness={"links": [end.shortest, end.longest]},
        proof="compressed-patches",
        detail=f"a hexagon of 7 under Algorithm 2 rests with links of {end.shortest:.5g} to {end.longest:.5g}, not 7",
    )


def _check(tolerances: Tolerances) -> list[Claim]:
    law = Algorithm1()
    return [
        _shares(law, tolerances),
        _double_agent(law),
        _smallest(tolerances),
        _strained(law, tolerances),
        _compressed(tolerances),
    ]


THEOREM = erratum(
    "E3",
    title="The limit need not be an α-lattice",
    statement=(
        "Theorem 1(i) and the slides' summaries say that almost every solution converges to an α-lattice. A strict "
        "local minimum of V that is none, modulo rigid motions, attracts an open set of starts; Algorithm 2's λJ "
        "strains every lattice. (Theorem 1 assumes in addition that all of Ω_c stays connected, which such starts do "
        "not grant.)"
    ),
    source="slides, Theorems 1(i) and 3(ii) and their summaries",
    check=_check,
    references=("geschwender-2016", "olfati-saber-2006"),
    expected={"double-agent": "refuted", "smallest": "refuted", "strained": "refuted", "algorithm-2": "refuted"},
)
