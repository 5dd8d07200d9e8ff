"""Erratum E6: 3n − 6 needs three agents, and is not sharp."""

from __future__ import annotations

from flockana.lattice import harborth, hexagonal_spiral, links
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge

_MOST = 60
_D, _R = 7.0, 8.4
_PROOF = "theorem5-counts"


def link_counts() -> dict[int, tuple[int, int, int]]:
    """Links of the hexagonal spiral of n agents, 3n − 6, and ⌊3n − √(12n − 3)⌋, for n = 1 … 60.

    Examples
    --------
    >>> link_counts()[2], link_counts()[19]
    ((1, 0, 1), (42, 51, 42))
    """
    counts = {n: len(links(hexagonal_spiral(n, _D), _R)) for n in range(1, _MOST + 1)}
    return {n: (found, 3 * n - 6, harborth(n)) for n, found in counts.items()}


def _check(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    table = link_counts()
    exceeding = [n for n, (found, printed, _) in table.items() if found > printed]
    slack = min(table[n][1] - table[n][0] for n in range(3, _MOST + 1))
    off = [n for n, (found, _, sharp) in table.items() if found != sharp]
    return [], [
        Claim(
            "printed",
            judge(0.5 - len(exceeding), 0.0, []),
            computed=table[2][0],
            stated=table[2][1],
            margin=0.5 - len(exceeding),
            error=0.0,
            witness={"n": exceeding},
            proof=_PROOF,
            detail="two agents at distance d have 1 link; 3n - 6 is 0",
        ),
        Claim(
            "corrected",
            judge(slack + 0.5, 0.0, []),
            computed={n: (found, printed) for n, (found, printed, _) in table.items() if n >= 3},
            stated="at most 3n - 6 links for n >= 3",
            margin=slack + 0.5,
            error=0.0,
            witness={"n with 3n - 6 links": [n for n in range(3, _MOST + 1) if table[n][0] == table[n][1]]},
            proof=_PROOF,
            detail=f"hexagonal spirals of 3 to {_MOST} agents have at most 3n - 6 links, and that many only if n = 3",
        ),
        Claim(
            "sharp",
            judge(0.5 - len(off), 0.0, []),
            computed={n: (found, sharp) for n, (found, _, sharp) in table.items()},
            stated="floor(3n - sqrt(12n - 3)) links",
            margin=0.5 - len(off),
            error=0.0,
            witness={"n": off},
            proof=_PROOF,
            detail=f"hexagonal spirals of 1 to {_MOST} agents have Harborth's number of links, every one",
        ),
    ]


THEOREM = Theorem(
    id="E6",
    title="At most 3n − 6 links, for three agents or more",
    statement=(
        "Theorem 5(ii) is printed without a condition on n, and fails for n = 2 (1 link, 3n - 6 = 0). It holds for "
        "n >= 3; the sharp bound ⌊3n - √(12n - 3)⌋ (Harborth) holds for every n and is reached by hexagonal spirals."
    ),
    source="Lecture slides, Theorem 5",
    kind="fixed",
    check=_check,
    references=("geschwender-2016", "olfati-saber-2006", "harborth-1974"),
    expected={"E6": "refuted", "E6:printed": "refuted", "E6:corrected": "verified", "E6:sharp": "verified"},
)
