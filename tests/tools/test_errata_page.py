from __future__ import annotations

import pytest

from flockana.theorems.errata import errata
from tools import errata_page


def test_page_and_readme_are_what_the_table_says():
    assert errata_page.main(["--check"]) == 0
    assert errata_page.README.read_text(encoding="utf-8").count("| E1 | slides | ✗ ") == 1


def test_every_erratum_stands_once_on_the_page_below_its_sort():
    text = errata_page.page(errata())
    for item in errata():
        assert text.count(f"\n| {item.id} | ") == 1
    wrong, confirmed = text.index("## Wrong: "), text.index("## Confirmed: ")
    assert wrong < text.index("| E1 |") < confirmed < text.index("| J17 |")


def test_what_stands_around_the_errata_of_the_readme_stays():
    text = errata_page.README.read_text(encoding="utf-8")
    changed = errata_page.readme(errata()[:1], text)
    (head, tail), (before, after) = text.split("| E1 |"), changed.split("| E1 |")
    assert head == before
    assert tail.rsplit("<!--", 1)[1] == after.rsplit("<!--", 1)[1]
    assert "| E2 |" not in changed


@pytest.mark.parametrize(("path", "text"), [("PAGE", "another page"), ("PAGE", None)])
def test_another_page_is_told(path, text, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(errata_page, path, tmp_path / "errata.md")
    if text is not None:
        (tmp_path / "errata.md").write_text(text, encoding="utf-8")
    assert errata_page.main(["--check"]) == 3
    assert "is not what the table of errata says: write it with `make coverage`" in capsys.readouterr().err


def test_another_argument_is_refused(capsys):
    assert errata_page.main(["--chek"]) == 2
    assert "--chek: expected nothing, or --check" in capsys.readouterr().err
