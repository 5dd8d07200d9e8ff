"""The bearing-distance law: its two forms, its readings of the paper, its measures, and what it refuses."""

from dataclasses import dataclass
from math import tanh

import numpy as np
import pytest

from flockana import Alien, Box, DiscreteLaw, SimplePolygon, Trajectory, ZoneWorld, coordination, rescale, simulate
from flockana.sources.jond_2025 import ZoneNoise, ZoneRadii, ZoneWeights
from flockana.sources.jond_2025.laws.zone_flocking import CHOICES, ZoneFlocking
from flockana.sources.jond_2025.symbolic import zone_pair as symbolic
from tests.refused import refused

RADII = ZoneRadii(1.5, c=3.0, a=5.0, s=6.0)
BLOCK = SimplePolygon([(20.0, 20.0), (30.0, 18.0), (28.0, 31.0)])
WORLD = ZoneWorld((BLOCK,), Box((0.0, 0.0), (50.0, 50.0)), (Alien((15.0, 15.0)),))


def a_start(seed=0, n=10, m=2):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, 10.0, (n, m)), rng.uniform(0.0, 1.0, (n, m))


@dataclass(frozen=True)
class OneByOne(ZoneFlocking):
    """The same map without a whole-run form: every step is a call of its own."""

    steps_at_once = 1

    def iterate(self, t, q, p, memory, steps):
        return DiscreteLaw.iterate(self, t, q, p, memory, steps)

    def step(self, t, q, p, memory):
        q, p, u, after = ZoneFlocking.iterate(self, t, q, p, memory, 1)
        return q[0], p[0], u[0], {name: values[0] for name, values in after.items()}


@pytest.mark.parametrize(
    "options",
    [
        {},
        {name: names[-1] for name, names in CHOICES.items()},
        {"growth": 3.0, "noise": ZoneNoise(weights=1.0, velocities=0.2)},
    ],
)
def test_whole_runs_and_single_steps_agree_to_the_bit(options):
    q, p = a_start()
    fast = simulate(ZoneFlocking(RADII, world=WORLD, **options), q, p, (0.0, 30.0))
    slow = simulate(OneByOne(RADII, world=WORLD, **options), q, p, (0.0, 30.0))
    assert len(fast.t) == 301 > ZoneFlocking.steps_at_once
    for name in ("t", "q", "p", "u"):
        np.testing.assert_array_equal(getattr(fast, name), getattr(slow, name))
    own = {"reach", "step"} if "noise" in options else set()
    assert set(fast.extra) == {"heading", "estimate", "alien"} | own == set(slow.extra)
    for name, series in fast.extra.items():
        np.testing.assert_array_equal(series, slow.extra[name])
    assert fast.stats["steps"] == 300


def test_a_run_leaves_its_arguments_alone_and_records_its_memory():
    q, p = a_start()
    kept = q.copy(), p.copy()
    run = simulate(ZoneFlocking(RADII, world=WORLD), q, p, (0.0, 2.0))
    np.testing.assert_array_equal([q, p], kept)
    np.testing.assert_array_equal(run.extra["alien"][0], [[15.0, 15.0]])
    np.testing.assert_array_equal(run.extra["estimate"][1], p)  # measured: what the agent knew at the step's start
    speeds = np.linalg.norm(run.extra["heading"], axis=2)
    np.testing.assert_allclose(speeds, 1.0, rtol=1e-14)


def test_a_run_in_other_units_is_the_run_of_the_law_in_other_units():
    """Places, velocities, and the memory: estimates, how far agents have learnt to see, and where the alien is."""
    law, (q, p) = ZoneFlocking(RADII, world=WORLD, growth=0.3), a_start()
    run = simulate(law, q, p, (0.0, 2.0))
    one, other = (
        rescale(run, length=2.0, time=0.5),
        simulate(rescale(law, length=2.0, time=0.5), 2.0 * q, 4.0 * p, (0.0, 1.0)),
    )
    assert {"estimate", "heading", "reach", "alien"} <= one.extra.keys() == other.extra.keys()
    for name in one.extra:
        np.testing.assert_allclose(one.extra[name], other.extra[name], rtol=1e-9, atol=1e-9, err_msg=name)
    np.testing.assert_allclose(one.q, other.q, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("m", [2, 3])
def test_the_two_forms_agree_on_whole_runs_until_rounding_grows(m):
    q, p = a_start(m=m)
    one, other = (simulate(ZoneFlocking(form=form), q, p, (0.0, 2.0)) for form in CHOICES["form"])
    np.testing.assert_allclose(one.q, other.q, atol=1e-10)


def test_remark_3_is_false_the_printed_estimate_drifts():
    """(17) leaves out the global speed term and the bounds; one step shows δ u^ga exactly where nothing saturates."""
    law = ZoneFlocking(own_velocity="estimated", u_max=1e9, v_max=1e9)
    q, p = np.array([[0.0, 0.0]]), np.array([[2.0, 0.0]])
    once = law.step(0.0, q, p, law.start(q, p))
    values = {symbolic.OWN: 2, symbolic.STEP: 0.1, symbolic.GAIN: 5, symbolic.SPEED: 3}
    drive = float(symbolic.estimate_gap().subs(values))
    gap = once[1][0, 0] - once[3]["estimate"][0, 0]
    assert gap == pytest.approx(drive, rel=1e-12) == pytest.approx(0.5, rel=1e-12)
    q, p = a_start(3)
    errors = {}
    for name in CHOICES["own_velocity"]:
        run = simulate(ZoneFlocking(own_velocity=name), q, p, (0.0, 20.0))
        errors[name] = np.linalg.norm(run.extra["estimate"][1:] - run.p[:-1], axis=2).mean()
    assert errors["measured"] == 0.0
    assert errors["predicted"] < 0.5 < 1.5 < errors["estimated"]


@pytest.mark.parametrize(("name", "of"), [("predicted", "velocity"), ("estimated", "estimate")])
def test_what_an_agent_adds_to_know_its_velocity(name, of):
    """(16), (17): the sum of the five other behaviours, times dt, to its velocity or to its last estimate."""
    world = ZoneWorld(box=Box((-1.0, -1.0), (9.0, 9.0)), aliens=(Alien((4.0, 2.0)),))
    law = ZoneFlocking(RADII, world=world, own_velocity=name)
    q, p = np.array([[0.0, 0.0], [0.0, 2.0], [3.0, 1.0]]), np.array([[-1.0, -1.0], [-2.0, 0.5], [0.3, 0.1]])
    memory = dict(law.start(q, p)) | {"estimate": p[::-1].copy()}
    parts = law.behaviours(q, p, memory)
    others = sum(part for part_name, part in parts.items() if part_name != "speed")
    assert all(part[0].any() for part_name, part in parts.items()), "a behaviour is idle, so that it is not tested"
    known = (p if of == "velocity" else p[::-1]) + 0.1 * others
    wanted = 5.0 * (3.0 * known / np.linalg.norm(known, axis=1, keepdims=True) - known)
    np.testing.assert_allclose(parts["speed"], wanted, rtol=1e-12)
    np.testing.assert_array_equal(memory["estimate"], p[::-1])  # asking changes nothing


def test_the_printed_speed_bound_is_a_drag():
    """Erratum J7: 3 m/s become 2.541 in a step, and no input of 2 m/s² keeps more than 2.0083."""
    law = ZoneFlocking(speed_bound="tanh")
    q, p = np.zeros((1, 2)), np.array([[3.0, 0.0]])
    after = law.step(0.0, q, p, law.start(q, p))[1][0, 0]
    assert after == pytest.approx(4.0 * tanh(0.75), rel=1e-15)
    assert after == pytest.approx(float(symbolic.saturation(3, bound=4)), rel=1e-14)
    pushed = ZoneFlocking(speed_bound="tanh", desired_speed=1e9)
    end = simulate(pushed, q, p, (0.0, 40.0)).p[-1, 0, 0]
    assert end == pytest.approx(float(symbolic.fastest_under_drag(0.1, 2, 4)), rel=1e-9)


@pytest.mark.parametrize(("weight", "distance"), [(6.25, 0.6), (5.5, 3.0 - 15.0 / 5.5), (5.0, 0.0)])
def test_stand_off_at_a_wall(weight, distance):
    """J12: head-on and unsaturated they balance at c − v^d w^ga/w^oa: contact with the printed weights, 5."""
    stated = symbolic.stand_off(desired_speed=3, drive=5, weight=weight).subs(symbolic.C, 3)
    assert float(stated) == pytest.approx(distance, rel=1e-14, abs=1e-15)
    law = ZoneFlocking(
        weights=ZoneWeights(obstacle=weight), world=ZoneWorld(box=Box((0.0, 0.0), (20.0, 20.0))), u_max=1e6, dt=0.01
    )
    run = simulate(law, [[10.0, 10.0]], [[3.0, 0.0]], (0.0, 12.0))
    assert 20.0 - run.q[-1, 0, 0] == pytest.approx(distance, abs=1e-4)  # at rates from 1.4 on nothing else is left


def test_an_alien_nearer_than_a_walks_in_by_the_letter():
    """J9. It hunts at 1.5 an agent that wants 0.2: heeded in the disc, it is kept at s − w^ga (1.5 − 0.2)/w^ss."""
    nearest = {}
    for name in CHOICES["surveillance"]:
        law = ZoneFlocking(RADII, world=ZoneWorld(aliens=(Alien((0.0, 0.0)),)), desired_speed=0.2, surveillance=name)
        run = simulate(law, [[5.9, 0.0]], [[0.2, 0.0]], (0.0, 60.0))
        gap = run.metrics().alien_distance.values
        nearest[name] = gap.min()
        if name == "disc":
            assert gap[-1] == pytest.approx(4.7, abs=1e-9)
    assert nearest["disc"] > 4.0
    assert nearest["annulus"] < 0.15  # one step of the alien


def test_measures_are_in_the_metrics():
    run = simulate(ZoneFlocking(RADII, world=WORLD), *a_start(), (0.0, 20.0))
    found = run.metrics()
    k = 37
    d = np.linalg.norm(run.q[k][:, None] - run.q[k], axis=2)
    np.testing.assert_allclose(found.in_attraction[k], ((d > 3.0) & (d <= 5.0)).sum() / 10.0)
    np.testing.assert_allclose(found.in_conflict[k], ((d > 1.5) & (d <= 3.0)).sum() / 10.0)
    np.testing.assert_allclose(found.in_repulsion[k], ((d > 0.0) & (d <= 1.5)).sum() / 10.0)
    np.testing.assert_allclose(found.coordination[k], coordination(run.p[k]))
    gaps = np.linalg.norm(run.q[k] - run.extra["alien"][k], axis=1)
    np.testing.assert_allclose(found.alien_distance[k], gaps.min())
    np.testing.assert_allclose(found.obstacle_clearance[k], BLOCK.clearance(run.q[k]).min())
    ways = BLOCK.clearance_along(run.q[k - 1], run.q[k])
    np.testing.assert_allclose(found.obstacle_clearance_bound[k], ways.min())
    assert (found.obstacle_clearance_bound <= found.obstacle_clearance).all()
    np.testing.assert_allclose(found.wall_distance[k], np.minimum(run.q[k], 50.0 - run.q[k]).min())
    assert found.in_attraction.attrs["long_name"] == "mean number of agents in the zone of attraction"


def test_between_kept_samples_far_apart_the_way_is_not_known():
    law, (q, p) = ZoneFlocking(RADII, world=WORLD), a_start()
    found = simulate(law, q, p, (0.0, 4.0), t_eval=[0.0, 1.0, 1.1, 4.0]).metrics()
    assert np.isnan(found.obstacle_clearance_bound).values.tolist() == [False, True, False, True]


def test_an_empty_plane_has_no_dangers_and_one_agent_is_connected():
    found = simulate(ZoneFlocking(), [[0.0, 0.0]], [[1.0, 0.0]], (0.0, 1.0)).metrics()
    assert not {"alien_distance", "obstacle_clearance", "wall_distance"} & set(found)
    assert (found.connectivity == 1.0).all()


@pytest.mark.parametrize("printed", [False, True])
def test_a_run_is_saved_with_its_law(tmp_path, printed):
    weights = ZoneWeights(cohesion=tuple(map(tuple, (1.0 + np.eye(10)).tolist())), speed=(5.0,) * 9 + (0.0,))
    make = ZoneFlocking.printed if printed else ZoneFlocking
    run = simulate(make(RADII, weights, world=WORLD), *a_start(), (0.0, 1.0))
    again = Trajectory.load(run.save(tmp_path / "run.nc"))
    assert again.law == run.law
    assert type(again.law) is ZoneFlocking
    for name, series in run.extra.items():
        np.testing.assert_array_equal(again.extra[name], series)


def test_the_letter_is_the_last_of_every_choice():
    law = ZoneFlocking.printed()
    assert (law.order, law.own_velocity, law.inside) == ("sequential", "estimated", "literal")
    assert (law.obstacle_zone, law.zone_length) == ("triangle", "conflict")
    assert (law.weights.cohesion_gain, law.weights.alignment_gain) == (1.0, 1.0)
    assert (law.walls, law.polygons) == ("each", "each")  # (21) is a sum over edges
    point = ZoneFlocking.printed(form="position")  # (8) has one closest point
    assert (point.walls, point.polygons) == ("nearest", "nearest")
    assert ZoneFlocking.printed(walls="nearest").walls == "nearest"
    assert all(getattr(ZoneFlocking(), name) == names[0] for name, names in CHOICES.items())


test_bad_parameters = refused(
    (lambda: ZoneRadii(3.0, a=2.0), "r = 3, c = 3, a = 2: expected radii that increase, 0 < r <= c < a"),
    (lambda: ZoneRadii(1.5, c=1.0, a=5.0), "expected radii that increase"),
    (lambda: ZoneRadii(1.5, c=3.0, a=5.0, s=5.0), "s = 5: expected radii that increase, 0 < r <= c < a < s"),
    (lambda: ZoneRadii((1.0, 2.0), c=(3.0, 3.0), a=(5.0, 3.0)), "r = 2, c = 3, a = 3"),
    (lambda: ZoneRadii((1.0, 2.0), a=(5.0, 5.0, 5.0)), "numbers of radii"),
    (lambda: ZoneRadii(0.0, a=5.0), "r = 0: expected a number > 0"),
    (lambda: ZoneWeights(cohesion=0.0), "cohesion sums to zero.*switch cohesion off by cohesion_gain=0"),
    (lambda: ZoneWeights(alignment=((1.0, 0.0), (1.0, 1.0))), r"alignment\[0\] sums to zero"),
    (lambda: ZoneWeights(separation=((1.0, 0.0),)), r"separation has shape \(1, 2\)"),
    (lambda: ZoneWeights(separation=((1.0, -1.0), (0.0, 0.0))), r"separation\[0\]\[1\] = -1: expected a number >= 0"),
    (lambda: ZoneFlocking(RADII, order="random"), "order = 'random': expected one of synchronous, sequential"),
    (lambda: ZoneFlocking(1.5), "radii = 1.5: expected a ZoneRadii"),
    (lambda: ZoneFlocking(base=1.2), "base = 1.2: expected at most 1"),
    (lambda: ZoneFlocking(u_max=0.0), "u_max = 0: expected a number > 0"),
    (
        lambda: ZoneFlocking(world=ZoneWorld(box=Box((0.0, 0.0), (50.0, 6.0)))),
        "a side of 6, the zone of conflict a diameter of 6: expected a box larger than a zone",
    ),
)


def begun(q, p, **options):
    return simulate(ZoneFlocking(RADII, **options), q, p, (0.0, 1.0))


TWO = ((0.0, 1.0), (1.0, 0.0))
test_bad_starts = refused(
    (lambda: begun(*a_start(m=3), world=WORLD), "the world of the law has 2 dimensions, the agents 3"),
    (lambda: begun(*a_start(), weights=ZoneWeights(speed=(1.0, 2.0))), "speed has 2 entries"),
    (lambda: begun(*a_start(), weights=ZoneWeights(cohesion=TWO)), r"\(2, 2\): expected one number, or \(10, 10\)"),
    (lambda: begun([[15.0, 15.0]], [[0.0, 0.0]], world=WORLD), "is where alien 0 begins"),
    (lambda: begun([[25.0, 22.0]], [[0.0, 0.0]], world=WORLD), "expected a point outside obstacle 0"),
)
