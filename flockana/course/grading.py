"""Check a student's answer in a notebook: right, not yet, or not answered; never an exception."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import maximum_bipartite_matching

from flockana.base.errors import ArgumentError

_MARKS = {"right": "✓", "handed in": "✓", "not yet": "✗", "not answered": "…"}
_WORD = re.compile(r"[\w-]+")
_ROUNDING = 1e-9  # of the right answer: what double precision may leave of an exact one


@dataclass(frozen=True)
class Grade:
    """Result of grading an answer, shown in a notebook.

    Examples
    --------
    >>> Grade("not yet", "count each pair once")
    ✗ not yet: count each pair once
    """

    status: str  # the finding; ``handed in`` says that the form is right and that nobody has looked at the value
    hint: str = ""  # where to look, if it is not right

    def __repr__(self) -> str:
        hint = f": {self.hint}" if self.hint and self.status != "right" else ""
        return f"{_MARKS[self.status]} {self.status}{hint}"


def grade(
    answer: Any, right: Any, *, digits: int | None = None, within: float | None = None, hint: str = "", form: str = ""
) -> Grade:
    """Grade an answer against the right one, or by a function of the answer.

    A number counts to the precision that the question asks for, and no wider: to so many significant `digits`, that is
    half a unit of the last of them, or `within` so much. Without either, to rounding.

    Examples
    --------
    >>> grade(..., 42), grade(41, 42, hint="count each pair once"), grade(42, 42)
    (… not answered, ✗ not yet: count each pair once, ✓ right)
    >>> grade(0.0929, 0.092857, digits=3), grade(0.0928, 0.092857, digits=3)
    (✓ right, ✗ not yet)
    >>> grade([4, 3], {3, 4}), grade("Refuted", "refuted"), grade("one", 1.0)
    (✓ right, ✓ right, ✗ not yet: a number is asked for)
    """
    if digits is not None and within is not None:
        raise ArgumentError(f"digits = {digits} and within = {within}: expected one of the two; leave the other out")
    form_grade = answered(answer, form or form_of(right))
    if form_grade.status != "handed in":
        return form_grade
    if isinstance(right, list | tuple | set | np.ndarray) and len(answer) != len(right):
        return Grade("not yet", f"a list of {len(right)} is asked for; got {len(answer)}")
    try:
        if isinstance(right, Callable):  # type: ignore[arg-type]
            is_right = bool(right(answer))
        else:
            is_right = _same(answer, right, lambda b: _tolerance(b, digits, within))
    except Exception:  # whatever a student hands in, the check answers
        is_right = False
    return Grade("right" if is_right else "not yet", hint)


def answered(answer: Any, form: str) -> Grade:
    """Check only the form of an answer, as a student's copy does.

    Examples
    --------
    >>> answered(3.0, "number"), answered("three", "number"), answered(..., "number")
    (✓ handed in: a number, ✗ not yet: a number is asked for, … not answered)
    """
    if answer is ...:
        return Grade("not answered")
    if not form:
        return Grade("handed in")
    if not _FORMS[form](answer):
        return Grade("not yet", f"a {form} is asked for")
    if form == "word" and not _WORD.fullmatch(answer.strip()):
        return Grade("not yet", f"one word is asked for, without blanks or marks around it; got {answer!r}")
    return Grade("handed in", f"a {form}")


def form_of(right: Any) -> str:
    """Return the name of the form that a right answer has; empty if it is a function."""
    if isinstance(right, Callable):  # type: ignore[arg-type]
        return ""
    return next(name for name, fits in _FORMS.items() if fits(right))


def shows(axes: Any, sets: Any) -> bool:
    """Return whether each set of points is drawn, as part of a curve or as markers, in labelled axes of its own.

    Examples
    --------
    >>> from flockana.plots import subplots
    >>> _, ax = subplots()
    >>> _ = ax.plot([0.0, 1.0], [2.0, 3.0]), ax.set(xlabel="t (s)", ylabel="x (m)")
    >>> shows([ax], [[[1.0, 3.0]]]), shows([ax], [[[1.0, 2.0]]]), shows([ax], [[[1.0, 3.0]], [[0.0, 2.0]]])
    (True, False, False)
    """
    is_drawn = np.array([[_draws(ax, points) for ax in axes] for points in sets])
    matching = maximum_bipartite_matching(csr_matrix(is_drawn), perm_type="column")
    return bool((matching >= 0).all())


def _draws(ax: Any, points: Any) -> bool:
    if not (ax.get_xlabel() and ax.get_ylabel()):
        return False
    curves = [np.asarray(line.get_xydata(), float) for line in ax.lines]
    for each in ax.collections:
        curves += [np.asarray(each.get_offsets(), float), *(path.vertices for path in each.get_paths())]
    all_points = np.vstack([np.empty((0, 2)), *(np.ma.filled(each, np.nan).reshape(-1, 2) for each in curves)])
    wanted_points = np.asarray(points, float).reshape(-1, 2)
    tolerance = 1e-6 * max(1.0, float(np.abs(wanted_points).max()))
    return all(np.any(np.abs(all_points - each).max(axis=1) <= tolerance) for each in wanted_points)


def is_own(*things: Any) -> bool:
    """Return whether functions and classes come from the student: neither library nor course files."""
    return not any(thing.__module__.partition(".")[0] in ("flockana", "own_law") for thing in things)


def _number(x: Any) -> bool:
    try:
        a = np.asarray(x)
        float(a.real.item())
    except (TypeError, ValueError):
        return False
    return a.dtype.kind in "fiuO" or (a.dtype.kind == "c" and not np.any(a.imag))  # no text, date or truth value


_FORMS: dict[str, Callable[[Any], bool]] = {
    "truth value": lambda x: isinstance(x, bool | np.bool_),
    "word": lambda x: isinstance(x, str),
    "formula": lambda x: isinstance(x, str),
    "function": callable,
    "list": lambda x: (
        isinstance(x, list | tuple | set | frozenset | range) or (isinstance(x, np.ndarray) and x.ndim > 0)
    ),
    "number": _number,
}


def _tolerance(right: float, digits: int | None, within: float | None) -> float:
    rounding = _ROUNDING * abs(right)
    if within is not None:
        return within + rounding
    if digits is None or right == 0.0:
        return max(rounding, _ROUNDING if right == 0.0 else 0.0)
    return 0.5 * float(10.0 ** (np.floor(np.log10(abs(right))) - digits + 1)) + rounding


def _same(answer: Any, right: Any, tolerance: Callable[[float], float]) -> bool:
    if isinstance(right, set | frozenset):
        return _matched(list(answer), list(right), tolerance)
    if isinstance(right, list | tuple | np.ndarray):
        return len(answer) == len(right) and all(_same(a, b, tolerance) for a, b in zip(answer, right, strict=True))
    if isinstance(right, bool | np.bool_):
        return isinstance(answer, bool | np.bool_) and bool(answer) is bool(right)
    if isinstance(right, str):
        return isinstance(answer, str) and answer.strip().casefold() == right.casefold()
    return _number(answer) and abs(float(np.asarray(answer).real.item()) - right) <= tolerance(float(right))


def _matched(answers: list[Any], rights: list[Any], tolerance: Callable[[float], float]) -> bool:
    """Return whether a student's answers and the right ones agree one to one, in any order."""
    for b in rights:
        index = next((k for k, a in enumerate(answers) if _same(a, b, tolerance)), None)
        if index is None:
            return False
        del answers[index]
    return not answers
