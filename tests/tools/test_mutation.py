"""Mutation testing: which mutants there are, and what is made of what the tests say of them."""

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


def drawn(project, size=None, salt=""):
    """The lines of a sample, and its mutants, by cosmic-ray's own `init`."""
    from cosmic_ray.commands import init
    from cosmic_ray.modules import find_modules
    from cosmic_ray.work_db import use_db

    session = project / f"session-{size}-{salt}.sqlite"
    session.unlink(missing_ok=True)
    with use_db(session) as database:
        init([path.relative_to(project) for path in find_modules([project / "flockana/laws"])], database, {})
    mutation.sample(session, project, size, salt)
    with use_db(session) as database:
        specs = [item.mutations[0] for item in database.pending_work_items]
    lines = [((project / spec.module_path).read_text().splitlines()[spec.start_pos[0] - 1], spec) for spec in specs]
    return {(line.strip(), spec.operator_name, spec.occurrence) for line, spec in lines}


def test_mutants_are_of_what_is_computed_and_not_of_texts_types_or_compiling(project, monkeypatch):
    monkeypatch.chdir(project)
    assert {line for line, _, _ in drawn(project)} == {
        "def area(a: float | None, *, b=2) -> float | None:",
        "if a < b:",
        "c: int | None = a * b",
        "return area(a) - -1",
    }


def test_a_larger_sample_holds_the_smaller_and_lines_above_change_nothing(project, monkeypatch):
    monkeypatch.chdir(project)
    few, more = (drawn(project, size) for size in (4, 9))
    assert len(few) == 4
    assert few < more
    assert few != drawn(project, 4, "another")
    path = project / "flockana/laws/area.py"
    path.write_text(path.read_text().replace("\n\n\n", "\n\nHIGH = LOW = None\n\n\n"))
    assert few == drawn(project, 4)


@pytest.mark.parametrize(("test", "outcome", "code"), [("assert area(1) == 2", "killed", 0), ("", "survived", 3)])
def test_cosmic_ray_tries_what_is_drawn_and_what_survives_is_shown(project, tmp_path, capsys, test, outcome, code):
    (project / "flockana/laws/area.py").write_text("def area(a):\n    return a + 1\n")
    (project / "flockana/laws/twice.py").unlink()
    text = f"from flockana.laws.area import area\n\n\ndef test_area():\n    {test or 'pass'}\n"
    (project / "tests/laws/test_twice.py").write_text(text)
    folder = tmp_path / "out"
    assert mutation.main(["laws", "--sample", "2", "--out", str(folder)]) == code
    tried = mutation.outcomes(folder / "laws-2.sqlite")
    assert [one for one, _ in tried] == [outcome] * 2
    told = capsys.readouterr()
    assert (folder / "table.md").read_text() == told.out
    assert ("- return a + 1" in told.out) is (code == 3)
    (project / "tests/laws/test_twice.py").write_text("raise AssertionError")
    assert mutation.main(["laws", "--sample", "2", "--out", str(folder)]) == code  # tries nothing again


def test_the_table_counts_what_was_said_and_shows_survivors():
    kinds = ("killed", "incompetent", "survived", "equivalent")
    text, survivors = mutation.report({"laws": [(kind, f"a.py:3 {kind}\n") for kind in kinds]})
    assert survivors == 1
    row = "| laws | 4 | 2 | 1 | 1 | 9.4-99.2 % |"  # 2 of 3, Clopper and Pearson
    assert text.splitlines()[2:4] == [row, row.replace("laws", "all")]
    assert "a.py:3 survived\n" in text
    assert "a.py:3 killed\n" not in text


def test_a_reviewed_mutant_is_equivalent(project, tmp_path, monkeypatch):
    (project / "flockana/laws/area.py").write_text("def area(a):\n    return a  + 1  # b\n")
    (project / "flockana/laws/twice.py").unlink()
    session = tmp_path / "laws.sqlite"
    assert mutation.carry_out("laws", session, 1, "", 60.0)
    ((outcome, text),) = mutation.outcomes(session)
    (before, after) = (line[6:].strip() for line in text.splitlines()[1:])
    (tmp_path / "it.toml").write_text(
        f'[[mutant]]\npath = "flockana/laws/area.py"\nbefore = "{before}"\nafter = "{after}"\n'
    )
    monkeypatch.setattr(mutation, "REVIEWED", tmp_path / "it.toml")
    assert (outcome, mutation.outcomes(session)[0][0]) == ("killed", "equivalent")


def test_every_reviewed_mutant_has_a_reason_and_is_one_of_the_code_as_it_is():
    for one in tomllib.loads(mutation.REVIEWED.read_text("utf-8"))["mutant"]:
        lines = [line.strip() for line in (mutation.PROJECT / one["path"]).read_text("utf-8").splitlines()]
        assert one["before"] in lines, one
        assert one["before"] != one["after"]
        assert len(one["reason"]) > 20


@pytest.mark.parametrize("given", [["nonsense"], ["--sample", "0"], ["--timeout", "-1"]])
def test_bad_options_are_one_line(given, capsys, tmp_path):
    assert mutation.main([*given, "--out", str(tmp_path)]) == 2
    assert capsys.readouterr().err.count("\n") == 1
