from dataclasses import replace

import pytest

import flockana as fl
from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.explore.law_parameters import changed, expression, numbers, tree_of


def law():
    balls = (fl.Sphere((5.0, 0.0), 1.0), fl.Wall((0.0, -9.0), (0.0, 1.0)))
    return fl.Algorithm3(target=fl.StaticTarget((1.0, 2.0)), obstacles=balls)


def test_numbers_have_paths_and_places_are_told_apart():
    found = {each.path: each for each in numbers(law())}
    assert found["gains.c1_gamma"].value == 1.1
    assert found["target.q"].value == (1.0, 2.0)
    assert found["obstacles.0.radius"].value == 1.0
    assert [path for path, each in found.items() if each.place] == [
        "target.q",
        "obstacles.0.centre",
        "obstacles.1.point",
    ]


def test_changes_are_made_together_and_the_python_makes_the_same_law():
    changes = {"alpha.d": 9, "alpha.r": 12.5, "obstacles.1.point": [0, -3], "target.q": [4.0, 5.0]}
    tree = tree_of(law(), changes)
    new = changed(law(), tree)
    assert (new.alpha.d, new.alpha.r) == (9.0, 12.5)  # r first or d first alone would not be allowed
    assert new.obstacles[0] == law().obstacles[0]
    assert tuple(new.obstacles[1].point) == (0.0, -3.0)
    assert eval(expression("law", law(), tree), {"law": law(), "replace": replace}) == new
    assert changed(law(), {}) == law()
    assert expression("law", law(), {}) == "law"


def test_a_scheme_is_changed_in_the_law_that_it_steps():
    item = fl.scenario("dead-zone")
    paths = {each.path: each.value for each in numbers(item.law)}
    path = next(path for path in paths if path.endswith("interaction.k_r"))
    new = changed(item.law, tree_of(item.law, {path: 2.0 * paths[path]}))
    assert {each.path: each.value for each in numbers(new)} == {**paths, path: 2.0 * paths[path]}


@pytest.mark.parametrize(
    ("changes", "error"),
    [
        ({"alpha.d": "7"}, ArgumentError),
        ({"alpha.d": [1.0]}, ArgumentError),
        ({"alpha.d": True}, ArgumentError),
        ({"target.q": "__import__('os')"}, ArgumentError),
        ({"alpha.__class__": 1.0}, UnknownNameError),
        ({"obstacles.7.radius": 1.0}, UnknownNameError),
    ],
)
def test_only_numbers_at_known_paths(changes, error):
    with pytest.raises(error):
        tree_of(law(), changes)
