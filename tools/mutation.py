"""`python -m tools.mutation`: change the code in small ways with cosmic-ray, and see which changes no test notices.

A sample of the mutants of each package (drawn by a hash: the same on every machine, a larger one holds the smaller) is
tried in a copy of the project by cosmic-ray's own commands, in one session for a package and sample, which the output
folder keeps for `cr-report` and `cr-html`. Run the tests first: one that fails without a change kills every mutant.
Exit status: 0 every mutant was killed or is in equivalent_mutants.toml with its reason, 2 bad input, 3 one survived,
130 interrupted; the next call goes on.
"""

from __future__ import annotations

import argparse
import ast
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

PROJECT = Path(__file__).resolve().parents[1]
PACKAGES = ("kernels", "symbolic", "measures", "lattice", "laws", "interactions", "theorems", "certified")
LAST = ("tests/test_public_api.py", "tests/properties", "tests/reference")  # after the package's own tests
REVIEWED = Path(__file__).with_name("equivalent_mutants.toml")
_ARITHMETIC, _ORDER = "(Add|Sub|Mul|Div|FloorDiv|Mod|Pow)", "(Eq|NotEq|Lt|LtE|Gt|GtE)"
_OPERATORS = (  # the others of cosmic-ray change a type or cannot compile
    rf"core/(ReplaceBinaryOperator_({_ARITHMETIC}_{_ARITHMETIC}|BitOr_BitAnd|BitAnd_BitOr)"
    rf"|ReplaceComparisonOperator_({_ORDER}_{_ORDER}|Is_IsNot|IsNot_Is)|Replace[A-Z][a-z]+With[A-Z][a-z]+"
    "|ReplaceUnaryOperator_(USub_UAdd|Delete_Invert|Delete_Not)"
    "|AddNot|ExceptionReplacer|NumberReplacer|RemoveDecorator|ZeroIterationForLoop)"
)
_COMPILING = re.compile(r"njit|register_jitable|vectorize|lift|override|abstractmethod|overload|cache")


def meaningless(tree: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a source in which a change alters a message, a type or the way of compiling."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Raise | ast.Assert | ast.JoinedStr) or getattr(node, "arg", "") == "strict":
            yield node
        if annotation := getattr(node, "annotation", None) or getattr(node, "returns", None):
            yield annotation
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            yield node
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) in ("__all__", "__slots__"):
            yield node
        if isinstance(node, ast.FunctionDef) and node.name == "__repr__":
            yield node
        yield from (one for one in getattr(node, "decorator_list", ()) if _COMPILING.search(ast.unparse(one)))


def sample(session: Path, tree: Path, size: int | None, salt: str) -> None:
    """Skip all mutants of a new session but a sample of those that change what is computed."""
    from cosmic_ray.work_db import use_db
    from cosmic_ray.work_item import WorkerOutcome, WorkResult

    with use_db(session) as database:
        ranked, left, texts = [], [], dict[str, tuple[list[str], list[Any]]]()
        same = Counter[tuple[str, str, str]]()
        for item in database.pending_work_items:
            (spec,) = item.mutations
            path, (row, column) = str(spec.module_path), spec.start_pos
            if path not in texts:
                text = (tree / path).read_text("utf-8")
                spans = [
                    ((n.lineno, n.col_offset - 1), (n.end_lineno, n.end_col_offset))
                    for n in meaningless(ast.parse(text))
                ]  # type: ignore[attr-defined]
                texts[path] = text.splitlines(), spans
            lines, spans = texts[path]
            line = lines[row - 1]
            star = line[column:].startswith("*,")  # before parameters that go by name
            if star or any(start <= (row, column) < end for start, end in spans):
                left.append(item.job_id)
                continue
            place = path, spec.operator_name, line.strip()
            said = "\n".join((salt, *place, str(same[place])))
            same[place] += 1
            ranked.append((hashlib.sha256(said.encode()).hexdigest(), item.job_id))
        left += [job for _, job in sorted(ranked)[size:]] if size is not None else []
        database.set_multiple_results(left, WorkResult(worker_outcome=WorkerOutcome.SKIPPED))


def carry_out(package: str, session: Path, size: int | None, salt: str, timeout: float) -> bool:
    """Let cosmic-ray try a sample in a copy of the project, or go on with it; return whether it came to the end."""
    tests = [f"tests/{package}", f"flockana/{package}", *LAST]
    with tempfile.TemporaryDirectory(prefix="mutation-", ignore_cleanup_errors=True) as folder:
        tree, config = Path(folder) / "tree", session.with_suffix(".toml")
        shutil.copytree(PROJECT, tree, ignore=shutil.ignore_patterns(".*", "site", "dist", "*.ipynb", "*.tmp*"))
        asked = " ".join(each for each in tests if (tree / each).exists())
        command = f"'{sys.executable}' -m pytest -xq -p no:cacheprovider {asked}"
        config.write_text(
            f'[cosmic-ray]\nmodule-path = "flockana/{package}"\ntimeout = {timeout}\nexcluded-modules = []\n'
            f'test-command = {json.dumps(command)}\n[cosmic-ray.distributor]\nname = "local"\n'
            f"[cosmic-ray.filters.operators-filter]\nexclude-operators = [{json.dumps(f'(?!{_OPERATORS}$)')}]\n"
        )

        def run(module: str, *arguments: Any) -> bool:
            given = [sys.executable, "-m", f"cosmic_ray.{module}", *map(str, arguments)]
            return subprocess.run(given, cwd=tree, env={**os.environ, "PYTHONPATH": str(tree)}).returncode == 0

        try:
            if not session.exists():
                fresh = session.with_suffix(".new")
                fresh.unlink(missing_ok=True)
                if not (run("cli", "init", config, fresh) and run("tools.filters.operators_filter", fresh, config)):
                    return False
                sample(fresh, tree, size, salt)
                fresh.rename(session)
            return run("cli", "exec", config, session)
        except KeyboardInterrupt:
            return False


def outcomes(session: Path) -> list[tuple[str, str]]:
    """Return the outcome and the changed lines of each mutant that was tried; `equivalent` if it is a reviewed one."""
    from cosmic_ray.work_db import use_db

    table = tomllib.loads(REVIEWED.read_text("utf-8"))["mutant"]
    reviewed = {(one["path"], *(" ".join(one[side].split()) for side in ("before", "after"))) for one in table}
    found = []
    with use_db(session) as database:
        for item, result in database.completed_work_items:
            if result.test_outcome is None:  # skipped
                continue
            (spec,) = item.mutations
            changed = {
                sign: " ".join(line[1:].split())
                for line in (result.diff or "").splitlines()
                if (sign := line[:1]) in "-+" and line[:3] not in ("---", "+++") and sign
            }
            before, after = changed.get("-", ""), changed.get("+", "")
            known = (str(spec.module_path), before, after) in reviewed
            text = f"{spec.module_path}:{spec.start_pos[0]} {spec.operator_name}\n    - {before}\n    + {after}\n"
            found.append(("equivalent" if known else result.test_outcome.value, text))
    return found


def report(found: dict[str, list[tuple[str, str]]]) -> tuple[str, int]:
    """Return the table of what became of the samples, with the survivors below it, and their number."""
    from flockana.base.binomial import clopper_pearson

    text = "| package | tried | killed | equivalent | survived | killed, 95 % interval |\n" + "|---" * 6 + "|\n"
    everything = [one for some in found.values() for one in some]
    for package, some in [*found.items(), ("all", everything)]:
        kinds = Counter(outcome for outcome, _ in some)
        killed, survived = kinds["killed"] + kinds["incompetent"], kinds["survived"]
        low, high = clopper_pearson(killed, killed + survived)
        cells = package, len(some), killed, kinds["equivalent"], survived
        text += "| " + " | ".join(map(str, cells)) + f" | {100.0 * low:.1f}-{100.0 * high:.1f} % |\n"
    survivors = [mutant for outcome, mutant in everything if outcome == "survived"]
    return "\n".join((text, *survivors)), len(survivors)


def arguments() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(prog="python -m tools.mutation", description=(__doc__ or "").split("\n\n")[1])
    parser.add_argument("packages", nargs="*", metavar="PACKAGE", help=f"of {', '.join(PACKAGES)}; default: all")
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--sample", type=int, default=60, metavar="N", help="mutants of each package (default 60)")
    size.add_argument("--all", action="store_const", const=None, dest="sample", help="every mutant: weeks")
    size.add_argument("--quick", action="store_const", const=3, dest="sample", help="3 of each package: what CI tries")
    parser.add_argument("--salt", default="", metavar="TEXT", help="draw another sample")
    parser.add_argument(
        "--timeout", type=float, default=3600.0, metavar="S", help="a mutant that takes longer is killed"
    )
    parser.add_argument("--out", type=Path, default=PROJECT / "report" / "mutation", metavar="FOLDER")
    return parser


def main(given: Sequence[str] | None = None) -> int:
    """Try the samples, write the table; return the exit status."""
    options = arguments().parse_args(given)
    unknown = [name for name in options.packages if name not in PACKAGES]
    if unknown or options.timeout <= 0.0 or (options.sample is not None and options.sample < 1):
        sys.stderr.write(f"mutation: {unknown or 'a number'}: expected {', '.join(PACKAGES)}, numbers above 0\n")
        return 2
    options.out.mkdir(parents=True, exist_ok=True)
    found, complete = dict[str, list[tuple[str, str]]](), True
    for package in options.packages or PACKAGES:
        name = f"{package}-{options.sample or 'all'}{options.salt and '-' + options.salt}"
        session = options.out.resolve() / f"{name}.sqlite"
        complete = carry_out(package, session, options.sample, options.salt, options.timeout)
        if session.exists():
            found[package] = outcomes(session)
        if not complete:
            break
    text, survivors = report(found)
    (options.out / "table.md").write_text(text, "utf-8")
    sys.stdout.write(text)
    return 3 if survivors else 0 if complete else 130


if __name__ == "__main__":
    sys.exit(main())
