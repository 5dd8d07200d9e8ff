"""Catalogue entries: scenario builders and expected statuses: ``verified("os-3:i") | refuted("E11")``."""

from collections.abc import Callable
from typing import Any

from flockana.base.value_checks import FloatArray
from flockana.scenarios.scenario import OURS as OURS
from flockana.scenarios.scenario import Report as Report
from flockana.scenarios.scenario import Scenario as Scenario
from flockana.theorems import Status as Status

Start = tuple[FloatArray, FloatArray]  # positions and velocities
Builder = Callable[..., Scenario]


def entry(
    name: str,
    title: str,
    source: str,
    law: Any,
    draw: Callable[[int], Start],
    end: float,
    expected: dict[str, Status],
    reports: tuple[Report, ...] = (),
    **fields: Any,
) -> Builder:
    """Return a function of a seed that builds a scenario from time 0; the start alone depends on the seed."""

    def build(seed: int = 0) -> Scenario:
        return Scenario(name, title, source, law, *draw(seed), (0.0, end), seed, expected, reports, **fields)

    return build


def verified(*ids: str) -> dict[str, Status]:
    """Return a mapping of theorem and claim ids to the expected status `verified`."""
    return dict.fromkeys(ids, "verified")


def refuted(*ids: str) -> dict[str, Status]:
    """Return a mapping of theorem and claim ids to the expected status `refuted`."""
    return dict.fromkeys(ids, "refuted")


def vacuous(*ids: str) -> dict[str, Status]:
    """Return a mapping of theorem and claim ids to the expected status `vacuous`."""
    return dict.fromkeys(ids, "vacuous")


def inconclusive(*ids: str) -> dict[str, Status]:
    """Return a mapping of theorem and claim ids to the expected status `inconclusive`."""
    return dict.fromkeys(ids, "inconclusive")
