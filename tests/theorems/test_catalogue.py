"""The order of the catalogue, and what each kind of theorem is checked on."""

import numpy as np
import pytest

from flockana import Algorithm1, Tolerances, simulate, theorem, theorems, verify
from flockana.base.errors import ArgumentError, UnknownNameError
from tests.theorems.made_up import made_up

PAIR = np.array([[0.0], [7.0]])


def test_theorems_come_first_and_numbers_count_as_numbers():
    names = theorems()
    errata = [name for name in names if name[0].isupper()]
    assert names[-len(errata) :] == tuple(errata)
    assert [name for name in errata if name[0] == "E"] == [f"E{k}" for k in range(1, 17)]
    assert [name for name in errata if name[0] == "L"] == [f"L{k}" for k in range(1, 11)]
    assert [name for name in errata if name[0] == "J"] == [f"J{k}" for k in range(1, 20)]
    assert [name[0] for name in errata] == sorted(name[0] for name in errata)
    plain = names[: -len(errata)]
    assert [name for name in plain if name.startswith("os-")][:3] == ["os-1", "os-3", "os-5"]
    assert list(plain) == sorted(plain)
    assert all(theorem(name).id == name for name in names)


@pytest.mark.parametrize("name", ["os-2x", "e1", 3, ["os-1"], None])
def test_a_name_that_is_none(name):
    with pytest.raises(UnknownNameError if isinstance(name, str) else ArgumentError, match="theorem"):
        theorem(name)


def run():
    return simulate(Algorithm1(), PAIR, 0.0 * PAIR, (0.0, 0.1))


@pytest.mark.parametrize(
    ("name", "given", "message"),
    [
        ("E8", {"q": PAIR}, "E8 is checked on nothing: got q"),
        ("E8", {"trajectory": run}, "E8 is checked on nothing: got trajectory"),
        ("os-1", {}, "os-1 is checked on trajectory or law, p0, q0, t_span: got nothing"),
        ("os-1", {"law": Algorithm1()}, "t_span: got law"),
        ("os-1", {"trajectory": run, "t_span": (0.0, 1.0)}, "got t_span, trajectory"),
        ("os-1", {"trajectory": run, "d": 7.0}, "got d, trajectory"),
        ("os-1", {"trajectory": 3}, r"trajectory = 3: expected a Trajectory, such as scenario\('collapse'\)"),
        ("os-1", {"trajectory": run, "basin": 1}, "a basin decides the limit of a tube"),
        ("os-1", {"trajectory": run, "tolerances": 1e-6}, "tolerances = 1e-06: expected flockana.Tolerances"),
        ("E8", {"tolerances": {"energy": 1}}, "tolerances = {'energy': 1}"),
    ],
)
def test_what_is_given_must_be_what_it_needs(name, given, message):
    with pytest.raises(ArgumentError, match=message):
        verify(name, **{k: v() if v is run else v for k, v in given.items()})


def test_a_law_and_a_start_are_run_first():
    one = verify("os-1", law=Algorithm1(), q0=PAIR, p0=0.0 * PAIR, t_span=(0.0, 0.1), subject="two")
    two = verify("os-1", run())
    assert (one.subject, two.subject) == ("two", "")
    assert one.hypotheses == two.hypotheses
    assert [(c.name, c.status, c.margin) for c in one.claims] == [(c.name, c.status, c.margin) for c in two.claims]


def test_tolerances_are_those_given():
    used = Tolerances(agreement=0.5)
    assert verify("E9", tolerances=used).tolerances == used
    assert verify("E8").tolerances == Tolerances()


def test_configurations_are_checked_in_all_units():
    name = next(name for name in theorems() if theorem(name).kind == "configuration")
    q = np.array([[0.0, 0.0], [7.0, 0.0], [3.5, 6.062177826491071]])
    one = verify(name, q=q, d=7.0, r=8.4)
    two = verify(name, q=1e3 * q, d=7e3, r=8.4e3)
    assert [c.status for c in one.claims] == [c.status for c in two.claims]
    with pytest.raises(ArgumentError, match="d = -1"):
        verify(name, q=q, d=-1.0, r=8.4)
    with pytest.raises(ArgumentError, match="r = 0"):
        verify(name, q=q, d=7.0, r=0.0)


def test_a_run_that_no_integrator_made_is_refused():
    with pytest.raises(ArgumentError, match="expected a run as simulate returned it"):
        verify("os-1", made_up(Algorithm1(), [PAIR, 2.0 * PAIR]))


class Interrupted(Algorithm1):
    """Ctrl-C at the fifth evaluation, and never again."""

    def flow(self, t, q, p):
        global LEFT
        LEFT -= 1
        if LEFT == 0:
            raise KeyboardInterrupt
        return super().flow(t, q, p)


def test_an_interrupted_run_ends_a_verdict(monkeypatch):
    """It is no run to judge, however much of it there is."""
    monkeypatch.setitem(globals(), "LEFT", 200)
    with pytest.raises(KeyboardInterrupt):
        verify("os-1", law=Interrupted(), q0=[[0.0, 0.0], [8.0, 0.0]], p0=[[0.1, 0.0], [0.0, 0.0]], t_span=(0.0, 9.0))
