"""What every law keeps: its symmetries, its derivatives and rates, its parameters in files and in other units.

A new law is to be named here: a test fails until it is.
"""

import inspect
import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flockana as fl
from flockana import CuckerSmale, DiscreteLaw, ExplicitEuler, HeadingAveraging, SemiImplicitEuler, TaylorStep
from flockana.base.module_discovery import modules, source_modules
from flockana.base.serialize import from_data, to_data
from flockana.laws.law import LawOfMotion
from flockana.laws.wrapper_base import Wrapper
from flockana.sources.isola_2024.laws import MSNDiscretisation
from flockana.sources.notebook_r2.laws import PushedAlgorithm1, PushedAlgorithm2
from flockana.sources.tanner_2007.laws import FixedNetFlocking, ProximityFlocking
from flockana.sources.zavlanos_2007.laws import LinkKeeping

N, SPREAD, TIME = 9, 12.0, 0.7
ORIGIN = fl.StaticTarget((0.0, 0.0))
ROUND = {"rotation", "reflection"}
PLACED = ROUND | {"permutation"}  # about a γ-agent or an obstacle at the origin
FREE = PLACED | {"translation", "boost"}
AVERAGES = np.random.default_rng(3).dirichlet(np.ones(N), (2, N))

LAWS = {
    "Algorithm1": (fl.Algorithm1(), FREE),
    "Algorithm2": (fl.Algorithm2(target=ORIGIN), PLACED),
    "Algorithm3": (fl.Algorithm3(target=ORIGIN, obstacles=[fl.Sphere((0.0, 0.0), 0.5)]), PLACED),
    "PushedAlgorithm1": (PushedAlgorithm1(min_distance=2.0), FREE),
    "PushedAlgorithm2": (PushedAlgorithm2(target=ORIGIN, min_distance=2.0), PLACED),
    "PeerToPeer": (fl.PeerToPeer(fl.Copies([[0.0, 0.0]] * N, [[0.0, 0.0]] * N, fl.Spring((0.0, 0.0), 1.0))), PLACED),
    "Composition": (
        fl.compose(pair=fl.AlphaInteraction(), consensus=1.0, navigation=ORIGIN, drag=0.2, speed=(1.0, 0.1)),
        PLACED,
    ),
    "CuckerSmale": (CuckerSmale(fl.RationalWeight(strength=2.0, decay=0.5, length=5.0)), FREE),
    "CuckerDong": (fl.CuckerDong(fl.RationalWeight(2.0, 0.5, 5.0), distance=0.1), FREE),
    "MotschTadmor": (fl.MotschTadmor(fl.RationalWeight(decay=0.5, length=5.0), gain=2.0), FREE),
    "SingularAlignment": (fl.SingularAlignment(fl.SingularWeight(2.0, 0.5, 5.0)), FREE),
    "FiniteTimeAlignment": (fl.FiniteTimeAlignment(((0, 1), (1, 2))), {"translation", "boost"}),
    "GaziPassino": (fl.GaziPassino(1.0, 5.0, 20.0), FREE),
    "AverageConsensus": (fl.AverageConsensus(10.0 * AVERAGES[0] * (1.0 - np.eye(N))), ROUND | {"translation", "boost"}),
    "InTurn": (fl.InTurn((fl.Algorithm1(), CuckerSmale(fl.RationalWeight(2.0, 0.5, 5.0))), (0.5, 1.0)), FREE),
    "VelocityInTurn": (fl.VelocityInTurn([fl.GaziPassino(1.0, 5.0, 20.0)] * 2, (0.5, 1.0)), FREE),
    "DistanceFormation": (fl.DistanceFormation(((0, 1), (1, 2), (0, 2)), (3.0, 4.0, 5.0)), FREE - {"permutation"}),
    "CyclicPursuit": (fl.CyclicPursuit(2.0, 20.0), FREE - {"permutation", "reflection"}),
    "FixedNetFlocking": (FixedNetFlocking(((0, 1), (1, 2)), fl.LogPotential(1.0, 5.0)), FREE - {"permutation"}),
    "ProximityFlocking": (ProximityFlocking(fl.LogPotential(1.0, 5.0), r=8.0), FREE),
    "LinkKeeping": (LinkKeeping(((0, 1), (1, 2)), r=60.0), FREE - {"permutation"}),
    "HeadingAveraging": (HeadingAveraging(range=8.0, speed=2.0, dt=0.1, average="vectors"), FREE - {"boost"}),
    "NetAveraging": (fl.NetAveraging(AVERAGES, lengths=(2, 1)), ROUND | {"translation"}),
    "DirectedNet": (fl.DirectedNet(fl.Algorithm1(), view=2.0), FREE - {"boost"}),
    "DeadZoneFlocking": (fl.DeadZoneFlocking(), FREE),
    "LedDeadZoneFlocking": (
        fl.LedDeadZoneFlocking(
            fl.DeadZoneInteraction(ramp=0.1), leaders=(ORIGIN,), group=(0,) * N, pinned=tuple(range(N))
        ),
        PLACED,
    ),
    "ZoneFlocking": (fl.ZoneFlocking(fl.ZoneRadii(1.5, c=3.0, a=8.0)), FREE - {"boost"}),
    "SafetyFilter": (fl.SafetyFilter(fl.Algorithm1(), distance=0.5, acceleration_limit=20.0), FREE),
    "MinimalFlocking": (fl.MinimalFlocking(radius=9.0), FREE),
    "DiscreteMinimalFlocking": (fl.DiscreteMinimalFlocking(fl.MinimalFlocking(radius=9.0), dt=0.1), FREE),
    "MSNDiscretisation": (
        MSNDiscretisation(fl.Algorithm1(), dt=0.01),
        FREE - {"permutation", "boost"},
    ),  # one after another
    "ExplicitEuler": (ExplicitEuler(fl.Algorithm1(), dt=0.01), FREE),
    "SemiImplicitEuler": (SemiImplicitEuler(fl.Algorithm1(), dt=0.01), FREE),
    "TaylorStep": (TaylorStep(fl.Algorithm1(), dt=0.01), FREE),
}


def state(seed):
    """Agents in range of each other, and how to turn, mirror, shift, hasten and rename them."""
    rng = np.random.default_rng(seed)
    q, p = rng.uniform(-SPREAD, SPREAD, (N, 2)), rng.normal(0.0, 2.0, (N, 2))
    angle = rng.uniform(0.3, 2.8)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return q, p, turn, turn @ np.diag([1.0, -1.0]), rng.normal(0.0, 5.0, 2), rng.permutation(N)


def answer(law, q, p, t=TIME):
    """What the law makes of a state: accelerations, or places and velocities after a step."""
    if isinstance(law, DiscreteLaw):
        after = law.step(t, q, p, law.start(q, p))
        return after[0], after[1]
    return None, law.velocity(t, q) if isinstance(law, fl.VelocityLaw) else law.flow(t, q, p)[0]


def off(law, symmetry, seed):
    """How far the law is from commuting with the symmetry, relative to what it does."""
    q, p, turn, mirror, shift, order = state(seed)
    places, rates = answer(law, q, p)
    later = law.dt if isinstance(law, DiscreteLaw) else 0.0
    if symmetry in ROUND:
        matrix = turn if symmetry == "rotation" else mirror
        q2, p2 = q @ matrix.T, p @ matrix.T
        places, rates = None if places is None else places @ matrix.T, rates @ matrix.T
    elif symmetry == "permutation":
        q2, p2 = q[order], p[order]
        places, rates = None if places is None else places[order], rates[order]
    elif symmetry == "translation":
        q2, p2 = q + shift, p
        places = None if places is None else places + shift
    else:
        q2, p2 = q, p + shift
        places = None if places is None else places + shift * later
        rates = rates + shift if places is not None else rates
    there, speeds = answer(law, q2, p2)
    apart = np.abs(speeds - rates).max() / (1.0 + np.abs(rates).max())
    return apart if places is None else max(apart, np.abs(there - places).max() / SPREAD)


def test_every_law_is_here():
    rooms = (*modules("flockana.laws"), *source_modules("laws"))
    kinds = [thing for module in rooms for thing in vars(module).values() if inspect.isclass(thing)]
    laws = {
        k.__name__
        for k in kinds
        if issubclass(k, LawOfMotion) and hasattr(k, "__dataclass_fields__") and not inspect.isabstract(k)
        if not issubclass(k, Wrapper)  # which move as the law within them
    }
    maps = {"ExplicitEuler", "SemiImplicitEuler", "TaylorStep"}  # by the name of the solver
    assert laws | maps == {*LAWS, "NetConsensus"}  # which is of a net of named agents
    assert all(law.title == name for name, (law, _) in LAWS.items())


@pytest.mark.slow
@pytest.mark.parametrize(("law", "symmetry"), [(law, s) for law, (_, has) in LAWS.items() for s in sorted(has)])
@settings(max_examples=10)
@given(st.integers(0, 2**32 - 1))
def test_a_symmetry_holds_for_any_state(law, symmetry, seed):
    assert off(LAWS[law][0], symmetry, seed) <= 1e-9


@pytest.mark.parametrize(("law", "symmetry"), [(law, s) for law, (_, has) in LAWS.items() for s in sorted(FREE - has)])
def test_a_symmetry_that_a_law_lacks_is_seen_to_fail(law, symmetry):
    assert max(off(LAWS[law][0], symmetry, seed) for seed in range(8)) > 1e-4


@pytest.mark.parametrize("name", LAWS)
def test_a_state_that_cannot_be_written_gives_the_same_and_stays_what_it_was(name):
    q, p, *_ = state(3)
    free, frozen = (q.copy(), p.copy()), (q.copy(), p.copy())
    for x in frozen:
        x.flags.writeable = False
    told, again = answer(LAWS[name][0], *free), answer(LAWS[name][0], *frozen)
    assert all(np.array_equal(a, b) for a, b in zip(told, again, strict=True) if a is not None)
    assert all(np.array_equal(x, was) for x, was in zip((*free, *frozen), (q, p, q, p), strict=True))


@pytest.mark.parametrize("name", LAWS)
def test_what_a_law_says_of_itself_is_true_or_false_and_not_a_method(name):
    law = LAWS[name][0]
    said = [
        getattr(law, word) for word in ("conservative", "centre_decouples", "located", "moving") if hasattr(law, word)
    ]
    assert said
    assert all(type(word) is bool for word in said)
    assert isinstance(getattr(law, "surfaces", ()), tuple)


CARRYING = {  # a pair law or a weight whose own numbers have a time in them, next to gains
    "pair with a time": fl.Algorithm2(alpha=fl.DeadZoneInteraction(ramp=0.1), target=ORIGIN),
    "weight with a time": fl.compose(
        pair=fl.AlphaInteraction(), consensus=fl.RationalWeight(strength=2.0, decay=0.5, length=5.0)
    ),
    "both": fl.compose(
        pair=fl.DeadZoneInteraction(ramp=0.1),
        consensus=fl.RationalWeight(strength=2.0, decay=0.5, length=5.0),
        navigation=ORIGIN,
    ),
}
SOLIDS = (
    fl.Sphere((20.0, -2.0), 1.5),
    fl.Wall((0.0, -15.0), (1.0, 3.0)),
    fl.Capsule((-20.0, 0.0), (-20.0, 3.0), 0.5),
    fl.Polygon([(0.0, 23.0), (2.0, 22.0), (1.0, 25.0)]),
)
RNG = np.random.default_rng(4)
CIRCLE, LINE = fl.CircleTarget((1.0, 2.0), 3.0, frequency=0.1, phase=0.4), fl.LinearTarget((9.0, 0.0), (-0.5, 1.0))
PATH = (*((i, i + 1) for i in range(N - 1)), *((i + 1, i) for i in range(N - 1)))
LED = fl.LedDeadZoneFlocking(
    leaders=(CIRCLE, LINE), group=tuple(k % 2 for k in range(N)), pinned=(0, 1, 4), c1=0.7, c2=1.3, k2=0.9
)
FURTHER = {  # parameters that an entry above leaves at one number or without an effect
    "solids of every kind": fl.Algorithm3(target=CIRCLE, obstacles=SOLIDS),
    "peers that differ": fl.PeerToPeer(
        fl.Copies(RNG.normal(0.0, 9.0, (N, 2)), RNG.normal(size=(N, 2)), fl.Spring((3.0, 1.0), 0.2, 0.1)),
        gains=fl.Gains(c1_gamma=np.linspace(1.0, 2.0, N)),
    ),
    "a net that is heard": fl.NetConsensus(np.ones((N, N)) - np.eye(N), position=0.7, velocity=1.3),
    "two leaders": LED,
    "leaders that tell nothing": replace(LED, feedforward=False),
    "a stronger zone": fl.DeadZoneFlocking(fl.DeadZoneInteraction(k1=0.05), 2.0),
    "a mean of weights": fl.CuckerSmale(fl.RationalWeight(2.0, 0.7, 1.5), mean=True),
    "links": fl.MinimalFlocking(edges=PATH, spacing=1.1, mu=1.7, sigma=0.6, normalised=False),
    "a net of all": FixedNetFlocking(tuple((i, j) for i in range(N) for j in range(i)), fl.LogPotential(2.0, 1.1), 1.5),
}
EVERY = {name: law for name, (law, _) in LAWS.items()} | CARRYING | FURTHER
EVERY["a path"] = fl.MinimalFlocking(radius=tuple(np.linspace(3.0, 9.0, N)), edges=PATH[:8], beta=0.3)
EVERY["a path of steps"] = fl.MinimalFlocking(edges=PATH[:8]).discrete(0.2)
EVERY["ranges of their own"] = fl.DirectedNet(fl.Algorithm1(), (8.4, 3.0, 9.0) * 3, view=2.0, slow=0.5)
ENERGETIC = (
    *("Algorithm1", "Algorithm2", "Algorithm3", "PeerToPeer", "Composition", "CuckerSmale", "FixedNetFlocking"),
    *("ProximityFlocking", "LinkKeeping", "DeadZoneFlocking", "LedDeadZoneFlocking", *CARRYING, *FURTHER),
)
OWN_RATE = ("HeadingAveraging", "MinimalFlocking", "DiscreteMinimalFlocking")  # ask for the unit of time they are in


@pytest.mark.parametrize("name", EVERY)
def test_a_law_in_other_units_does_the_same(name):
    law = EVERY[name]
    length, time = 3.0, 1.0 if law.title in OWN_RATE else 0.25
    q, p, *_ = state(5)
    places, rates = answer(law, q, p)
    power = 1 if places is not None or isinstance(law, fl.VelocityLaw) else 2  # a flow gives accelerations
    other = fl.rescale(law, length=length, time=time)
    there, speeds = answer(other, length * q, length / time * p, time * TIME)
    np.testing.assert_allclose(speeds, rates * length / time**power, rtol=1e-9, atol=1e-9 * np.abs(speeds).max())
    assert places is None or there == pytest.approx(length * places, rel=1e-12)


@pytest.mark.parametrize("name", EVERY)
def test_a_law_is_read_as_it_was_written(name):
    assert from_data(json.loads(json.dumps(to_data(EVERY[name])))) == EVERY[name]


@pytest.mark.parametrize("name", ENERGETIC)
def test_derivatives_are_those_of_the_input(name):
    law, (q, p, *_), h = EVERY[name], state(5), 1e-6
    matrix = law.jacobian(TIME, q, p)[2 * N :]
    for dq, dp in np.random.default_rng(0).normal(size=(4, 2, N, 2)):
        up, down = (law.flow(TIME, q + s * dq, p + s * dp)[0].ravel() for s in (h, -h))
        found = matrix @ np.concatenate([dq.ravel(), dp.ravel()])
        np.testing.assert_allclose(found, (up - down) / (2.0 * h), atol=1e-6 * np.abs(matrix).max())


@pytest.mark.parametrize("name", ENERGETIC)
def test_the_rate_is_that_of_the_energy_along_the_flow(name):
    law, (q, p, *_), h = EVERY[name], state(5), 1e-5
    u, rate = law.flow(TIME, q, p)
    ahead, behind = (law.hamiltonian(TIME + s, q + s * p + 0.5 * s * s * u, p + s * u) for s in (h, -h))
    assert rate == pytest.approx((ahead - behind) / (2.0 * h), rel=1e-6, abs=1e-7 * np.abs(u * p).sum())
