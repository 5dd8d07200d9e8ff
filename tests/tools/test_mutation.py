"""Mutation testing: which mutants there are, which tests are asked first, and what is made of what they say."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("cosmic_ray", exc_type=ImportError)

from tools.mutation import __main__ as command
from tools.mutation import mutants, nearby, table, trial
from tools.mutation.mutants import Mutant

SOURCE = '''"""A module, 1 + 1 = 2."""

from __future__ import annotations

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
def project(tmp_path) -> Path:
    """A package of two modules of which one is tested by itself."""
    for name, text in {
        "flockana/laws/area.py": SOURCE,
        "flockana/laws/twice.py": "from flockana.laws.area import area\n\n\ndef twice(a):\n    return area(a) - -1\n",
        "tests/laws/test_twice.py": "from flockana.laws.twice import twice\n",
        "tests/laws/test_other.py": "def test_nothing():\n    pass\n",
        "tests/properties/test_all.py": "",
    }.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def drawn(project, size=None, salt=""):
    return mutants.count_and_draw(project, mutants.files(project, ["laws"]), size, salt)


def test_mutants_are_of_what_is_computed_and_not_of_texts_types_or_compiling(project):
    counts, found = drawn(project)
    assert counts == {"laws": len(found)}
    assert {one.before for one in found} == {
        "def area(a: float | None, *, b=2) -> float | None:",
        "if a < b:",
        "c: int | None = a * b",
        "return area(a) - -1",
    }
    defaults = {one.after.replace(" ", "") for one in found if one.before.startswith("def area")}
    assert defaults == {f"defarea(a:float|None,*,b={number})->float|None:" for number in (1, 3)}
    changed = {one.after for one in found if one.before == "if a < b:"}
    assert changed == {*(f"if a {sign} b:" for sign in ("==", "!=", "<=", ">", ">=")), "if not a < b:"}
    products = {one.after for one in found if "a * b" in one.before}
    assert products == {f"c: int | None = a {sign} b" for sign in ("+", "-", "/", "//", "%", "**")}


def test_a_mutant_is_the_file_with_one_line_changed(project):
    for one in drawn(project)[1]:
        old, new = (project / one.path).read_text().splitlines(), one.source(project).splitlines()
        [(number, line)] = [(at, b) for at, (a, b) in enumerate(zip(old, new, strict=True), 1) if a != b]
        assert (number, line.strip()) == (one.line, one.after)


def test_a_larger_sample_holds_the_smaller_and_lines_above_change_nothing(project):
    few, more = ({one.key for one in drawn(project, size)[1]} for size in (4, 9))
    assert len(few) == 4
    assert few < more
    assert few != {one.key for one in drawn(project, 4, "another")[1]}
    path = project / "flockana/laws/area.py"
    path.write_text(path.read_text().replace("\n\n\n", "\n\nHIGH = LOW = None\n\n\n"))
    assert few == {one.key for one in drawn(project, 4)[1]}


def test_the_nearest_tests_come_first(project):
    order = nearby.Nearby(project).order
    assert order("flockana/laws/twice.py") == ["tests/laws/test_twice.py", "tests/properties/test_all.py"]
    assert order("flockana/laws/area.py") == ["tests/laws/test_twice.py", "tests/properties/test_all.py"]


@pytest.mark.parametrize(
    ("path", "first"),
    [
        ("lattice/measure", ["tests/lattice/test_measure.py"]),  # its own
        ("kernels/listed", ["tests/dynamics/test_compiled.py"]),  # has none: that of what imports it
        (  # its own, and one that names the theorem
            "theorems/olfati_saber/lattice_limit",
            ["tests/theorems/olfati_saber/test_lattice_limit.py", "tests/theorems/olfati_saber/test_os_1.py"],
        ),
        (
            "theorems/dead_zone/l01",
            [
                "tests/theorems/dead_zone/test_l01.py",
                "tests/adversarial/test_fixed.py::test_what_is_printed_and_what_is_true[L1]",
            ],
        ),
    ],
)
def test_what_a_file_of_the_package_is_tested_by(path, first):
    assert nearby.Nearby(command.PROJECT).order(f"flockana/{path}.py")[: len(first)] == first


def test_a_theorem_on_runs_is_asked_of_short_runs_soon():
    order = nearby.Nearby(command.PROJECT).order("flockana/theorems/classics/cucker_smale.py")
    short = "tests/adversarial/test_catalogue.py::test_short_runs_say_what_was_published"
    assert order[3:5] == [f"{short}[cucker-smale]", f"{short}[cucker-smale-steep]"]  # after its own and its room's


def test_what_decides_from_a_tube_is_asked_for_by_what_names_it():
    order = nearby.Nearby(command.PROJECT).order
    assert "tests/theorems/olfati_saber/test_os_3.py" in order("flockana/theorems/olfati_saber/enclosed.py")[:4]
    theorem = "tests/theorems/olfati_saber/test_alpha_flocking.py"
    assert theorem in order("flockana/theorems/olfati_saber/flocking_enclosed.py")[:3]


def test_a_copy_has_the_packages_and_not_what_runs_wrote(tmp_path):
    project = tmp_path / "project"
    for name in ("flockana/report/page.py", "tests/report/test_page.py", "report/index.html", ".venv/bin/python"):
        (project / name).parent.mkdir(parents=True)
        (project / name).touch()
    copy = trial.clean_copy(project, tmp_path / "copies")
    copied = sorted(str(one.relative_to(copy)) for one in copy.rglob("*") if one.is_file())
    assert copied == ["flockana/report/page.py", "tests/report/test_page.py"]


@pytest.mark.parametrize("name", ["kernels/test_sums", "laws/test_directed"])
def test_kernels_run_as_python_too(name):
    asked = [sys.executable, "-m", "pytest", "-xq", "-p", "no:cacheprovider", f"tests/{name}.py"]
    done = subprocess.run(
        asked, cwd=command.PROJECT, env={**os.environ, "NUMBA_DISABLE_JIT": "1"}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout


ASKED = """
import json, sys
from pathlib import Path
from tools.mutation import trial
sys.path.append(str(Path(sys.argv[1]).parent / "libraries"))
trial._SLACK = 0.5
if sys.argv[2] == "3":
    trial._spent = lambda child: 0.0  # it has ended
with trial.mutated(Path(sys.argv[1]), "number.py", f"number = {sys.argv[2]}") as tree:
    result = trial.attempt(tree, ["test_first.py", "test_number.py"], {"test_number.py": 0.1}, 60.0, False)
    print(json.dumps([result.outcome, result.by, result.killed, result.killed or result.seconds >= 0.3]))
"""

TESTS = """
import time
from number import number
def test_right():
    begin = time.process_time()
    while time.process_time() < begin + 0.3 or number == 4:
        pass
    assert number == 3
"""


@pytest.mark.parametrize(
    ("number", "said"),
    [
        ("3", ["survived", "", False, True]),
        ("2", ["killed", "test_number.py::test_right", True, True]),
        ("1 +", ["killed", "test_number.py", True, True]),
        ("__import__('os')._exit(0)", ["killed", "test_number.py ended its process", True, True]),
        ("4", ["timeout", "test_number.py", True, True]),
    ],
)
def test_what_tests_say_of_a_mutant(tmp_path, number, said):
    clean = tmp_path / "clean"
    clean.mkdir()
    (clean / "number.py").write_text("number = 3")
    (clean / "test_first.py").write_text("import beside\ndef test_nothing():\n    pass\n")
    libraries = tmp_path / "libraries"  # data of an editable install lie there under the package's name
    (libraries / "flockana/course").mkdir(parents=True)
    (libraries / "beside.py").touch()
    (clean / "test_number.py").write_text(TESTS)
    asked = [sys.executable, "-c", ASKED, str(clean), number]  # not forked from here, out of a test that runs
    done = subprocess.run(asked, cwd=command.PROJECT, capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == said
    assert (clean / "number.py").read_text() == "number = 3"
    assert sorted(one.name for one in tmp_path.iterdir()) == ["clean", "libraries"]


def test_tests_that_fail_without_a_change_kill_nothing(monkeypatch, tmp_path, capsys):
    (tmp_path / "flockana/laws").mkdir(parents=True)
    (tmp_path / "flockana/laws/a.py").write_text("c = a + b")
    crew = object.__new__(command.Crew)
    crew.clean, crew.budget, crew.usual, crew.broken = tmp_path, 1.0, {}, set()
    crew.nearby = type("Two", (), {"order": staticmethod(lambda path: ["test_bad.py", "test_good.py"])})
    monkeypatch.setattr(Mutant, "source", lambda *_: "c = a - b")
    monkeypatch.setattr(trial, "attempt", lambda tree, files, *_: said(tree == tmp_path, files))

    def said(unchanged, files):
        wrong = [file for file in files if file in ("test_bad.py", *([] if unchanged else failing))]
        return trial.Result("killed", f"{wrong[0]}::test") if wrong else trial.Result("survived", "", 0.1)

    failing = []
    assert crew.judge(mutant("a - b")).outcome == "survived"
    assert "test_bad.py is left out, it fails without a change" in capsys.readouterr().err
    failing.append("test_good.py")
    assert crew.judge(mutant("a - b")).by == "test_good.py::test"
    crew.broken.add(("test_good.py", False))
    with pytest.raises(RuntimeError, match=r"no test that reaches flockana/laws/a\.py passes without a change"):
        crew.judge(mutant("a - b"))


def mutant(after, package="laws"):
    return Mutant(f"flockana/{package}/a.py", "Add", 0, 3, "a + b", after)


def test_the_table_counts_what_was_said_and_shows_survivors():
    drawn = [mutant(f"a {sign} b") for sign in ("-", "*", "/", "%", "//")]
    said = zip(drawn, ("killed", "timeout", "survived", "survived"), strict=False)
    results = {one.key: trial.Result(outcome, "", 2.0, 3) for one, outcome in said}
    reviewed = {(drawn[3].path, "a + b", "a % b"): "a is below b"}
    text, survivors = table.table({"laws": 50}, drawn, results, reviewed)
    assert survivors == [drawn[2]]
    row = "| laws | 50 | 4 | 2 | 1 | 1 | 1 | 9.4-99.2 % |"  # 2 of 3, Clopper and Pearson
    assert text.splitlines()[2:4] == [row, row.replace("laws", "all")]
    assert "a.py:3 Add (3 test files, 2 s)\n    - a + b\n    + a / b\n" in text


def test_results_are_kept_and_a_line_that_was_cut_off_is_tried_again(tmp_path):
    state = tmp_path / "results.jsonl"
    state.write_text(
        json.dumps({"key": "k", "outcome": "killed", "by": "t", "seconds": 1.0, "files": 1}) + '\n{"key": "l'
    )
    assert command.read_results(state) == {"k": trial.Result("killed", "t", 1.0, 1)}


def test_every_reviewed_mutant_has_a_reason_and_is_one_of_the_code_as_it_is():
    entries = command.read_reviewed()
    for (path, before, after), reason in entries.items():
        lines = [line.strip() for line in (command.PROJECT / path).read_text("utf-8").splitlines()]
        assert before in lines, (path, before)
        assert before != after
        assert len(reason) > 20


@pytest.mark.parametrize("given", [["nonsense"], ["--jobs", "0"], ["--sample", "0"], ["--budget", "-1"]])
def test_bad_options_are_one_line(given, capsys, tmp_path):
    assert command.main([*given, "--out", str(tmp_path)]) == command.BAD_INPUT
    assert capsys.readouterr().err.count("\n") == 1


def test_copies_leave_out_what_is_no_source(tmp_path):
    (tmp_path / "project/.git").mkdir(parents=True)
    (tmp_path / "project/a.py").touch()
    assert [one.name for one in trial.clean_copy(tmp_path / "project", tmp_path).iterdir()] == ["a.py"]
    shutil.rmtree(tmp_path / "clean")
