"""Scenarios of first-order consensus: balanced and unbalanced nets, a leader, and two groups."""

import numpy as np

from flockana.laws.scheduled_laws import VelocityInTurn
from flockana.scenarios.scenario_builders import Builder, Start, Status, entry, vacuous, verified
from flockana.sources.olfati_saber_murray_2004.laws import AverageConsensus

_NAMES = tuple(f"average-consensus:{part}" for part in ("agreement", "average", "some-start", "decay", "steps"))
_AVERAGE = verified("average-consensus", *_NAMES) | vacuous(_NAMES[2])
_LENGTHS = (0.3, 0.8, 0.5)  # for which nets act in turn
_OTHER = verified("average-consensus", *_NAMES) | vacuous(_NAMES[1], _NAMES[3])


def _net(name: str, title: str, nets: list[np.ndarray], expected: dict[str, Status]) -> Builder:
    """Return the builder of a scenario of consensus on one or several nets, with agents at random in a plane."""
    laws = [AverageConsensus(weights) for weights in nets]
    law = laws[0] if len(nets) == 1 else VelocityInTurn(laws, _LENGTHS)

    def draw(seed: int) -> Start:
        return law.start(0.0, np.random.default_rng(seed).uniform(-1.0, 1.0, (len(nets[0]), 2)))

    source_text = "Ours, on Olfati-Saber and Murray: q' = -Lq from random places."
    references = ("olfati-saber-murray-2004", "flockana")
    return entry(name, title, source_text, law, draw, 20.0, expected, references=references)


_RING = np.roll(np.eye(4), 1, axis=1)
_UNEVEN = np.array([[0.0, 2.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
_PARTED = np.kron(np.eye(2), np.ones((2, 2)) - np.eye(2))
_TURNED = [0, 2, 1, 3]
SCENARIOS = {
    "average-ring": _net("average-ring", "A directed ring of four averages", [_RING], _AVERAGE),
    "average-weighted": _net("average-weighted", "Three agents that weigh their start", [_UNEVEN], _OTHER),
    "average-leader": _net("average-leader", "A chain of four that comes to its leader", [np.eye(4, k=-1)], _OTHER),
    "average-parted": _net("average-parted", "Two pairs keep two averages", [_PARTED], vacuous("average-consensus")),
    "average-switching": _net(
        "average-switching",
        "Three balanced rings of four in turn",
        [_RING, 2.0 * _RING.T, _RING[_TURNED][:, _TURNED]],
        verified("average-switching", "average-switching:average", "average-switching:decay"),
    ),
    "average-switching-uneven": _net(
        "average-switching-uneven",
        "Rings in turn, one of them uneven",
        [_RING, _RING + np.eye(4, k=2), _RING.T],
        vacuous("average-switching"),
    ),
}
