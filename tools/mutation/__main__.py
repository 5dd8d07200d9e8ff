"""`python -m tools.mutation`: change the code in small ways, one at a time, and see which changes no test notices.

A sample of the mutants of each package (the same on every machine; a larger one holds the smaller) is made in copies of
the project, and tests are run on each, the nearest first, until one fails. What was tried is kept and not tried again.
Exit status: 0 every mutant was killed or is in equivalent.toml with its reason, 2 bad input, 3 one survived,
130 interrupted; the next call goes on.
"""

from __future__ import annotations

import argparse
import compileall
import json
import os
import shutil
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from pathlib import Path

from . import trial
from .mutants import PACKAGES, Mutant, count_and_draw, files
from .nearby import INTERPRETED, Nearby
from .table import table

KILLED, BAD_INPUT, SURVIVED, INTERRUPTED = 0, 2, 3, 130
PROJECT = Path(__file__).resolve().parents[2]
REVIEWED = Path(__file__).with_name("equivalent.toml")
QUICK = 3  # mutants of each package


def arguments() -> argparse.ArgumentParser:
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m tools.mutation", description=(__doc__ or "").split("\n\n")[1])
    parser.add_argument("packages", nargs="*", metavar="PACKAGE", help=f"of {', '.join(PACKAGES)}; default: all")
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--sample", type=int, default=60, metavar="N", help="mutants of each package (default 60)")
    size.add_argument("--all", action="store_true", help="every mutant: weeks")
    size.add_argument("--quick", action="store_true", help=f"{QUICK} of each package: what CI runs")
    parser.add_argument("--salt", default="", metavar="TEXT", help="draw another sample")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="processes (default: cores)")
    parser.add_argument(
        "--budget",
        type=float,
        default=120.0,
        metavar="S",
        help="processor time for one mutant, in seconds (default 120)",
    )
    parser.add_argument("--file", metavar="PART", default="", help="only files whose path has this in it")
    parser.add_argument("--again", action="store_true", help="try survivors again, after new tests")
    parser.add_argument("--out", type=Path, default=PROJECT / "report" / "mutation", metavar="FOLDER")
    return parser


def read_results(state: Path) -> dict[str, trial.Result]:
    """What earlier calls found, by the key of the mutant; a line that was cut off is left out."""
    found = {}
    for line in state.read_text("utf-8").splitlines() if state.exists() else ():
        try:
            said = json.loads(line)
        except ValueError:
            continue
        key = said.pop("key")
        found[key] = trial.Result(**said)
    return found


def read_reviewed(path: Path = REVIEWED) -> dict[tuple[str, str, str], str]:
    """The reasons why some mutants compute the same, by file and lines before and after."""
    entries = tomllib.loads(path.read_text("utf-8")).get("mutant", []) if path.exists() else []
    return {(one["path"], one["before"], one["after"]): one["reason"] for one in entries}


class Crew:
    """Tries mutants, in a folder with a clean copy of the project."""

    def __init__(self, folder: Path, state: Path, budget: float) -> None:
        self.clean = trial.clean_copy(PROJECT, folder)
        compileall.compile_dir(self.clean, quiet=2)
        self.nearby, self.state, self.budget = Nearby(self.clean), state, budget
        self.usual, self.broken = dict[tuple[str, bool], float](), set[tuple[str, bool]]()

    def passes(self, file: str, interpreted: bool = False) -> bool:
        """Whether a test file passes without a change; its time is noted."""
        key = (file, interpreted)
        if key not in self.usual and key not in self.broken:
            result = trial.attempt(self.clean, [file], {file: 200.0}, 1e9, True, interpreted)
            if result.outcome == "survived":
                self.usual[key] = result.seconds
            else:
                self.broken.add(key)
                sys.stderr.write(f"mutation: {file} is left out, it fails without a change: {result.by}\n")
        return key not in self.broken

    def judge(self, mutant: Mutant) -> trial.Result:
        """Try one mutant: what fails counts only if it passes without the change."""
        if mutant.package == "kernels" and (result := self._asked(mutant, True)).killed:
            return result
        return self._asked(mutant, False)

    def _asked(self, mutant: Mutant, interpreted: bool) -> trial.Result:
        nearest = [file for file in self.nearby.order(mutant.path) if not interpreted or file in INTERPRETED]
        compiles = not interpreted and mutant.package in ("kernels", "interactions")
        if nearest and not interpreted:
            self.passes(nearest[0])  # for its time
        while files := [file for file in nearest if (file, interpreted) not in self.broken]:
            usual = {file: 2.0 if interpreted else self.usual.get((file, False), 20.0) for file in files}
            with trial.mutated(self.clean, mutant.path, mutant.source(self.clean)) as tree:
                budget = 10.0 if interpreted else self.budget
                result = trial.attempt(tree, files, usual, budget, compiles, interpreted)
            failed = next((file for file in files if result.by.startswith(file)), files[0])
            if not result.killed or self.passes(failed, interpreted):
                return result
        if interpreted:
            return trial.Result("survived")
        raise RuntimeError(f"no test that reaches {mutant.path} passes without a change: run the tests first")

    def work(self, mutants: Iterable[Mutant]) -> None:
        """Try mutants and note each."""
        for mutant in mutants:
            line = json.dumps({"key": mutant.key, **asdict(self.judge(mutant))}) + "\n"
            with self.state.open("a", encoding="utf-8") as notes:
                notes.write(line)


def carry_out(mutants: Sequence[Mutant], state: Path, *, jobs: int, budget: float) -> None:
    """Try mutants in some processes at once; each notes what it found."""
    os.environ.update(dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1"))
    sys.argv[1:] = []
    trial.preload()
    with tempfile.TemporaryDirectory(prefix="mutation-", ignore_cleanup_errors=True) as folder:
        crew, children = Crew(Path(folder), state, budget), []
        for number in range(min(jobs, len(mutants))):
            child = os.fork()
            if not child:
                code = 1
                try:
                    crew.work(mutants[number::jobs])
                    code = 0
                except Exception as error:
                    sys.stderr.write(f"mutation: {error}\n")
                finally:
                    os._exit(code)
            children.append(child)
        failed = [child for child in children if os.waitpid(child, 0)[1]]
        shutil.rmtree(crew.clean, ignore_errors=True)
    if failed:
        raise SystemExit("mutation: not all were tried")


def main(given: Sequence[str] | None = None) -> int:
    """Draw, try, write the table; return the exit status."""
    options = arguments().parse_args(given)
    unknown = [name for name in options.packages if name not in PACKAGES]
    size = None if options.all else QUICK if options.quick else options.sample
    if unknown or options.jobs < 1 or options.budget <= 0.0 or (size is not None and size < 1):
        sys.stderr.write(
            f"mutation: {' '.join(unknown) or 'a number'}: expected {', '.join(PACKAGES)}, numbers above 0\n"
        )
        return BAD_INPUT
    options.out.mkdir(parents=True, exist_ok=True)
    state, reviewed = options.out / "results.jsonl", read_reviewed()
    paths = [path for path in files(PROJECT, options.packages or PACKAGES) if options.file in path]
    counts, drawn = count_and_draw(PROJECT, paths, size, options.salt)
    known = read_results(state)
    open_ones = [one for one in drawn if (one.path, one.before, one.after) not in reviewed]
    left = [one for one in open_ones if one.key not in known or (options.again and not known[one.key].killed)]
    sys.stderr.write(f"mutation: {sum(counts.values())} mutants, {len(drawn)} drawn, {len(left)} to try\n")
    try:
        if left:
            carry_out(left, state, jobs=options.jobs, budget=options.budget)
    except KeyboardInterrupt:
        return INTERRUPTED
    text, survivors = table(counts, drawn, read_results(state), reviewed)
    (options.out / "table.md").write_text(text, "utf-8")
    sys.stdout.write(text)
    return SURVIVED if survivors else KILLED


if __name__ == "__main__":
    sys.exit(main())
