import pytest

from flockana.base.errors import ArgumentError
from flockana.course import build
from tools.wheel_lectures import without_solutions, write_shipped


def test_a_wheel_has_no_solutions_and_makes_the_same_notebooks_for_students(tmp_path):
    root = build.lectures().parent
    shipped = {path.relative_to(tmp_path).as_posix() for path in write_shipped(root, tmp_path)}
    assert {"lectures.toml", "notation.csv", "numbers.toml", "own_law/law.py", "proofs/proof.py"} <= shipped
    assert not {name for name in shipped if "lecturer" in name or "exam" in name}
    for source in build.sources():
        shorter = tmp_path / source.name
        assert not {'tags=["solution"]', 'tags=["facts"]'} & set(shorter.read_text(encoding="utf-8").split())
        for version, student in (("student", ""), ("self-study", "Ada")):
            books = [build.notebook(each, version, student=student) for each in (source, shorter)]
            plain, made = ([(cell.id, build.tags(cell), cell.source) for cell in book.cells] for book in books)
            assert made == plain
        with pytest.raises(ArgumentError, match="has no solutions: an installed flockana ships none"):
            build.notebook(shorter, "solutions")


def test_only_solutions_and_facts_are_left_out():
    head, check = "# head\n\n# %%\na\n\n", '# %% tags=["check"]\nd\n'
    left_out = '# %% tags=["solution"]\nb\n\n# %% [markdown] tags=["solution"]\n# c\n\n# %% tags=["facts"]\nd\n'
    assert without_solutions(head + left_out + check) == head + check
