"""The minimal bearing-distance model against a transcription of (23)-(25) in plain loops, and exact two-agent facts."""

from math import cos, exp, sin, sqrt

import numpy as np
import pytest

from flockana import DiscreteLaw, DiscreteMinimalFlocking, MinimalFlocking, simulate
from flockana.base.errors import ArgumentError
from flockana.measures.perception import both_ways
from flockana.sources.jond_2025.kernels.minimal import perceived_edges
from tests.refused import refused

R, BETA = (1.5, 3.0, 2.2, 4.0, 0.4), (0.5, 0.2, 0.9, 0.3, 1.0)
TREE = ((0, 1), (1, 2), (1, 3), (0, 4))


def table(n, seed):
    return np.random.default_rng(seed).uniform(0.2, 2.0, (n, n))


def state(n, m, seed=0, size=3.0):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, size, (n, m)), rng.uniform(-1.0, 1.0, (n, m))


def transcription(q, p, *, radius, mu, sigma, beta=None, spacing=None, edges=None, normalised=True):
    """Sums agent by agent; square roots of plain sums of squares, so that it takes complex states too."""
    n, m = q.shape
    u = np.zeros_like(q)
    for i in range(n):
        if edges is None:
            apart = [sqrt(sum((q[j, c] - q[i, c]).real ** 2 for c in range(m))) for j in range(n)]
            near = [j for j in range(n) if j != i and apart[j] <= radius[i]]
        else:
            near = [j for j, k in edges if k == i]
        rho = (beta[i] if beta else 1 / radius[i]) * len(near) * radius[i] if spacing is None else spacing[i]
        weight = sum(sigma[i][j] for j in near)
        for c in range(m):
            if normalised and weight > 0.0:
                u[i, c] += sum(sigma[i][j] * p[j, c] for j in near) / weight - p[i, c]
            elif not normalised:
                u[i, c] += sum(sigma[i][j] * (p[j, c] - p[i, c]) for j in near)
        for j in near:
            x = q[j] - q[i]
            length = np.sqrt(sum(x[c] * x[c] for c in range(m)))
            u[i] += mu[i][j] * (1.0 - rho / length) * x
    return u


TABLES = {"radius": R, "mu": table(5, 1), "sigma": table(5, 2)}
CASES = {
    "perceived": TABLES,
    "beta": TABLES | {"beta": BETA},
    "spacing": TABLES | {"spacing": BETA},
    "summed": TABLES | {"normalised": False},
    "tree": TABLES | {"edges": TREE},
    "tree-spacing": TABLES | {"edges": TREE, "spacing": BETA},
    "cycle": TABLES | {"edges": ((0, 1), (1, 2), (2, 0), (3, 2)), "normalised": False},
}


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("case", CASES)
def test_it_is_the_printed_law(case, m):
    q, p = state(5, m, seed=m)
    options = CASES[case]
    found = MinimalFlocking(**options).acceleration(0.0, q, p)
    # two orders of summation of at most four terms of order ten
    np.testing.assert_allclose(found, transcription(q, p, **options), rtol=0, atol=1e-13)


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("case", CASES)
def test_the_jacobian_is_the_complex_step_of_the_transcription(case, m):
    q, p = state(5, m, seed=m)
    options, step = CASES[case], 1e-30
    columns = []
    for k in range(2 * q.size):
        nudge = np.zeros(2 * q.size, dtype=complex)
        nudge[k] = 1j * step
        dq, dp = nudge[: q.size].reshape(q.shape), nudge[q.size :].reshape(q.shape)
        u = transcription(q + dq, p + dp, **options)
        columns.append(np.concatenate([(p + dp).imag.ravel(), u.imag.ravel()]) / step)
    law = MinimalFlocking(**options)
    np.testing.assert_allclose(law.jacobian(0.0, q, p), np.array(columns).T, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(law.jacobian(0.0, q, p, sparse=True).toarray(), law.jacobian(0.0, q, p))


def test_neighbours_are_within_their_own_closed_radius():
    q = np.array([[0.0], [3.0], [7.0]])
    law = MinimalFlocking((3.0, 2.999, 4.0))
    assert set(law.perceived(q)) == {(1, 0), (1, 2)}
    assert law.acceleration(0.0, q, 0 * q)[1, 0] == 0.0  # perceives nobody
    assert law.acceleration(0.0, q, 0 * q)[0, 0] == 2.0  # one neighbour, so one metre is wanted, and 3 are found


def test_perceived_edges_of_many_agents_in_several_blocks():
    rng = np.random.default_rng(3)
    q, radius = rng.uniform(0.0, 20.0, (300, 2)), rng.uniform(2.0, 9.0, 300)
    head, tail = perceived_edges(q, radius)
    distance = np.linalg.norm(q[:, None] - q, axis=2)
    near = (distance <= radius[:, None]) & ~np.eye(300, dtype=bool)
    assert len(head) > 8192  # more than a block of pairs holds
    assert set(zip(head.tolist(), tail.tolist(), strict=True)) == {tuple(edge) for edge in np.argwhere(near).tolist()}


def test_the_printed_spacing_is_the_number_of_neighbours():
    """A triangle of side 2: two neighbours want 2 m; with a third agent in the middle of nothing, nothing changes."""
    triangle = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, sqrt(3.0)]])
    assert np.abs(MinimalFlocking().acceleration(0.0, triangle, 0 * triangle)).max() < 1e-15
    moved = np.vstack([triangle, [[100.0, 0.0]]])
    assert np.abs(MinimalFlocking().acceleration(0.0, moved, 0 * moved)).max() < 1e-15
    near = np.vstack([triangle, [[1.0, -5.0]]])  # one more neighbour, and all want 3 m at once
    assert np.abs(MinimalFlocking().acceleration(0.0, near, 0 * near)[2]).max() > 0.5


def test_a_driven_edge_follows_its_closed_form():
    """Root at rest: y'' + y' + μ y = 0 for y = x − ρ on the line."""
    mu, rho, y0 = 2.0, 1.5, 0.7
    law = MinimalFlocking(edges=[(0, 1)], spacing=rho, mu=mu)
    run = simulate(law, [[0.0], [rho + y0]], [[0.0], [0.0]], (0.0, 6.0), rtol=1e-11, atol=1e-12)
    w = sqrt(mu - 0.25)
    exact = [rho + y0 * exp(-t / 2) * (cos(w * t) + sin(w * t) / (2 * w)) for t in run.t]
    np.testing.assert_allclose(run.q[:, 1, 0], exact, rtol=0, atol=1e-9)
    assert np.all(run.q[:, 0] == 0.0)


def test_coincident_agents_have_no_spring_but_align():
    q, p = np.zeros((2, 2)), np.array([[1.0, 0.0], [-1.0, 0.0]])
    u = MinimalFlocking(edges=[(0, 1)], spacing=1.0).acceleration(0.0, q, p)
    np.testing.assert_array_equal(u, [[0.0, 0.0], [2.0, 0.0]])
    with pytest.raises(ArgumentError, match="agents 0 and 1 coincide"):
        MinimalFlocking(edges=[(0, 1)], spacing=1.0).jacobian(0.0, q, p)


def test_energy_of_two_agents_and_its_rate_by_hand():
    law = MinimalFlocking(edges=both_ways([(0, 1)]), spacing=2.0, mu=3.0, normalised=False)
    # ½·3·(5 − 2)² and ½(1² + 1²) in the moving frame
    assert law.energy(0.0, [[0.0, 0.0], [3.0, 4.0]], [[1.0, 5.0], [-1.0, 5.0]]) == 13.5 + 1.0
    q, p = state(5, 2)
    law = MinimalFlocking(edges=both_ways(TREE), spacing=1.1, mu=1.7, sigma=0.6, normalised=False)
    rate = -0.6 * sum(np.sum((p[i] - p[j]) ** 2) for i, j in TREE)
    assert law.energy_rate(0.0, q, p) == pytest.approx(rate, rel=1e-12)


@pytest.mark.parametrize(
    "options",
    [
        {"edges": TREE, "spacing": 1.0},  # directed
        {"edges": both_ways(TREE), "spacing": (1.0, 2.0, 1.0, 1.0, 1.0)},  # two lengths for one link
        {"edges": both_ways(TREE), "spacing": 1.0},  # means over different numbers of neighbours
        {"edges": both_ways(TREE), "spacing": 1.0, "normalised": False, "sigma": table(5, 0)},
        {"edges": both_ways(TREE), "spacing": 1.0, "normalised": False, "mu": table(5, 0)},
        {"spacing": 1.0, "normalised": False},  # perception may switch
    ],
)
def test_there_is_no_energy_without_reciprocity(options):
    law = MinimalFlocking(**options)
    assert not law.reciprocal
    assert np.isnan(law.energy(0.0, *state(5, 2)))
    assert np.isnan(law.energy_rate(0.0, *state(5, 2)))


def test_one_discrete_step_is_velocity_first():
    law, dt = MinimalFlocking(**CASES["perceived"]), 0.1
    q, p = state(5, 2)
    after_q, after_p, u, memory = law.discrete(dt).step(0.0, q, p, {})
    expected = transcription(q, p, **CASES["perceived"])
    np.testing.assert_allclose(after_p, p + dt * expected, rtol=0, atol=1e-13)
    np.testing.assert_allclose(after_q, q + dt * (p + dt * expected), rtol=0, atol=1e-13)
    np.testing.assert_allclose(u, expected, rtol=0, atol=1e-13)
    assert memory == {}


def one_by_one(law, q, p, steps):
    """By `step`, and by `step` alone."""
    return DiscreteLaw.iterate(law, 0.0, q, p, {}, steps)[:3]


def assert_same_bits(found, expected):
    for one, other in zip(found, expected, strict=True):
        assert one.shape == other.shape
        assert one.tobytes() == other.tobytes()


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"radius": tuple(np.linspace(0.1, 4.0, 20))},
        {"radius": tuple(np.linspace(0.1, 4.0, 20)), "beta": tuple(np.linspace(1.0, 0.1, 20)), "mu": 0.7},
        {"radius": 3.0, "spacing": 1.5, "mu": 0.4, "sigma": 0.1, "normalised": False},
        {"radius": tuple(np.linspace(1.0, 5.0, 20)), "spacing": tuple(np.linspace(2.0, 0.5, 20)), "sigma": 0.3},
        {"radius": 3.0, "beta": 0.3, "sigma": 0.0},
        {"radius": 1e-200, "mu": 2.0},  # whose square is no number: coincident agents perceive each other
        {"radius": 1e200, "spacing": 1.0},
    ],
)
@pytest.mark.filterwarnings("ignore:overflow encountered in multiply")  # the square of 1e200
def test_steps_made_at_once_are_steps_one_by_one_to_the_bit(options, m):
    q, p = state(20, m, seed=m, size=4.0)
    q[3] = q[4]  # coincident, and apart after a step
    q[5, 0] = 100.0  # alone
    law, (at, now) = MinimalFlocking(**options).discrete(0.1), (q.copy(), p.copy())
    *found, memory = law.iterate(0.0, q, p, {}, 40)
    assert memory == {}
    assert_same_bits(found, one_by_one(law, q, p, 40))
    assert_same_bits((q, p), (at, now))


def test_steps_made_at_once_perceive_up_to_the_radius_and_whatever_the_memory_order():
    q, p = np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 7.0], [3.0, 11.0]]), np.zeros((4, 2))
    law = MinimalFlocking((3.0, 2.999, 4.999, 5.0), normalised=False).discrete(1.0)
    u = law.iterate(0.0, q, p, {}, 1)[2][0]
    assert u[0].tolist() == [2.0, 0.0]  # one neighbour, so one metre is wanted, and 3 are found
    assert u[1].tolist() == u[2].tolist() == [0.0, 0.0]
    assert u[3].tolist() == pytest.approx([-3.0 * 0.8, -4.0 * 0.8])  # 5 are found
    as_columns = law.iterate(0.0, np.asfortranarray(q), np.asfortranarray(p), {}, 3)[:3]
    assert_same_bits(as_columns, one_by_one(law, q, p, 3))


def test_the_square_of_a_radius_may_have_few_digits():
    """The search is strict, and a few roundings more than 1e-160 have the same square."""
    law, q, p = (
        MinimalFlocking(1e-160, spacing=1.0).discrete(0.1),
        np.array([[0.0], [1e-160], [1e-160]]),
        np.zeros((3, 1)),
    )
    p[2] = 1.0
    found = law.iterate(0.0, q, p, {}, 2)[:3]
    assert found[2][0].ravel().tolist() == [0.0, 1.0, -1.0]
    assert_same_bits(found, one_by_one(law, q, p, 2))


@pytest.mark.parametrize("n", [1, 128, 129])
def test_flocks_of_any_size_are_stepped_as_one_by_one(n):
    law, (q, p) = MinimalFlocking(2.0).discrete(0.1), state(n, 2, size=8.0)
    assert law.law.steps_many(n) == (n <= 128)
    assert_same_bits(law.iterate(0.0, q, p, {}, 3)[:3], one_by_one(law, q, p, 3))


@pytest.mark.parametrize("case", CASES)
def test_tables_and_edges_are_stepped_by_the_law_itself(case):
    law, (q, p) = MinimalFlocking(**CASES[case]).discrete(0.1), state(5, 2)
    assert not law.law.steps_many(5)
    assert_same_bits(law.iterate(0.0, q, p, {}, 3)[:3], one_by_one(law, q, p, 3))


class Pulled(MinimalFlocking):
    """A wind blows, too."""

    def flow(self, t, q, p):
        u, rate = super().flow(t, q, p)
        return u + 1.0, rate


class PulledSteps(DiscreteMinimalFlocking):
    """The wind moves positions."""

    def step(self, t, q, p, memory):
        q, p, u, memory = super().step(t, q, p, memory)
        return q + 1.0, p, u, memory


class Counted(DiscreteMinimalFlocking):
    """Remembers something."""

    def start(self, q, p):
        return {"count": np.zeros(1)}


@pytest.mark.parametrize("law", [Pulled().discrete(), PulledSteps(MinimalFlocking())])
def test_a_subclass_is_not_bypassed(law):
    q, p = state(5, 2)
    blown, calm = simulate(law, q, p, (0.0, 0.5)), simulate(MinimalFlocking().discrete(), q, p, (0.0, 0.5))
    assert_same_bits((blown.q[1:], blown.p[1:], blown.u[1:]), one_by_one(law, q, p, 5))
    assert np.abs(blown.q[1] - calm.q[1]).min() > 0.009  # dt² of the wind


def test_what_a_subclass_remembers_is_kept():
    run = simulate(Counted(MinimalFlocking()), *state(5, 2), (0.0, 0.5))
    assert run.extra["count"].shape == (6, 1)


@pytest.mark.parametrize("edges", [None, [(0, 1), (1, 2)]])
def test_distances_of_all_pairs_are_in_the_metrics(edges):
    q = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 4.0]])
    run = simulate(MinimalFlocking(edges=edges), q, 0.0 * q, (0.0, 0.1))
    assert run.metric("median_distance")[0] == 4.0
    assert run.metric("largest_distance")[0] == 5.0


test_the_number_of_agents_must_fit = refused(
    (lambda: MinimalFlocking(**CASES["spacing"]).acceleration(0.0, *state(4, 2)), "4 agents: expected 5"),
    (lambda: simulate(MinimalFlocking(edges=TREE), *state(3, 2), (0.0, 1.0)), "3 agents: expected at least 5"),
    (
        lambda: simulate(MinimalFlocking(edges=TREE).discrete(), *state(3, 2), (0.0, 1.0)),
        "3 agents: expected at least 5",
    ),
    (lambda: DiscreteMinimalFlocking(3), r"expected MinimalFlocking\(\.\.\.\)"),
    (lambda: MinimalFlocking().discrete(0.0), "dt = 0"),
)
