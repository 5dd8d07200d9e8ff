"""What a checker of basins asks of each pair and shell, and that a basin of nothing is none."""

import copy
import json
from fractions import Fraction

import numpy as np
import pytest
from flint import arb, arb_mat, ctx, fmpq

from flockana import Algorithm2, AlphaInteraction, Gains, StaticTarget
from flockana.certified import check_basin
from flockana.certified.balls import dot
from flockana.certified.certificate import basin_certificate
from flockana.certified.certificate_check import RejectedError, check_data, unit
from flockana.certified.check_basin import DIGITS, ROOT_TWO, Net
from flockana.certified.decimal_rounding import decimal, round_down
from flockana.certified.enclosed_equilibrium import unique_projection
from flockana.certified.structural_potential import Structure
from tests.certified.conftest import basin_of, resealed, text_of


@pytest.fixture
def data():
    return copy.deepcopy(json.loads(json.dumps(basin_certificate(basin_of("triangle", 1)))))


def checked(data):
    return check_data(resealed(data))


def test_each_bound_is_asked_for_about_all_lengths_of_its_pairs_and_up_to_its_shell_s_end(data, monkeypatch):
    asked, places = [], []
    holds, equilibrium = Net.floor_holds, Net.equilibrium

    def noted(self, rest, eta, along, across):
        asked.append((rest, eta, along, across))
        return holds(self, rest, eta, along, across)

    monkeypatch.setattr(Net, "floor_holds", noted)
    monkeypatch.setattr(Net, "equilibrium", lambda self: places.append((self, equilibrium(self))) or places[-1][1])
    checked(data)
    net, x = places[0]
    with ctx.workdps(DIGITS):
        lengths = [length for _, _, length in net.pairs(x)]
    (bond,), shells = data["bonds"], len(data["curvatures"])
    assert len(asked) == shells == 16
    for k, (rest, eta, along, across) in enumerate(asked):
        assert all(rest.contains(length) for length in lengths)
        assert eta == Fraction(data["radius"]) * ROOT_TWO * (k + 1) / 16
        assert (along, across) == (Fraction(bond["along"][k]), Fraction(bond["across"][k]))


@pytest.mark.parametrize(("name", "value"), [("radius", "0"), ("radius", "-0.4"), ("curvatures", [])])
def test_a_radius_that_is_none_and_a_basin_without_shells_are_refused(data, name, value):
    with pytest.raises(RejectedError, match="no radius"):
        checked(data | {name: value})


@pytest.mark.parametrize("again", [[0, 1], [1, 0], [0, 3]])
def test_a_pair_is_listed_once_and_is_one(data, again):
    data["bonds"].append({**data["bonds"][0], "pairs": [again]})
    with pytest.raises(RejectedError, match="listed twice, or is none"):
        checked(data)


@pytest.mark.parametrize("name", ["along", "across"])
def test_a_bond_has_one_bound_for_each_shell(data, name):
    data["bonds"][0][name].append(data["bonds"][0][name][-1])
    with pytest.raises(RejectedError, match="other than one bound for each shell"):
        checked(data)


def test_a_curvature_is_stated_to_four_digits(data):
    stated = Fraction(data["curvatures"][3])
    data["curvatures"][3] = str(float(stated - unit(stated, 4) / 2))
    with pytest.raises(RejectedError, match="too many digits"):
        checked(data)


def test_two_agents_that_are_free_to_meet_have_no_basin(data, monkeypatch):
    """At places that coincide nothing is apart, whatever the certificate's other numbers are."""
    monkeypatch.setattr(Net, "equilibrium", lambda self: [self.centre[0], self.centre[0], self.centre[2]])
    with pytest.raises(RejectedError, match="agents may collide"):
        checked(data)


@pytest.mark.parametrize(("share", "unseen"), [(0.0, True), (0.99, True), (1.01, False)])
def test_a_pair_out_of_range_that_may_come_into_it_is_missed(data, monkeypatch, share, unseen):
    """At rest it is out of range by a share of what two agents may come nearer."""
    far = 8.4 + share * 1.4142136 * float(data["radius"])
    monkeypatch.setattr(Net, "equilibrium", lambda self: [[arb(x), arb(0)] for x in (0.0, 7.0, far)])
    data["bonds"][0]["pairs"] = [[0, 1], [1, 2]]
    with pytest.raises(RejectedError) as error:
        checked(data)
    assert ("may come into range unseen" in str(error.value)) is unseen


def test_the_nearest_point_is_asked_to_be_unique_in_all_of_the_radius(data, monkeypatch):
    asked = []
    monkeypatch.setattr(Net, "unique_projection", lambda self, x, radius: asked.append(radius) or len(asked) == 1)
    checked(data)
    assert asked[0].overlaps(arb(data["radius"]))
    with pytest.raises(RejectedError, match="nearest point"):
        checked(data)


@pytest.mark.parametrize("share", [Fraction(1, 2), Fraction(-1, 2)])
def test_the_rate_counts_all_that_damps_the_velocities(share):
    """With κ so large that the second of the three rates is the least, at `share` of what it is without damping."""
    data = copy.deepcopy(json.loads(json.dumps(basin_certificate(basin_of("triangle", 2)))))
    eps, theta, tau = (Fraction(data["lyapunov"][name]) for name in ("eps", "theta", "tau"))
    curvature, surplus, degree = (Fraction(data[name]) for name in ("curvature", "surplus", "degree"))
    c2_alpha, c2_gamma = (Fraction(data["law"][name]) for name in ("c2_alpha", "c2_gamma"))
    most = c2_gamma + 2 * c2_alpha * degree
    free = theta * curvature + 2 * (theta * surplus + (1 - theta) * curvature)
    kappa = (1 - share * min(1, theta * (curvature + eps * tau) / free)) * free / most
    rate = eps * (free - kappa * most) / (curvature + eps * tau) / 2
    data["lyapunov"]["kappa"], data["rate"] = (
        str(kappa),
        decimal(round_down(fmpq(rate.numerator, rate.denominator), 3)),
    )
    if share > 0:
        checked(data)
    else:
        with pytest.raises(RejectedError, match="the rate is not that of F"):
            checked(data)


LAW = Algorithm2(
    alpha=AlphaInteraction(a=1.0, b=3.0),
    gains=Gains(c1_alpha=4.0, c2_alpha=0.75, c1_gamma=1.5, c2_gamma=2.0),
    target=StaticTarget((0.0, 0.0)),
)
X = np.array([[-3.0, 0.5], [3.5, 0.25], [0.75, 5.25], [9.5, 4.0]])  # lengths from 4.5 to 13: pressed, stretched, apart


@pytest.fixture(autouse=True)
def precise():
    with ctx.workdps(30):
        yield


def balls(x):
    return [[arb(float(y)) for y in row] for row in x]


def floats(matrix):
    return np.array([[float(y) for y in row] for row in (matrix.tolist() if hasattr(matrix, "tolist") else matrix)])


NET = Net(text_of(LAW, X))


@pytest.mark.parametrize("length", [3.0, 6.5, 7.0, 7.5, 8.25, 9.0])
def test_tension_stiffness_and_weight_are_those_of_a_pair_of_the_law(length):
    def pull(x):
        """c1α φ_α(‖x‖_σ) x/√(1 + εx²)."""
        return 4.0 * LAW.alpha.phi_alpha(LAW.alpha.sigma_norm(x)) * x / np.sqrt(1.0 + LAW.alpha.eps * x**2)

    step = 1e-5
    slope = (pull(length + step) - pull(length - step)) / (2.0 * step)
    assert float(NET.tension(arb(length))) == pytest.approx(float(pull(length)) / length, abs=1e-12)
    assert float(NET.stiffness(arb(length))) == pytest.approx(float(slope), abs=1e-7)
    weight = LAW.alpha.adjacency(LAW.alpha.sigma_norm(length))
    assert float(NET.weight(arb(length))) == pytest.approx(float(weight), abs=1e-14)


def test_force_and_slope_are_those_of_the_law():
    still = np.zeros_like(X)
    pulled = -LAW.flow(0.0, X, still)[0]
    np.testing.assert_allclose([float(y) for y in NET.force(balls(X))], pulled.ravel(), atol=1e-12)
    held = NET.rotation_tangents(NET.centre) + NET.translations()
    found = floats(NET.slope(balls(X), held))
    np.testing.assert_allclose(found[:8, :8], LAW.stiffness(X).toarray(), atol=1e-11)
    motions = np.array([[-y for _, y in X], [x for x, _ in X]]).T.ravel()
    np.testing.assert_array_equal(found[8:, :8], [motions, [1, 0] * 4, [0, 1] * 4])
    np.testing.assert_array_equal(found[:8, 8:], found[8:, :8].T)
    assert not found[8:, 8:].any()


def test_the_matrix_of_an_equilibrium_that_is_enclosed_holds_that_of_each_point():
    gaps, floors = {(0, 1): [arb(6.5), arb(-0.25)]}, {(0, 1): (Fraction(5, 2), Fraction(-1, 4))}
    wide = NET.radial([[y + arb(0, 0.125) for y in row] for row in balls(X)], gaps, floors)
    for sign in (-0.0625, 0.0625):
        x = X + sign * np.array([1.0, -1.0])
        point = Net(text_of(LAW, x)).radial(balls(x), gaps, floors)
        assert all(a.contains(b) for a, b in zip(wide.entries(), point.entries(), strict=True))


@pytest.mark.parametrize("w", [(1, 0, -1, 0, 0, 0, 0, 0), (0, 1, 0, 2, 0, -3, 0, 0), (1, -2, 3, 0.5, -4, 1, 0, 0.5)])
def test_the_matrix_of_bounds_is_their_sum_over_pairs(w):
    """⟨w, M w⟩ = c1γ‖w‖² + Σ α ⟨u, e⟩² + β (|e|² − ⟨u, e⟩²), e = w_j − w_i, for w orthogonal to rigid motions."""
    x, floors = X, {(0, 1): (Fraction(5, 2), Fraction(-1, 4)), (1, 3): (Fraction(-3), Fraction(7, 8))}
    motions = np.array([[-x[:, 1], x[:, 0]], [np.ones(4), np.zeros(4)], [np.zeros(4), np.ones(4)]])
    motions = np.array([np.column_stack(motion).ravel() for motion in motions])
    w = np.array(w) - motions.T @ np.linalg.lstsq(motions.T, np.array(w, dtype=float), rcond=None)[0]
    expected = 1.5 * float(w @ w)
    for (i, j), (along, across) in floors.items():
        e, u = w.reshape(4, 2)[j] - w.reshape(4, 2)[i], (x[j] - x[i]) / np.linalg.norm(x[j] - x[i])
        expected += float(along) * (u @ e) ** 2 + float(across) * (e @ e - (u @ e) ** 2)
    gaps = {(i, j): [arb(float(y)) for y in x[j] - x[i]] for i, j in floors}
    matrix = NET.radial(balls(x), gaps, floors)
    exact_w = arb_mat([[arb(float(y))] for y in w])
    assert float((exact_w.transpose() * matrix * exact_w)[0, 0]) == pytest.approx(expected, abs=1e-4)
    for motion in motions:  # which are lifted far above every curvature
        g = arb_mat([[arb(float(y))] for y in motion])
        assert (g.transpose() * matrix * g)[0, 0] > 10**6 * float(motion @ motion)


def test_the_laplacian_of_a_path_and_its_lifted_translation():
    found = floats(Net(text_of(LAW, X[:3])).laplacian({(0, 1): arb(2), (1, 2): arb(3)}))
    np.testing.assert_array_equal(found - 1.0, [[2, -2, 0], [-2, 5, -3], [0, -3, 3]])


UNIT = 2.0**-16


def triangle_off(w, box):
    """A net of Algorithm 1 about the triangle of side 7 moved by so many units, in a box of so many of them."""
    data = json.loads(json.dumps(basin_certificate(basin_of("triangle", 1))))
    rest = np.array([[0.0, 7.0 / np.sqrt(3.0)], [-3.5, -3.5 / np.sqrt(3.0)], [3.5, -3.5 / np.sqrt(3.0)]])
    moved = rest + UNIT * np.reshape(w, (3, 2))
    return Net({**data, "positions": [[y.hex() for y in row] for row in moved], "box": repr(box * UNIT)})


@pytest.mark.parametrize("digits", [10, 30])
def test_an_equilibrium_that_is_not_where_it_was_sought_is_found_in_the_box(digits):
    """Beside the positions, and turned as they are: ⟨turns, x − positions⟩ = 0, Σ x = 0, and all sides are 7."""
    net = triangle_off([1, -1, 1, 1, -1, 1], 4)
    with ctx.workdps(digits):
        x = net.equilibrium()
    for _, _, side in net.pairs(x):
        assert side.contains(7)
        assert side.rad() < 1e-6
    places, before = ([y for row in rows for y in row] for rows in (x, net.centre))
    moved = [a - b for a, b in zip(places, before, strict=True)]
    assert dot(net.rotation_tangents(net.centre)[0], moved).contains(0)
    assert all(dot(shift, places).contains(0) for shift in net.translations())
    assert any(abs(y) > UNIT / 2 for y in moved)


def test_a_preconditioner_that_tells_nothing_proves_nothing(monkeypatch):
    """With Y = 0 Krawczyk's operator is the box itself, of which no point is proved to be a zero."""
    monkeypatch.setattr(check_basin, "proposed_inverse", lambda matrix: 0 * matrix)
    with pytest.raises(RejectedError, match="Krawczyk's test fails"):
        triangle_off([0] * 6, 1).equilibrium()


@pytest.mark.parametrize("k", range(6))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_box_that_one_coordinate_of_the_equilibrium_is_not_in_is_refused(k, sign):
    """A displacement orthogonal to the rigid motions, of which the coordinate k is by far the largest."""
    rest = triangle_off([0.0] * 6, 1)
    held = floats(rest.rotation_tangents(rest.centre) + rest.translations())
    w = np.eye(6)[k] - held.T @ np.linalg.lstsq(held.T, np.eye(6)[k], rcond=None)[0]
    w *= sign / w[k]
    assert 1.1 * np.sort(np.abs(w))[-2] < 1.0  # the others stay in
    assert len(triangle_off(0.9 * w, 1).equilibrium()) == 3
    with pytest.raises(RejectedError, match="Krawczyk's test fails"):
        triangle_off(1.1 * w, 1).equilibrium()


def test_a_box_in_which_the_flock_may_turn_round_is_refused():
    """Along the orbit there are other equilibria, and only a box in which no turn is lost holds one."""
    net = Net({**text_of(LAW, [[-1e-3, 0.0], [1e-3, 0.0]], "0.01")})
    with pytest.raises(RejectedError, match="the rotations are not independent"):
        net.equilibrium()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        *(({name: -0.5}, "a gain is negative") for name in ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma")),
        ({"algorithm": "Algorithm3"}, "neither Algorithm 1 nor 2"),
        *(({"algorithm": "Algorithm1", name: 0.0}, "no gains of a γ-agent") for name in ("c1_gamma", "c2_gamma")),
    ],
)
def test_what_is_no_such_law_is_refused(change, message):
    with pytest.raises(RejectedError, match=message):
        Net(text_of(LAW, X, **change))


@pytest.mark.parametrize("positions", [[[1.0, 2.0]], [[1.0, 2.0], [3.0]], [[1.0] * 4, [2.0] * 4]])
def test_what_is_no_flock_is_refused(positions):
    with pytest.raises(RejectedError, match="no flock"):
        Net(text_of(LAW, positions))


SQUARE = ([(x, y) for x in (1, -1) for y in (1, -1)], 8.0**0.5)
TETRAHEDRON = ([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], (12 - 48**0.5) / (1 + 3**0.5) / 48**0.25)


@pytest.mark.parametrize(("corners", "size"), [SQUARE, TETRAHEDRON], ids=["square", "tetrahedron"])
@pytest.mark.parametrize(("share", "unique"), [(0.99999, True), (1.00001, False)])
def test_the_nearest_point_of_an_orbit_is_unique_below_the_size_of_the_net(corners, size, share, unique):
    """√8 of the square; of the tetrahedron Σ x xᵀ = 4·1: (1 + √3) r √|4·1| < tr − |4·1|, in the norm √48 of 4·1."""
    n, m, x = len(corners), len(corners[0]), [[arb(y) for y in row] for row in corners]
    radius = fmpq(round(1e9 * share * size), 10**9)
    assert Net(text_of(LAW, corners)).unique_projection(x, arb(radius)) is unique
    assert unique_projection(Structure.of(LAW, n, m), [y for row in x for y in row], radius) is unique
