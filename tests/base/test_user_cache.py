"""Data kept on disk: computed once, and again as soon as a file of the package is another."""

import pytest

from flockana.base import user_cache
from flockana.base.user_cache import kept_data


@pytest.fixture
def package(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(user_cache, "ROOT", tmp_path / "package")
    (tmp_path / "package").mkdir()
    (tmp_path / "package" / "one.py").write_text("1")
    return tmp_path


def counted(calls):
    def compute():
        calls.append(1)
        return [{"name": "a", "t_span": [0.0, float(len(calls))]}]

    return compute


def test_data_are_computed_again_only_if_a_file_of_the_package_changes(package):
    calls = []
    assert [kept_data("list", counted(calls))[0]["t_span"] for _ in range(3)] == [[0.0, 1.0]] * 3
    (package / "package" / "table.csv").write_text("a")
    assert kept_data("list", counted(calls))[0]["t_span"] == [0.0, 2.0]
    assert kept_data("other", counted(calls))[0]["t_span"] == [0.0, 3.0]
    names = sorted(path.name.partition("-")[0] for path in (package / "cache" / "flockana" / "lists").iterdir())
    assert names == ["list", "other"]  # no older one is left


def test_a_damaged_file_or_a_folder_that_cannot_be_made_costs_time_alone(package):
    calls = []
    kept_data("list", counted(calls))
    (path,) = (package / "cache" / "flockana" / "lists").iterdir()
    path.write_text("[{")
    assert kept_data("list", counted(calls))[0]["t_span"] == [0.0, 2.0]
    assert kept_data("list", counted(calls))[0]["t_span"] == [0.0, 2.0]
    path.unlink()
    path.parent.rmdir()
    path.parent.write_text("no folder")
    assert [kept_data("list", counted(calls))[0]["t_span"][1] for _ in range(2)] == [3.0, 4.0]


def test_an_error_of_the_computation_is_its_own(package):
    def fails():
        raise ValueError("of its own")

    with pytest.raises(ValueError, match="of its own"):
        kept_data("list", fails)
