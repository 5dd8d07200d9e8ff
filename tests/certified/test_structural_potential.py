"""The structural energy in balls against the laws' own numbers: its value, gradient, Hessian and invariance."""

import numpy as np
import pytest
from flint import arb, arb_mat, ctx
from scipy.spatial.transform import Rotation

from flockana import Algorithm1, Algorithm2, AlphaInteraction, CuckerSmale, Gains, StaticTarget
from flockana.base.errors import ArgumentError
from flockana.certified import krawczyk
from flockana.certified.enclosed_equilibrium import centred, rotated_to
from flockana.certified.krawczyk import enclose_zero, least_eigenvalue
from flockana.certified.structural_potential import Structure
from tests.refused import refused

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


def turned(angle, m):
    """A rotation in the plane; in space about an axis askew."""
    if m == 2:
        return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return Rotation.from_rotvec(angle * np.array([0.6, -0.48, 0.64])).as_matrix()


@pytest.mark.parametrize("m", [2, 3])
@pytest.mark.parametrize("angle", [0.0, 0.3, 2.0, -2.9])
def test_the_equilibrium_is_turned_to_the_flock_by_a_true_rotation(angle, m):
    """Lengths and angles stay to 60 digits, though the matrix is proposed in floating point."""
    rest = np.random.default_rng(m).normal(size=(5, m))
    with ctx.workprec(200):
        found = rotated_to(centred("rest", rest, (5, m)), [arb(y) for y in (rest @ turned(angle, m).T).ravel()], (5, m))
        rows, before = ([z[i : i + m] for i in range(0, 5 * m, m)] for z in (found, centred("rest", rest, (5, m))))
        for a in range(5):
            for b in range(a + 1):
                kept, was = (sum(x * y for x, y in zip(z[a], z[b], strict=True)) for z in (rows, before))
                assert kept.overlaps(was)
                assert kept.rad() < 1e-50
        middle = (rest - rest.mean(axis=0)) @ turned(angle, m).T
        np.testing.assert_allclose([float(x) for x in found], middle.ravel(), atol=1e-14)


@pytest.mark.parametrize("m", [2, 3])
def test_a_mirrored_flock_is_turned_to_as_well_as_a_rotation_can(m):
    """Against the angle of the sum of products in the plane, and scipy's alignment in space."""
    rest = np.array([[1.0, 0.2, 0.3], [-0.4, 1.0, -0.9], [-0.6, -1.2, 0.6]])[:, :m]
    seen = rest * [1.0, -1.0, 1.0][:m] + 0.1 * rest[::-1]
    found = rotated_to(*([arb(y) for y in z.ravel()] for z in (rest, seen)), (3, m))
    best = Rotation.align_vectors(seen, rest)[0].as_matrix() if m == 3 else None
    if m == 2:
        dots, crosses = (rest * seen).sum(), (rest[:, 0] * seen[:, 1] - rest[:, 1] * seen[:, 0]).sum()
        best = turned(np.arctan2(crosses, dots), 2)
    np.testing.assert_allclose([float(x) for x in found], (rest @ best.T).ravel(), atol=1e-13)


def test_the_sum_over_the_agents_is_taken_off():
    assert [float(x) for x in centred("q", [[1.0, 2.0], [4.0, 8.0]], (2, 2))] == [-1.5, -3.0, 1.5, 3.0]


test_other_shapes_and_numbers_are_refused = refused(
    ([[1.0, 2.0]], r"x has shape \(1, 2\): expected \(2, 2\), as the equilibrium"),
    ([[1.0], [2.0]], r"x has shape \(2, 1\): expected \(2, 2\)"),
    ([[1.0, np.nan], [0.0, 0.0]], "x holds a number that is not finite: expected finite coordinates"),
    make=lambda values: centred("x", values, (2, 2)),
)


def root_of_two(centre, radius):
    return enclose_zero(
        lambda x: [x[0] * x[0] - 2], lambda x: arb_mat([[2 * x[0]]]), [arb(float(centre))], arb(float(radius))
    )


def test_the_zero_of_a_parabola_is_enclosed_and_none_where_there_is_none():
    (found,) = root_of_two(1.375, 0.125)
    assert found.contains(arb(2).sqrt())
    assert found.rad() < 0.125**2
    assert root_of_two(1.25, 0.125) is None  # √2 is outside
    assert root_of_two(1.625, 0.125) is None
    assert root_of_two(0.25, 2.0) is None  # two of them inside


@pytest.mark.parametrize(("place", "inside"), [(1.0624, True), (1.0625, False), (0.9376, True), (0.9375, False)])
def test_a_zero_on_the_edge_of_the_box_is_not_inside(place, inside):
    found = enclose_zero(lambda x: [x[0] - place], lambda x: arb_mat([[1]]), [arb(1)], arb(0.0625))
    assert (found is not None) is inside
    assert not inside or found[0].contains(arb(place))


def test_a_zero_of_two_equations_is_enclosed_by_what_slopes_leave_open():
    """3x + y = 5 + δ, x + 2y = 5 with an unknown δ of size 1/64: (1, 2) moves by (2, −1) δ/5."""
    slope, off = arb_mat([[3, 1], [1, 2]]), arb(0, arb(1) / 64)
    centre = [arb(1.03125), arb(1.96875)]
    found = enclose_zero(
        lambda x: [3 * x[0] + x[1] - 5 + off, x[0] + 2 * x[1] - 5], lambda x: slope, centre, arb(0.125)
    )
    for sign in (-1, 0, 1):
        exact = 1 + sign * arb(2) / 320, 2 - sign * arb(1) / 320
        assert all(ball.contains(x) for ball, x in zip(found, exact, strict=True))
    assert max(ball.rad() for ball in found) < 0.007


MATRICES = [
    ([[2, 1], [1, 2]], 1.0),
    ([[5, 2, 0], [2, 5, 2], [0, 2, 5]], 5.0 - 8.0**0.5),
    ([[3, -1, -1], [-1, 3, -1], [-1, -1, 3]], 1.0),  # two others alike
]


@pytest.mark.parametrize(("rows", "exact"), MATRICES)
@pytest.mark.parametrize("proposed", [1.0, 3.0, "nearly"])
def test_the_least_eigenvalue_is_bounded_whatever_vectors_are_proposed(monkeypatch, rows, exact, proposed):
    own = np.linalg.eigh

    def other(matrix):
        values, vectors = own(matrix)
        return values, vectors * proposed if proposed != "nearly" else vectors + 1e-3 * np.arange(vectors.size).reshape(
            vectors.shape
        )

    monkeypatch.setattr(krawczyk.np.linalg, "eigh", other)
    found = float(least_eigenvalue(arb_mat(rows)))
    assert exact * (0.9 if proposed == "nearly" else 1.0 - 1e-12) < found <= exact * (1.0 + 1e-15)


def test_balls_count_by_the_worst_matrix_in_them():
    wide = arb_mat([[arb(2, 0.125), arb(1)], [arb(1), arb(2)]])
    exact = 1.9375 - (1.0 + 0.0625**2) ** 0.5  # of [[1.875, 1], [1, 2]]
    assert exact - 0.1 < float(least_eigenvalue(wide)) <= exact


@pytest.mark.parametrize("rows", [[[1, 1], [1, 1]], [[1, 2], [2, 1]], [[-1, 0], [0, 1]], [[arb(1, 1.5), 0], [0, 1]]])
def test_what_is_not_certainly_positive_has_no_bound(rows):
    assert least_eigenvalue(arb_mat(rows)) is None
