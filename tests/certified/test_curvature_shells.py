"""Shells of curvature: which pairs they hold, what follows from them, and that nothing unproved does."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from flint import arb, ctx, fmpq

from flockana import Algorithm1, AlphaInteraction
from flockana.certified import curvature_shells
from flockana.certified.balls import ball, square
from flockana.certified.check_basin import Net
from flockana.certified.curvature_shells import SHELLS, BondTable, LengthCells, Shells, points, proposed_across
from flockana.certified.decimal_rounding import decimal, round_down, round_up
from flockana.certified.lyapunov import Bounds, damping, decay
from flockana.certified.structural_potential import Structure
from tests.certified.conftest import text_of

LAW = Algorithm1()


@pytest.mark.parametrize(
    ("curvatures", "slopes", "level", "curvature", "surplus"),
    [
        ([2] * 16, [2 * t for t in range(1, 17)], 256, 2, 1),  # G = t²
        ([2] * 8 + [0] * 8, [2, 4, 6, 8, 10, 12, 14, 16] + [16] * 8, 192, 1, fmpq(1, 4)),  # then 64 + 16 (t − 8)
        ([0] * 8 + [2] * 8, [0] * 8 + [2, 4, 6, 8, 10, 12, 14, 16], 64, 0, 0),
    ],
)
def test_what_follows_from_curvatures_is_their_integral(curvatures, slopes, level, curvature, surplus):
    """G'' = k, G(0) = G'(0) = 0, in shells of width 1."""
    found = Shells(fmpq(SHELLS), (), (), (), tuple(fmpq(k) for k in curvatures))
    assert list(found.slopes) == slopes
    assert (found.level, found.curvature, found.surplus) == (level, curvature, surplus)


def test_pairs_that_may_come_into_range_have_bounds_too():
    with ctx.workdps(25):
        u = Structure.of(LAW, 3, 1)
        around = BondTable(LAW, u, [arb(-8), arb(0), arb("8.5")])
        assert [bond.pairs for bond in around.bonds(fmpq(1, 20))] == [((0, 1),)]
        assert [bond.pairs for bond in around.bonds(fmpq(1, 5))] == [((0, 1),), ((1, 2),)]
        wide = BondTable(LAW, u, [arb(-8), arb(0), arb("8.55", "0.2")])
        assert [bond.pairs for bond in wide.bonds(fmpq(1, 100))] == [((0, 1),), ((1, 2),)]


def test_pairs_of_one_bond_have_all_their_lengths_in_one_ball():
    with ctx.workdps(25):
        around = BondTable(LAW, Structure.of(LAW, 3, 1), [arb(-7), arb(0), arb("7.0000005")])
        (bond,) = around.bonds(fmpq(1, 10))
        assert bond.pairs == ((0, 1), (1, 2))
        assert bond.rest.contains(7)
        assert bond.rest.contains(arb("7.0000005").mid())


def test_what_is_proved_was_asked_of_each_bond_up_to_the_end_of_each_shell(monkeypatch):
    asked, holds = [], LengthCells.holds

    def noted(self, shell, along, across):
        asked.append((self.rest, self.reach, shell, along, across))
        return holds(self, shell, along, across) and len(asked) != refused

    monkeypatch.setattr(LengthCells, "holds", noted)
    with ctx.workdps(25):
        around = BondTable(LAW, Structure.of(LAW, 3, 1), [arb(-7), arb(0), arb("7.25")])
        floors, refused = around.proposed(0.12345678), None
        found = curvature_shells.prove(around, floors)
        assert found.radius == fmpq(1234, 10_000)
        expected = zip(found.along, found.across, strict=True)
        assert asked == [
            (bond.rest, curvature_shells.ROOT_TWO * found.radius, i + 1, a[k], b[k])
            for i, (a, b) in enumerate(expected)
            for k, bond in enumerate(found.bonds)
        ]
        assert len(asked) == 2 * SHELLS
        for i in range(SHELLS):
            proved = around.curvature(found.bonds, found.along[i], found.across[i])
            assert ball(found.curvatures[i]) <= proved
            for stated, proposed in ((found.along[i], floors.along[i]), (found.across[i], floors.across[i])):
                assert all(float(y.p) / float(y.q) <= x for y, x in zip(stated, proposed, strict=True))
        for number in (1, 2, 7):  # of the bound that is not proved
            asked.clear()
            refused = number
            assert curvature_shells.prove(around, floors) is None
        asked.clear()
        refused = None
        assert curvature_shells.prove(around, replace(floors, along=floors.along[:, :1])) is None


def test_a_matrix_that_nothing_is_proved_of_leaves_no_shells(monkeypatch):
    with ctx.workdps(25):
        u = Structure.of(LAW, 2, 1)
        around = BondTable(LAW, u, [arb("-3.5"), arb("3.5")])
        floors = around.proposed(0.1)
        found = curvature_shells.prove(around, floors)
        assert found is not None
        monkeypatch.setattr(curvature_shells, "least_eigenvalue", lambda matrix: None)
        assert curvature_shells.prove(around, floors) is None


def test_a_curvature_is_below_that_of_every_matrix_in_the_balls():
    """Of two agents on a line it is 2α: with α in a ball, twice the least."""
    with ctx.workdps(25):
        around = BondTable(LAW, Structure.of(LAW, 2, 1), [arb("-3.5"), arb("3.5")])
        bonds = around.bonds(fmpq(1, 10))
        for along in (arb(3), arb(3, 0.5), arb(-3, 0.5)):
            found = around.curvature(bonds, [along], [fmpq(0)])
            assert found <= 2 * along.lower()
            assert found > 2 * along.lower() - (2 if along.rad() > 0 else arb("0.01"))


U = Structure.of(LAW, 2, 2)


def curves(length):
    """F'' and T = F'/ℓ of a pair in floating point, and its largest |F''|."""
    alpha, root = LAW.alpha, np.sqrt(1 + LAW.alpha.eps * length**2)
    action = 30.0 * alpha.phi_alpha(alpha.sigma_norm(length))
    stiff = 30.0 * alpha.phi_alpha_slope(alpha.sigma_norm(length)) * (length / root) ** 2 + action / root**3
    return stiff, action / root


def largest_across(rest, eta, along, curves=curves):
    """The largest β on a fine net of displacements, those of length η and those across among them."""
    length = rest + np.linspace(-eta, eta, 1001)[1:-1, None]
    stiff, pull = curves(length)
    turned = np.linspace(0.002, 1.0, 500) * (eta**2 - (length - rest) ** 2) / (2.0 * length * rest)  # 1 − cos
    inward, across = length * (1.0 - turned) - rest, length**2 * turned * (2.0 - turned)
    outward = (length**2 - rest * length * (1.0 - turned)) / length
    form = stiff * outward**2 + pull * (inward**2 + across - outward**2)
    return float(((form - along * inward**2) / across).min())


class Made:
    """A pair at rest at length 1 with F'' = stiff + dip x², T = pull + steeper x, one that no law has."""

    def __init__(self, stiff, pull, steeper=0.0, dip=0.0):
        self.numbers = stiff, pull, steeper, dip

    def __call__(self, length):
        stiff, pull, steeper, dip = self.numbers
        return stiff + dip * (length - 1) ** 2, pull + steeper * (length - 1)

    def of_length(self, length):
        x, (stiff, pull, steeper, dip) = length - 1, map(arb, self.numbers)
        return stiff + dip * square(x), pull + steeper * x

    def stiffness(self, s):
        return self.of_length(s.sqrt())[0]

    def tension(self, s):
        return self.of_length(s.sqrt())[1]


def provers(rest, eta, pair=None):
    """Those of the certificate and of its checker, up to the length η; of a pair that was made up, or of the law's."""
    cells, net = LengthCells(pair or U, arb(rest), fmpq(round(10_000 * eta), 10_000)), Net(text_of(LAW))
    if pair:
        net.stiffness, net.tension = (lambda x, k=k: pair.of_length(x)[k] for k in (0, 1))
    yield lambda a, b: cells.holds(SHELLS, a, b)
    yield lambda a, b: net.floor_holds(arb(rest), as_fraction(cells.reach), as_fraction(a), as_fraction(b))


@pytest.mark.parametrize("rest", [6.8, 7.0, 7.3])
@pytest.mark.parametrize("eta", [0.1, 0.4, 0.7])
def test_proposed_bounds_are_proved(rest, eta):
    x = points(eta)
    stiff, pull = curves(rest + x)
    along = float(stiff.min()) - 0.25 * float(np.abs(stiff).max())
    across = proposed_across(along, rest, x, stiff, pull, eta)
    assert across < largest_across(rest, eta, along)
    with ctx.workdps(25):
        cells = LengthCells(U, arb(rest), fmpq(int(1000 * eta), 1000))
        assert cells.holds(SHELLS, round_down(arb(along), 6), round_down(arb(across), 6))


def as_fraction(number):
    return Fraction(int(number.p), int(number.q))


@pytest.mark.parametrize(
    ("eta", "pair"), [(0.125, Made(1.75, -1.25)), (0.75, Made(-0.5, 1.75, 4.0)), (0.0625, Made(-2.0, -0.5))]
)
def test_where_a_coarse_cell_would_do_it_still_is_a_bound(eta, pair):
    """With α = F'' to the digit each cell has only its own width to spare."""
    along = fmpq(*pair.numbers[0].as_integer_ratio())
    true = largest_across(1.0, eta, pair.numbers[0], lambda length: pair(length + 0.0 * length))
    with ctx.workdps(25):
        for holds in provers(1.0, eta, pair):
            assert not holds(along, round_down(arb(true + 2e-3 * max(1.0, abs(true))), 6))
            assert holds(along, round_down(arb(true - 4.0 * eta**2), 6))


def test_the_least_of_a_square_in_the_turn_may_be_within_and_not_at_its_end():
    """F'' = ½, T = −¼ and α = −2: the pair gives way most where it has turned a part of what it may."""
    pair, along = Made(0.5, -0.25), fmpq(-2)
    true = largest_across(1.0, 0.5, -2.0, lambda length: pair(length + 0.0 * length))
    with ctx.workdps(25):
        for holds in provers(1.0, 0.5, pair):
            assert not holds(along, round_down(arb(true + 2e-3), 6))
            assert holds(along, round_down(arb(true - 0.5), 6))


def test_nothing_is_proved_of_a_pair_of_which_nothing_is_known():
    with ctx.workdps(25):
        for holds in provers(1.0, 0.5, Made(float("nan"), 0.0)):
            assert not holds(fmpq(-10), fmpq(-10))


def test_a_stiffness_that_is_least_at_rest_bounds_what_is_along():
    """F'' = 1 + 100 x²: only within a hundredth of its length has the pair less than 1.01."""
    with ctx.workdps(25):
        for holds in provers(1.0, 0.5, Made(1.0, 0.0, 0.0, 100.0)):
            assert not holds(fmpq(101, 100), fmpq(-1000))
            assert holds(fmpq(99, 100), fmpq(-1000))


@pytest.mark.parametrize(
    ("rest", "eta", "slack"), [(6.8, 0.2, 0.05), (6.8, 0.2, 0.5), (7.0, 0.05, 0.05), (7.6, 0.2, 0.05), (7.6, 0.6, 0.5)]
)
def test_what_is_proved_of_a_pair_is_nearly_all_that_is_true(rest, eta, slack):
    """Below the true β by what the direction of a pair costs, K (η/ℓ0)², nothing is refused; above it nothing holds."""
    x = np.linspace(-eta, eta, 1001)
    stiff = curves(rest + x)[0]
    most = float(np.abs(stiff).max())
    along = round_down(arb(float(stiff.min()) - slack * most), 6)
    true = largest_across(rest, eta, float(along.p) / float(along.q))
    with ctx.workdps(25):
        for holds in provers(rest, eta):
            assert holds(along, round_down(arb(true - 0.4 * most * (eta / rest) ** 2), 6))
            assert not holds(along, round_down(arb(true + 1e-3 * abs(true) + 1e-4), 6))
            assert not holds(round_down(arb(float(stiff.min()) + 1e-3 * most), 6), fmpq(-1000))


def test_damping_of_a_path_is_that_of_its_laplacian():
    u = Structure.of(LAW, 3, 1)
    with ctx.workdps(25):
        lengths = {(0, 1): arb(7), (1, 2): arb(7), (0, 2): arb(14)}
        second, degree = damping(u, lengths, fmpq(1, 2))
    alpha = AlphaInteraction()
    weak, strong = (float(alpha.adjacency(alpha.sigma_norm(7.0 + s))) for s in (0.5, -0.5))
    assert weak * 0.999 < float(second.p) / float(second.q) <= weak  # eigenvalues 0, a, 3a
    assert 2 * strong <= float(degree.p) / float(degree.q) < 2.01 * strong
    with ctx.workdps(25):
        assert damping(u, {**lengths, (1, 2): arb(8)}, fmpq(1, 2))[0] == 0  # the net may part


@pytest.mark.parametrize("seed", range(6))
def test_the_rate_is_one_of_every_linear_system_within_its_bounds(seed):
    """x'' + D x' + K x = 0 with λ <= K <= Λ, μ <= D <= M: dF/dt <= −αF as a quadratic form."""
    rng = np.random.default_rng(seed)
    size = 4
    turn, other = (np.linalg.qr(rng.standard_normal((size, size)))[0] for _ in range(2))
    stiff, drag = np.linspace(1.0, 1.0 + 30.0 * rng.uniform(), size), np.linspace(0.5, 0.5 + 8.0 * rng.uniform(), size)
    k, d = turn @ np.diag(stiff) @ turn.T, other @ np.diag(drag) @ other.T
    bounds = Bounds(fmpq(1), fmpq(1, 2), fmpq(1, 2), round_up(arb(float(drag[-1])), 4))
    found = decay(bounds)
    eps, alpha = (float(y.p) / float(y.q) for y in (found.eps, 2 * found.rate))
    one, zero = np.eye(size), np.zeros((size, size))
    form = 0.5 * np.block([[k, eps * one], [eps * one, one]])
    system = np.block([[zero, one], [-k, -d]])
    change = form @ system + system.T @ form + alpha * form
    assert np.linalg.eigvalsh(change)[-1] <= 1e-12
    assert alpha > 0.0
    assert float(found.overshoot.p) / float(found.overshoot.q) >= (1 + eps) / (1 - eps)


def test_stated_decimals_are_on_the_safe_side_to_the_digit():
    assert decimal(round_down(arb("12.3456"), 4)) == "12.34"
    assert decimal(round_up(arb("12.3416"), 4)) == "12.35"
    assert decimal(round_down(arb("-0.0123416"), 4)) == "-0.01235"
    assert round_down(fmpq(1, 4), 3) == fmpq(1, 4)
    assert round_down(fmpq(0), 3) == 0
