"""Erratum E3: limits that are no α-lattice have open basins."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from flockana.base.binomial import clopper_pearson
from flockana.base.checks import FloatArray
from flockana.environment.targets import StaticTarget
from flockana.equilibria.coincidence import least_with_coincidence
from flockana.equilibria.gradient_flow import gradient_flow
from flockana.equilibria.record import smallest_strained
from flockana.equilibria.terminal import TerminalState, terminal_state
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.measures.nets import components, links
from flockana.theorems.olfati_saber.attraction import attraction
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge

_SIZES, _STARTS = (10, 20, 40), 20
_CONFIDENCE = 0.95
_ROUNDING = 1e-9  # of the ends of an interval, which are quantiles of a beta distribution
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
    rows = {}
    for n in _SIZES:
        limits = [gradient_flow(law, random_disc(n, seed, d=law.alpha.length)) for seed in range(_STARTS)]
        ends = [terminal_state(law, limit.q, 0.0 * limit.q) for limit in limits if limit.converged]
        exact = sum(end.strain <= tolerances.lattice for end in ends)
        low, high = clopper_pearson(exact, len(ends), level=_CONFIDENCE)
        rows[n] = {"exact": exact, "of": len(ends), "share": [float(low), float(high)]}
    worst = min(rows.values(), key=lambda row: row["share"][1])  # type: ignore[index]
    margin = worst["share"][1] - 1.0  # type: ignore[index]
    table = ", ".join(f"n = {n}: {row['exact']} of {row['of']}" for n, row in rows.items())
    return Claim(
        "share",
        "refuted" if margin < -_ROUNDING else "inconclusive",  # a sample verifies no share of 1
        computed=rows,
        stated="almost every gradient-flow limit of a random start is an α-lattice (share 1)",
        margin=margin,
        error=_ROUNDING,
        witness=f"exact Clopper-Pearson intervals of {_CONFIDENCE:.0%}",
        detail=f"exact limits of random starts: {table}; at worst the share is below {worst['share'][1]:.3f}",  # type: ignore[index]
    )


def _double_agent(law: Algorithm1) -> Claim:
    """The smallest strained minimum we know: a coincident pair, held by the three neighbours that both share."""
    q = rhombus_with_double_agent(law.alpha.length)
    end, held = terminal_state(law, q, 0.0 * q), attraction(law, q, 0.0 * q).certificate
    trapped = held.margin > held.error and end.coincident > 0
    return Claim(
        "double-agent",
        "refuted" if trapped else "inconclusive",
        computed=end.curvature,
        stated="every strict local minimum of V is an α-lattice of distinct agents",
        margin=-held.margin,
        error=held.error,
        witness=q,
        detail=f"n = 5: two agents on one corner of a rhombus are a strict minimum of V (least curvature "
        f"{end.curvature:.3g} of the largest, off rigid motions), with an open basin and a coincident pair",
    )


def _strained(law: Algorithm1, tolerances: Tolerances) -> Claim:
    """A limit of distinct agents whose links differ from d, with no direction in which V falls."""
    limit = gradient_flow(law, random_disc(*_STRAINED, d=law.alpha.length))
    labels = components(len(limit.q), links(limit.q, law.alpha.range))
    parts = [np.ascontiguousarray(limit.q[labels == label]) for label in range(labels.max() + 1)]
    ends = [terminal_state(law, part, 0.0 * part) for part in parts]
    worst = max(range(len(parts)), key=lambda k: np.nan_to_num(ends[k].strain))
    end = ends[worst]
    off = end.strain - tolerances.lattice > limit.force / tolerances.curvature
    found = limit.converged and off and end.coincident == 0
    return Claim(
        "strained",
        "refuted" if found and end.curvature > -tolerances.curvature else "inconclusive",
        computed=end.strain,
        stated="|link - d|/d = 0 in the limit of every solution but a null set",
        margin=tolerances.lattice - end.strain,
        error=limit.force / tolerances.curvature,  # what moves under the residual force gives way by its curvature
        witness={"start": f"random_disc{_STRAINED}", "agents": len(parts[worst]), "links": end.links},
        detail=f"{len(parts[worst])} distinct agents at rest with links of {end.shortest:.4g} to {end.longest:.4g}; "
        f"least curvature {end.curvature:.1g}: not negative",
    )


def _off(law: Algorithm1 | Algorithm2, q: FloatArray, end: TerminalState, tolerances: Tolerances) -> dict[str, Any]:
    """Status, margin and error of "the limit is an α-lattice", at a strict minimum; inconclusive anywhere else."""
    held, margin = attraction(law, q, 0.0 * q), tolerances.lattice - end.strain
    error = sqrt(2.0) * held.distance / law.alpha.length + held.certificate.error
    trapped = held.certificate.margin > held.certificate.error and judge(margin, error, []) == "refuted"
    return {"status": "refuted" if trapped else "inconclusive", "margin": margin, "error": error}


def _smallest(tolerances: Tolerances) -> Claim:
    """The smallest strained minimum of distinct agents that our searches found, verified anew from its file."""
    found = smallest_strained()
    end = terminal_state(found.law, found.q, 0.0 * found.q)
    return Claim(
        "smallest",
        **_off(found.law, found.q, end, tolerances),
        computed={"strain": end.strain, "curvature": found.curvature, "agents": len(found.q)},
        stated="every strict local minimum of V with distinct agents is an α-lattice",
        witness=found.q,
        detail=f"{len(found.q)} distinct agents in a connected strict minimum with {len(found.links)} links, off d by "
        f"up to {100.0 * end.strain:.2g} %; least curvature {found.curvature:.3g} of the largest. With coincident "
        f"agents it takes {least_with_coincidence(found.law.alpha)} at least",
    )


def _compressed(tolerances: Tolerances) -> Claim:
    """Algorithm 2: λJ presses on every link."""
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    limit = gradient_flow(law, hexagonal_patch(1, law.alpha.length))
    end = terminal_state(law, limit.q, 0.0 * limit.q)
    return Claim(
        "algorithm-2",
        **_off(law, limit.q, end, tolerances),
        computed=end.strain,
        stated="Algorithm 2 converges to an α-lattice (slides' summary of Theorem 3)",
        witness={"links": [end.shortest, end.longest]},
        detail=f"a hexagon of 7 under Algorithm 2 rests with links of {end.shortest:.5g} to {end.longest:.5g}, not 7",
    )


def _check(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    law = Algorithm1()
    return [], [
        _shares(law, tolerances),
        _double_agent(law),
        _smallest(tolerances),
        _strained(law, tolerances),
        _compressed(tolerances),
    ]


THEOREM = Theorem(
    id="E3",
    title="The limit need not be an α-lattice",
    statement=(
        "Theorem 1(i) and the slides' summaries say that almost every solution converges to an α-lattice. A strict "
        "local minimum of V that is none, modulo rigid motions, attracts an open set of starts; Algorithm 2's λJ "
        "strains every lattice. (Theorem 1 assumes in addition that all of Ω_c stays connected, which such starts do "
        "not grant.)"
    ),
    source="slides, Theorems 1(i) and 3(ii) and their summaries",
    kind="fixed",
    check=_check,
    references=("geschwender-2016", "olfati-saber-2006"),
    expected={
        "E3": "refuted",
        "E3:double-agent": "refuted",
        "E3:smallest": "refuted",
        "E3:strained": "refuted",
        "E3:algorithm-2": "refuted",
    },
)
