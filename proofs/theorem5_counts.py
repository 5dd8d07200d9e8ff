"""Theorem 5(ii) and (iii), and erratum E6: how many links an α-lattice has, and that it is complete only if small.

Hexagonal sites are whole pairs (x, y) at distance √(x² + xy + y²), in units of d: whole numbers decide every link.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product

import sympy as sp
import z3

from flockana.lattice import harborth, planar_bound
from proofs.proof import Proof, Step
from proofs.smt import implication

Site = tuple[int, int]
_TURN = ((1, 0), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -1))  # steps to the six neighbours, counter-clockwise
_MOST = 60
_LESS = 6  # than 3n: the links of a net of the plane that do not cross


def equidistant_gram(size: int) -> sp.Matrix:
    """Inner products of the differences x_i - x_0 to `size` points that all are d apart, from the distances alone."""
    d = sp.Symbol("d", positive=True)
    return d**2 / 2 * (sp.eye(size) + sp.ones(size, size))


def cayley_menger(points: int) -> sp.Expr:
    """The Cayley-Menger determinant of points that all are d apart."""
    square = sp.Symbol("d", positive=True) ** 2
    inner = square * (sp.ones(points, points) - sp.eye(points))
    border = sp.Matrix.hstack(sp.ones(points, 1), inner)
    return sp.Matrix.vstack(sp.Matrix([[0] + [1] * points]), border).det()


def spiral(n: int) -> tuple[Site, ...]:
    """The first n sites of a hexagonal spiral: shell after shell, each without a gap."""
    sites, shell = [(0, 0)], 0
    while len(sites) < n:
        shell += 1
        x, y = shell, 0
        for dx, dy in (*_TURN[2:], *_TURN[:2]):
            for _ in range(shell):
                x, y = x + dx, y + dy
                sites.append((x, y))
    return tuple(sites[:n])


def squared_distances(sites: tuple[Site, ...]) -> list[int]:
    """Of all pairs, in units of d²."""
    differences = [(a - x, b - y) for (a, b), (x, y) in combinations(sites, 2)]
    return [x * x + x * y + y * y for x, y in differences]


def _not_complete() -> Iterator[Step]:
    d = sp.Symbol("d", positive=True)
    for m in (1, 2, 3):
        x = sp.Matrix(m + 1, m, sp.symbols(f"x_1:{m * (m + 1) + 1}"))
        yield Step(
            f"(iii), m = {m}: the inner products of any {m + 1} vectors form a singular matrix",
            sp.expand((x * x.T).det()) == 0,
            r"\det\big(\langle x_i - x_0, x_j - x_0\rangle\big)_{i,j = 1 \ldots m+1} = 0",
        )
        yield Step(
            f"(iii), m = {m}: of {m + 2} points all d apart it would be regular: no such points exist",
            sp.expand(equidistant_gram(m + 1).det() - (m + 2) * (d**2 / 2) ** (m + 1)) == 0,
            r"\det \tfrac{d^2}{2}(I + \mathbf{1}\mathbf{1}^\top) = (m+2)\left(\tfrac{d^2}{2}\right)^{m+1} > 0",
        )
        yield Step(
            f"(iii), m = {m}: the same by the Cayley-Menger determinant of {m + 2} points, which is not 0 either",
            sp.expand(cayley_menger(m + 2) - (-1) ** m * (m + 2) * d ** (2 * m + 2)) == 0,
            r"(-1)^{m}(m+2)\, d^{2(m+1)} \ne 0",
        )
    root = sp.sqrt
    simplex = sp.Matrix([[0, 0, 0], [1, 0, 0], [sp.Rational(1, 2), root(3) / 2, 0]])
    simplex = simplex.col_join(sp.Matrix([[sp.Rational(1, 2), root(3) / 6, root(6) / 3]]))
    distances = [(simplex.row(i) - simplex.row(j)).norm() for i, j in combinations(range(4), 2)]
    yield Step(
        "(iii) needs n > m + 1: two, three and four agents at the corners of a simplex are a complete α-lattice",
        all(sp.simplify(length) == 1 for length in distances),
    )


def planar(text: str, bound: int, *given: z3.BoolRef) -> Step:
    """The step from Euler's formula that a drawing without crossings has at most 3n - `bound` links."""
    n, links, faces, parts = z3.Reals("n links faces components")
    euler = (n - links + faces == 1 + parts, parts >= 1, 3 * faces <= 2 * links)
    return implication(
        text, links <= 3 * n - bound, *euler, *given, latex=r"n - e + f = 1 + c,\ 3f \le 2e \implies e \le 3n - 6"
    )


def _planar_bound() -> Iterator[Step]:
    yield planar("(ii): two links or more, so that each face has three sides or more: at most 3n - 6 links", _LESS)
    n, links = z3.Reals("n links")
    yield implication("(ii): one link or none: likewise, as n >= 3", links <= 3 * n - _LESS, n >= 3, links <= 1)
    yield Step(
        "E6: the printed bound fails for n = 1 (0 > -3) and n = 2 (1 > 0)",
        all(len([s for s in squared_distances(spiral(n)) if s == 1]) > 3 * n - _LESS for n in (1, 2)),
        evidence="one agent has no link; two at distance d have one",
    )
    yield Step(
        "it is met by three agents d apart",
        squared_distances(spiral(3)) == [1, 1, 1] and planar_bound(3) == 3 * 3 - _LESS,
    )


def _harborth() -> Iterator[Step]:
    x, y = z3.Reals("x y")
    yield implication(
        "hexagonal sites closer than √3 differ by 0 or ±1 in x and in y",
        z3.And(x**2 < 4, y**2 < 4),
        x**2 + x * y + y**2 < 3,
    )
    yield Step(
        "and then they are d apart: no others are links for κ <= √3",
        {x * x + x * y + y * y for x, y in product((-1, 0, 1), repeat=2)} == {0, 1, 3},
    )
    found = {n: squared_distances(spiral(n)) for n in range(1, _MOST + 1)}
    yield Step(
        f"hexagonal spirals of 1 to {_MOST} agents are α-lattices for every κ <= √3",
        all({s for s in squares if s < 3} <= {1} for squares in found.values()),
        evidence="no squared distance is 0 or 2",
    )
    yield Step(
        f"they have ⌊3n - √(12n - 3)⌋ links, every n from 1 to {_MOST}",
        all(squares.count(1) == harborth(n) for n, squares in found.items()),
        r"\lfloor 3n - \sqrt{12n - 3} \rfloor",
        "counted in whole numbers",
        {"most": str(max(found))},
    )
    k = sp.Symbol("k", integer=True, nonnegative=True)
    n = 3 * k**2 + 3 * k + 1
    yield Step(
        "so has every full hexagon, k shells: n sites on 2k + 1 lines of each of three directions have 3(n - (2k + 1))",
        sp.expand(12 * n - 3 - (6 * k + 3) ** 2) == 0 and sp.expand(3 * (n - 2 * k - 1) - (3 * n - (6 * k + 3))) == 0,
        r"12n - 3 = (6k+3)^2,\quad 3\big(n - (2k+1)\big) = 3n - \sqrt{12n - 3}",
    )
    yield Step(
        "the count on lines agrees with the sites for k = 0 to 6",
        all(
            len(sites) == 1 or squared_distances(sites).count(1) == 9 * j**2 + 3 * j
            for j, sites in ((j, spiral(3 * j**2 + 3 * j + 1)) for j in range(7))
        ),
    )
    n, root = z3.Reals("n √(12n-3)")
    yield implication(
        "⌊3n - √(12n - 3)⌋ is less than 3n - 6 from n = 4 on: there 3n - 6 is not sharp",
        root > 6,
        *(n >= 4, root >= 0, root**2 == 12 * n - 3),
    )


def _steps() -> Iterator[Step]:
    yield from _not_complete()
    yield from _planar_bound()
    yield from _harborth()


PROOF = Proof(
    id="theorem5-counts",
    title="Theorem 5(ii), (iii) and erratum E6: how many links an α-lattice has",
    statement=(
        f"A net of the plane whose links do not cross has at most 3n - {_LESS} links if n >= 3; as printed, without a "
        "condition on n, the bound fails for n = 1 and 2. Hexagonal spirals have ⌊3n - √(12n - 3)⌋ links for n = 1 to "
        f"{_MOST}, and so has every full hexagon. No α-lattice of n > m + 1 agents is complete, m = 1, 2, 3."
    ),
    hypotheses=(
        "links of an α-lattice do not cross (theorem5-crossings); cited, not proved: Euler's formula for plane graphs, "
        "and Harborth's theorem that no α-lattice of the plane has more than ⌊3n - √(12n - 3)⌋ links"
    ),
    rigour="smt",
    theorems=("os-5", "os-5-terminal", "E6"),
    steps=_steps,
    size=21,
    values={"most": str(_MOST)},
)
