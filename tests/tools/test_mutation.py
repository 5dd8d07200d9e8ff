import json
import tomllib

import pytest

pytest.importorskip("cosmic_ray", exc_type=ImportError)

from tools import mutation

SOURCE = '''"""A module, 1 + 1 = 2."""

__all__ = ["area"] + ["b"]


@lru_cache(maxsize=32)
@njit(cache=True)
def area(a: float | None, *, b=2) -> float | None:
    """3 * 4."""
    if a < b:
        raise ValueError(f"{a + 1}: expected more than {b}" + "!")
    c: int | None = a * b
    return c
'''


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A package of two modules of which one is tested by itself."""
    for name, text in {
        "flockana/__init__.py": "",
        "flockana/laws/area.py": SOURCE,
        "flockana/laws/twice.py": "from flockana.laws.area import area\n\n\ndef twice(a):\n    return area(a) - -1\n",
        "tests/laws/test_twice.py": "from flockana.laws.twice import twice\n",
        "tests/laws/test_other.py": "def test_nothing():\n    pass\n",
    }.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(mutation, "PROJECT", tmp_path)
    return tmp_path


def drawn(size=None, salt=""):
    return mutation.draw(["flockana/laws/area.py", "flockana/laws/twice.py"], size, salt)


def test_mutants_are_of_what_is_computed_and_not_of_texts_types_or_compiling(project):
    found = drawn()[1]
    assert {one["before"] for one in found} == {
        "def area(a: float | None, *, b=2) -> float | None:",
        "if a < b:",
        "c: int | None = a * b",
        "return area(a) - -1",
    }
    defaults = {one["after"].replace(" ", "") for one in found if one["before"].startswith("def area")}
    assert defaults == {f"defarea(a:float|None,*,b={number})->float|None:" for number in (1, 3)}
    changed = {one["after"] for one in found if one["before"] == "if a < b:"}
    assert changed == {*(f"if a {sign} b:" for sign in ("==", "!=", "<=", ">", ">=")), "if not a < b:"}
    products = {one["after"] for one in found if "a * b" in one["before"]}
    assert products == {f"c: int | None = a {sign} b" for sign in ("+", "-", "/", "//", "%", "**")}


def test_a_larger_sample_holds_the_smaller_and_lines_above_change_nothing(project):
    few, more = ({one["key"] for one in drawn(size)[1]} for size in (4, 9))
    assert len(few) == 4
    assert few < more
    assert few != {one["key"] for one in drawn(4, "another")[1]}
    path = project / "flockana/laws/area.py"
    path.write_text(path.read_text().replace("\n\n\n", "\n\nHIGH = LOW = None\n\n\n"))
    assert few == {one["key"] for one in drawn(4)[1]}


def test_a_file_that_moves_keeps_its_mutants(project):
    before = {one["key"] for one in mutation.draw(["flockana/laws/area.py"], 4, "")[1]}
    moved = project / "flockana/sources/key/laws.py"
    moved.parent.mkdir(parents=True)
    (project / "flockana/laws/area.py").rename(moved)
    assert before == {one["key"] for one in mutation.draw(["flockana/sources/key/laws.py"], 4, "")[1]}
    assert mutation.package_of("flockana/sources/key/laws.py") == "laws"
    assert mutation.package_of("flockana/sources/key/theorems/printed.py") == "theorems"


def test_the_nearest_tests_come_first(project):
    twice = ["flockana/laws/twice.py", "tests/laws/test_other.py"]
    assert mutation.nearest("flockana/laws/twice.py") == ["tests/laws/test_twice.py", *twice]
    area = ["flockana/laws/area.py", "tests/laws/test_other.py", "tests/laws/test_twice.py"]
    assert mutation.nearest("flockana/laws/area.py") == area


@pytest.mark.parametrize(("test", "outcome", "code"), [("assert area(1) == 2", "killed", 0), ("", "survived", 3)])
def test_cosmic_ray_tries_what_is_drawn_and_what_survives_is_shown(
    project, tmp_path, monkeypatch, capsys, test, outcome, code
):
    (project / "flockana/laws/area.py").write_text("def area(a):\n    return a + 1\n")
    (project / "flockana/laws/twice.py").unlink()
    text = f"from flockana.laws.area import area\n\n\ndef test_area():\n    {test or 'pass'}\n"
    (project / "tests/laws/test_twice.py").write_text(text)
    (project / "tools").mkdir()
    (project / "tools/mutation.py").write_text(mutation.REVIEWED.with_name("mutation.py").read_text())
    folder = tmp_path / "out"
    assert mutation.main(["laws", "--sample", "2", "--jobs", "1", "--out", str(folder)]) == code
    assert set(json.loads((folder / "results.json").read_text()).values()) == {outcome}
    told = capsys.readouterr()
    assert (folder / "table.md").read_text() == told.out
    assert ("- return a + 1" in told.out) is (code == 3)
    assert mutation.main(["laws", "--sample", "2", "--out", str(folder)]) == code  # tries nothing again
    assert "0 to try" in capsys.readouterr().err


def test_every_reviewed_mutant_has_a_reason_and_is_one_of_the_code_as_it_is():
    for one in tomllib.loads(mutation.REVIEWED.read_text("utf-8"))["mutant"]:
        lines = [line.strip() for line in (mutation.PROJECT / one["path"]).read_text("utf-8").splitlines()]
        assert one["before"] in lines, one
        assert one["before"] != one["after"]
        assert len(one["reason"]) > 20


@pytest.mark.parametrize("given", [["nonsense"], ["--jobs", "0"], ["--sample", "0"], ["--budget", "-1"]])
def test_bad_options_are_one_line(given, capsys, tmp_path):
    assert mutation.main([*given, "--out", str(tmp_path)]) == 2
    assert capsys.readouterr().err.count("\n") == 1
