"""Scenarios of links kept by tension: a chain with outer agents moving out, and two unlinked pairs."""

import numpy as np

from flockana.scenarios.one_start import RANGE, LawEntry, net_of
from flockana.scenarios.scenario_builders import Builder, Scenario, vacuous, verified
from flockana.sources.zavlanos_2007.laws import LinkKeeping

_REFERENCES = ("zavlanos-2007", "ji-egerstedt-2007")


def _chain(seed: int = 0) -> Scenario:
    """Return the scenario of six agents linked in a chain, the outer ones moving outwards."""
    q = np.array([[0.0, 0.0], [0.6, 0.1], [1.2, 0.0], [1.8, 0.1], [2.4, 0.0], [3.0, 0.1]])
    p = np.array([[-1.5, 0.4], [0.0, -0.6], [0.2, 0.5], [0.1, -0.5], [-0.3, 0.6], [1.5, -0.4]])
    title = "A chain of six agents, thrown apart, that stays connected"
    source_text = (
        "Ours: six agents 0.6 apart in a chain of links of range r = 1, the outer ones flung outwards at 1.5, k = c = "
        "1. The start is fixed."
    )
    law = LinkKeeping(tuple((i, i + 1) for i in range(5)))
    expected = verified("links-kept")
    return Scenario("links-kept", title, source_text, law, q, p, (0.0, 6.0), seed, expected, references=_REFERENCES)


def _pairs(seed: int = 0) -> Scenario:
    """Return the scenario of two pairs of linked agents, not linked to each other, that move apart."""
    q = np.array([[0.0, 0.0], [0.5, 0.0], [0.0, 0.9], [0.5, 0.9]])
    p = np.array([[0.3, -1.0], [-0.3, -1.0], [0.3, 1.0], [-0.3, 1.0]])
    title = "Two linked pairs without a link between them: they separate"
    source_text = (
        "Ours: two pairs of linked agents within r = 1 of each other, but not linked, that leave each other at 2; k = "
        "c = 1. The start is fixed."
    )
    law = LinkKeeping(((0, 1), (2, 3)))
    expected = verified("links-kept") | vacuous("links-kept:connected")
    return Scenario("links-parted", title, source_text, law, q, p, (0.0, 4.0), seed, expected, references=_REFERENCES)


SCENARIOS: dict[str, Builder] = {"links-kept": _chain, "links-parted": _pairs}


ONE_START = (
    LawEntry(
        "Links kept",
        lambda q, p: LinkKeeping(net_of(q), r=RANGE),
        "links-kept",
        "a tension without bound at r: no link reaches it, so that a connected net stays connected; nothing keeps "
        "agents apart, and here they meet",
    ),
)
