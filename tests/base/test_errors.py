"""Errors and the checks at the boundary: every message names what it got and what was expected."""

import pickle
import re
from functools import partial

import numpy as np
import pytest

from flockana.base import value_checks
from flockana.base.errors import ArgumentError, FileError, FlockanaError, SolverError, UnknownNameError
from tests.refused import refused


def raises(message):
    return pytest.raises(ArgumentError, match=re.escape(message))


def test_the_family():
    assert issubclass(ArgumentError, FlockanaError)
    assert issubclass(ArgumentError, ValueError)
    assert issubclass(FileError, OSError)
    assert issubclass(SolverError, RuntimeError)


def test_unknown_name_suggests_and_lists():
    error = UnknownNameError("theorem", "os-11", ["os-3", "os-1"])
    assert str(error) == "unknown theorem 'os-11'; did you mean 'os-1'? Known: os-1, os-3"
    assert str(UnknownNameError("scenario", "zzz", ["collapse"])) == "unknown scenario 'zzz'; known: collapse"
    assert str(UnknownNameError("scenario", None, 3)) == "unknown scenario None; known: 3"
    assert str(UnknownNameError("flock", "f", [])) == "unknown flock 'f'; known: none"


@pytest.mark.parametrize(
    "error", [UnknownNameError("method", "RK5", ["RK4", "RK45"]), ArgumentError("a"), FileError("b"), SolverError("c")]
)
def test_errors_travel_between_processes(error):
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error)
    assert str(again) == str(error)


test_ensure_finite_scalar = refused(
    (None, "d = None: expected one real number"),
    ("seven", "d = 'seven': expected one real number"),
    ([1.0, 2.0], "d = [1.0, 2.0]: expected one real number"),
    (1j, "d = 1j: expected one real number"),
    (10**400, "expected one real number"),
    (np.nan, "d = nan: expected a finite number"),
    (-np.inf, "d = -inf: expected a finite number"),
    make=partial(value_checks.ensure_finite_scalar, "d"),
    exact=True,
)


def test_signs():
    assert value_checks.ensure_positive("d", 5e-324) == 5e-324
    assert value_checks.ensure_nonnegative("d", 0) == 0.0
    with raises("d = 0: expected a number > 0"):
        value_checks.ensure_positive("d", 0.0)
    with raises("d = -1: expected a number >= 0"):
        value_checks.ensure_nonnegative("d", -1)


test_ensure_points = refused(
    ("abc", "q: expected numbers in an (n, m) array, got str"),
    ([[1.0], [2.0, 3.0]], "q: expected numbers in an (n, m) array, got list"),
    (np.array([[1j]]), "q: expected numbers in an (n, m) array, got ndarray"),
    ([[10**400]], "q: expected numbers in an (n, m) array, got list"),
    ([1.0, 2.0], "q has shape (2,): expected (n, m), one row per agent; for agents on a line use a column"),
    (np.zeros((2, 2, 2)), "q has shape (2, 2, 2): expected (n, m)"),
    (np.zeros((0, 2)), "q has no agents (shape (0, 2)): expected n >= 1"),
    (np.zeros((3, 4)), "q has shape (3, 4): expected m = 1, 2 or 3 columns"),
    (np.zeros((3, 0)), "q has shape (3, 0): expected m = 1, 2 or 3 columns"),
    ([[0.0, 0.0], [np.nan, 1.0], [np.inf, 0.0]], "q[1] = [nan  1.]: expected finite numbers (2 bad agents)"),
    make=partial(value_checks.ensure_points, "q"),
    exact=True,
)


def test_points_are_contiguous_float64():
    points = value_checks.ensure_points("q", np.arange(6).reshape(2, 3).T)
    assert points.dtype == np.float64
    assert points.flags.c_contiguous
    assert points.tolist() == [[0.0, 3.0], [1.0, 4.0], [2.0, 5.0]]


def test_ensure_state():
    with raises("q has shape (2, 1) but p has shape (1, 1): expected equal shapes (n, m)"):
        value_checks.ensure_state([[0.0], [1.0]], [[0.0]])
    with raises("p[0] = [inf]: expected finite numbers (1 bad agents)"):
        value_checks.ensure_state([[0.0]], [[np.inf]])


test_ensure_vector = refused(
    (("x", None), "v = 'x': expected a vector of numbers"),
    (([1j, 0.0], None), "expected a vector of numbers"),
    ((3.0, None), "v has shape (): expected a vector of 1, 2 or 3 components"),
    (([[1.0]], None), "v has shape (1, 1): expected a vector of 1, 2 or 3 components"),
    (([], None), "v has shape (0,): expected a vector of 1, 2 or 3 components"),
    (([1.0, 2.0, 3.0, 4.0], None), "v has shape (4,): expected a vector of 1, 2 or 3 components"),
    (([1.0, 2.0], 3), "v has 2 components: expected 3, the dimension of the flock"),
    (([1.0, np.nan], 2), "v = [ 1. nan]: expected finite numbers"),
    make=lambda case: value_checks.ensure_vector("v", *case),
    exact=True,
)


test_ensure_time_span = refused(
    (3.0, "t_span = 3.0: expected two numbers (t0, t1)"),
    ((0.0, 1.0, 2.0), "expected two numbers (t0, t1)"),
    (("a", "b"), "t_span = ('a', 'b'): expected two numbers"),
    ((0, 10**400), "expected two numbers (t0, t1)"),
    ((1.0, 1.0), "t_span = (1, 1): expected finite t0 < t1"),
    ((2.0, 1.0), "t_span = (2, 1): expected finite t0 < t1"),
    ((0.0, np.inf), "t_span = (0, inf): expected finite t0 < t1"),
    ((np.nan, 1.0), "t_span = (nan, 1): expected finite t0 < t1"),
    make=value_checks.ensure_time_span,
    exact=True,
)
