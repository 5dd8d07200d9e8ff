import pytest

from flockana.report.coverage import Reference, Row, Source, coverage
from tools import coverage_page


def test_the_page_is_what_the_tables_say():
    assert coverage_page.PAGE.read_text(encoding="utf-8") == coverage_page.page(coverage())
    assert coverage_page.main(["--check"]) == 0


def test_a_table_of_rows_of_each_standing():
    held = (Reference("theorem", "os-1"), Reference("theorem", "os-3"), Reference("notebook", "07"))
    rows = (
        Row("Theorem 1", "C* of q_i", "held", held),
        Row("end", "thanks", "prose", (), "no claim"),
        Row("Theorem 2", "more", "absent", (), "left out"),
        Row("Fig. 2", "a run", "weaker", (Reference("scenario", "collapse"),), "R is not judged"),
    )
    text = coverage_page.page((Source("jond-2025", "A paper", rows),))
    room = "../flockana/sources/olfati_saber_2006/theorems"
    assert "| A paper | 4 | 1 | 1 | 1 | 1 |" in text
    assert "| A paper | Fig. 2 | a run | *in part* | R is not judged |" in text
    assert (
        f"| Theorem 1 | C\\* of q\\_i | theorem [`os-1`]({room}/theorem_1_free_flock.py), "
        f"[`os-3`]({room}/theorem_3_led_flock.py); "
        "notebook [`07`](../notebooks/07_what_the_theorems_say.py) |  |"
    ) in text
    assert "| end | thanks | *prose* | no claim |" in text
    assert "| Theorem 2 | more | *absent* | left out |" in text
    assert "| Fig. 2 | a run | *in part*: scenario [`collapse`](" in text
    lines = [line for line in text.splitlines() if line.startswith("|")]
    assert {line.count("|") for line in lines} == {5, 6, 7}


@pytest.mark.parametrize("written", [None, "another page\n"])
def test_a_page_that_is_not_theirs_is_told_and_then_written(written, tmp_path, monkeypatch, capsys):
    page = tmp_path / "coverage.md"
    monkeypatch.setattr(coverage_page, "PAGE", page)
    if written is not None:
        page.write_text(written, encoding="utf-8")
    assert coverage_page.main(["--check"]) == 3
    assert "is not what the tables say: write it with `make coverage`" in capsys.readouterr().err
    assert coverage_page.main([]) == 0
    assert coverage_page.main(["--check"]) == 0


def test_a_wrong_name_ends_it_before_anything_is_written(tmp_path, monkeypatch, capsys):
    wrong = Source("jond-2025", "A paper", (Row("Fig. 1", "a run", "held", (Reference("theorem", "os-0"),)),))
    monkeypatch.setattr(coverage_page, "PAGE", tmp_path / "coverage.md")
    monkeypatch.setattr(coverage_page, "coverage", lambda: (wrong,))
    assert coverage_page.main([]) == 2
    assert "jond-2025, Fig. 1: unknown theorem 'os-0'" in capsys.readouterr().err
    assert not (tmp_path / "coverage.md").exists()
