"""Scenarios of formations by distances: near, far, and on a line."""

import numpy as np

from flockana.lattice import hexagonal_patch
from flockana.scenarios.scenario_builders import Builder, Start, Status, entry, vacuous, verified
from flockana.sources.krick_2009.laws import DistanceFormation

_TRIANGLE = ((0, 1), (1, 2), (0, 2))
_FREE = vacuous("distance-formation:collinear")
_REACHED = _FREE | verified("distance-formation", "distance-formation:formation", "distance-formation:nearby")
_OPEN = verified("distance-formation") | vacuous("distance-formation:formation", "distance-formation:nearby")


def _formation(name: str, title: str, law: DistanceFormation, places: object, expected: dict[str, Status]) -> Builder:
    """Return the builder of a scenario in which a formation starts from given positions."""
    source_text = "Ours, on Krick, Broucke and Francis: formation by squared lengths, k = 1. The start is fixed."
    q = np.array(places, dtype=float)

    def draw(seed: int) -> Start:
        return law.start(0.0, q)

    return entry(name, title, source_text, law, draw, 20.0, expected, references=("krick-2009", "flockana"))


_PATCH = hexagonal_patch(1, 1.0)[:4]
_RHOMB = tuple((i, j) for i in range(4) for j in range(i) if np.linalg.norm(_PATCH[i] - _PATCH[j]) < 1.1)
_LINE = [[0.0, 0.0], [0.9, 0.0], [2.0, 0.0]]
SCENARIOS = {
    "formation-near": _formation(
        "formation-near", "A triangle near its lengths", DistanceFormation(_TRIANGLE), [[0, 0], [1.1, 0], [0.5, 0.9]],
        _REACHED,
    ),
    "formation-rhomb": _formation(
        "formation-rhomb", "Two triangles on an edge, near their lengths", DistanceFormation(_RHOMB), 1.02 * _PATCH,
        _REACHED,
    ),
    "formation-far": _formation(
        "formation-far", "A triangle far from its lengths", DistanceFormation(_TRIANGLE), [[0, 0], [3, 0], [0.2, 0.4]],
        _OPEN | _FREE,
    ),
    "formation-line": _formation(
        "formation-line", "Lengths 1, 1 and 2 on a line", DistanceFormation(_TRIANGLE, (1.0, 1.0, 2.0)), _LINE,
        _OPEN,
    ),
}  # fmt: skip
