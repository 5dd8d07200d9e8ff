"""`python -m tools.mutation`: change the code in small ways with cosmic-ray, and see which changes no test notices.

A sample of the mutants of each package (drawn by a hash of the changed lines: the same on every machine and wherever
a file stands, a larger one holds the smaller) is tried in copies of the project, with the nearest tests first, until
one fails. Results are kept in the output folder.
Run the tests first: a test that fails without a change kills every mutant.
Exit status: 0 every mutant was killed or is in equivalent_mutants.toml with its reason, 2 bad input, 3 one survived,
130 interrupted; the next call goes on.
"""

from __future__ import annotations

import argparse
import ast
import filecmp
import hashlib
import json
import os
import re
import resource
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
COMPILED = ("kernels", "interactions")  # a mutant compiles them, and all that calls them, anew
LAST = ("tests/test_public_api.py", "tests/properties", "tests/reference")
REVIEWED = Path(__file__).with_name("equivalent_mutants.toml")
_ARITHMETIC, _ORDER = "(Add|Sub|Mul|Div|FloorDiv|Mod|Pow)", "(Eq|NotEq|Lt|LtE|Gt|GtE)"
_OPERATORS = re.compile(  # the others of cosmic-ray change a type or cannot compile
    rf"core/(ReplaceBinaryOperator_({_ARITHMETIC}_{_ARITHMETIC}|BitOr_BitAnd|BitAnd_BitOr)"
    rf"|ReplaceComparisonOperator_({_ORDER}_{_ORDER}|Is_IsNot|IsNot_Is)|Replace[A-Z][a-z]+With[A-Z][a-z]+"
    "|ReplaceUnaryOperator_(USub_UAdd|Delete_Invert|Delete_Not)"
    "|AddNot|ExceptionReplacer|NumberReplacer|RemoveDecorator|ZeroIterationForLoop)"
)
_COMPILING = re.compile(
    r"njit|kernel$|subroutine|inlined|register_jitable|vectorize|lift|override|abstractmethod|overload|cache"
)


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


def draw(paths: Sequence[str], size: int | None, salt: str) -> tuple[int, list[dict[str, Any]]]:
    """Return the number of mutants of some files of one package, and the sample drawn from them."""
    from cosmic_ray import plugins
    from cosmic_ray.ast import ast_nodes, get_ast
    from cosmic_ray.mutating import mutate_code

    names = [name for name in plugins.operator_names() if _OPERATORS.fullmatch(name)]
    operators = {name: plugins.get_operator(name)() for name in names}
    found, same, texts = [], Counter[tuple[str, str]](), {path: (PROJECT / path).read_text("utf-8") for path in paths}
    for path, text in texts.items():
        lines = text.splitlines()
        spans = [(n.lineno, n.col_offset - 1, n.end_lineno, n.end_col_offset) for n in meaningless(ast.parse(text))]  # type: ignore[attr-defined]
        counts = Counter[str]()
        for node in ast_nodes(get_ast(text)):
            for name, operator in operators.items():
                for start, end in operator.mutation_positions(node):
                    place = {"path": path, "operator": name, "occurrence": counts[name], "start": start, "end": end}
                    counts[name] += 1
                    line = lines[start[0] - 1]
                    star = line[start[1] :].startswith("*,")  # before parameters that go by name
                    if star or any(span[:2] <= start < span[2:] for span in spans):
                        continue
                    around = "\n".join(each.strip() for each in lines[max(0, start[0] - 2) : start[0] + 1])
                    said = "\n".join((salt, name, around, str(same[name, around])))
                    same[name, around] += 1
                    found.append((hashlib.sha256(said.encode()).hexdigest()[:16], place))
    drawn = list[dict[str, Any]]()
    for key, place in sorted(found, key=lambda one: one[0]):
        if len(drawn) == size:
            break
        text, at = texts[place["path"]], place["start"][0] - 1
        try:
            changed = str(mutate_code(text, operators[place["operator"]], place["occurrence"]))
            compile(changed, place["path"], "exec")
        except (AttributeError, SyntaxError):  # cosmic-ray knows no dotted name after `except`
            continue
        before, after = (" ".join(source.splitlines()[at].split()) for source in (text, changed))
        if changed != text:
            drawn.append(place | {"key": key, "before": before, "after": after})
    return len(found), drawn


def package_of(path: str) -> str:
    """Return the package of a file: its room, or in a source its kind."""
    parts = Path(path).with_suffix("").parts
    return parts[3] if parts[1] == "sources" and len(parts) > 3 else parts[1]


def nearest(path: str) -> list[str]:
    """Return the tests to ask of a file: named for it, naming it or its theorems, of what imports it, of its room."""
    sources = [one for top in ("flockana", "tests") for one in sorted((PROJECT / top).rglob("*.py"))]
    texts = {str(one.relative_to(PROJECT)): one.read_text("utf-8") for one in sources}

    def naming(file: str) -> list[str]:
        module = file.removesuffix(".py").replace("/", ".")
        room, _, name = module.rpartition(".")
        ids = re.findall(r'\b(?:id=|erratum\(\s*)"([\w-]+)"', texts[file])
        named = [
            rf"{re.escape(module)}\b",
            rf"from {re.escape(room)} import .*\b{name}\b",
            *(f'"{one}"' for one in ids),
        ]
        return [one for one, text in texts.items() if re.search("|".join(named), text)]

    room, stem = Path(path).parent.relative_to("flockana"), Path(path).stem
    own = [
        one for one in texts if one == f"tests/{room}/test_{stem}.py" or one.startswith(f"tests/{room}/{stem}/test_")
    ]
    users = naming(path)
    farther = [one for user in users if user.startswith("flockana/") and "__init__" not in user for one in naming(user)]
    beside = [
        one for one in texts if one.startswith(f"tests/{'/'.join(room.parts[: 1 + (room.parts[0] == 'sources')])}/")
    ]
    tests = [one for one in (*users, *beside, *farther) if Path(one).name.startswith("test_")]
    tests.sort(key=lambda one: (one not in users, Path(one).parts[1] not in PACKAGES))
    return list(dict.fromkeys([*own, path, *tests, *(one for one in LAST if (PROJECT / one).exists())]))


def ask(clean: Path, budget: float) -> int:
    """Run the nearest tests of the one file that differs from a clean project; 0 if none fails within the budget."""
    files = (path.relative_to(PROJECT) for path in (PROJECT / "flockana").rglob("*.py"))
    changed = next(str(path) for path in files if not filecmp.cmp(PROJECT / path, clean / path, shallow=False))
    fresh = tempfile.TemporaryDirectory(prefix="numba-", ignore_cleanup_errors=True)
    environment = {**os.environ, "PYTHONPATH": str(PROJECT)}
    if package_of(changed) in COMPILED:
        environment["NUMBA_CACHE_DIR"] = fresh.name
    before = _used()
    with fresh:
        for test in nearest(changed):
            if _used() - before > budget:
                break
            asked = [sys.executable, "-m", "pytest", "-xq", "-p", "no:cacheprovider", test]
            if subprocess.run(asked, cwd=PROJECT, env=environment).returncode not in (0, 5):
                sys.stdout.write(f"\nkilled by {test}\n")
                return 1
    return 0


def _used() -> float:
    """Return the processor seconds of child processes; the clock runs faster on a busy machine."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def carry_out(
    mutants: Sequence[dict[str, Any]], folder: Path, outcomes: dict[str, str], *, jobs: int, budget: float
) -> bool:
    """Let cosmic-ray try mutants, one session and one copy of the project for each job; note what became of each."""
    from cosmic_ray.work_db import use_db
    from cosmic_ray.work_item import MutationSpec, WorkItem

    ignored = shutil.ignore_patterns(".*", "site", "dist", "*.ipynb", "*.tmp*")
    sessions, children = list[Path](), list[subprocess.Popen[bytes]]()
    try:
        for job in range(min(jobs, len(mutants))):
            tree, session, config = (folder / f"{job}{end}" for end in ("", ".sqlite", ".toml"))
            shutil.copytree(PROJECT, tree, ignore=ignored)
            command = f"'{sys.executable}' -m tools.mutation --ask '{PROJECT}' --budget {budget}"
            config.write_text(
                f'[cosmic-ray]\nmodule-path = "flockana"\ntimeout = {20.0 * budget}\n'
                f'test-command = {json.dumps(command)}\n[cosmic-ray.distributor]\nname = "local"\n'
            )
            with use_db(session) as database:
                for one in mutants[job::jobs]:
                    spec = MutationSpec(one["path"], one["operator"], one["occurrence"], one["start"], one["end"])
                    database.add_work_item(WorkItem.single(one["key"], spec))
            sessions.append(session)
            given = [sys.executable, "-m", "cosmic_ray.cli", "exec", str(config), str(session)]
            children.append(subprocess.Popen(given, cwd=tree, env={**os.environ, "PYTHONPATH": str(tree)}))
        return not any(child.wait() for child in children)
    except KeyboardInterrupt:
        return False
    finally:
        for child in children:
            child.terminate()
            child.wait()
        for session in sessions:
            with use_db(session) as database:
                outcomes |= {key: result.test_outcome.value for key, result in database.results if result.test_outcome}


def report(counts: dict[str, int], drawn: Sequence[dict[str, Any]], outcomes: dict[str, str]) -> tuple[str, int]:
    """Return the table of what became of the sample, with the survivors below it, and their number."""
    from flockana.base.binomial_intervals import clopper_pearson

    text = (
        "| package | mutants | tried | killed | equivalent | survived | killed, 95 % interval |\n" + "|---" * 7 + "|\n"
    )
    for package, mutants in [*counts.items(), ("all", sum(counts.values()))]:
        kinds = Counter(outcomes.get(one["key"]) for one in drawn if package in ("all", package_of(one["path"])))
        killed, survived = kinds["killed"] + kinds["incompetent"], kinds["survived"]
        low, high = clopper_pearson(killed, killed + survived)
        cells = package, mutants, killed + survived + kinds["equivalent"], killed, kinds["equivalent"], survived
        text += "| " + " | ".join(map(str, cells)) + f" | {100.0 * low:.1f}-{100.0 * high:.1f} % |\n"
    survivors = [one for one in drawn if outcomes.get(one["key"]) == "survived"]
    for one in survivors:
        text += f"\n{one['path']}:{one['start'][0]} {one['operator']}\n    - {one['before']}\n    + {one['after']}\n"
    return text, len(survivors)


def arguments() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(prog="python -m tools.mutation", description=(__doc__ or "").split("\n\n")[1])
    parser.add_argument("packages", nargs="*", metavar="PACKAGE", help=f"of {', '.join(PACKAGES)}; default: all")
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--sample", type=int, default=60, metavar="N", help="mutants of each package (default 60)")
    size.add_argument("--all", action="store_const", const=None, dest="sample", help="every mutant: weeks")
    size.add_argument("--quick", action="store_const", const=3, dest="sample", help="3 of each package")
    parser.add_argument("--salt", default="", metavar="TEXT", help="draw another sample")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="processes (default: cores)")
    parser.add_argument("--budget", type=float, default=120.0, metavar="S", help="processor seconds each (default 120)")
    parser.add_argument("--file", metavar="PART", default="", help="only files whose path has this in it")
    parser.add_argument("--again", action="store_true", help="try survivors again, after new tests")
    parser.add_argument("--out", type=Path, default=PROJECT / "report" / "mutation", metavar="FOLDER")
    parser.add_argument("--ask", type=Path, help=argparse.SUPPRESS)  # what cosmic-ray runs in a copy
    return parser


def main(given: Sequence[str] | None = None) -> int:
    """Draw, try, write the table; return the exit status."""
    options = arguments().parse_args(given)
    if options.ask:
        return ask(options.ask, options.budget)
    unknown = [name for name in options.packages if name not in PACKAGES]
    if unknown or options.jobs < 1 or options.budget <= 0.0 or (options.sample is not None and options.sample < 1):
        sys.stderr.write(f"mutation: {unknown or 'a number'}: expected {', '.join(PACKAGES)}, numbers above 0\n")
        return 2
    counts, drawn = dict[str, int](), list[dict[str, Any]]()
    for package in options.packages or PACKAGES:
        every = (str(path.relative_to(PROJECT)) for path in (PROJECT / "flockana").rglob("*.py"))
        files = sorted(path for path in every if package_of(path) == package)
        counts[package], some = draw([path for path in files if options.file in path], options.sample, options.salt)
        drawn += some
    known = tomllib.loads(REVIEWED.read_text())["mutant"]
    reviewed = {tuple(" ".join(one[key].split()) for key in ("before", "after")) for one in known}
    kept = options.out / "results.json"
    options.out.mkdir(parents=True, exist_ok=True)
    outcomes = json.loads(kept.read_text()) if kept.exists() else {}
    same = [one["key"] for one in drawn if (one["before"], one["after"]) in reviewed]
    outcomes |= dict.fromkeys(same, "equivalent")
    done = ("killed", "incompetent", "equivalent", *(() if options.again else ("survived",)))
    left = [one for one in drawn if outcomes.get(one["key"]) not in done]
    sys.stderr.write(f"mutation: {sum(counts.values())} mutants, {len(drawn)} drawn, {len(left)} to try\n")
    with tempfile.TemporaryDirectory(prefix="mutation-", ignore_cleanup_errors=True) as folder:
        complete = carry_out(left, Path(folder), outcomes, jobs=options.jobs, budget=options.budget)
    kept.write_text(json.dumps(outcomes, indent=0))
    text, survivors = report(counts, drawn, outcomes)
    (options.out / "table.md").write_text(text, "utf-8")
    sys.stdout.write(text)
    return 3 if survivors else 0 if complete else 130


if __name__ == "__main__":
    sys.exit(main())
