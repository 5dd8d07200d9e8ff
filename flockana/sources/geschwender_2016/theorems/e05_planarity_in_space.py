"""Erratum E5: in space, edges of an α-lattice do not cross, and yet its graph need not be planar."""

from collections.abc import Iterator
from itertools import combinations, product
from math import sqrt

import numpy as np

from flockana.lattice import is_planar, kuratowski, planar_bound
from flockana.lattice.builders import fcc_star
from flockana.sources.olfati_saber_2006 import check
from flockana.theorems.theorem_toolkit import Claim, FloatArray, Tolerances, by_count, erratum, of_state

_D, _R = 7.0, 8.4
Site = tuple[int, int, int]

# Face-centred cubic sites are the whole points of even coordinate sum; neighbours are √2 apart.
_STEPS: tuple[Site, ...] = tuple((x, y, z) for x, y, z in product((-1, 0, 1), repeat=3) if x * x + y * y + z * z == 2)
STAR: tuple[Site, ...] = ((0, 0, 0), *_STEPS)
EIGHT: tuple[Site, ...] = ((0, 0, 0), (1, 0, 1), (2, 1, 1), (1, 1, 0), (2, 2, 0), (2, 1, -1), (1, 0, -1), (2, 0, 0))
_FRAGMENT = 6
_PROOF = "nonplanar-fcc"


def fcc_eight(d: float) -> FloatArray:
    """Return eight sites of the face-centred cubic lattice with 17 links and a non-planar graph."""
    return d / sqrt(2.0) * np.array(EIGHT, dtype=float)


def _add(site: Site, step: Site) -> Site:
    return site[0] + step[0], site[1] + step[1], site[2] + step[2]


def fragments(size: int) -> Iterator[tuple[Site, ...]]:
    """Yield every connected set of `size` face-centred cubic sites, up to translation (Redelmeier 1981)."""
    origin: Site = (0, 0, 0)

    def grow(chosen: list[Site], untried: list[Site], seen: set[Site]) -> Iterator[tuple[Site, ...]]:
        for k, site in enumerate(untried):
            grown_sites = [*chosen, site]
            if len(grown_sites) == size:
                yield tuple(grown_sites)
                continue
            new_sites = [s for s in (_add(site, step) for step in _STEPS) if s > origin and s not in seen]
            yield from grow(grown_sites, untried[k + 1 :] + new_sites, seen | set(new_sites))

    return grow([], [origin], {origin})  # the least site of each set is the origin


def site_links(sites: tuple[Site, ...]) -> tuple[tuple[int, int], ...]:
    """Return the pairs of nearest-neighbour sites, by whole-number coordinates."""
    steps = set(_STEPS)
    return tuple(
        (i, j)
        for (i, a), (j, b) in combinations(enumerate(sites), 2)
        if (b[0] - a[0], b[1] - a[1], b[2] - a[2]) in steps
    )


def non_planar_fragments(size: int) -> tuple[int, int]:
    """Return the numbers of fragments and of non-planar fragments of a size, exactly."""
    known_answers: dict[tuple[tuple[int, int], ...], bool] = {}
    total = failure_count = 0
    for sites in fragments(size):
        total += 1
        edges = site_links(sites)
        if len(edges) < 9:  # K3,3 has nine links, K5 ten
            continue
        if edges not in known_answers:
            known_answers[edges] = is_planar(size, edges)
        failure_count += not known_answers[edges]
    return total, failure_count


def _counterexample(name: str, q: FloatArray, sites: tuple[Site, ...], tolerances: Tolerances) -> list[Claim]:
    """Return the claims of Theorem 5(i) on a lattice in space: its graph is planar, and its edges do not cross."""
    uncrossed = next(claim for claim in check(q, _D, _R, tolerances)[1] if claim.name == "i")
    edges = site_links(sites)
    witness, planar = kuratowski(len(sites), edges), is_planar(len(sites), edges)
    bound, kind = planar_bound(len(sites)), "planar" if planar else "not planar"
    return [
        by_count(f"printed-{name}", 0 if planar else 1, about="all", disproof=_PROOF).described(
            computed={"links": len(edges), "bound": bound, "graph": kind},
            stated="the graph is planar",
            witness={"q": q} | (vars(witness) if witness else {}),
            detail=f"{len(sites)} face-centred cubic sites: the graph of {len(edges)} links is {kind}; a planar one "
            f"has at most {bound}",
        ),
        of_state(
            f"uncrossed-{name}", uncrossed.margin or 0.0, uncrossed.error or 0.0, uncrossed.needs, proof=_PROOF
        ).described(
            computed=uncrossed.computed,
            stated=uncrossed.stated,
            witness=uncrossed.witness,
            detail=f"in space its edges do not cross: {uncrossed.detail}",
        ),
    ]


@erratum(
    "E5",
    expected={"refuted": "printed-13 printed-8", "verified": "uncrossed-13 uncrossed-8 six"},
    corrected=("uncrossed-13", "uncrossed-8"),
    ours=("six",),
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Theorem 5(i) is printed as: the graph is planar for m = 2, 3. In space only the edges do not cross. A
    face-centred cubic site and its twelve neighbours have 36 links, more than 3n - 6 = 33; eight sites with 17 links
    are not planar either. All fragments of six sites are planar.
    """
    total, bad = non_planar_fragments(_FRAGMENT)
    return [
        *_counterexample("13", fcc_star(_D), STAR, tolerances),
        *_counterexample("8", fcc_eight(_D), EIGHT, tolerances),
        by_count("six", bad, about="all", proof=_PROOF, computed={"fragments": total, "not planar": bad}).described(
            stated="every fragment of six sites is planar",
            witness="every connected fragment, up to translation",
            detail=f"all {total} connected fragments of {_FRAGMENT} sites were tested: {bad} are not planar",
        ),
    ]
