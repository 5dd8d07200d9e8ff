import re

import pytest

from flockana.base import progress
from flockana.base.progress import progress_bar, show_part


@pytest.fixture
def shown(capsys, monkeypatch):
    """What a bar shows on a terminal, without its colours."""

    def read(total, *steps, **options):
        monkeypatch.setenv("FORCE_COLOR", "1")
        monkeypatch.setenv("COLUMNS", "120")
        with progress_bar(total, **options) as advance:
            for done, text in steps:
                advance(done, text)
        out, err = capsys.readouterr()
        assert out == ""
        return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", err)

    return read


def test_tasks_are_counted_and_named(shown):
    text = shown(7, (3, "hexagon, E8"))
    assert "3/7" in text
    assert "hexagon, E8" in text
    assert "left" not in text
    assert "/s" not in text


def test_a_task_shows_its_part_while_a_bar_is_there(capsys, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "120")
    show_part("before")
    with progress_bar(1):
        show_part("flow 3 of 20")
    show_part("after")
    text = capsys.readouterr().err
    assert "flow 3 of 20" in text
    assert "before" not in text
    assert "after" not in text


def test_steady_work_has_a_rate_and_time_left(shown):
    text = shown(7, (3, "runs"), steady=True)
    assert re.search(r"3/7 .* left .* runs, [0-9.e+]+/s", text)


def test_what_is_not_counted_shows_no_numbers_of_its_own(shown):
    text = shown(20.0, (5.0, "t = 5"), counted=False, steady=True)
    assert "t = 5" in text
    assert "5.0/20" not in text
    assert "/s" not in text


def test_a_text_is_no_markup(shown):
    assert "[bold]runs" in shown(2, (1, "[bold]runs"))


def test_there_is_none_in_a_pipe_or_where_it_is_not_wanted(capsys, shown):
    with progress_bar(2) as advance:
        advance(1, "half")
    assert capsys.readouterr() == ("", "")
    assert shown(2, (1, "half"), enabled=False) == ""


def test_off_a_terminal_long_work_is_told_in_a_line_now_and_then(capsys, monkeypatch):
    clock = [100.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: clock[0])
    with progress_bar(8) as advance:
        for seconds, done in ((0.0, 0), (59.0, 1), (60.0, 2), (61.0, 3), (119.0, 3), (120.0, 4), (240.0, 8)):
            clock[0] = 100.0 + seconds
            advance(done, f"task {done}")
    out, err = capsys.readouterr()
    assert out == ""
    assert err.splitlines() == ["2 of 8 in 60 s, about 180 s left: task 2", "4 of 8 in 120 s, about 120 s left: task 4"]
    with progress_bar(8, enabled=False) as advance:
        clock[0] += 1000.0
        advance(4, "")
    assert capsys.readouterr().err == ""


def test_the_time_left_is_not_told_before_a_tenth_is_done(capsys, monkeypatch):
    clock = [0.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: clock[0])
    with progress_bar(40) as advance:
        for clock[0], done in ((60.0, 3), (120.0, 4)):
            advance(done, "")
    assert capsys.readouterr().err.splitlines() == ["3 of 40 in 60 s: ", "4 of 40 in 120 s, about 1080 s left: "]
