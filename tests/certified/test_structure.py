"""The structural energy in balls against the laws' own numbers: its value, gradient, Hessian and invariance."""

import numpy as np
import pytest
from flint import arb, ctx

from flockana import Algorithm1, Algorithm2, AlphaInteraction, CuckerSmale, Gains, StaticTarget
from flockana.base.errors import ArgumentError
from flockana.certified.balls import dot
from flockana.certified.structure import Structure, outer

GAINS = Gains(c1_alpha=2.5, c2_alpha=0.75, c1_gamma=1.25, c2_gamma=0.5)
ALPHA = AlphaInteraction(a=2.0, b=5.0, d=6.0, r=7.5)


def law_of(m, *, led):
    return Algorithm2(ALPHA, GAINS, StaticTarget((0.0,) * m)) if led else Algorithm1(ALPHA, GAINS)


def places(m):
    """Pairs in the core, at a distance, on the taper and out of range; their sum is 0."""
    q = np.random.default_rng(m).uniform(-5.0, 5.0, (6, m))
    q[0] += 30.0
    return q - q.mean(axis=0)


@pytest.fixture(autouse=True)
def precise():
    with ctx.workprec(128):
        yield


@pytest.mark.parametrize("led", [False, True])
@pytest.mark.parametrize("m", [1, 2, 3])
def test_energy_gradient_and_hessian_are_those_of_the_law(m, led):
    law, q = law_of(m, led=led), places(m)
    of, x = Structure.of(law, 6, m), [arb(y) for y in q.ravel()]
    s = np.linalg.norm(q[:, None] - q, axis=2)[np.triu_indices(6, 1)]
    assert 0 < np.sum(s > ALPHA.r) < 15
    assert float(of.energy(x)) == pytest.approx(law.structural_energy(q, 0.0 * q), rel=1e-13)
    assert len(list(of.near(x))) == np.sum(s < ALPHA.r)
    force = law.acceleration(0.0, q, 0.0 * q)
    np.testing.assert_allclose([-float(y) for y in of.gradient(x)], force.ravel(), atol=1e-11)
    found = np.array([[float(y) for y in row] for row in of.hessian(x).tolist()])
    np.testing.assert_allclose(found, law.stiffness(q).toarray(), atol=1e-11)
    weights = [float(of.weight(arb(y) ** 2)) for y in s]
    np.testing.assert_allclose(weights, ALPHA.adjacency(ALPHA.sigma_norm(s)), atol=1e-13)


def test_two_agents_beyond_the_range_have_the_potential_there():
    of = Structure.of(law_of(1, led=False), 2, 1)
    assert float(of.energy([arb(-4), arb(4)])) == pytest.approx(2.5 * ALPHA.far_potential, rel=1e-13)
    assert float(of.energy([arb(-3), arb(3)])) == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_turns_and_shifts_are_the_rigid_motions(m):
    """As many as there are; each leaves all distances as they are to first order."""
    of, q = Structure.of(law_of(m, led=False), 6, m), places(m)
    x = [arb(y) for y in q.ravel()]
    motions = [*of.rotation_tangents(x), *of.translations()]
    assert len(of.rotation_tangents(x)) == m * (m - 1) // 2
    assert np.linalg.matrix_rank([[float(y) for y in row] for row in motions]) == len(motions)
    for row in motions:
        way = np.array([float(y) for y in row]).reshape(6, m)
        for i in range(6):
            np.testing.assert_allclose(((way - way[i]) * (q - q[i])).sum(axis=1), 0.0, atol=1e-13)


def test_products():
    a, b = ([arb(y) for y in z] for z in ((1, -2, 3), (4, 5, 6)))
    assert dot(a, b) == 12
    block = outer(a, arb(7), arb(2))
    assert [[float(y) for y in row] for row in block] == [[9.0, -4.0, 6.0], [-4.0, 15.0, -12.0], [6.0, -12.0, 25.0]]


@pytest.mark.parametrize(
    ("law", "message"),
    [
        (CuckerSmale(), "expected Algorithm1 or Algorithm2 with AlphaInteraction, unwrapped"),
        (Algorithm1(gains=Gains(c1_alpha=0.0)), "c1_alpha = 0: expected more than 0, or no force holds the agents"),
        (Algorithm1(AlphaInteraction(unit=2.0)), "unit = 2: expected 1; rescale law and places by it"),
    ],
)
def test_other_laws_are_refused(law, message):
    with pytest.raises(ArgumentError, match=message):
        Structure.of(law, 2, 2)
