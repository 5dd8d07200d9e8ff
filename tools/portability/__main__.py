"""`python -m tools.portability`: the catalogue on other machine code, from moved starts, at other tolerances.

Every entry is run and verified on the machine as it is, and in every variant; each claim whose status differs from the
one here, or from the one that the catalogue expects, is a row. Exit status: 0 nothing changed, 2 bad input, 3 something
did, 130 interrupted.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, NamedTuple

UNCHANGED, BAD_INPUT, CHANGED, INTERRUPTED = 0, 2, 3, 130
HERE = Path(__file__).resolve().parent
NATIVE = "native"
# What chooses machine code, or block sizes, from outside; a child has these from its variant alone.
LEVERS = (
    *("OPENBLAS_CORETYPE", "OPENBLAS_L2_SIZE", "GLIBC_TUNABLES", "NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES"),
    *("NUMBA_CACHE_DIR", "NPY_DISABLE_CPU_FEATURES", "NPY_ENABLE_CPU_FEATURES"),
)
_ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
# OpenBLAS core types, and what a processor must have for each.
CORES = {
    "Prescott": (),
    "Nehalem": ("SSE42",),
    "Sandybridge": ("AVX",),
    "Haswell": ("AVX2", "FMA3"),
    "SkylakeX": ("AVX512F", "AVX512_SKX"),
}
# Units of length and time, in the entry's own: micrometres and milliseconds, kilometres and minutes, and odd ones.
UNITS = {"small": (1e6, 1e3), "large": (1e-3, 1.0 / 60.0), "odd": (2.54, 0.37)}
Outcome = Mapping[str, Any]


class Row(NamedTuple):
    """One claim of one entry whose status differs; no claim for a verdict as a whole."""

    scenario: str
    theorem: str
    claim: str
    variant: str
    there: str  # in the variant
    here: str  # on the machine as it is
    expected: str  # by the catalogue; empty if it expects nothing


def environments(native: Mapping[str, Any]) -> tuple[dict[str, dict[str, str]], list[str]]:
    """Return the environment variables of each variant of machine code, and notices of those this machine lacks."""
    if native["machine"].lower() not in ("x86_64", "amd64"):
        return {}, [f"machine code is not varied: {native['machine']} is no x86-64"]
    has, found, notices = set(native["processor"]), dict[str, dict[str, str]](), []
    for core, needs in CORES.items():
        if missing := [one for one in needs if one not in has]:
            notices.append(f"blas-{core.lower()} is left out: the processor has no {', '.join(missing)}")
        else:
            found[f"blas-{core.lower()}"] = {"OPENBLAS_CORETYPE": core}
    libm = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"} if native["libc"] == "glibc" else {}
    if not libm:
        notices.append(f"libm is left out: it is varied through glibc, and this is {native['libc'] or 'another libc'}")
    numpy = {"NPY_DISABLE_CPU_FEATURES": " ".join(native["numpy"])} if native["numpy"] else {}
    generic = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}
    found |= {"libm": libm, "numba-generic": generic, "numpy-generic": numpy}
    if {"AVX2", "FMA3"} <= has:
        haswell = {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": ""}
        newer = [one for one in native["numpy"] if "AVX512" in one or one == "X86_V4"]
        older = {"NPY_DISABLE_CPU_FEATURES": " ".join(newer)} if newer else {}
        found |= {"numba-haswell": haswell, "numpy-haswell": older}
        found["haswell"] = {"OPENBLAS_CORETYPE": "Haswell", **haswell, **older}
    found["generic"] = {"OPENBLAS_CORETYPE": "Prescott", **libm, **generic, **numpy}
    return {name: settings for name, settings in found.items() if settings}, notices


def changes(draws: int) -> dict[str, dict[str, float]]:
    """Return what each variant changes, as `worker.outcome` takes it; those that share a run are adjacent."""
    found = dict[str, dict[str, float]]({NATIVE: {}})
    for what in ("thresholds", "definitions", "solver"):
        found |= {f"{what}-halved": {what: 0.5}, f"{what}-doubled": {what: 2.0}}
    found |= {f"units-{name}": {"length": length, "time": time} for name, (length, time) in UNITS.items()}
    return found | {f"moved-{draw}": {"draw": draw} for draw in range(1, draws + 1)}


def choose(names: Sequence[str], patterns: Sequence[str]) -> list[str]:
    """Return the variants that any pattern fits; without patterns all but those that change what is claimed."""
    if lost := [one for one in patterns if not any(fnmatchcase(name, one) for name in names)]:
        raise ValueError(f"no variant is called {' or '.join(lost)}; there are {', '.join(names)}")
    return [name for name in names if any(fnmatchcase(name, one) for one in patterns or ["[!d]*"])]


class Matrix:
    """Children that work through entries, each in the environment of one variant, and what came of them."""

    def __init__(self, caches: Path) -> None:
        self.caches, self.children, self.stopped = caches, set[subprocess.Popen[str]](), False
        self.machines, self.left_out = dict[str, Any](), dict[str, str]()
        self.outcomes, self.seconds = dict[str, dict[str, Outcome | None]](), dict[str, float]()

    def ask(self, settings: Mapping[str, str], requests: Sequence[Any]) -> tuple[list[Any], str]:
        """Return the answers of one child, the first of which is its machine, and how it ended if not well."""
        variables = {name: value for name, value in os.environ.items() if name not in LEVERS}
        # the root of this checkout first: an installed flockana may be another one
        variables["PYTHONPATH"] = os.pathsep.join([str(HERE.parents[1]), *filter(None, [os.environ.get("PYTHONPATH")])])
        variables |= dict.fromkeys(_ONE_THREAD, "1") | dict(settings)
        if code := settings.get("NUMBA_CPU_NAME"):
            variables["NUMBA_CACHE_DIR"] = str(self.caches / code)
        given = [
            json.dumps(one) + "\n" for one in ({"settings": settings, "native": self.machines.get(NATIVE)}, *requests)
        ]
        pipe = subprocess.PIPE
        child = subprocess.Popen(
            [sys.executable, str(HERE / "worker.py")],
            **{"stdin": pipe, "stdout": pipe, "stderr": pipe},
            env=variables,
            text=True,
            errors="replace",
            start_new_session=True,  # Ctrl-C is for the parent, which ends its children
        )
        self.children.add(child)
        if self.stopped:
            child.kill()
        told, errors = child.communicate("".join(given))
        self.children.discard(child)
        code = child.returncode
        how = signal.Signals(-code).name if code < 0 else f"exit status {code}"
        last = (errors.strip().splitlines() or ["nothing said"])[-1]
        answers = [json.loads(line) for line in told.splitlines(keepends=True) if line.endswith("\n")]
        return answers, f"the worker ended by {how}: {last}" if code else ""

    def work(self, variant: str, settings: Mapping[str, str], names: Sequence[str], asked: Mapping[str, Any]) -> None:
        """Run entries in one environment; an entry of which a child dies is lost, the others go on."""
        left = list(names)
        while left and not self.stopped and variant not in self.left_out:
            answers, ended = self.ask(settings, [{"name": name, "changes": asked} for name in left])
            if not answers or answers[0]["unfit"]:
                reason = answers[0]["unfit"] if answers else ended
                if not self.stopped and self.left_out.setdefault(variant, reason) is reason:
                    sys.stderr.write(f"{variant} is left out: {reason}\n")
                return
            self.machines.setdefault(variant, answers[0])
            if ended and not self.stopped:
                lost = {"run": ended, "statuses": {}, "expected": {}}
                answers.append({"outcomes": dict.fromkeys(asked, lost), "seconds": 0.0})
            done, left = left[: len(answers) - 1], left[len(answers) - 1 :]
            for name, answer in zip(done, answers[1:], strict=True):
                for change in asked:  # machine code and changes are not combined: one of the two is that of here
                    key = variant if change == NATIVE else change
                    self.outcomes.setdefault(key, {})[name] = answer["outcomes"].get(change)
                    self.seconds[key] = self.seconds.get(key, 0.0) + answer["seconds"] / len(asked)
            sys.stderr.write(f"{variant}: {len(done)} entries\n" if done else "")

    def carry_out(
        self, where: Mapping[str, Mapping[str, str]], names: Sequence[str], asked: Mapping[str, Any], jobs: int
    ) -> None:
        """Work through all entries: with every change on the machine as it is, unchanged in every other environment."""
        with ThreadPoolExecutor(jobs) as pool:
            try:
                futures = []
                for variant, settings in where.items():
                    some = asked if variant == NATIVE else {NATIVE: asked[NATIVE]}
                    futures += [pool.submit(self.work, variant, settings, names[k::jobs], some) for k in range(jobs)]
                for future in futures:
                    future.result()
            finally:
                self.stopped = True
                for child in list(self.children):
                    child.kill()

    def rows(self, share: float | None) -> list[Row]:
        """Return everything that differs."""
        here = self.outcomes.get(NATIVE, {})
        return [
            row
            for variant, found in self.outcomes.items()
            for name, there in sorted(found.items())
            if there is not None and here.get(name) is not None
            for row in differences(name, variant, there, here[name], share=share)  # type: ignore[arg-type]
        ]


def differences(name: str, variant: str, there: Outcome, here: Outcome, *, share: float | None = None) -> Iterator[Row]:
    """Yield a row for each claim of an entry that differs from that of the machine as it is, or from the expected."""
    if there["run"] != here["run"] or there["run"] != "complete":
        yield Row(name, "", "run", variant, there["run"], here["run"], "complete")
    expected = there["expected"] if there["statuses"] else here["expected"]
    keys = dict.fromkeys([*here["statuses"], *there["statuses"], *expected])
    for key in keys if there["statuses"] and here["statuses"] else ():  # the row above says it all
        one, other = (side["statuses"].get(key, "missing") for side in (there, here))
        wanted, (theorem, _, claim) = expected.get(key), key.partition(":")
        # a verdict as a whole follows from its claims: it is told where it is expected
        if (one != other and (claim or wanted)) or (wanted and one != wanted):
            yield Row(name, theorem, claim, variant, one, other, wanted or "")
    residual, own = there.get("residual"), here.get("residual")
    if share is not None and residual is not None and not residual <= share:  # NaN is too much as well
        beside = "none" if own is None else f"{own:.2g}"
        yield Row(name, "", "energy residual", variant, f"{residual:.2g}", beside, f"<= {share:g}")


def table(rows: Sequence[Row]) -> str:
    """Return rows as text, in columns."""
    widths = [max(map(len, column)) for column in zip(Row._fields, *rows, strict=True)]
    return "".join("  ".join(map(str.ljust, line, widths)).rstrip() + "\n" for line in (Row._fields, *rows))


def machine_text(name: str, machine: Mapping[str, Any]) -> str:
    """Return what a child computes with, on one line."""
    cores = ", ".join(f"{library} {core}" for library, (core, _) in machine["openblas"].items()) or "unknown"
    numpy = " ".join(machine["numpy"]) or "baseline"
    return f"{name}: OpenBLAS {cores}; libm {machine['libm']}; numba {machine['numba'][0]}; numpy {numpy}"


def arguments() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(prog="python -m tools.portability", description=(__doc__ or "").split("\n\n")[1])
    parser.add_argument("names", nargs="*", metavar="NAME", help="scenarios and theorems by themselves; default: all")
    parser.add_argument("--variants", action="append", metavar="PATTERN", help="such as 'blas-*'; may be repeated")
    parser.add_argument("--list", action="store_true", help="print the variants of this machine and end")
    parser.add_argument("--draws", type=int, default=5, metavar="N", help="moved starts (default 5)")
    parser.add_argument("--residual", type=float, metavar="SHARE", help="share of its tolerance for the energy balance")
    parser.add_argument("--no-verdicts", action="store_true", help="make the runs alone, for their balance of energy")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes (default: cores)")
    parser.add_argument("--caches", type=Path, metavar="DIR", help="keep compiled code of other processors there")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all outcomes there")
    return parser


def main(given: Sequence[str] | None = None) -> int:
    """Run the matrix; return the exit status."""
    options = arguments().parse_args(given)
    with tempfile.TemporaryDirectory(prefix="portability-") as folder:
        matrix = Matrix(options.caches.resolve() if options.caches else Path(folder))
        try:
            answers, ended = matrix.ask({}, ())
            if ended:
                raise ValueError(ended)
            native = matrix.machines[NATIVE] = answers[0]
            known = [*native["scenarios"], *native["fixed"]]
            if unknown := [name for name in options.names if name not in known]:
                raise ValueError(f"no entry is called {' or '.join(unknown)}; there are {', '.join(known)}")
            if options.jobs < 1 or options.draws < 0:
                raise ValueError(f"--jobs {options.jobs} --draws {options.draws}: expected at least 1 and 0")
            (where, notices), what = environments(native), changes(options.draws)
            chosen = choose([*what, *where], options.variants or ())
        except ValueError as error:
            sys.stderr.write(f"portability: {error}\n")
            return BAD_INPUT
        if options.list:
            sys.stdout.write("".join(f"{name}\n" for name in chosen))
            return UNCHANGED
        ignored = [f"{name}={os.environ[name]} is set, and not used here" for name in LEVERS if name in os.environ]
        sys.stderr.write("".join(f"{notice}\n" for notice in (*ignored, *notices)))
        verdicts = {"verdicts": not options.no_verdicts}
        asked = {name: change | verdicts for name, change in what.items() if name in (NATIVE, *chosen)}
        where = {NATIVE: {}, **{name: settings for name, settings in where.items() if name in chosen}}
        try:
            matrix.carry_out(where, options.names or known, asked, options.jobs)
            code = report(matrix, options)
        except KeyboardInterrupt:
            report(matrix, options)
            sys.stdout.write("interrupted: some was not tried\n")
            code = INTERRUPTED
    return code


def report(matrix: Matrix, options: argparse.Namespace) -> int:
    """Write what was found; return the exit status."""
    rows, machines = matrix.rows(options.residual), matrix.machines
    if options.json:
        shown = ("openblas", "libm", "numba", "numpy")
        parts = {"machines": {name: {key: one[key] for key in shown} for name, one in machines.items()}}
        found = {"left_out": matrix.left_out, "seconds": matrix.seconds, "outcomes": matrix.outcomes}
        options.json.write_text(json.dumps(parts | found | {"rows": [row._asdict() for row in rows]}, indent=1) + "\n")
    for name, machine in machines.items():
        sys.stdout.write(machine_text(name, machine) + "\n")
    for name, reason in matrix.left_out.items():
        sys.stdout.write(f"{name} is left out: {reason}\n")
    claims = sum(len(one["statuses"]) for one in matrix.outcomes.get(NATIVE, {}).values() if one)
    told = f"{len(rows)} rows differ" if rows else "nothing changed"
    seconds = sum(matrix.seconds.values())
    sys.stdout.write("\n" + table(rows) if rows else "")
    sys.stdout.write(f"\n{told}: {len(matrix.outcomes)} variants of {claims} statuses, {seconds:.0f} CPU-s\n")
    return CHANGED if rows else UNCHANGED


def interrupt(*_: object) -> None:
    """Raise KeyboardInterrupt once: `timeout` sends its signal twice, and what was found is still to be reported."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt


if __name__ == "__main__":
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, interrupt)
    sys.exit(main())
