"""Erratum E6: 3n − 6 bounds the links of three agents or more only, and is not sharp."""

from flockana.lattice import harborth, hexagonal_spiral, links
from flockana.theorems.theorem_toolkit import Claim, Tolerances, by_count, counted, erratum

_MOST = 60
_D, _R = 7.0, 8.4
_PROOF = "theorem5-counts"


def link_counts() -> dict[int, tuple[int, int, int]]:
    """Return link counts of the hexagonal spiral, 3n − 6, and ⌊3n − √(12n − 3)⌋, for n = 1 … 60."""
    counts = {n: len(links(hexagonal_spiral(n, _D), _R)) for n in range(1, _MOST + 1)}
    return {n: (count, 3 * n - 6, harborth(n)) for n, count in counts.items()}


@erratum(
    "E6",
    references=("geschwender-2016", "olfati-saber-2006", "harborth-1974"),
    expected={"refuted": "printed", "verified": "corrected sharp"},
    ours=("sharp",),
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Theorem 5(ii) is printed without a condition on n, and fails for n = 2 (1 link, 3n - 6 = 0). It holds for n >= 3;
    the sharp bound ⌊3n - √(12n - 3)⌋ (Harborth) holds for every n and is reached by hexagonal spirals.
    """
    table = link_counts()
    exceeding = [n for n, (count, printed, _) in table.items() if count > printed]
    count, printed, _ = min((table[n] for n in range(3, _MOST + 1)), key=lambda row: row[1] - row[0])
    failures = [n for n, (count, _, sharp_bound) in table.items() if count != sharp_bound]
    return [
        by_count("printed", len(exceeding), about="all", disproof=_PROOF, computed=table[2][0]).described(
            stated=table[2][1], witness={"n": exceeding}, detail="two agents at distance d have 1 link; 3n - 6 is 0"
        ),
        counted("corrected", printed, count, count, about="all", proof=_PROOF).described(
            computed={n: (count, printed) for n, (count, printed, _) in table.items() if n >= 3},
            stated="at most 3n - 6 links for n >= 3",
            witness={"n with 3n - 6 links": [n for n in range(3, _MOST + 1) if table[n][0] == table[n][1]]},
            detail=f"hexagonal spirals of 3 to {_MOST} agents have at most 3n - 6 links, and that many only if n = 3",
        ),
        by_count("sharp", len(failures), proof=_PROOF).described(
            computed={n: (count, sharp_bound) for n, (count, _, sharp_bound) in table.items()},
            stated="floor(3n - sqrt(12n - 3)) links",
            witness={"n": failures},
            detail=f"hexagonal spirals of 1 to {_MOST} agents have Harborth's number of links, every one",
        ),
    ]
