"""Predictions in notebooks: a reader enters a number or a word, then opens the answer."""

from dataclasses import dataclass
from html import escape
from typing import Any

from flockana.course.grading import answered, form_of


@dataclass(frozen=True)
class Prediction:
    """Question with a reader's guess; the answer is shown after the guess.

    As HTML the answer is folded away, with a guess or without, so that a page that nobody can run has it too.

    Examples
    --------
    >>> Prediction("How many neighbours has an agent inside a triangular lattice?", ..., 6)
    How many neighbours has an agent inside a triangular lattice?
    … no guess yet: put a number in the place of the dots, and run the cell again
    >>> Prediction("How long is its second link?", 2.0, 3**0.5)
    How long is its second link?
    you said 2.0; it is 1.73
    """

    question: str
    guess: Any  # an ellipsis as long as there is none
    right: float | str

    def __repr__(self) -> str:
        answer_text = self._answer() if answered(self.guess, form_of(self.right)).status == "handed in" else ""
        return f"{self.question}\n{self._guess()}{f'; {answer_text}' if answer_text else ''}"

    def _repr_html_(self) -> str:
        summary, told = escape(self._guess()), escape(self._answer())
        return f"<p><b>Predict.</b> {escape(self.question)}</p><details><summary>{summary}</summary>{told}</details>"

    def _guess(self) -> str:
        form = form_of(self.right)
        form_grade = answered(self.guess, form)
        if form_grade.status == "handed in":
            return f"you said {self.guess}"
        if form_grade.status == "not yet":
            return f"✗ {form_grade.hint}; got {self.guess!r}"
        return f"… no guess yet: put a {form} in the place of the dots, and run the cell again"

    def _answer(self) -> str:
        number = isinstance(self.right, float)
        return f"it is {self.right:.3g}" if number else f"it is {self.right}"
