"""Which changes of a published verdict are told, and which are rounding."""

import copy

import pytest

from flockana.scenarios import scenario
from tests.adversarial import published
from tests.adversarial.published import alike, differences, near, number


@pytest.mark.parametrize(
    ("path", "was", "now", "expected"),
    [
        ("x/margin", 1.0, 1.00009, True),
        ("x/margin", 1.0, 1.0002, False),
        ("x/margin", 1.0, -1.0, False),
        ("x/error", 1e-3, 1.04e-3, True),
        ("x/error", 1e-3, 1.1e-3, False),
        ("x/error", 1e-9, 2e-8, True),
        ("x/error", 1e-10, 2e-8, False),
        ("x/error", 1e-9, -1e-9, False),
        ("x/computed", 0.0, 5e-15, True),
        ("x/computed", 0.0, 1e-13, False),
        ("x/computed", True, 1, True),
        ("x/computed", True, False, False),
        ("x/computed", None, 0.0, False),
        ("x/detail", "at 1.23e-16 of 4", "at 2.5e-9 of 4.01", True),
        ("x/detail", "at 1.23 of 4", "at 1.23 of 4.2", False),
        ("x/detail", "at 1.23 of 4", "at 1.23 off 4", False),
    ],
)
def test_what_is_alike(path, was, now, expected):
    assert alike(path, was, now) is expected


def test_every_place_of_a_change_is_named():
    was, now = {"a": {"computed": [1.0, 2.0]}, "b": 1}, {"a": {"computed": [1.0, 3.0, 4.0]}}
    assert list(differences("E1", was, now)) == [
        "E1/a/computed/1: 2.0 is now 3.0",
        "E1/a/computed/2: None is now 4.0",
        "E1/b: 1 is now None",
    ]


@pytest.mark.parametrize(
    ("was", "now", "expected"),
    [
        ((1.0, 1e-6), (1.0005, 1e-6), True),
        ((1.0, 1e-6), (1.01, 1e-6), False),
        ((1.0, 0.006), (1.01, 0.006), True),
        ((1.0, 1e-6), (1.0, 2e-4), False),
        ((1.0, 1e-6), (1.0, 5e-5), True),
        ((1.0, 1e-16), (1.0, 0.0), True),
        ((1.0, None), (1.0, None), True),
        ((1.0, None), (1.0, 0.0), False),
        ((None, None), (None, None), True),
        ((None, 0.0), (1.0, 0.0), False),
        ((1.0, "inf"), (0.9995, "inf"), True),
        ((1.0, "inf"), (1.0, 1.0), False),
        (("inf", 0.0), ("inf", 0.0), True),
        (("inf", 0.0), (1e9, 0.0), False),
    ],
)
def test_which_margins_of_runs_are_near(was, now, expected):
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
