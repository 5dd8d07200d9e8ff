"""A false claim of one's own, and a counterexample that several tests read."""

from dataclasses import replace

import numpy as np
import pytest

from flockana import falsify, scenario
from flockana.theorems import Hypothesis, Theorem
from flockana.theorems.claims import judged
from flockana.theorems.enclosure import Enclosure

HEAD_ON = scenario("head-on")
THREE_AT_REST = replace(scenario("three-agents-1d"), p0=np.zeros((3, 1)))


def fast(run, tolerances):
    """The last agent never moves faster than 10 in the first second: false, and with a slope."""
    q, speed = run.run.q, float(np.abs(run.run.p).max())
    unmet = Hypothesis("agent 0 starts left of 1", "met" if q[0, 0, 0] < 1.0 else "unmet", 1.0 - q[0, 0, 0])
    return [unmet], [judged("slow", Enclosure.of(35.0 - speed), [unmet])]


OWN = Theorem("slow", "Agents are slow", "No agent ever moves faster than 35, " * 2, "ours", "trajectory", fast)


@pytest.fixture(scope="session")
def collision():
    return falsify("collision-energy", HEAD_ON, claim="twice", budget=60)
