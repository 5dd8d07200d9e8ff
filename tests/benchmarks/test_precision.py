import pytest

from benchmarks import before, precision


def line(name, factor, exponents):
    """Seconds that grow as the eighth root of the error falls."""
    return [{"method": name, "error": 10.0**-k, "seconds": factor * 10.0 ** (k / 8.0)} for k in exponents]


def gain_of(monkeypatch, series):
    monkeypatch.setattr(precision, "methods", lambda: ("DOP853", "scipy-DOP853"))
    monkeypatch.setattr(precision, "peer", lambda name: "scipy-DOP853" if name == "DOP853" else None)
    return precision.at_equal_error(series)


def test_a_method_that_is_twelve_times_cheaper_is_told_so_whatever_its_tolerances_gave(monkeypatch):
    ours, theirs = line("DOP853", 1.0, (1.5, 4.0, 9.7)), line("scipy-DOP853", 12.0, (2, 4, 6, 8))
    (row,) = gain_of(monkeypatch, ours + theirs)
    assert row.ratio == pytest.approx(12.0, rel=1e-12)
    assert row.verdict == "yes"
    assert "median of 4" in row.name


def test_errors_that_the_method_never_made_are_not_compared(monkeypatch):
    ours, theirs = line("DOP853", 1.0, (3, 5)), line("scipy-DOP853", 12.0, (1, 2, 8))
    assert gain_of(monkeypatch, ours + theirs) == []


def test_runs_of_the_code_of_before_are_compared_in_the_same_way():
    points = line("now", 1.0, (1.5, 4.0, 9.7)) + line("before", 11.0, (2, 4, 6))
    rows = before._rows([{"rtol": 1e-6, **point} for point in points])
    assert rows[-1].ratio == pytest.approx(11.0, rel=1e-12)
    assert rows[-1].verdict == "yes"
    assert len(rows) == 7
