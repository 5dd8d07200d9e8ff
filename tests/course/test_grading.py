import numpy as np
import pytest
import sympy as sp

from flockana.base.errors import ArgumentError
from flockana.course import answered, form_of, grade


@pytest.mark.parametrize(
    ("answer", "right", "status"),
    [
        (..., 1.0, "not answered"),
        (1.0 + 1e-12, 1.0, "right"),
        (1.0 + 1e-7, 1.0, "not yet"),
        (np.float32(0.5), 0.5, "right"),
        (sp.Rational(1, 2), 0.5, "right"),
        (np.array([0.5]), 0.5, "right"),
        (float("nan"), 0.5, "not yet"),
        (1e-12, 0.0, "right"),
        (1e-6, 0.0, "not yet"),
        ([1.0, 2.0], [1.0, 2.0], "right"),
        ([2.0, 1.0], [1.0, 2.0], "not yet"),
        ([2.0, 1.0], {1.0, 2.0}, "right"),
        ([2.0, 1.0, 1.0], {1.0, 2.0}, "not yet"),
        (["B", "a"], {"a", "b"}, "right"),
        ([1.0], [1.0, 1.0], "not yet"),
        (1, True, "not yet"),
        (True, 1, "not yet"),
        (True, True, "right"),
        (np.True_, True, "right"),
        (np.True_, False, "not yet"),
        (["wrong", ""], [True, False], "not yet"),
        ("refuted", "refuted", "right"),
        ("one", 1.0, "not yet"),
        (3, lambda n: n % 2 == 1, "right"),
        ("x", lambda n: n % 2 == 1, "not yet"),
    ],
)
def test_grades(answer, right, status):
    assert grade(answer, right).status == status


@pytest.mark.parametrize("digits", [1, 2, 3, 4])
@pytest.mark.parametrize("right", [0.09291926, -5.8170727, 239.764139, 1.0004, 9.996e-4])
def test_the_tolerance_is_half_a_unit_of_the_last_digit_asked_for(right, digits):
    rounded = float(f"{right:.{digits - 1}e}")
    unit = 10.0 ** (np.floor(np.log10(abs(right))) - digits + 1)
    assert grade(rounded, right, digits=digits).status == "right"
    for off, status in ((0.49, "right"), (-0.49, "right"), (0.51, "not yet"), (-0.51, "not yet")):
        assert grade(right + off * unit, right, digits=digits).status == status


@pytest.mark.parametrize("answer", ["vacuous.", "it is vacuous", "'vacuous'", ""])
def test_a_word_in_another_form_is_told_so(answer):
    graded = grade(answer, "vacuous", hint="read the hypotheses")
    assert graded.status == "not yet"
    assert graded.hint == f"one word is asked for, without blanks or marks around it; got {answer!r}"
    assert grade(" Vacuous ", "vacuous").status == "right"
    assert grade("refuted", "vacuous", hint="read the hypotheses").hint == "read the hypotheses"


def test_a_list_of_another_length_is_told_so():
    assert grade([1.0], [1.0, 2.0], hint="add").hint == "a list of 2 is asked for; got 1"
    assert grade([1.0, 3.0], [1.0, 2.0], hint="add").hint == "add"


def test_one_precision_at_a_time():
    assert [grade(x, 5.0, within=0.1).status for x in (5.1, 5.11)] == ["right", "not yet"]
    with pytest.raises(ArgumentError, match=r"digits = 2 and within = 0\.1"):
        grade(1.0, 1.0, digits=2, within=0.1)


@pytest.mark.parametrize(
    ("answer", "form", "status"),
    [
        (3, "number", "handed in"),
        ([3, 4], "number", "not yet"),
        (True, "number", "not yet"),
        ("vacuous", "word", "handed in"),
        (np.False_, "truth value", "handed in"),
        ((3, 4), "list", "handed in"),
        (..., "list", "not answered"),
        (object(), "", "handed in"),
        ("vacuous.", "word", "not yet"),
        ("s**2", "formula", "handed in"),
    ],
)
def test_a_students_copy_looks_at_the_form_only(answer, form, status):
    assert answered(answer, form).status == status


@pytest.mark.parametrize(
    ("right", "form"), [(1, "number"), (True, "truth value"), ("a", "word"), ([1], "list"), (len, "")]
)
def test_the_form_of_a_right_answer(right, form):
    assert form_of(right) == form


@pytest.mark.parametrize(
    "answer", [np.complex128(1.0 + 5.0j), np.array([1.0 + 5.0j]), 1.0 + 5.0j, np.datetime64("1970-01-02"), "1"]
)
def test_what_is_no_real_number_is_not_graded_as_one(answer):
    assert grade(answer, 1.0).status == "not yet"
    assert grade(np.complex128(1.0), 1.0).status == "right"
