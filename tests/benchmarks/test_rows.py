import json

import pytest

from benchmarks.rows import Asked, Row, from_json, missed, table, to_json


@pytest.mark.parametrize(
    ("sense", "of", "expected"), [("<=", "ratio", "no"), (">=", "ratio", "yes"), ("<=", "value", "yes")]
)
def test_a_bound_is_compared_with_the_ratio_or_with_the_value(sense, of, expected):
    row = Row("s", "x", 150, 2.0, "µs", "numpy", ratio=7.0, asked=Asked(sense, 5.0, of))
    assert row.verdict == expected


def test_what_is_missing_or_no_number_keeps_no_bound_and_what_is_not_asked_says_nothing():
    assert Row("s", "x", None, 1.0, "s", asked=Asked(">=", 0.5)).verdict == "no"
    assert Row("s", "x", None, float("nan"), "s", asked=Asked(">=", 0.5, "value")).verdict == "no"
    assert Row("s", "x", None, 1.0, "s").verdict == ""


def test_rows_survive_json():
    rows = [Row("s", "x", 150, 2.0, "µs", "numpy", 7.0, Asked("<=", 1.5), "a note"), Row("s", "y", None, 1.0, "s")]
    assert from_json(json.loads(json.dumps(to_json(rows)))) == rows


def test_the_table_shows_name_size_value_bound_and_verdict():
    text = table([Row("s", "gas", 10_000, 17.24, "ns per pair", "C: 6 ns", 2.9, Asked("<=", 1.5), "twice")])
    assert text.splitlines()[2] == "| gas (twice) | 10 000 | 17.2 ns per pair | C: 6 ns | 2.9 | <= 1.5 | no |"
    assert "| median <= 8 |" in table([Row("s", "x", 150, 35.0, "µs", asked=Asked("<=", 8.0, "value"))])


def test_what_is_missed_is_told_with_its_reason():
    asked = Asked("<=", 0.5, "value", "Python alone takes half of it.")
    rows = [
        Row("Command line", "scenarios", None, 0.6, "s", "a shell", asked=asked),
        Row("Command line", "help", None, 0.4, "s", asked=asked),
        Row("Pairs", "gas", 10_000, 9.0, "ns", "C", 1.62, Asked("<=", 1.5)),
        Row("Pairs", "gas", 10_000, 9.0, "ns"),
    ]
    assert missed(rows) == (
        "- Command line, scenarios: 0.6 s, asked median <= 0.5. Python alone takes half of it.\n"
        "- Pairs, gas, n = 10 000: ratio 1.62 (against C), asked <= 1.5.\n"
    )
    assert missed(rows[1:2]) == ""
