"""Definition 5 on runs whose answer is known: each condition, the window, what lies between samples, and at r."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import flockana as fl
from flockana import Algorithm1, Tolerances, simulate, verify
from flockana.lattice import hexagonal_patch
from flockana.measures.metrics import cohesion_radius, net_measures
from flockana.theorems.bounds_between_samples import nets_between, radius_over
from flockana.theorems.observed_run import Observed
from tests.theorems.made_up import hexagon, judged, made_up, statuses

LAW = Algorithm1()
BOTH = ("alpha-flocking", "alpha-flocking-strict")
SPEED = 0.04 * LAW.scales.speed  # of two agents: K̃ is an eighth of its square


@pytest.mark.parametrize("until", [1e-6, 2.0, 100.0])
def test_a_lattice_in_steady_flight_flocks(until):
    q = hexagonal_patch(1, 7.0)
    run = simulate(LAW, q, 0 * q + 1.0, (0.0, until), t_eval=np.linspace(0.0, until, 30))
    for name in BOTH:
        verdict = verify(name, run)
        assert set(statuses(verdict).values()) == {"verified"}
        assert all(claim.error > 0.0 or claim.name in ("giant", "flock") for claim in verdict.claims)


@pytest.mark.parametrize(
    ("name", "claim", "q", "p"),
    [
        ("alpha-flocking", "giant", [[0.0], [7.0], [100.0], [107.0]], None),
        ("alpha-flocking-strict", "flock", [[0.0], [7.0], [100.0]], None),
        ("alpha-flocking", "deviation", [[0.0], [3.0]], None),
        ("alpha-flocking-strict", "mismatch", [[0.0], [7.0]], [[0.0], [SPEED]]),
    ],
)
def test_each_condition_is_looked_at(name, claim, q, p):
    q = np.array(q)
    p = 0 * q if p is None else np.array(p)
    still = made_up(LAW, [q] * 3, [p] * 3, t=(0.0, 1e-3, 2e-3))
    verdict = judged(name, still)
    assert verdict.claim(claim).status == "refuted"
    assert {c.status for c in verdict.claims if c.name != claim} == {"verified"}


@pytest.mark.parametrize("name", BOTH)
def test_what_was_before_the_window_does_not_count_between_its_samples(name):
    near, lattice = np.array([[0.0], [5.0]]), np.array([[0.0], [7.0]])
    t = 1e-3 * np.arange(9.0)
    settled = made_up(LAW, [near] * 3 + [lattice] * 6, t=t)
    tolerances = Tolerances(settle=0.5)
    claim = judged(name, settled, tolerances).claim("deviation")
    assert (claim.status, claim.computed) == ("verified", 0.0)
    back = made_up(LAW, [near] * 3 + [lattice] * 3 + [near] + [lattice] * 2, t=t)
    again = judged(name, back, tolerances).claim("deviation")
    assert (again.status, again.computed) == ("refuted", pytest.approx(2.0 * (2.0 / 7.0) ** 2 / 3.0))


@pytest.mark.parametrize(
    ("off", "status"), [(-0.1, "refuted"), (-1e-12, "inconclusive"), (1e-12, "inconclusive"), (10.0, "verified")]
)
@pytest.mark.parametrize(("claim", "bound"), [("cohesive", "cohesion"), ("deviation",) * 2, ("mismatch",) * 2])
def test_what_lies_nearer_to_its_bound_than_the_run_is_known_is_open(claim, bound, off, status):
    run = simulate(LAW, *hexagon(), (0.0, 1.0))
    first = verify("alpha-flocking", run).claim(claim)
    share = (1.0 + off) * first.computed / (first.computed + first.margin)
    moved = Tolerances(**{bound: share * getattr(Tolerances(), bound)})
    found = verify("alpha-flocking", run, tolerances=moved).claim(claim)
    assert found.status == status
    assert found.margin == pytest.approx(off * first.computed, rel=1e-2)


def test_a_window_is_judged_between_its_samples_too():
    """One sample lies in the second half of the second run; the first has no time at all."""
    q = hexagonal_patch(1, 7.0)
    for times, status in (([2.0], "vacuous"), ([0.0, 2.0], "verified")):
        run = simulate(LAW, q, 0 * q, (0.0, 2.0), t_eval=times)
        for name in BOTH:
            assert judged(name, run).status == status
    apart = simulate(LAW, [[0.0, 0.0], [20.0, 0.0]], np.zeros((2, 2)), (0.0, 2.0), t_eval=[0.0, 2.0])
    assert judged("alpha-flocking-strict", apart).claim("flock").status == "refuted"


def test_a_share_that_is_reached_exactly_is_not_exceeded():
    """C* > 0.5: two of four agents are no giant, three are; 29 of 100 are not more than 0.29, though 0.29·100 < 29."""
    for sizes, giant, status in (((2, 2), 0.5, "refuted"), ((3, 1), 0.5, "verified"), ((29, 71), 0.71, "refuted"),
                                 ((28, 72), 0.71, "verified")):  # fmt: skip
        q = np.concatenate([7.0 * np.arange(sizes[0]), 1e4 + 7.0 * np.arange(sizes[1])])[:, None]
        claim = judged("alpha-flocking", made_up(LAW, [q] * 3), Tolerances(giant=giant)).claim("giant")
        assert claim.status == status
        assert (2.0 * claim.margin) % 2.0 == 1.0


@pytest.mark.parametrize("side", [-1.0, 0.0, 1.0])
def test_a_pair_at_r_but_for_rounding_decides_nothing(side):
    """Two pairs r apart, to the last bit or two: linked or not, Ẽ is 0.04 or 0 and the net connected or not."""
    gap = 8.4 * (1.0 + side * 2.3e-16)
    q = np.array([[0.0], [7.0], [7.0 + gap], [14.0 + gap]])
    run = made_up(LAW, [q] * 4)
    found = judged("alpha-flocking-strict", run, Tolerances(deviation=0.004))
    assert (found.claim("flock").status, found.claim("deviation").status) == ("inconclusive", "inconclusive")
    # the pair that may be a link or not moves Ẽ by 2 (r/d - 1)²/(2·2 + 1) = 0.016
    claim = judged("alpha-flocking-strict", run, Tolerances(deviation=0.045)).claim("deviation")
    assert (claim.status, claim.error) == ("verified", pytest.approx(0.016, rel=1e-9))


class TestBetweenSamples:
    def test_a_net_that_breaks_in_between_is_not_called_connected(self):
        """Both samples show a link of 7; at the speed it had it may have been 8.4 and back."""
        q = np.array([[0.0], [7.0]])
        p = np.array([[[-2.0], [2.0]], [[2.0], [-2.0]]])
        u = np.array([[[2.0], [-2.0]]] * 2)
        run = made_up(LAW, [q, q], p, t=(0.0, 2.0), u=u)
        found = judged("alpha-flocking-strict", run, Tolerances(settle=0.0, mismatch=1.0))
        assert found.claim("flock").status == "inconclusive"
        assert found.claim("deviation").status == "inconclusive"

    @pytest.mark.slow
    @given(st.integers(0, 2**32 - 1), st.integers(2, 7), st.integers(1, 3))
    def test_bounds_hold_of_a_dense_run(self, seed, n, m):
        rng = np.random.default_rng(seed)
        q, p = rng.uniform(0.0, 12.0, (n, m)), rng.normal(0.0, 4.0, (n, m))
        law = fl.Algorithm2(target=fl.StaticTarget((0.0,) * m))
        dense = simulate(law, q, p, (0.0, 0.4), t_eval=np.linspace(0.0, 0.4, 161))
        keep = slice(0, None, 8)
        sparse = fl.Trajectory(dense.t[keep], dense.q[keep], dense.p[keep], dense.u[keep], law, stats={"steps": 20})
        seen = Observed.alone(sparse)
        nets, radius = nets_between(seen), radius_over(seen).hi
        for k, first in enumerate(range(0, 160, 8)):
            inside = dense.q[first : first + 9]
            assert max(cohesion_radius(x) for x in inside) <= radius[k] * (1.0 + 1e-12)
            for x in inside:
                connected, giant, _ = net_measures(x, 7.0, 8.4)
                parts = n - connected * (n - 1)
                assert nets.components_least[k] <= parts + 1e-9
                assert parts <= nets.components[k] + 1e-9
                assert nets.giant[k] - 1e-9 <= n * giant <= nets.giant_most[k] + 1e-9
