from flockana.ensemble.process_guard import is_guarded


def test_a_line_under_the_question_for_main_is_guarded():
    text = 'import os\nif __name__ == "__main__":\n    os.getpid()\n'
    assert is_guarded(text, 3)
    assert not is_guarded(text, 1)
