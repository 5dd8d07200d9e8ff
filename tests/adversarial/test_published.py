"""Which changes of a published verdict are told, and which are rounding."""

import copy

import pytest

from flockana.scenarios import scenario
from tests.adversarial import published
from tests.adversarial.published import alike, differences, near, number


@pytest.mark.parametrize(
    ("path", "was", "same", "others"),
    [
        ("x/margin", 1.0, 1.00009, (1.0002, -1.0)),
        ("x/error", 1e-3, 1.04e-3, (1.1e-3,)),
        ("x/error", 1e-10, 5e-9, (2e-8, -1e-10)),
        ("x/computed", 0.0, 5e-15, (1e-13, None)),
        ("x/computed", True, 1, (False,)),
        ("x/detail", "at 1.23e-16 of 4", "at 2.5e-9 of 4.01", ("at 1.23e-16 of 4.2", "at 1.23e-16 off 4")),
    ],
)
def test_what_is_alike(path, was, same, others):
    assert alike(path, was, same)
    assert not any(alike(path, was, other) for other in others)


def test_every_place_of_a_change_is_named():
    was, now = {"a": {"computed": [1.0, 2.0]}, "b": 1}, {"a": {"computed": [1.0, 3.0, 4.0]}}
    first, second, last = differences("E1", was, now)
    assert (first, second) == ("E1/a/computed/1: 2.0 is now 3.0", "E1/a/computed/2: None is now 4.0")
    assert last == "E1/b: 1 is now None"


@pytest.mark.parametrize(
    ("was", "same", "another"),
    [
        ((1.0, 1e-6), (1.0005, 1e-6), (1.01, 1e-6)),
        ((1.0, 0.006), (1.01, 0.006), (1.02, 0.006)),
        ((1.0, 1e-6), (1.0, 5e-5), (1.0, 2e-4)),
        ((1.0, 1e-16), (1.0, 0.0), (1.0, 1e-3)),
        ((1.0, None), (1.0, None), (1.0, 0.0)),
        ((None, None), (None, None), (None, 0.0)),
        ((1.0, "inf"), (0.9995, "inf"), (1.0, 1.0)),
        (("inf", 0.0), ("inf", 0.0), (1e9, 0.0)),
        ((None, 0.0), (None, 0.0), (1.0, 0.0)),
    ],
)
def test_which_margins_of_runs_are_near(was, same, another):
    for now, expected in ((same, True), (another, False)):
        margin, error, other, own = map(number, (*was, *now))
        assert bool(near(margin, other, error, own)) is expected


@pytest.fixture(scope="module")
def judged():
    entry = scenario("head-on")
    return entry.verify(entry.run())


@pytest.mark.parametrize(
    ("what", "place", "value"),
    [
        ("H(0) < c*", 0, "unmet"),
        ("H(0) < c*", 1, 800.0),
        ("twice", 0, "refuted"),
        ("twice", 1, 4.9),  # 4.8393, to 6.5e-5 by both runs and to 7e-9 by the first alone
        ("twice", 2, 1e-2),
        ("twice", 3, 4.9),
        ("twice", 4, "interval"),
        ("twice", 6, "collisions"),
    ],
)
def test_each_change_of_a_run_is_told(judged, monkeypatch, what, place, value):
    assert published.changes_of_run("head-on", judged) == []
    said = copy.deepcopy(published.published_runs())
    said["head-on"]["collision-energy"][what][place] = value
    monkeypatch.setattr(published, "published_runs", lambda: said)
    (line,) = published.changes_of_run("head-on", judged)
    assert line.startswith(f"head-on/collision-energy/{what}: ")


def test_a_claim_that_is_missing_is_told(judged, monkeypatch):
    said = copy.deepcopy(published.published_runs())
    del said["head-on"]["collision-energy"]["twice"]
    monkeypatch.setattr(published, "published_runs", lambda: said)
    assert published.changes_of_run("head-on", judged) == ["head-on: other claims or hypotheses than published"]
