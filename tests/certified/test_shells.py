"""Shells of curvature: which pairs they hold, what follows from them, and that nothing unproved does."""

from dataclasses import replace

import pytest
from flint import arb, ctx, fmpq

from flockana import Algorithm1
from flockana.certified import shells
from flockana.certified.balls import ball
from flockana.certified.pair_floors import LengthCells
from flockana.certified.shells import SHELLS, BondTable, Shells
from flockana.certified.structure import Structure

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
        found = shells.prove(around, floors)
        assert found.radius == fmpq(1234, 10_000)
        expected = zip(found.along, found.across, strict=True)
        assert asked == [
            (bond.rest, shells.ROOT_TWO * found.radius, i + 1, a[k], b[k])
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
            assert shells.prove(around, floors) is None
        asked.clear()
        refused = None
        assert shells.prove(around, replace(floors, along=floors.along[:, :1])) is None


def test_a_matrix_that_nothing_is_proved_of_leaves_no_shells(monkeypatch):
    with ctx.workdps(25):
        u = Structure.of(LAW, 2, 1)
        around = BondTable(LAW, u, [arb("-3.5"), arb("3.5")])
        floors = around.proposed(0.1)
        found = shells.prove(around, floors)
        assert found is not None
        monkeypatch.setattr(shells, "least_eigenvalue", lambda matrix: None)
        assert shells.prove(around, floors) is None


def test_a_curvature_is_below_that_of_every_matrix_in_the_balls():
    """Of two agents on a line it is 2α: with α in a ball, twice the least."""
    with ctx.workdps(25):
        around = BondTable(LAW, Structure.of(LAW, 2, 1), [arb("-3.5"), arb("3.5")])
        bonds = around.bonds(fmpq(1, 10))
        for along in (arb(3), arb(3, 0.5), arb(-3, 0.5)):
            found = around.curvature(bonds, [along], [fmpq(0)])
            assert found <= 2 * along.lower()
            assert found > 2 * along.lower() - (2 if along.rad() > 0 else arb("0.01"))
