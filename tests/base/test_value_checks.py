"""Checks write whatever they are given on one line, and compare it with choices only if it can be one."""

import numpy as np
import pytest

import flockana as fl
from flockana.base import value_checks
from flockana.base.binomial_intervals import clopper_pearson
from flockana.base.errors import ArgumentError, UnknownNameError, format_value
from flockana.lattice import fcc, honeycomb, triangular

ARRAY = np.arange(30.0).reshape(10, 3)  # its repr has ten lines
HUGE = 10**400


def message(kind, function, *arguments, **options):
    with pytest.raises(kind) as caught:
        function(*arguments, **options)
    return str(caught.value)


@pytest.mark.parametrize(
    "check",
    [value_checks.ensure_positive, value_checks.ensure_count, lambda name, value: value_checks.ensure_seed(value)],
)
def test_an_array_for_a_scalar_is_told_on_one_line(check):
    text = message(ArgumentError, check, "seed", ARRAY)
    assert text.startswith("seed = array([[ 0., 1., 2.], [ 3.,")
    assert "\n" not in text


def test_what_is_not_finite_and_what_is_unknown_are_told_on_one_line_too():
    assert "\n" not in message(ArgumentError, value_checks.ensure_series, "weights", np.full(50, np.nan))
    assert "\n" not in message(UnknownNameError, fl.scenario, ARRAY)
    assert format_value("two  spaces") == "'two  spaces'"


def test_whole_numbers_of_very_many_digits_are_told_by_their_size():
    assert (format_value(10**39), format_value(-HUGE)) == (f"{10**39}", "about -1e+400")
    assert format_value([10**5000]) == "a list that cannot be written"
    assert (
        message(ArgumentError, value_checks.ensure_count, "n", -(10**5000))
        == "n = about -1e+5000: expected a whole number >= 1"
    )


@pytest.mark.parametrize(
    ("function", "arguments"),
    [
        (fcc, (HUGE, 1, 1, 7.0)),
        (honeycomb, (HUGE, 2, 7.0)),
        (triangular, (10**5000, 7.0)),
        (value_checks.ensure_fits, ("A", (HUGE, 2), "ask for less")),
    ],
)
def test_sizes_beyond_every_float_are_refused(function, arguments):
    assert "more than half of this machine's" in message(ArgumentError, function, *arguments)


def test_counts_beyond_every_float_are_refused():
    text = message(ArgumentError, clopper_pearson, HUGE, HUGE)
    assert text == "successes = about 1e+400, trials = about 1e+400: expected counts"


@pytest.mark.parametrize(
    ("made", "text"),
    [
        (lambda value: fl.ZoneFlocking(form=value), "form = array([1., 2.]): expected one of "),
        (lambda value: fl.HeadingAveraging(average=value), "average = array([1., 2.]): expected one of headings, "),
        (
            lambda value: value_checks.ensure_choice("kind", value, ("a", "b")),
            "kind = array([1., 2.]): expected one of a, b",
        ),
        (lambda value: fl.SineTarget((0.0, 0.0), (1.0, 0.0), 1.0, 0.1, axis=value), "axis = array([1., 2.]): expected"),
        (value_checks.ensure_dimension, "m = array([1., 2.]): expected a dimension"),
    ],
)
def test_an_array_is_no_choice(made, text):
    assert message(ArgumentError, made, np.array([1.0, 2.0])).startswith(text)


def test_numbers_become_an_array_and_texts_do_not():
    assert value_checks.real_array([1, 2.5]).tolist() == [1.0, 2.5]
    with pytest.raises(TypeError, match="<U3 are no real numbers"):
        value_checks.real_array(["1", "2.5"])


def test_a_value_of_another_kind_is_refused_by_name():
    with pytest.raises(ArgumentError, match=r"system = None: expected a control\.StateSpace"):
        value_checks.ensure_kind("system", None, "StateSpace", "a control.StateSpace")
