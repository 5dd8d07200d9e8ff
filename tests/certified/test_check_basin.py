"""What a checker of basins asks of each pair and shell, and that a basin of nothing is none."""

import copy
import json
from fractions import Fraction

import pytest
from flint import arb, ctx, fmpq

from flockana.certified.certificate import basin_certificate
from flockana.certified.check import RejectedError, check_data, unit
from flockana.certified.check_basin import DIGITS
from flockana.certified.check_net import ROOT_TWO, Net
from flockana.certified.decimals import format_decimal, round_down
from tests.certified.conftest import basin_of, resealed


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


@pytest.mark.parametrize("radius", ["0", "-0.4"])
def test_a_radius_that_is_none_is_refused(data, radius):
    data["radius"] = radius
    with pytest.raises(RejectedError, match="no radius"):
        checked(data)


def test_a_basin_without_shells_is_refused(data):
    data["curvatures"] = []
    with pytest.raises(RejectedError, match="no radius"):
        checked(data)


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
    monkeypatch.setattr(Net, "unique_projection", lambda self, x, radius: asked.append(radius) or True)
    checked(data)
    (radius,) = asked
    assert radius.overlaps(arb(data["radius"]))


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
        format_decimal(round_down(fmpq(rate.numerator, rate.denominator), 3)),
    )
    if share > 0:
        checked(data)
    else:
        with pytest.raises(RejectedError, match="the rate is not that of F"):
            checked(data)
