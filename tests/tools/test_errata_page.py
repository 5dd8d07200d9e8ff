import pytest

from flockana.theorems.errata import errata
from tools import errata_page


def test_page_is_what_the_table_says():
    assert errata_page.main(["--check"]) == 0


def test_every_erratum_stands_once_on_the_page_below_its_sort():
    text = errata_page.page(errata())
    for item in errata():
        assert text.count(f"\n| {item.id} | ") == 1
    wrong, confirmed = text.index("## Wrong: "), text.index("## Confirmed: ")
    assert wrong < text.index("| E1 |") < confirmed < text.index("| J17 |")


@pytest.mark.parametrize("text", ["another page", None])
def test_another_page_is_told(text, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(errata_page, "PAGE", tmp_path / "errata.md")
    if text is not None:
        (tmp_path / "errata.md").write_text(text, encoding="utf-8")
    assert errata_page.main(["--check"]) == 3
    assert "is not what the table of errata says: write it with `make coverage`" in capsys.readouterr().err
    assert errata_page.main(["--chek"]) == 2
