"""Hand the course to the graders themselves: `python tools/graders.py [NUMBER...]`, by default lecture 00a.

Needs `pip install 'flockana[course,graders]'`. Each program makes the student's copy, in which no hidden test may be
left, and grades two submissions: our solutions must get all points that a program gives, an untouched copy none.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from flockana.course.build import exercises, sources
from flockana.course.export import write_for

BIN = Path(sys.executable).parent


def call(*command: str | Path, cwd: Path) -> None:
    """Run a program of this environment; its output is shown if it fails."""
    path = {**os.environ, "PATH": f"{BIN}{os.pathsep}{os.environ.get('PATH', '')}"}  # nbgrader calls alembic by name
    done = subprocess.run(
        [str(each) for each in command], cwd=cwd, env=path, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))} in {cwd}:\n{done.stdout[-3000:]}{done.stderr[-3000:]}")


def otter(folder: Path, source: Path) -> tuple[bool, float, float]:
    """Whether the student's copy leaks, and the points of our solutions and of an untouched copy."""
    name = f"{source.stem}.ipynb"
    call(BIN / "otter", "assign", name, f"dist-{source.stem}", "--no-pdfs", "--no-run-tests", cwd=folder)
    made, points = folder / f"dist-{source.stem}", []
    archive = next((made / "autograder").glob("*.zip"))
    for version in ("autograder", "student"):
        out = made / f"out-{version}"
        out.mkdir()
        shutil.copy(made / version / name, folder / f"{version}-{name}")
        call(BIN / "otter", "run", "-a", archive, f"{version}-{name}", "-o", out, cwd=folder)
        tests = json.loads((out / "results.json").read_text())["tests"]
        points.append(sum(float(test.get("score") or 0.0) for test in tests))
    return "grade(" in (made / "student" / name).read_text(), points[0], points[1]


def nbgrader(folder: Path, source: Path) -> tuple[bool, float, float]:
    """Whether the student's copy leaks, and the points of our solutions and of an untouched copy."""
    from nbgrader.api import Gradebook

    name, program = source.stem, [sys.executable, "-m", "nbgrader"]
    call(*program, "generate_assignment", name, "--create", cwd=folder)
    for student, made in (("right", "source"), ("blank", "release")):
        shutil.copytree(folder / made / name, folder / "submitted" / student / name)
    call(*program, "autograde", name, "--create", cwd=folder)
    with Gradebook(f"sqlite:///{folder / 'gradebook.db'}") as book:
        found = {each.student.id: float(each.score) for each in book.assignment_submissions(name)}
    return "grade(" in (folder / "release" / name / f"{name}.ipynb").read_text(), found["right"], found["blank"]


def main(numbers: list[str]) -> int:
    """Try both; return the exit status."""
    failed = False
    for program in (otter, nbgrader):
        with tempfile.TemporaryDirectory() as home:
            folder = Path(home)
            write_for(folder, program.__name__)
            for source in (path for path in sources() if path.name.startswith(tuple(numbers or ["00a"]))):
                full = sum(each.points for each in exercises(source) if each.form != "text")
                leaks, right, blank = program(folder, source)
                good = not leaks and (right, blank) == (full, 0)
                failed |= not good
                sys.stdout.write(
                    f"{program.__name__}, {source.stem}: {'ok' if good else 'FAILED'} (solutions {right:g} of {full} "
                    f"points, an untouched copy {blank:g}{', the copy leaks' * leaks})\n"
                )
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
