from io import StringIO

import pytest
from rich.console import Console
from rich.table import Column

from flockana.report.tables import FoldingTable, column, fact_table, headed_table


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


def share_like():
    table = headed_table(column("claim", wraps=True), column("runs", right=True), column("verified, %", right=True))
    table.add_row("os-5")
    table.add_row("  extension-quantitative", "100", "100.0 [96.4, 100.0]")
    return table


def test_words_are_broken_after_hyphens_alone_where_a_table_is_too_wide():
    assert "extension-quantitative    100   100.0 [96.4, 100.0]" in printed(share_like(), 60)
    lines = printed(share_like(), 48)
    assert lines[-2:] == ["extension-        100   100.0 [96.4, 100.0]", "quantitative"]  # moved in


@pytest.mark.parametrize("width", [20, 30, 40, 46])
def test_rows_are_blocks_where_a_table_would_be_cut(width):
    lines = printed(share_like(), width)
    assert "claim" not in "".join(lines)
    text = " ".join(lines)
    assert text.replace("quantita tive", "quantitative") == (
        "os-5 extension-quantitative runs: 100 verified, %: 100.0 [96.4, 100.0]"
    )


@pytest.mark.parametrize("width", [12, 20, 30, 40, 80])
def test_facts_lose_no_letter(width):
    facts = [("spectral abscissa", "-1.96375 per time unit"), ("rigidity", "infinitesimally rigid; [rank] 3")]
    text = "".join("".join(printed(fact_table(facts), width)).split())
    letters = sorted("".join(name + value for name, value in facts).replace(" ", ""))
    assert sorted(text) == letters


def test_a_column_that_takes_what_is_left_is_not_squeezed_to_nothing():
    table = FoldingTable(column("theorem"), Column("what", ratio=1, overflow="fold"), column("checked on"), box=None)
    table.add_row("alpha-flocking-strict", "The run is strictly α-flocking", "a run")
    assert printed(table, 40) == [
        *("alpha-flocking-strict", "what: The run is strictly α-flocking", "checked on: a run")
    ]
    assert printed(table, 60)[0].split() == ["theorem", "what", "checked", "on"]
