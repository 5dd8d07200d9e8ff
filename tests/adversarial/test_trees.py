"""The bearing-distance theorem on frozen trees: springs in closed form, equilibria to the last bit, collisions."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana.measures.perception import both_ways, edge_vectors, random_out_tree
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from tests.adversarial.cases import FALSE, OPEN, REFUTED, TRUE, VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import powers, seeds, ways

THEOREMS = ("zone-1-printed", "zone-1-corrected")
HELD = "lengths", "velocities", "spectrum", "exponential", "root-edge", "energy", "no-collision"
CORRECTED = dict.fromkeys(HELD, TRUE)
PRINTED = {"equilibrium": REFUTED, "edges": FALSE, "velocities": TRUE, "hurwitz": TRUE | FALSE}
exactly = st.just(0.0)


def printed(case):
    """What the printed theorem may be said to be; one sample shows no motion, and decides nothing."""
    one_sample = np.size(case.options.get("t_eval", (0.0, case.until))) < 2
    return PRINTED | ({"equilibrium": FALSE} if one_sample else {})


scales = st.sampled_from((1.0, 2.0, 1e-6, 1e4))


def placed(edges, lengths, rng, m):
    q = np.zeros((1 + max(max(edge) for edge in edges), m))
    for (j, i), length in zip(edges, lengths, strict=True):
        axis = rng.normal(size=m)
        q[i] = q[j] + length * axis / np.linalg.norm(axis)
    return q


@st.composite
def trees(draw, *, directed=True, off=exactly, sigma=1.0):
    """(law, q, ρ, generator) of a random tree with every edge near its desired length, in any unit of length."""
    n, m, rho, mu = map(draw, (st.integers(2, 6), st.integers(1, 3), scales, st.sampled_from((1.0, 0.2, 5.0))))
    rng = np.random.default_rng(draw(seeds))
    edges = random_out_tree(n, rng)
    lengths = rho * (1.0 + draw(off) * rng.uniform(-1.0, 1.0, n - 1))
    q = placed(edges, lengths, rng, m)
    edges = edges if directed else both_ways(edges)
    return MinimalFlocking(edges=edges, spacing=rho, mu=mu, sigma=sigma, normalised=directed), q, rho, rng


@effort(0.4)
@given(trees(), powers(-9.0, 1.5), st.sampled_from((0.0, 1.0, 1e3)), st.data())
def test_at_its_own_equilibrium(drawn, until, drift, data):
    law, q, rho, _ = drawn
    p = np.full(q.shape, drift * rho)
    case = Case(law, q, p, until, data.draw(ways(until, until / 100.0)))
    hold("zone-1-corrected", case, CORRECTED)
    hold("zone-1-printed", case, printed(case))


@effort(0.4)
@given(trees(off=powers(-8.0, -0.4)), powers(-8.0, -0.4), st.sampled_from((1e-6, 0.01, 3.0, 60.0, 1000.0)), st.data())
def test_near_the_manifold(drawn, speed, until, data):
    law, q, rho, rng = drawn
    case = Case(law, q, speed * rho * rng.normal(size=q.shape), until, data.draw(ways(until, until / 1000.0)))
    hold("zone-1-corrected", case, CORRECTED)
    hold("zone-1-printed", case, printed(case))


@effort(0.2)
@given(trees(off=st.just(0.2)), st.booleans())
def test_edges_take_their_lengths(drawn, long):
    """y'' + y' + μy = 0 along each edge: settled after 150 slowest times, however deep the tree."""
    law, q, _, _ = drawn
    slowest = min(0.5, float(np.min(law.mu)))
    case = Case(law, q, 0.0 * q, (150.0 if long else 0.01) / slowest)
    limit = VERIFIED if long else TRUE
    hold("zone-1-corrected", case, CORRECTED | {"lengths": limit, "velocities": limit, "spectrum": VERIFIED})
    inside = np.linalg.norm(edge_vectors(q, law.edges), axis=1).min() < 0.99 * law.spacing
    expected = {"edges": REFUTED if long else FALSE, "hurwitz": REFUTED if inside else TRUE | FALSE}
    hold("zone-1-printed", case, PRINTED | {"velocities": limit} | expected)


@effort(0.2)
@given(trees(directed=False, off=powers(-8.0, -0.7)), powers(-8.0, -0.7), powers(-7.0, 1.5), st.data())
def test_reciprocal_trees(drawn, speed, until, data):
    """H falls; below μρ²/2 no edge vanishes."""
    law, q, rho, rng = drawn
    case = Case(law, q, speed * rho * rng.normal(size=q.shape), until, data.draw(ways(until, until / 1000.0)))
    hold("zone-1-corrected", case, CORRECTED)
    hold("zone-1-printed", case, dict.fromkeys(("edges", "velocities", "hurwitz"), VACUOUS))


@effort(0.2)
@given(trees(off=st.just(0.1), sigma=0.0), st.integers(1, 6))
def test_without_alignment_it_swings_for_ever(drawn, halves):
    """y'' + μy = 0 on the edges of the root, from rest: at rest again, for an instant, after each half period."""
    law, q, _, _ = drawn
    case = Case(law, q, 0.0 * q, halves * np.pi / np.sqrt(law.mu))
    hold("zone-1-corrected", case, dict.fromkeys(CORRECTED, OPEN))
    hold("zone-1-printed", case, PRINTED | {"equilibrium": VACUOUS, "velocities": FALSE})


@pytest.mark.parametrize("m", [1, 2, 3])
def test_linked_agents_at_one_place(m):
    law = MinimalFlocking(edges=((0, 1), (1, 2)), spacing=1.0)
    q = np.zeros((3, m))
    q[2, 0] = 1.0
    case = Case(law, q, 0.0 * q, 1.0)
    hold("zone-1-corrected", case, CORRECTED)
    hold("zone-1-printed", case, {"edges": TRUE | FALSE, "velocities": TRUE | FALSE, "hurwitz": TRUE | FALSE})


@pytest.mark.parametrize("sized", [1.0, 1e-6, 1e5])
@pytest.mark.parametrize("speed", [0.5, 0.99, 1.01, 4.0])
def test_the_root_edge_bound(speed, sized):
    """V(0) = ½ speed² against ½μρ²: below it the edge never vanishes, above it the theorem says nothing."""
    law = MinimalFlocking(edges=((0, 1),), spacing=sized)
    case = Case(law, [[0.0], [sized]], [[0.0], [-speed * sized]], 8.0)
    bound = VERIFIED if speed < 0.9 else TRUE if speed < 1.0 else OPEN
    hold("zone-1-corrected", case, CORRECTED | {"root-edge": bound})
