import ast

import pytest

from flockana.course import Prediction, build


def test_the_answer_is_told_after_a_guess_of_its_form_and_folded_in_html():
    shown = {guess: repr(Prediction("How far?", guess, 12.345)) for guess in (..., "far", 3)}
    assert ["12.3" in text for text in shown.values()] == [False, False, True]
    assert shown[3] == "How far?\nyou said 3; it is 12.3"
    assert shown["far"] == "How far?\n✗ a number is asked for; got 'far'"
    assert repr(Prediction("Up or down?", "up", "down")) == "Up or down?\nyou said up; it is down"
    assert Prediction("1 < 2?", 3, 4)._repr_html_() == (
        "<p><b>Predict.</b> 1 &lt; 2?</p><details><summary>you said 3</summary>it is 4</details>"
    )
    assert "<summary>… no guess yet: put a number" in Prediction("How far?", ..., 12.345)._repr_html_()


@pytest.mark.parametrize(
    "source", [path for path in build.sources() if not path.name.startswith("A")], ids=lambda path: path.stem
)
def test_every_lecture_asks_for_a_prediction_whose_answer_it_computes(source):
    cells = [cell for cell in build.notebook(source, "student").cells if "predict" in build.tags(cell)]
    assert cells
    for cell in cells:
        first, last = ast.parse(cell.source).body
        assert ast.unparse(first) == "guess = ..."
        question, guess, right = last.value.args
        assert ast.unparse(last.value.func) == "Prediction"
        assert question.value.endswith("?")
        assert guess.id == "guess"
        assert not isinstance(right, ast.Constant)  # a number to be read beside the question is no answer to predict
