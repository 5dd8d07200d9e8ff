"""Laws with another force, targets that declare what is not so, and laws at odds with a theorem."""

from functools import cache

import numpy as np
import pytest

from flockana import Algorithm3, DeadZoneFlocking, MinimalFlocking, theorem, theorems, verify
from flockana.environment.targets import CallableTarget, StaticTarget
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from tests.adversarial.cases import Case, hold

ORIGIN = StaticTarget((0.0, 0.0))
APART, STILL = np.array([[0.0, 0.0], [8.0, 0.0]]), np.zeros((2, 2))
ON_RUNS = [name for name in theorems() if theorem(name).kind == "trajectory"]


def pushed(law, **options):
    """A law that descends from this one, with another force."""
    flow = {"flow": lambda self, t, q, p: (law.flow(self, t, q, p)[0] + 1.0, 1.0)}
    return type("Pushed", (law,), flow)(**options)


PAIRS = "energy", "collision-energy", "linearised-decay-terminal"
PUSHED = {
    pushed(Algorithm1): ("os-1", "lattice-limit-printed", *PAIRS),
    pushed(Algorithm2, target=ORIGIN): ("os-3", "E11", "E12", "E13", *PAIRS),
    pushed(Algorithm3, target=ORIGIN): ("os-6", "energy", "energy-printed", "linearised-decay-terminal"),
    pushed(DeadZoneFlocking): ("dead-zone-1-printed", "dead-zone-1-corrected"),
    pushed(MinimalFlocking, edges=((0, 1),), spacing=7.0): ("zone-1-printed", "zone-1-corrected"),
}


@cache
def at_rest(law, factor=1.0, until=0.5):
    return Case(law, factor * APART, STILL, until)


@pytest.mark.parametrize(("law", "name"), [(law, name) for law, names in PUSHED.items() for name in names])
def test_a_law_with_another_force_is_another_law(law, name):
    for claim in hold(name, at_rest(law), {}).claims:
        assert claim.status == "vacuous", claim


def consistency(target, until=2.0, time=1.0):
    gains = Gains(30.0 / time**2, 10.0 / time, c1_gamma=1.1 / time**2, c2_gamma=2.0 / time)
    run = Case(Algorithm2(gains=gains, target=target), APART, STILL, until).run
    return next(h.status for h in verify("os-3", run).hypotheses if "dq_r/dt" in h.name)


@pytest.mark.parametrize("time", [1e-6, 1.0, 1e6])
def test_a_smooth_target_is_consistent_in_any_unit_of_time(time):
    """Differences over 10⁻⁵ max(1, |t|) time units see a swing of a microsecond as noise."""
    w = 2.0 / time

    def honest(t):
        return (np.sin(w * t), np.cos(w * t)), (w * np.cos(w * t), -w * np.sin(w * t))

    def lying(t):
        return honest(t)[0], tuple(0.9 * x for x in honest(t)[1])

    assert (
        consistency(CallableTarget(honest, time), 3.0 * time, time) == "assumed"
    )  # for nobody says how fast it changes
    assert consistency(CallableTarget(honest, time, changes_slower_than=0.3 * time), 3.0 * time, time) == "met"
    assert consistency(CallableTarget(lying, time), 3.0 * time, time) == "unmet"


ODD = {
    "c1α = 0": Algorithm1(gains=Gains(c1_alpha=0.0)),
    "c1α = 0 under a γ-agent": Algorithm2(gains=Gains(c1_alpha=0.0), target=ORIGIN),
    "all gains 0": Algorithm2(gains=Gains(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), target=ORIGIN),
    "per agent": Algorithm2(gains=Gains(c1_gamma=(1.0, 2.0), c2_gamma=(1.0, 0.0)), target=ORIGIN),
    "a = b = 5e4": Algorithm2(AlphaInteraction(a=5e4, b=5e4), Gains(1.0, 1.0, 0.0, 0.0, 0.01, 0.01), ORIGIN),
    "no α": DeadZoneFlocking(),
    "a tree": MinimalFlocking(edges=((0, 1),), spacing=1.0),
    "perceived": MinimalFlocking(),
    "a map": MinimalFlocking().discrete(0.1),
    "no obstacles": Algorithm3(gains=Gains(c1_alpha=0.0), target=ORIGIN),
}
SLOW = {(law, "E11") for law in ODD if ODD[law].__class__ is Algorithm2}


@pytest.mark.parametrize(
    ("law", "name"),
    [pytest.param(x, n, marks=pytest.mark.attack if (x, n) in SLOW else ()) for x in ODD for n in ON_RUNS],
)
def test_every_theorem_has_an_answer_for_every_law(law, name):
    for factor in (1.0, 3.0, 0.0):
        if "no α" in law and factor == 0.0:
            continue  # coincident agents are refused at the start there
        hold(name, at_rest(ODD[law], factor, 1.0), {})
