"""Which changes of a published verdict are told, and which are rounding."""

from __future__ import annotations

import pytest

from tests.adversarial.published import _alike, _changes


@pytest.mark.parametrize(
    ("path", "was", "now", "alike"),
    [
        ("x/margin", 1.0, 1.00009, True),
        ("x/margin", 1.0, 1.0002, False),
        ("x/margin", 1.0, -1.0, False),
        ("x/error", 1e-3, 1.04e-3, True),
        ("x/error", 1e-3, 1.1e-3, False),
        ("x/error", 1e-9, 2e-8, True),
        ("x/error", 1e-9, 4e-8, False),
        ("x/error", 1e-9, -1e-9, False),
        ("x/computed", 0.0, 5e-15, True),
        ("x/computed", 0.0, 1e-13, False),
        ("x/computed", True, 1, True),
        ("x/computed", True, False, False),
        ("x/computed", None, 0.0, False),
        ("x/detail", "at 1.23e-16 of 4", "at 2.5e-16 of 4.01", True),
        ("x/detail", "at 1.23 of 4", "at 1.23 of 4.2", False),
        ("x/detail", "at 1.23 of 4", "at 1.23 off 4", False),
    ],
)
def test_what_is_alike(path, was, now, alike):
    assert _alike(path, was, now) is alike


def test_every_place_of_a_change_is_named():
    was, now = {"a": {"computed": [1.0, 2.0]}, "b": 1}, {"a": {"computed": [1.0, 3.0, 4.0]}}
    assert list(_changes("E1", was, now)) == [
        "E1/a/computed/1: 2.0 is now 3.0",
        "E1/a/computed/2: None is now 4.0",
        "E1/b: 1 is now None",
    ]
