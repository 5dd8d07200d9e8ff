"""Hand the course to the graders themselves: `python tools/graders.py [NUMBER...]`, by default lecture 00a.

Needs `pip install 'flockana[course,graders]'`. Each program makes the student's copy, in which no hidden test may be
left, and grades five submissions: our solutions must get all points that a program gives; an untouched copy, and three
with wrong answers (the first three to each question in tests/course/answers.py), none.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import nbformat

from flockana.course.build import exercises, sources
from flockana.course.course_pages import number_of
from flockana.course.export import write_for

BIN = Path(sys.executable).parent
ROOT = Path(__file__).resolve().parent.parent
WRONG = range(3)
_SETUP = f"""import sys

sys.path.insert(0, {str(ROOT)!r})
import numpy as np

import flockana as fl
from flockana import lattice
from tests.course.answers import ANSWERS
"""


def call(*command: str | Path, cwd: Path) -> None:
    """Run a program of this environment; its output is shown if it fails."""
    path = {**os.environ, "PATH": f"{BIN}{os.pathsep}{os.environ.get('PATH', '')}"}  # nbgrader calls alembic by name
    done = subprocess.run(
        [str(each) for each in command], cwd=cwd, env=path, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))} in {cwd}:\n{done.stdout[-3000:]}{done.stderr[-3000:]}")


def wrong(copy: Path, source: Path, choice: int) -> nbformat.NotebookNode:
    """A student's copy with a wrong answer to every question, without what the lecture shows: no grader needs that."""
    book, kept = nbformat.read(copy, as_version=4), [nbformat.v4.new_code_cell(_SETUP)]
    names = {f"{each.name} = ...": each.name for each in exercises(source) if each.form != "text"}
    filled = 0
    for cell in book.cells:
        name = names.get(cell.source.partition("\n")[0]) if cell.cell_type == "code" else None
        if name is not None:
            cell.source, filled = f'{name} = ANSWERS["{number_of(source)}"]["{name}"][0][{choice}]', filled + 1
        if name is not None or "nbgrader" in cell.metadata or "otter" in cell.source or "grader." in cell.source:
            kept.append(cell)
    if filled != len(names):
        raise SystemExit(f"{copy}: {filled} places for answers, expected {len(names)}")
    book.cells = kept
    return book


def otter(folder: Path, source: Path) -> tuple[bool, list[float]]:
    """Whether the student's copy leaks, and the points of the submissions: solutions, untouched, wrong ones."""
    name = f"{source.stem}.ipynb"
    call(BIN / "otter", "assign", name, f"dist-{source.stem}", "--no-pdfs", "--no-run-tests", cwd=folder)
    made, points = folder / f"dist-{source.stem}", []
    archive = next((made / "autograder").glob("*.zip"))
    for version in ("autograder", "student", *(f"wrong{k}" for k in WRONG)):
        out = made / f"out-{version}"
        out.mkdir()
        if version.startswith("wrong"):
            nbformat.write(wrong(made / "student" / name, source, int(version[-1])), folder / f"{version}-{name}")
        else:
            shutil.copy(made / version / name, folder / f"{version}-{name}")
        call(BIN / "otter", "run", "-a", archive, f"{version}-{name}", "-o", out, cwd=folder)
        tests = json.loads((out / "results.json").read_text())["tests"]
        points.append(sum(float(test.get("score") or 0.0) for test in tests))
    return "grade(" in (made / "student" / name).read_text(), points


def nbgrader(folder: Path, source: Path) -> tuple[bool, list[float]]:
    """Whether the student's copy leaks, and the points of the submissions: solutions, untouched, wrong ones."""
    from nbgrader.api import Gradebook

    name, program = source.stem, [sys.executable, "-m", "nbgrader"]
    call(*program, "generate_assignment", name, "--create", cwd=folder)
    for student, made in (("right", "source"), ("blank", "release")):
        shutil.copytree(folder / made / name, folder / "submitted" / student / name)
    released = folder / "release" / name / f"{name}.ipynb"
    for k in WRONG:
        home = folder / "submitted" / f"wrong{k}" / name
        shutil.copytree(folder / "release" / name, home)
        nbformat.write(wrong(released, source, k), home / released.name)
    call(*program, "autograde", name, "--create", cwd=folder)
    with Gradebook(f"sqlite:///{folder / 'gradebook.db'}") as book:
        found = {each.student.id: float(each.score) for each in book.assignment_submissions(name)}
    return "grade(" in released.read_text(), [found[who] for who in ("right", "blank", *(f"wrong{k}" for k in WRONG))]


def main(numbers: list[str]) -> int:
    """Try both; return the exit status."""
    failed = False
    for program in (otter, nbgrader):
        with tempfile.TemporaryDirectory() as home:
            folder = Path(home)
            write_for(folder, program.__name__)
            for source in (path for path in sources() if path.name.startswith(tuple(numbers or ["00a"]))):
                full = sum(each.points for each in exercises(source) if each.form != "text")
                leaks, points = program(folder, source)
                good = not leaks and points == [full, 0, *(0 for _ in WRONG)]
                failed |= not good
                right, blank, *refused = (f"{each:g}" for each in points)
                sys.stdout.write(
                    f"{program.__name__}, {source.stem}: {'ok' if good else 'FAILED'} (solutions {right} of {full} "
                    f"points, an untouched copy {blank}, wrong answers {', '.join(refused)}"
                    f"{'; the copy leaks' * leaks})\n"
                )
                sys.stdout.flush()
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
