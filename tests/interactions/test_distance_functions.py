"""One vocabulary for functions of the distance, the list of those that a law reads, and pairs at their corners."""

import numpy as np
import pytest

import flockana as fl
from flockana import FixedNetFlocking, Law, PairTerm, ProximityFlocking, Term
from flockana.interactions.distance_functions import DistanceFunction, Within

BENT = fl.pair_law(
    "(s - d)**2/2 + k*Abs(s - d)*(s - d)", adjacency="1 - s/r", range=6.0, length=2.0, parameters={"k": 0.2}
)
FUNCTIONS = {
    "alpha": fl.AlphaInteraction(),
    "dead zone": fl.DeadZoneInteraction(),
    "formula": BENT,
    "formula of the force": fl.pair_law(
        force="k*(s - d)*(r - s)", adjacency=0, range=3.0, length=1.0, parameters={"k": 2.0}
    ),
    "logarithm": fl.LogPotential(2.0, 1.1),
    "cut logarithm": Within(fl.LogPotential(2.0, 1.1), 1.7),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_force_is_minus_the_derivative_of_the_energy_and_slopes_are_derivatives(name):
    of = FUNCTIONS[name]
    end = min(of.range, 5.0)
    s = np.array([0.11, 0.37, 0.52, 0.83, 0.97]) * end
    h = 1e-6 * end
    middle = of.values(s)
    np.testing.assert_allclose(of.force(s), (of.energy(s - h) - of.energy(s + h)) / (2.0 * h), rtol=2e-6, atol=1e-6)
    ends = of.values(s - h), of.values(s + h)
    np.testing.assert_allclose(middle.force_slope, (ends[1].force - ends[0].force) / (2.0 * h), rtol=2e-5, atol=1e-5)
    fading = (ends[1].adjacency - ends[0].adjacency) / (2.0 * h)
    np.testing.assert_allclose(middle.adjacency_slope, fading, rtol=2e-5, atol=1e-5)


def test_values_beyond_the_range_are_those_at_it():
    for of in FUNCTIONS.values():
        if np.isfinite(of.range):
            beyond = of.values(1.5 * of.range)
            assert (beyond.force[0], beyond.adjacency[0], beyond.force_slope[0]) == (0.0, 0.0, 0.0)
            assert of.energy(1.5 * of.range) == pytest.approx(of.energy(of.range * (1.0 - 1e-12)), abs=1e-9)


def test_a_weight_has_no_force():
    weight = fl.RationalWeight(2.0, 1.0)
    assert (weight.force(1.0), weight.energy(1.0), weight.adjacency(1.0), weight(1.0)) == (0.0, 0.0, 1.0, 1.0)
    assert weight.corners == ()


def rows(of):
    return [(round(corner.distance, 9), corner.part, corner.kind) for corner in of.corners]


def test_corners_are_where_values_or_slopes_jump():
    assert rows(fl.AlphaInteraction()) == []  # C¹, its end too
    assert rows(BENT) == [(2.0, "force", "kink"), (6.0, "force", "jump"), (6.0, "adjacency", "kink")]
    slopes = BENT.corners[0]
    assert (slopes.below, slopes.above) == (pytest.approx(-0.6), pytest.approx(-1.4))  # −V″ = −1 ± 2k
    ends = [(s, "force", "kink") for s in (3.25, 3.5, 12.5, 12.75)]
    assert rows(fl.DeadZoneInteraction()) == [*ends, (15.0, "force", "jump"), (15.0, "adjacency", "jump")]
    hard = rows(fl.DeadZoneInteraction(ramp=0.0))
    assert hard[:2] == [(3.5, "force", "jump"), (12.5, "force", "jump")]
    assert rows(FUNCTIONS["cut logarithm"]) == [(1.7, "force", "jump"), (1.7, "adjacency", "jump")]


def test_a_slope_without_a_limit_is_a_corner():
    law = fl.pair_law("Abs(s - d)**(3/2)*(r - s)**3", adjacency=0, range=3.0, length=1.0)
    assert rows(law)[0] == (1.0, "force", "kink")


def names(law, q):
    return [(at.i, at.j, at.name, at.corner.kind) for at in law.corners_at(q)]


def test_a_law_is_asked_for_all_functions_that_it_reads_through_wrappers_and_schemes():
    net = fl.pair_law("0", adjacency="Piecewise((1, s < 5), (0, True))", range=9.0, length=1.0)
    law = fl.compose(pair=BENT, gradient=1.0, consensus=2.0, net=net)
    q = [[0.0], [2.0], [-5.0]]
    seen = [(0, 1, "the pair law", "kink"), (0, 2, "the consensus net", "jump")]
    for wrapped in (law, fl.Delayed(law, 0.1), fl.Saturated(fl.Sampled(law, 0.1), 9.0), fl.SemiImplicitEuler(law, 0.1)):
        assert names(wrapped, q) == seen
    unread = fl.compose(pair=BENT, gradient=0.0, consensus=2.0)
    assert names(unread, q) == []  # the gain before the bent force is 0
    assert [entry.name for entry in fl.CuckerSmale().functions] == ["the alignment weight"]


def test_pairs_of_links_and_of_directed_ranges():
    fixed = FixedNetFlocking(((0, 1),), fl.LogPotential(2.0, 1.1))
    assert names(fixed, [[0.0], [1.7]]) == []
    (near,) = ProximityFlocking(fl.LogPotential(2.0, 1.1), 1.7).functions
    assert [corner.distance for corner in near.corners] == [1.7, 1.7]
    directed = fl.DirectedNet(fl.Algorithm1(), ranges=(8.4, 3.0, 3.0))
    assert [(entry.function.range, entry.listeners) for entry in directed.functions] == [(3.0, (1, 2)), (8.4, (0,))]
    assert names(directed, [[0.0], [3.0], [9.0]]) == []


class Own(Law):
    """A law that does not say what it reads."""

    surfaces = (2.0,)

    def flow(self, t, q, p):
        return 0.0 * q, 0.0


class Louder(PairTerm):
    """A term with a force of its own."""

    def act(self, t, q, p, u):
        return 2.0 * super().act(t, q, p, u)


class Silent(Term):
    """A term that says nothing."""

    def act(self, t, q, p, u):
        return 0.0

    def derivatives(self, t, q, p):
        raise NotImplementedError


def test_what_does_not_say_what_it_reads_is_unknown_and_has_corners_at_its_surfaces():
    assert [entry.function for entry in Own().functions] == [None]
    assert [(one.name, one.width) for one in Own().features()] == [("what Own reads", None)]
    (corner,) = Own().corners_at([[0.0], [2.0], [2.5]])
    assert (corner.i, corner.j, corner.corner.kind, np.isnan(corner.corner.below)) == (0, 1, "jump", True)
    assert [entry.function for entry in Silent().functions] == [None]

    class Loud(fl.Algorithm1):
        @property
        def terms(self):
            return (Louder(self.alpha, 1.0, 1.0),)

    assert [entry.function for entry in Loud().functions] == [None]

    class Changed(fl.Algorithm1):
        def flow(self, t, q, p):
            return 2.0 * super().flow(t, q, p)[0], 0.0

    assert [entry.name for entry in Changed().functions] == ["the pair law", "what Changed reads"]
    assert isinstance(Changed().functions[0].function, DistanceFunction)


@pytest.mark.parametrize(
    "options", [{}, {"h": 0.9, "a": 1.0, "b": 9.0}, {"unit": 0.1}, {"d": 2.0, "r": 9.0, "eps": 3.0}]
)
def test_slopes_of_the_papers_pair_law_are_bounded_on_parts(options):
    """Against exact slopes on a grid: never below them, and not far above their largest."""
    law = fl.AlphaInteraction(**options)
    s = np.linspace(1e-6, law.r * (1.0 - 1e-9), 20001)
    force, adjacency = np.abs(law.values(s).force_slope), np.abs(law.values(s).adjacency_slope)
    bounds = law.slopes()
    for bound in bounds:
        inside = (s >= bound.left) & (s <= bound.right)
        assert force[inside].max() <= bound.force
        assert adjacency[inside].max() <= bound.adjacency
    assert max(bound.force for bound in bounds) <= 2.0 * force.max()
    assert max(bound.adjacency for bound in bounds) <= 1.2 * adjacency.max()


def test_slopes_of_a_rational_weight_are_bounded_at_all_distances():
    weight = fl.RationalWeight(3.0, 1.5, 0.1)
    s = np.geomspace(1e-9, 1e9, 20001)
    slope = np.abs(weight.values(s).adjacency_slope)
    bounds = weight.slopes()
    assert (bounds[0].left, bounds[-1].right) == (0.0, np.inf)
    for bound in bounds:
        inside = (s >= bound.left) & (s <= bound.right)
        assert slope[inside].max(initial=0.0) <= bound.adjacency
    assert max(bound.adjacency for bound in bounds) == pytest.approx(slope.max(), rel=1e-6)
