"""Scenarios of Tanner, Jadbabaie and Pappas: a fixed wheel, and proximity nets that hold or part."""

import numpy as np

from flockana.interactions.log_potential import LogPotential
from flockana.lattice.builders import hexagonal_spiral
from flockana.laws.tanner import FixedNetFlocking, ProximityFlocking
from flockana.scenarios.expected import inconclusive, vacuous, verified
from flockana.scenarios.scenario import Scenario

_REFERENCES = ("tanner-2007", "flockana")


def _fixed(seed: int = 0) -> Scenario:
    generator, n = np.random.default_rng(seed), 7
    angle = np.pi * np.arange(6) / 3.0
    q = np.concatenate([np.zeros((1, 2)), np.stack([np.cos(angle), np.sin(angle)], axis=1)])
    q += generator.uniform(-0.1, 0.1, (n, 2))
    return Scenario(
        "tanner-fixed",
        "Seven agents in a fixed net: a hub and a ring",
        "Ours, on the theorem for fixed networks: V = 1/s² + log s² as the paper's example, seven agents, a hub "
        "joined to a ring of six, coordinates displaced by up to 0.1 from a hexagon of radius 1, "
        "velocities uniform in [-0.3, 0.3]².",
        FixedNetFlocking((*((0, k) for k in range(1, n)), *((k, 1 + k % 6) for k in range(1, n)))),
        q,
        generator.uniform(-0.3, 0.3, (n, 2)),
        (0.0, 20.0),
        seed,
        verified("tanner-fixed:energy", "tanner-fixed:no-collision"),
        options={"rtol": 1e-9, "t_eval": np.linspace(0.0, 20.0, 401)},
        shipped=verified("tanner-fixed"),
        references=_REFERENCES,
    )


def _switching(seed: int = 0) -> Scenario:
    generator, n = np.random.default_rng(seed), 5
    return Scenario(
        "tanner-switching",
        "Five agents in a net of proximity that stays connected",
        "Ours, on the theorem for switching networks: V = 10 (1/s² + log s²) below R = 1.6, five agents beside a "
        "lattice, each coordinate displaced by up to 0.05, velocities uniform in [1, 2] × [-0.5, 0.5].",
        ProximityFlocking(LogPotential(10.0, 1.0), r=1.6, k2=2.0),
        hexagonal_spiral(n, 1.0) + generator.uniform(-0.05, 0.05, (n, 2)),
        generator.uniform((1.0, -0.5), (2.0, 0.5), (n, 2)),
        (0.0, 10.0),
        seed,
        # where forces jump no proof says that they die out
        verified("tanner-switching:energy", "tanner-switching:no-collision")
        | inconclusive("tanner-switching:critical"),
        options={"rtol": 1e-9, "t_eval": np.linspace(0.0, 10.0, 401)},
        shipped=inconclusive("tanner-switching") | verified("tanner-switching:velocities"),
        references=_REFERENCES,
    )


def _parting(seed: int = 0) -> Scenario:
    return Scenario(
        "tanner-switching-parts",
        "Two agents whose net breaks: the theorem says nothing",
        "Ours: two agents at the distance d that leave each other at 10, four times what V(R) could hold. Fixed start.",
        ProximityFlocking(),
        np.array([[0.0, 0.0], [1.0, 0.0]]),
        np.array([[-5.0, 0.0], [5.0, 0.0]]),
        (0.0, 2.0),
        seed,
        vacuous("tanner-switching"),
        references=_REFERENCES,
    )


SCENARIOS = {"tanner-fixed": _fixed, "tanner-switching": _switching, "tanner-switching-parts": _parting}
