"""Certificates of tubes: what was altered is rejected, by the digest or, sealed again, by the mathematics."""

import json
from math import sqrt
from types import SimpleNamespace

import numpy as np
import pytest
from flint import arb, ctx

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, certify, check_certificate, enclose, find_equilibrium
from flockana.base.errors import ArgumentError
from flockana.certified import check_tube
from flockana.certified.certificate import tube_certificate, write_tube_certificate
from flockana.certified.certificate_check import RejectedError, check_data
from tests.certified.conftest import more, resealed, with_leaf

LAW = Algorithm2(target=StaticTarget((0.0,)))


WIDE = "the error may exceed"


@pytest.fixture(scope="module")
def tube():
    return enclose(LAW, [[-3.625], [3.625]], [[0.0], [0.0]], (0.0, 0.03125))


@pytest.fixture(scope="module")
def data(tube):
    basin = certify(find_equilibrium(LAW, [[-3.5], [3.5]]))
    return json.loads(json.dumps(tube_certificate(tube, basin=basin)))


def test_it_holds_and_says_what_was_verified(data, tmp_path, tube):
    checked = check_data(data)
    assert checked.kind == "tube"
    assert checked.steps[0].startswith("the run is within the errors stated of the path, through ")
    assert checked.steps[-1].startswith("all of the end lies in the basin: the run converges")
    assert float(data["distance"]) <= tube.min_distance().lower + 1e-3
    write_tube_certificate(tube, tmp_path / "tube.json")
    assert check_certificate(tmp_path / "tube.json").kind == "tube"


def bits(value):
    """A number in hexadecimal, one 256th larger."""
    mantissa, exponent = value.split("p")
    return f"{int(mantissa, 16) * 257:#x}p{int(exponent) - 8}" if int(mantissa, 16) else "0x1p-8"


@pytest.mark.parametrize(
    ("at", "change", "message"),
    [
        *((at, bits, WIDE) for at in (("q0", 0, 0), ("p0", 0, 0), ("times", 3))),
        *((("paths", 2, 1, k), bits, WIDE) for k in range(4)),
        (("errors", 4), lambda e: repr(float(e) / 10.0), f"{WIDE} what is stated"),
        (("errors", 4), lambda e: repr(float(e) / 2.05), f"{WIDE} what is stated"),  # it was twice the last
        (("errors", 4), lambda e: repr(float(e) * 1e12), "is not the one proved|may exceed"),
        *((("law", name), more, WIDE) for name in ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma", *"drhb", "eps")),
        *((("law", name, 0), more, WIDE) for name in ("start", "declared")),
        (("law", "a"), more, "expected 0 < d < r"),
        (("distance",), more, "the least distance"),
        (("cohesion_radius",), more, "the largest radius"),
        (("energy",), more, "the energy at the start"),
        (("below_c_star",), lambda holds: not holds, "H\\(0\\) < c"),
        (("basin", "radius"), more, "."),
        *((("weight",), lambda w, new=new: new, "the weight is not positive") for new in ("-10", "0")),
    ],
)
def test_what_was_sealed_again_is_decided_by_the_mathematics(data, at, change, message):
    altered = resealed(with_leaf(data, at, change))
    if at[0] == "basin":
        altered = resealed({**altered, "basin": resealed(altered["basin"])})
    with pytest.raises(RejectedError, match=message):
        check_data(altered)


def test_a_path_with_more_terms_in_one_coordinate_is_rejected(data):
    """Terms that the defect would not see."""
    longer = with_leaf(data, ("paths", 0, 1), lambda row: [*row, "0x1p0"])
    with pytest.raises(RejectedError, match="a path of another size"):
        check_data(resealed(longer))


def test_only_a_certificate_of_a_basin_stands_for_the_basin(data):
    """A tube's own certificate holds, and what else is written into it would be believed unseen."""
    inner = {**data, "basin": None, "turn": "0"}
    claimed = {name: data["basin"][name] for name in ("positions", "box", "radius", "level")}
    forged = resealed({**data, "basin": resealed({**inner, **claimed, "level": "1000000"})})
    with pytest.raises(RejectedError, match="no certificate of one"):
        check_data(forged)


def test_a_basin_of_gains_that_differ_by_less_than_balls_tell_is_of_another_law(data):
    law = {**data["law"], "c1_alpha": f"{data['law']['c1_alpha'].split('.')[0]}." + "0" * 60 + "1"}
    with pytest.raises(RejectedError, match="the basin is of another law"):
        check_data(resealed({**data, "law": law}))


@pytest.mark.parametrize("name", ["statement", "prose", "format"])
def test_what_it_states_is_what_is_proved(data, name):
    other = ["Every flock flocks."] if name == "prose" else "Every flock flocks."
    with pytest.raises(RejectedError, match=r"states|lists|format"):
        check_data(resealed({**data, name: other}))


def test_what_has_no_certificate_is_said(tube):
    one = enclose(Algorithm1(), [[0.0]], [[1.0]], (0.0, 0.125))
    with pytest.raises(ArgumentError, match="two agents or more"):
        tube_certificate(one)
    wide = enclose(LAW, [[-3.625], [3.625]], [[0.0], [0.0]], (0.0, 0.0078125), radius=0.001)
    with pytest.raises(ArgumentError, match="expected a complete tube of two agents or more from one start"):
        tube_certificate(wide)
    other = certify(find_equilibrium(Algorithm1(), [[-3.5], [3.5]]))
    with pytest.raises(ArgumentError, match="that the tube certainly ends in"):
        tube_certificate(tube, basin=other)


def ends_in(monkeypatch, data, q, p, *, error=0.0, turn=0.0):
    """Whether states within an error of (q, p), in the norm that counts places ten times, end in the basin."""
    monkeypatch.setattr(check_tube, "check_data", lambda basin: SimpleNamespace(steps=()))  # it holds
    with ctx.workprec(128):
        run = check_tube.Run.of(data)
        assert run.weight == 10
        state = [arb(float(x)) for x in (*np.ravel(q), *np.ravel(p))]
        return list(run.ends_in(data["basin"], data["law"], arb(turn), state, arb(error)))


def rest_of(data):
    return np.array([[float.fromhex(x) for x in row] for row in data["basin"]["positions"]])


@pytest.mark.parametrize(
    ("share", "error", "inside"), [(0.999, 0.0, True), (1.001, 0.0, False), (0.98, 0.01, True), (0.98, 0.1, False)]
)
def test_the_end_of_a_run_has_less_energy_than_the_basin_s_level(data, monkeypatch, share, error, inside):
    """Velocities v and −v at the equilibrium have v² above it, and an error counts for the worst."""
    rest, v = rest_of(data), sqrt(share * float(data["basin"]["level"]))
    p = np.array([[v], [-v]])
    if inside:
        assert len(ends_in(monkeypatch, data, rest, p, error=error)) == 1
        return
    with pytest.raises(RejectedError, match="the energy at the end may be too high"):
        ends_in(monkeypatch, data, rest, p, error=error)


@pytest.mark.parametrize(("error", "inside"), [(1.5, True), (4.5, False)])
def test_the_end_of_a_run_is_within_the_basin_s_radius(data, monkeypatch, error, inside):
    """Two places off by a tenth of the error, one against the other, are √2 of that away; the radius is 0.537."""
    calm = {**data, "basin": {**data["basin"], "level": "1000"}}  # to ask for the place alone
    rest, still = rest_of(data), np.zeros((2, 1))
    assert 0.3 * sqrt(2.0) < float(data["basin"]["radius"]) < 0.45 * sqrt(2.0)
    if inside:
        assert len(ends_in(monkeypatch, calm, rest + 5.0, still, error=error)) == 1
        return
    with pytest.raises(RejectedError, match="the end may be too far"):
        ends_in(monkeypatch, calm, rest + 5.0, still, error=error)
    with pytest.raises(RejectedError, match="the end may be too far"):
        ends_in(monkeypatch, calm, -rest, still)  # the mirror image


@pytest.mark.parametrize("angle", [0.5, -2.0])
def test_the_end_of_a_run_is_compared_with_the_equilibrium_turned(monkeypatch, angle):
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    basin = certify(find_equilibrium(law, [[-3.5, 0.0], [3.5, 0.0]]))
    tube = enclose(law, basin.rest, np.zeros((2, 2)), (0.0, 0.0078125))
    data = json.loads(json.dumps(tube_certificate(tube, basin=basin)))
    turned = rest_of(data) @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    assert len(ends_in(monkeypatch, data, turned, 0.0 * turned, turn=angle)) == 1
    with pytest.raises(RejectedError, match="the end may be too far"):
        ends_in(monkeypatch, data, turned, 0.0 * turned, turn=-angle)


def test_times_that_do_not_rise_are_rejected(data):
    for other in (data["times"][2], data["times"][1]):
        with pytest.raises(RejectedError, match="its times do not rise"):
            check_data(resealed(with_leaf(data, ("times", 3), lambda _, other=other: other)))


def test_the_barrier_of_collisions_counts_with_its_gain():
    """H(0) < c1α c*, c* = 52.4: of two agents that meet with a kinetic energy of 100, and c1α = 30 or 1."""
    for gain, below in ((30.0, True), (1.0, False)):
        law = Algorithm1(gains=Gains(c1_alpha=gain, c2_alpha=1.0))
        tube = enclose(law, [[0.0], [7.0]], [[10.0], [-10.0]], (0.0, 0.0009765625))
        data = tube_certificate(tube)
        assert data["below_c_star"] is below
        assert check_data(json.loads(json.dumps(data))).kind == "tube"


def test_a_basin_of_more_agents_is_another_flock_s(data, monkeypatch):
    larger = {**data, "basin": {**data["basin"], "positions": [*data["basin"]["positions"], ["0x0p+0"]]}}
    with pytest.raises(RejectedError, match="a basin of another flock"):
        ends_in(monkeypatch, larger, rest_of(data), np.zeros((2, 1)))
