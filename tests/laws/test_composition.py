"""Laws put together from terms: what each composition has by being a sum, whatever its parts."""

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flockana as fl
from flockana import Algorithm1, Algorithm2, Algorithm3, Composition, Sphere, Wall, compose
from flockana.base.errors import UnknownNameError
from flockana.base.serialize import from_data, to_data
from flockana.environment.targets import CallableTarget, CircleTarget, LinearTarget, StaticTarget
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.terms.along_velocity import AlongVelocity
from flockana.laws.terms.consensus import Consensus
from flockana.sources.li_dead_zone import DeadZoneInteraction
from tests.refused import refused

LEADER = CircleTarget((3.0, -2.0), radius=4.0, frequency=0.1)
SOLIDS = (Sphere((20.0, 0.0), 3.0), Wall((0.0, -14.0), (0.0, 1.0)))
N = 4

compositions = st.fixed_dictionaries(
    {},
    optional={
        "pair": st.sampled_from([AlphaInteraction(), AlphaInteraction(d=5.0, r=9.0), DeadZoneInteraction()]),
        "net": st.sampled_from([AlphaInteraction(d=6.0, r=12.0), fl.RationalWeight(2.0, 0.6, 3.0)]),
        "consensus": st.floats(0.1, 9.0),
        "navigation": st.sampled_from([LEADER, LinearTarget((1.0, 2.0), (0.5, 0.1)), StaticTarget((4.0, 0.0))]),
        "informed": st.sampled_from([(0,), (1, 3), (0, 1, 2, 3)]),
        "bounded": st.sampled_from([False, 3.0]),
        "feedforward": st.booleans(),
        "obstacles": st.just(SOLIDS),
        "drag": st.floats(0.01, 2.0),
        "speed": st.tuples(st.floats(0.1, 1.0), st.floats(0.1, 1.0)),
    },
)
states = st.integers(0, 2**31).map(
    lambda seed: (
        np.array([[0.0, 0.0], [6.0, 0.5], [2.0, 6.5], [9.0, 5.0]]) + np.random.default_rng(seed).uniform(-1, 1, (N, 2)),
        np.random.default_rng(seed + 1).uniform(-2, 2, (N, 2)),
    )
)


def made(chosen: dict) -> fl.Law:
    """The law of a drawn choice, from which parts without their like are taken out."""
    chosen = dict(chosen)
    if "navigation" not in chosen:
        for name in ("informed", "bounded", "feedforward"):
            chosen.pop(name, None)
    if "informed" in chosen:
        chosen["agents"] = N
    if "consensus" not in chosen or not {"pair", "net"} & {*chosen}:
        chosen.pop("consensus", None)
        chosen.pop("net", None)
    if not {*chosen} - {"feedforward", "bounded"}:
        chosen["drag"] = 0.5
    return compose(**chosen)


@settings(max_examples=60, deadline=None)
@given(compositions, states)
def test_rate_is_that_of_the_energy_along_the_flow(chosen, state):
    """By central differences along q + hp + h²u/2, p + hu: what is left is h² of the third derivative."""
    law, (q, p), t, h = made(chosen), state, 0.7, 1e-4
    u, rate = law.flow(t, q, p)
    before, after = (law.hamiltonian(t + s, q + s * p + 0.5 * s * s * u, p + s * u) for s in (-h, h))
    size = abs(rate) + float(np.sum(np.abs(u) * np.abs(p))) + 1.0
    assert (after - before) / (2.0 * h) == pytest.approx(rate, abs=3e-5 * size)


@settings(max_examples=60, deadline=None)
@given(compositions, states)
def test_jacobian_is_the_derivative_of_the_force(chosen, state):
    law, (q, p), h = made(chosen), state, 1e-6
    matrix = law.jacobian(0.7, q, p)
    size = np.abs(matrix).max() + 1.0
    for k in range(2 * q.size):
        e = np.zeros(2 * q.size)
        e[k] = h
        dq, dp = e[: q.size].reshape(q.shape), e[q.size :].reshape(q.shape)
        slope = (law.flow(0.7, q + dq, p + dp)[0] - law.flow(0.7, q - dq, p - dp)[0]).ravel() / (2.0 * h)
        np.testing.assert_allclose(matrix[q.size :, k], slope, atol=2e-5 * size)


@settings(max_examples=60, deadline=None)
@given(compositions)
def test_through_a_file_and_other_units(chosen):
    law = made(chosen)
    assert from_data(to_data(law)) == law
    q, p = np.array([[0.0, 0.0], [6.0, 0.5], [2.0, 6.5], [9.0, 5.0]]), np.full((N, 2), 0.3)
    p[0] = (1.0, -1.0)
    other = fl.rescale(law, length=1000.0, time=60.0)
    u, rate = law.flow(0.7, q, p)
    seen, seen_rate = other.flow(60.0 * 0.7, 1000.0 * q, p * 1000.0 / 60.0)
    np.testing.assert_allclose(seen * 3600.0 / 1000.0, u, atol=1e-9 * np.abs(u).max())
    assert seen_rate * 60.0**3 / 1e6 == pytest.approx(rate, abs=1e-9 * (abs(rate) + np.abs(u).sum()))


@pytest.mark.slow
@pytest.mark.parametrize(
    "chosen",
    [
        {"pair": AlphaInteraction(), "consensus": 3.0, "net": AlphaInteraction(r=12.0), "drag": 0.2},
        {"pair": AlphaInteraction(), "navigation": LEADER, "feedforward": True, "drag": 0.3},
        {"pair": AlphaInteraction(), "navigation": LEADER, "feedforward": True, "informed": (1,), "speed": (1.0, 0.5)},
        {"pair": AlphaInteraction(), "navigation": StaticTarget((4.0, 0.0)), "obstacles": SOLIDS[:1], "drag": 0.1},
        {"speed": (1.0, 0.5)},
        {"pair": AlphaInteraction(), "consensus": 1.0, "net": fl.RationalWeight(2.0, 0.6, 3.0)},
    ],
)
@pytest.mark.parametrize("drift", [0.0, 40.0])
def test_compiled_runs_are_those_of_the_law_s_own_flow(chosen, drift):
    """`drift` moves the frame that compiled integrators see the agents from."""
    law = made(chosen)
    q = np.array([[0.0, 0.0], [6.0, 0.5], [2.0, 6.5], [9.0, 5.0]])
    p = np.array([[1.0, 0.0], [0.0, -1.0], [0.5, 0.5], [-1.0, 0.2]]) + np.array([drift, 0.0])
    assert law.compiled(2) is not None
    ours, theirs = (
        fl.simulate(law, q, p, (0.0, 1.5), method=method, rtol=1e-10) for method in ("DOP853", "scipy-DOP853")
    )
    size = np.abs(theirs.q[-1]).max()
    np.testing.assert_allclose(ours.q[-1], theirs.q[-1], atol=1e-7 * size)
    np.testing.assert_allclose(ours.p[-1], theirs.p[-1], atol=1e-7 * (1.0 + np.abs(theirs.p).max()))
    assert np.abs(ours.energy_residual).max() <= 1e-8 * (1.0 + np.abs(ours.energy()).max())


def test_algorithms_are_compositions():
    pair, gains = AlphaInteraction(), Gains()
    consensus, target = gains.c2_alpha, StaticTarget((4.0, 0.0))
    assert compose(pair=pair, consensus=consensus) == Algorithm1()
    assert compose(pair=pair, consensus=consensus, navigation=target) == Algorithm2(target=target)
    third = compose(pair=pair, consensus=consensus, navigation=target, bounded=True, obstacles=SOLIDS)
    assert third == Algorithm3(target=target, obstacles=SOLIDS)
    few = compose(pair=pair, consensus=consensus, navigation=target, informed=(0, 2), agents=3)
    assert few == Algorithm2(
        gains=Gains(c1_gamma=(1.1, 0, 1.1), c2_gamma=(2 * 1.1**0.5, 0, 2 * 1.1**0.5)), target=target
    )
    for law in (Algorithm1(), Algorithm2(target=target), Algorithm3(target=target, obstacles=SOLIDS)):
        same = Composition(
            law.alpha, law.gains, target=law.target, obstacles=law.obstacles,
            unit=7.0 if isinstance(law, Algorithm3) else None,
        )  # fmt: skip
        assert [type(term) for term in same.terms] == [type(term) for term in law.terms]


def test_the_frame_of_the_energy_follows_what_ties_the_shape():
    pair, target = AlphaInteraction(), StaticTarget((4.0, 0.0))
    free = compose(pair=pair, navigation=target, drag=0.1)
    assert free.moving
    assert free.centre_decouples
    assert not free.terms[0].idle
    for tied in ({"obstacles": SOLIDS}, {"speed": (1.0, 1.0)}, {"informed": (0,), "agents": 2}, {"bounded": 2.0}):
        law = compose(pair=pair, navigation=target, **tied)
        assert not law.moving
        assert not law.centre_decouples
    assert not compose(pair=pair, speed=(1.0, 1.0)).centre_decouples  # the speed of the centre changes the shape
    assert compose(pair=pair, drag=1.0).centre_decouples


def test_drag_takes_energy_and_speed_control_adds_it():
    """Exact numbers: u = −c p at rate −c‖p‖², (α − β‖p‖²) p at (α − β‖p‖²)‖p‖², 0 at the speed √(α/β)."""
    q, p = np.zeros((1, 2)), np.array([[3.0, 4.0]])
    dragged, held = compose(drag=0.5), compose(speed=(1.0, 0.25))
    assert dragged.acceleration(0.0, q, p).tolist() == [[-1.5, -2.0]]
    assert dragged.energy_rate(0.0, q, p) == -12.5
    assert held.acceleration(0.0, q, p).tolist() == [[-15.75, -21.0]]
    assert held.energy_rate(0.0, q, 0.1 * p) == pytest.approx((1.0 - 0.0625) * 0.25, rel=1e-15)
    assert held.energy_rate(0.0, q, [[0.0, 2.0]]) == 0.0


def test_equilibria_and_linearisation_of_a_composition():
    """Idle terms move no equilibrium: a bond at d, of which drag damps every mode, the drift too."""
    law = compose(pair=AlphaInteraction(), consensus=1.0, net=AlphaInteraction(r=12.0), drag=0.25)
    rest = fl.find_equilibrium(law, [[0.0, 0.0], [6.5, 0.0]])
    assert float(np.linalg.norm(rest.q[1] - rest.q[0])) == pytest.approx(7.0, abs=1e-6)
    system = fl.linearise(law, rest)
    values = np.sort(system.eigenvalues.real)
    assert np.count_nonzero(np.abs(system.eigenvalues) < 1e-6) == 3  # two translations and a turn
    assert np.count_nonzero(np.abs(values + 0.25) < 1e-9) >= 2  # the drift dies with the drag


def test_consensus_s_own_net_reaches_beyond_the_pair():
    law = compose(pair=AlphaInteraction(), consensus=2.0, net=AlphaInteraction(r=20.0))
    assert law.term(Consensus) is not None
    assert law.term(AlongVelocity) is None
    assert law.surfaces == (8.4, 20.0)
    q, p = np.array([[0.0], [12.0]]), np.array([[1.0], [-1.0]])
    u = law.acceleration(0.0, q, p)
    assert u[0, 0] < 0.0 < u[1, 0]
    assert compose(pair=AlphaInteraction(), consensus=2.0).acceleration(0.0, q, p).tolist() == [[0.0], [0.0]]


def test_a_law_without_pairs_has_scales_only_of_what_it_has():
    assert compose(drag=2.0).scales is None
    assert compose(pair=AlphaInteraction(), gradient=0.0, drag=2.0).scales.time == 0.5
    assert compose(net=AlphaInteraction(), consensus=4.0).scales.time == 0.25
    assert compose(net=AlphaInteraction(), consensus=4.0).lattice is None


def test_a_weight_is_a_consensus_by_itself():
    """Cucker and Smale's law, and the same with a pair potential: a(4) = 2 (1 + 16/9)^−0.6 here."""
    weight = fl.RationalWeight(2.0, 0.6, 3.0)
    law, q, p = compose(consensus=weight), np.array([[0.0], [4.0]]), np.array([[1.0], [-1.0]])
    assert law == compose(consensus=1.0, net=weight)
    pull = 2.0 * (1.0 + 16.0 / 9.0) ** -0.6
    np.testing.assert_allclose(law.acceleration(0.0, q, p), [[-2.0 * pull], [2.0 * pull]], rtol=1e-14)
    assert law.energy_rate(0.0, q, p) == pytest.approx(-4.0 * pull, rel=1e-14)
    assert compose(pair=AlphaInteraction(), consensus=weight).surfaces == (8.4,)
    rest = fl.find_equilibrium(compose(pair=AlphaInteraction(), consensus=weight), [[0.0, 0.0], [6.5, 0.0]])
    assert float(np.linalg.norm(rest.q[1] - rest.q[0])) == pytest.approx(7.0, abs=1e-6)


class NearWeight(fl.RationalWeight):
    """A weight that ends."""

    @property
    def range(self):
        return 9.0


def test_where_a_weight_ends_is_a_surface():
    assert compose(pair=AlphaInteraction(), consensus=NearWeight()).surfaces == (8.4, 9.0)


PAIR = AlphaInteraction()
test_what_is_wrong_is_said_in_one_line = refused(
    ({"pairs": PAIR}, "'pairs'"),
    ({}, "the law has no term: expected at least one of pair"),
    ({"gradient": 2.0, "drag": 1.0}, "gradient = 2.0 without its part: give pair="),
    ({"pair": PAIR, "net": PAIR}, "without its part: give consensus="),
    ({"consensus": 1.0}, "consensus = 1.0 without a net"),
    ({"consensus": fl.RationalWeight(), "net": PAIR}, "expected one of the two weights"),
    ({"pair": PAIR, "pull": 1.0}, "pull = 1.0 without its part: give navigation="),
    ({"pair": PAIR, "informed": (0,)}, "without its part: give navigation="),
    (
        {"pair": PAIR, "navigation": LEADER, "informed": (0, 5), "agents": 5},
        "informed has 5: expected a whole number, 0 to 4",
    ),
    ({"pair": PAIR, "navigation": LEADER, "informed": (0,)}, "informed = .* without agents"),
    ({"pair": PAIR, "navigation": LEADER, "agents": 5}, "agents = 5 without its part: give informed="),
    ({"pair": PAIR, "repulsion": 1.0}, "repulsion = 1.0 without its part: give obstacles="),
    ({"pair": PAIR, "gradient": -1.0}, "c1_alpha = -1: expected a gain >= 0"),
    ({"drag": -1.0}, "drag"),
    (
        {"pair": PAIR, "navigation": LEADER, "informed": (0,), "agents": 2, "pull": -1.0},
        "^pull = -1: expected a number >= 0",
    ),
    (
        {"pair": PAIR, "navigation": LEADER, "informed": (0,), "agents": 2, "match": -2.0},
        "^match = -2: expected a number >= 0",
    ),
    ({"speed": 2.0}, r"speed = 2.0: expected \(α, β\)"),
    ({"pair": 3.0}, "alpha = 3.0: expected"),
    (
        {"navigation": CallableTarget(lambda t: (np.zeros(2), np.zeros(2))), "feedforward": True},
        "expected a γ-agent of known acceleration",
    ),
    (
        {"navigation": StaticTarget((0.0,)), "obstacles": SOLIDS},
        r"obstacles\[0\] = .* has 2 components but the target has 1",
    ),
    ({"navigation": LEADER, "bounded": True}, "bounded = True without a pair"),
    make=compose,
)


def test_a_misspelt_gain_is_told_the_gain():
    with pytest.raises(UnknownNameError, match="did you mean 'gradient'"):
        compose(pair=AlphaInteraction(), gradiant=2.0)


def test_a_composition_has_no_gain_but_those_given():
    assert fields(Composition)[1].default == Gains(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
