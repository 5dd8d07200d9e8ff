"""Scenarios of Tanner, Jadbabaie and Pappas: a fixed wheel, and proximity nets that hold or split."""

from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.interactions import AlphaInteraction
from flockana.lattice.builders import hexagonal_spiral
from flockana.scenarios.one_start import RANGE, LawEntry, net_of
from flockana.scenarios.scenario_builders import Scenario, Status, inconclusive, vacuous, verified
from flockana.sources.tanner_2007.interactions import LogPotential
from flockana.sources.tanner_2007.laws import FixedNetFlocking, ProximityFlocking


def _scenario(
    name: str,
    text: tuple[str, str],
    law: FixedNetFlocking | ProximityFlocking,
    q: FloatArray,
    p: FloatArray,
    end: float,
    seed: int,
    expected: dict[str, Status],
    **fields: Any,
) -> Scenario:
    options = {"rtol": 1e-9, "t_eval": np.linspace(0.0, end, 401)}
    fields = {"options": options, "references": ("tanner-2007", "flockana")} | fields
    return Scenario(name, *text, law, q, p, (0.0, end), seed, expected, **fields)


def _fixed(seed: int = 0) -> Scenario:
    generator, n = np.random.default_rng(seed), 7
    angle = np.pi * np.arange(6) / 3.0
    q = np.concatenate([np.zeros((1, 2)), np.stack([np.cos(angle), np.sin(angle)], axis=1)])
    q += generator.uniform(-0.1, 0.1, (n, 2))
    p = generator.uniform(-0.3, 0.3, (n, 2))
    text = (
        "Seven agents in a fixed net: a hub and a ring",
        "Ours, on the theorem for fixed networks: V = 1/s² + log s² as the paper's example, seven agents, a hub "
        "joined to a ring of six, coordinates displaced by up to 0.1 from a hexagon of radius 1, "
        "velocities uniform in [-0.3, 0.3]².",
    )
    law = FixedNetFlocking((*((0, k) for k in range(1, n)), *((k, 1 + k % 6) for k in range(1, n))))
    expected, shipped_statuses = verified("tanner-fixed:energy", "tanner-fixed:no-collision"), verified("tanner-fixed")
    return _scenario("tanner-fixed", text, law, q, p, 20.0, seed, expected, shipped=shipped_statuses)


def _switching(seed: int = 0) -> Scenario:
    generator, n = np.random.default_rng(seed), 5
    text = (
        "Five agents in a net of proximity that stays connected",
        "Ours, on the theorem for switching networks: V = 10 (1/s² + log s²) below R = 1.6, five agents beside a "
        "lattice, each coordinate displaced by up to 0.05, velocities uniform in [1, 2] × [-0.5, 0.5].",
    )
    law = ProximityFlocking(LogPotential(10.0, 1.0), r=1.6, k2=2.0)
    q = hexagonal_spiral(n, 1.0) + generator.uniform(-0.05, 0.05, (n, 2))
    p = generator.uniform((1.0, -0.5), (2.0, 0.5), (n, 2))
    expected = verified("tanner-switching:energy", "tanner-switching:no-collision")
    expected |= inconclusive("tanner-switching:critical")  # where forces jump no proof says that they die out
    shipped_statuses = inconclusive("tanner-switching") | verified("tanner-switching:velocities")
    return _scenario("tanner-switching", text, law, q, p, 10.0, seed, expected, shipped=shipped_statuses)


def _parting(seed: int = 0) -> Scenario:
    text = (
        "Two agents whose net breaks: the theorem says nothing",
        "Ours: two agents at the distance d that leave each other at 10, four times what V(R) could hold. Fixed start.",
    )
    q, p = np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([[-5.0, 0.0], [5.0, 0.0]])
    expected = vacuous("tanner-switching")
    return _scenario("tanner-switching-parts", text, ProximityFlocking(), q, p, 2.0, seed, expected, options={})


SCENARIOS = {"tanner-fixed": _fixed, "tanner-switching": _switching, "tanner-switching-parts": _parting}


_STRENGTH, _CONSENSUS = 40.0, 1.0  # of forces of the size of k/d near d
ONE_START = (
    LawEntry(
        "Tanner, fixed net",
        lambda q, p: FixedNetFlocking(net_of(q), LogPotential(_STRENGTH, AlphaInteraction().d), k2=_CONSENSUS),
        "tanner-fixed",
        "the links of the start pull at all times: velocities agree, and no two linked agents collide",
    ),
    LawEntry(
        "Tanner, switching",
        lambda q, p: ProximityFlocking(LogPotential(_STRENGTH, AlphaInteraction().d), r=RANGE, k2=_CONSENSUS),
        "tanner-switching",
        "only agents within r pull: the same holds if the net stays connected",
    ),
)
