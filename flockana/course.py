"""Check a student's answer in a notebook: right, not yet, or not answered; never an exception."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Grade:
    """What became of an answer; shows itself in a notebook.

    Parameters
    ----------
    status : {"right", "not yet", "not answered"}
        The finding.
    hint : str
        Where to look, if it is not right.

    Examples
    --------
    >>> Grade("not yet", "count each pair once")
    ✗ not yet: count each pair once
    """

    status: str
    hint: str = ""

    def __repr__(self) -> str:
        mark = {"right": "✓", "not yet": "✗", "not answered": "…"}[self.status]
        return f"{mark} {self.status}" + (f": {self.hint}" if self.hint and self.status == "not yet" else "")


def grade(answer: Any, right: Any, *, hint: str = "", rtol: float = 1e-6) -> Grade:
    """Compare an answer with the right one, or ask a function whether it is right.

    Parameters
    ----------
    answer : object
        The student's; ``...`` stands for no answer yet.
    right : object
        A number, an array, a text, a truth value, or a function of the answer that returns one. A function that
        stumbles over the answer counts as a no.
    hint : str
        Shown with an answer that is not right.
    rtol : float
        Relative tolerance between numbers.

    Returns
    -------
    Grade

    Examples
    --------
    >>> grade(..., 42), grade(41, 42, hint="count each pair once"), grade(42, 42)
    (… not answered, ✗ not yet: count each pair once, ✓ right)
    >>> grade([1.0, 2.0], lambda found: sum(found) == 3.0)
    ✓ right
    """
    if answer is ...:
        return Grade("not answered")
    try:
        good = bool(right(answer)) if isinstance(right, Callable) else _same(answer, right, rtol)  # type: ignore[arg-type]
    except Exception:  # whatever a student hands in, the check answers
        good = False
    return Grade("right" if good else "not yet", hint)


def _same(answer: Any, right: Any, rtol: float) -> bool:
    if isinstance(right, bool | str) or isinstance(answer, bool | str):
        return type(answer) is type(right) and bool(answer == right)
    a, b = np.asarray(answer, dtype=float), np.asarray(right, dtype=float)
    return a.shape == b.shape and bool(np.allclose(a, b, rtol=rtol, atol=rtol * float(np.abs(b).max(initial=0.0))))
