from __future__ import annotations

from io import StringIO

from rich.console import Console

from flockana.report.tables import column, fact_table, headed_table


def printed(table, width=60):
    console = Console(width=width, file=StringIO())
    console.print(table)
    return [line.strip() for line in console.file.getvalue().splitlines() if line.strip()]


def test_numbers_stand_right_and_names_left():
    table = headed_table(column("mode"), column("rate", right=True))
    table.add_row("breathing", "1")
    table.add_row("2", "10.5")
    heading, line, first, second = printed(table)
    assert set(line) == {"─"}
    assert (heading.split(), first.split(), second.split()) == (["mode", "rate"], ["breathing", "1"], ["2", "10.5"])
    assert len(heading) == len(first) == len(second)  # all end with the numbers
    assert second.startswith("2 ")


def test_a_column_has_at_least_its_width():
    table = headed_table(column("claim"), column("runs", right=True, width=9))
    table.add_row("i", "3")
    table.add_row("ii", "1234567890")
    assert [len(line) for line in printed(table)[2:]] == [len("claim") + 3 + 10] * 2
    table = headed_table(column("claim"), column("runs", right=True, width=9))
    table.add_row("claim", "3")
    assert printed(table)[-1] == "claim" + "3".rjust(3 + 9)


def test_facts_have_no_heading_and_no_markup():
    assert [" ".join(line.split()) for line in printed(fact_table([("links", "[3] of 4"), ("graph", "planar")]))] == [
        "links [3] of 4",
        "graph planar",
    ]
