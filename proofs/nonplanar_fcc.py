"""Erratum E5: in space, α-lattices whose graphs are not planar, though no two of their links cross; in whole numbers.

Face-centred cubic sites are the whole points of even coordinate sum. In units of d/√2 neighbours have squared distance
2, and no other two sites have less than 4: every set of sites is an α-lattice for all 1 < κ <= √2.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import combinations, permutations, product
from typing import Any

from flockana.lattice import kuratowski, planar_bound
from flockana.sources.geschwender_2016.theorems.e05_planarity_in_space import fragments
from proofs.proof import Proof, Step

Site = tuple[int, int, int]
Links = tuple[tuple[int, int], ...]

_STEPS: tuple[Site, ...] = tuple((x, y, z) for x, y, z in product((-1, 0, 1), repeat=3) if x * x + y * y + z * z == 2)
STAR: tuple[Site, ...] = ((0, 0, 0), *_STEPS)
EIGHT: tuple[Site, ...] = (
    *((0, 0, 0), (1, 0, 1), (2, 1, 1), (1, 1, 0)),
    *((2, 2, 0), (2, 1, -1), (1, 0, -1), (2, 0, 0)),
)
_SYMMETRIES = tuple((order, signs) for order in permutations(range(3)) for signs in product((1, -1), repeat=3))
_LARGEST = 7
SIZES = {"neighbours": "12", "fragment": "8", "planar up to": str(_LARGEST)}


def _minus(a: Site, b: Site) -> Site:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _dot(a: Site, b: Site) -> int:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Site, b: Site) -> Site:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def squared_distances(sites: Iterable[Site]) -> set[int]:
    """Of all pairs, in units of d²/2."""
    return {_dot(_minus(b, a), _minus(b, a)) for a, b in combinations(sites, 2)}


def links_of(sites: tuple[Site, ...]) -> Links:
    """Pairs of neighbours, squared distance 2."""
    pairs = combinations(range(len(sites)), 2)
    return tuple((i, j) for i, j in pairs if _dot(*(_minus(sites[j], sites[i]),) * 2) == 2)


def meet(a: Site, b: Site, c: Site, d: Site) -> bool:
    """Whether two segments of positive length share a point: a + s(b - a) = c + t(d - c) with 0 <= s, t <= 1."""
    w, z, o = _minus(b, a), _minus(d, c), _minus(c, a)
    normal = _cross(w, z)
    if normal != (0, 0, 0):
        s = Fraction(_dot(_cross(o, z), normal), _dot(normal, normal))
        t = Fraction(_dot(_cross(o, w), normal), _dot(normal, normal))
        return _dot(o, normal) == 0 and 0 <= s <= 1 and 0 <= t <= 1
    ends = sorted((_dot(o, w), _dot(_minus(d, a), w)))  # parallel: along w, ab covers 0 to |w|²
    return _cross(o, w) == (0, 0, 0) and ends[1] >= 0 and ends[0] <= _dot(w, w)


def overlap(a: Site, b: Site, c: Site) -> bool:
    """Whether b and c lie on one ray from a."""
    w, z = _minus(b, a), _minus(c, a)
    return _cross(w, z) == (0, 0, 0) and _dot(w, z) > 0


def crossing(sites: tuple[Site, ...], links: Links) -> int:
    """How many pairs of links share a point that is not a common agent."""
    count = 0
    for one, other in combinations(links, 2):
        common = set(one) & set(other)
        if common:
            (i,) = common
            ends = (sites[j] for link in (one, other) for j in link if j != i)
            count += overlap(sites[i], *ends)
        else:
            count += meet(*(sites[i] for i in (*one, *other)))
    return count


def smoothed(links: Iterable[tuple[int, int]]) -> set[frozenset[int]] | None:
    """What is left of a graph when each agent of two links is replaced by one link; None if that doubles a link."""
    near: dict[int, set[int]] = {}
    for i, j in links:
        near.setdefault(i, set()).add(j)
        near.setdefault(j, set()).add(i)
    for agent in sorted(near):
        if len(near[agent]) == 2:
            i, j = near.pop(agent)
            if j in near[i]:
                return None
            near[i] = near[i] - {agent} | {j}
            near[j] = near[j] - {agent} | {i}
    return {frozenset((i, j)) for i, around in near.items() for j in around}


def is_subdivided(kind: str, links: Iterable[tuple[int, int]]) -> bool:
    """Whether the graph is a subdivision of K5 or of K3,3, found by smoothing its agents of degree 2."""
    rest = smoothed(links)
    if rest is None:
        return False
    corners = sorted(set().union(*rest))
    if kind == "K5":
        return len(corners) == 5 and rest == {frozenset(pair) for pair in combinations(corners, 2)}
    sides = (set(side) for side in combinations(corners, 3) if len(corners) == 6)
    return any(rest == {frozenset((i, j)) for i in side for j in corners if j not in side} for side in sides)


def embeds(size: int, links: Links) -> bool:
    """Whether networkx embeds this connected graph in the plane; we count the faces: agents - links + faces = 2."""
    import networkx

    graph = networkx.Graph(links)
    planar, rotation = networkx.check_planarity(graph)
    if not planar or len(graph) != size or not networkx.is_connected(graph):
        return False
    around: dict[int, list[int]] = {i: list(ring) for i, ring in rotation.get_data().items()}
    if sorted((i, j) for i, ring in around.items() for j in ring) != sorted([*links, *((j, i) for i, j in links)]):
        return False
    after = {(j, i): (i, ring[(k + 1) % len(ring)]) for i, ring in around.items() for k, j in enumerate(ring)}
    faces, left = 0, set(after)
    while left:
        faces, start = faces + 1, next(iter(left))
        while start in left:
            left.remove(start)
            start = after[start]
    return size - len(links) + faces == 2


def _placed(sites: Iterable[Site]) -> tuple[Site, ...]:
    """The sites in order, moved so that the least is the origin."""
    ordered = sorted(sites)
    return tuple(_minus(site, ordered[0]) for site in ordered)


def _images(sites: tuple[Site, ...]) -> set[tuple[Site, ...]]:
    """A fragment under the 48 symmetries of the cube, up to translation."""
    return {_placed((s * site[i], t * site[j], u * site[k]) for site in sites) for (i, j, k), (s, t, u) in _SYMMETRIES}


def grown(shapes: Iterable[tuple[Site, ...]]) -> Iterator[tuple[Site, ...]]:
    """All fragments with one more site: each connected one comes from a connected one, as a tree has a leaf."""
    for sites in shapes:
        new = {(a + x, b + y, c + z) for a, b, c in sites for x, y, z in _STEPS} - set(sites)
        yield from (_placed((*sites, site)) for site in new)


def shapes(size: int) -> dict[tuple[Site, ...], int]:
    """Every connected set of sites up to symmetry and translation, with the number of its images."""
    found: dict[tuple[Site, ...], int] = {((0, 0, 0),): 1}
    for _ in range(size - 1):
        larger: dict[tuple[Site, ...], int] = {}
        seen: set[tuple[Site, ...]] = set()
        for sites in grown(found):
            if sites not in seen:
                images = _images(sites)
                seen |= images
                larger[sites] = len(images)
        found = larger
    return found


def _counterexample(sites: tuple[Site, ...], name: str) -> Iterator[Step]:
    n, links = len(sites), links_of(sites)
    squares = squared_distances(sites)
    yield Step(
        f"{name}: {n} sites are an α-lattice for every κ <= √2, as squared distances are 2, of links, or 4 and more",
        all(sum(site) % 2 == 0 for site in sites) and min(squares) == 2 and min(squares - {2}) >= 4,
        evidence=f"squared distances {sorted(squares)} in units of d²/2",
    )
    yield Step(
        f"{name}: no two of its {len(links)} links cross", crossing(sites, links) == 0, evidence="all pairs tried"
    )
    found: Any = kuratowski(n, links)
    part = [tuple(sorted(link)) for link in found.links.tolist()]
    yield Step(
        f"{name}: a subdivision of {found.kind} is among its links, so that its graph is not planar",
        set(part) <= set(links) and len(set(part)) == len(part) and is_subdivided(found.kind, part),
        evidence=f"corners {list(found.corners)}, links {part}",
    )


def _steps() -> Iterator[Step]:
    yield Step(
        "K5 is not planar: it would have 2 - 5 + 10 = 7 faces of three sides or more, and 10 links have 20 sides",
        3 * (2 - 5 + 10) > 2 * 10,
        r"n - e + f = 2,\ 3f \le 2e",
    )
    yield Step(
        "K3,3 is not planar: without triangles, 2 - 6 + 9 = 5 faces would have four sides or more, and 9 links have 18",
        4 * (2 - 6 + 9) > 2 * 9,
        r"n - e + f = 2,\ 4f \le 2e",
    )
    yield from _counterexample(STAR, "site and neighbours")
    n, links = len(STAR), len(links_of(STAR))
    yield Step(
        f"site and neighbours: {links} links are more than 3n - 6 = {planar_bound(n)}",
        links > planar_bound(n),
        found={"neighbours": str(n - 1)},
    )
    yield from _counterexample(EIGHT, "eight sites")
    n, links = len(EIGHT), len(links_of(EIGHT))
    yield Step(
        f"{n} sites have {links} links, within 3n - 6 = {planar_bound(n)}: their count does not tell",
        links < planar_bound(n) and n == _LARGEST + 1,
        found={"fragment": str(n)},
    )
    for size in range(1, _LARGEST):
        known = shapes(size)
        yield Step(
            f"there are {len(known)} shapes of {size} connected sites up to symmetry; their images are all fragments",
            sum(known.values()) == sum(1 for _ in fragments(size)),
            evidence=f"{sum(known.values())} up to translation, as many as Redelmeier's algorithm finds",
        )
    graphs = {links_of(sites) for sites in grown(shapes(_LARGEST - 1))}
    yield Step(
        f"every connected fragment of {_LARGEST} sites has a planar graph, and so have smaller ones, as parts",
        all(embeds(_LARGEST, links) for links in graphs),
        evidence=f"{len(graphs)} graphs, with embeddings whose faces satisfy Euler's formula",
        found={"planar up to": str(len(next(iter(shapes(_LARGEST - 1)))) + 1)},
    )


PROOF = Proof(
    id="nonplanar-fcc",
    title="Erratum E5: α-lattices in space need not have planar graphs",
    statement=(
        f"A face-centred cubic site and its {SIZES['neighbours']} neighbours, and a fragment of {SIZES['fragment']} "
        "sites, are α-lattices in space for every 1 < κ <= √2 whose links do not cross and whose graphs are not planar."
        f" {SIZES['fragment']} is the least: the graph of every connected face-centred cubic fragment of "
        f"{SIZES['planar up to']} sites or fewer is planar."
    ),
    hypotheses="links are the pairs closer than r = κd; cited: Euler's formula for plane graphs",
    rigour="symbolic",
    theorems=("E5",),
    steps=_steps,
    size=17,
    values=SIZES,
)
