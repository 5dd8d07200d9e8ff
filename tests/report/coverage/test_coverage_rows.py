import re

import pytest

from flockana.base.errors import ArgumentError
from flockana.report.coverage import Reference, Row, read_table

HEAD = "# A paper\nplace | what | standing | held by | remark\n"
GOOD = "Fig. 1 | a run | held | scenario:collapse theorem:os-3 |"


def table(tmp_path, *lines, head=HEAD, name="jond-2025.csv"):
    path = tmp_path / name
    path.write_text(head + "\n".join(lines), encoding="utf-8")
    return path


def test_a_table_is_read_in_its_order(tmp_path):
    source = read_table(table(tmp_path, GOOD, "Fig. 2 | more | weaker | | not judged", "end | thanks | prose | | none"))
    references = (Reference("scenario", "collapse"), Reference("theorem", "os-3"))
    assert (source.key, source.title) == ("jond-2025", "A paper")
    assert source.rows == (
        Row("Fig. 1", "a run", "held", references),
        Row("Fig. 2", "more", "weaker", (), "not judged"),
        Row("end", "thanks", "prose", (), "none"),
    )
    assert [source.count(standing) for standing in ("held", "weaker", "prose")] == [1, 1, 1]


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("Fig. 1 | a run | held | theorem:os-3", "4 columns, expected 5: place, what, standing, held by, remark"),
        (f"\n{GOOD}", "1 columns, expected 5"),
        ("| a run | held | theorem:os-3 |", "a row says '', 'a run': expected a place and what stands there"),
        ("Fig. 1 | a run | done | theorem:os-3 |", "standing = 'done', expected one of held, weaker, absent, prose"),
        ("Fig. 1 | a run | held | |", "held by nothing; name what holds it, or call it weaker"),
        ("Fig. 1 | a run | weaker | theorem:os-3 |", "weaker, without a remark that says why"),
        ("Fig. 1 | a run | held | os-3 |", "reference 'os-3:': expected kind:name"),
        ("Fig. 1 | a run | held | theorem:os-3 theorem:os-3 |", "a reference is given twice"),
        (f"{GOOD}\n{GOOD.replace('theorem:os-3', '')}", "line 4: the same as line 3"),
    ],
)
def test_a_line_that_is_no_row_is_told_with_its_place(tmp_path, line, told):
    with pytest.raises(ArgumentError, match=re.escape(told)) as raised:
        read_table(table(tmp_path, line))
    assert str(raised.value).startswith("jond-2025.csv, line ")


@pytest.mark.parametrize("head", ["", "A paper\n", "# A paper\n", "# A paper\nplace | what\n"])
def test_a_table_begins_with_its_title_and_the_names_of_its_columns(tmp_path, head):
    with pytest.raises(ArgumentError, match=r"jond-2025.csv: expected '# title' and 'place | what"):
        read_table(table(tmp_path, head=head))


def test_a_table_is_named_for_an_entry_of_the_bibliography(tmp_path):
    with pytest.raises(ArgumentError, match=r"nobody-1999.csv: expected a key of the bibliography"):
        read_table(table(tmp_path, GOOD, name="nobody-1999.csv"))
