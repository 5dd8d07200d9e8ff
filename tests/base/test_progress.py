from __future__ import annotations

import re

import pytest

from flockana.base.progress import progress_bar


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
