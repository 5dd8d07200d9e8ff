import pytest

import flockana.sources
from flockana.base.module_discovery import modules, source_files, source_modules


@pytest.fixture
def package(tmp_path, monkeypatch):
    for file in ("__init__", "b_toy", "a", "inner/__init__", "inner/c_toy"):
        path = tmp_path / "walked_package" / f"{file}.py"
        path.parent.mkdir(exist_ok=True)
        path.write_text("")
    monkeypatch.syspath_prepend(tmp_path)
    return "walked_package"


def test_every_module_is_found_in_packages_of_packages_too(package):
    names = [module.__name__ for module in modules(package)]
    assert names == [f"{package}.{name}" for name in ("a", "b_toy", "inner", "inner.c_toy")]


@pytest.fixture
def sources(tmp_path, monkeypatch):
    """A folder of sources beside the package's: one with a file of the kind, one with a folder, one without."""
    for file in (
        "zz_one/__init__",
        "zz_one/toys",
        "zz_one/other",
        "zz_two/__init__",
        "zz_two/toys/a",
        "zz_three/__init__",
    ):
        path = tmp_path / f"{file}.py"
        path.parent.mkdir(exist_ok=True, parents=True)
        path.write_text("raise AssertionError('imported')" if file.endswith("other") else "")
    (tmp_path / "zz_one" / "table.csv").write_text("1")
    (tmp_path / "zz_data").mkdir()
    (tmp_path / "zz_data" / "table.csv").write_text("2")
    monkeypatch.setattr(flockana.sources, "__path__", [str(tmp_path)])


def test_parts_of_a_kind_are_imported_and_no_others(sources):
    names = [module.__name__.removeprefix("flockana.sources.") for module in source_modules("toys")]
    assert names == ["zz_one.toys", "zz_two.toys.a"]


def test_tables_of_sources_are_found_without_a_module(sources):
    assert [path.read_text() for path in source_files("table.csv")] == ["2", "1"]
