import pytest

from flockana.base.modules import modules


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


def test_only_modules_of_that_ending_are_imported(package, tmp_path):
    (tmp_path / package / "a.py").write_text("raise AssertionError('imported')")
    assert [module.__name__ for module in modules(package, ending="_toy")] == [
        f"{package}.b_toy",
        f"{package}.inner.c_toy",
    ]
