"""`python -m tools.portability`: the catalogue on other machine code, from moved starts, at other tolerances.

Every entry is run and verified on the machine as it is and in every variant; each claim whose status differs from the
one here, or from the one that the catalogue expects, is a row. Exit status: 0 nothing changed, 2 bad input, 3 something
changed, 130 interrupted.
"""

from __future__ import annotations

import argparse
import ctypes
import faulthandler
import hashlib
import json
import math
import os
import platform
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields, replace
from fnmatch import fnmatchcase
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

PROJECT, NATIVE, LIMIT = Path(__file__).resolve().parents[1], "native", 1800  # seconds for one entry
# Variables that choose machine code or block sizes; a child has them from its variant alone.
LEVERS = (
    *("OPENBLAS_CORETYPE", "OPENBLAS_L2_SIZE", "GLIBC_TUNABLES", "NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES"),
    *("NUMBA_CACHE_DIR", "NPY_DISABLE_CPU_FEATURES", "NPY_ENABLE_CPU_FEATURES"),
)
_ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
# OpenBLAS core types, and the flags in /proc/cpuinfo that each needs; OpenBLAS itself reports Prescott as Katmai.
CORES: dict[str, set[str]] = {
    "Prescott": set(),
    "Nehalem": {"sse4_2"},
    "Sandybridge": {"avx"},
    "Haswell": {"avx2", "fma"},
    "SkylakeX": {"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"},
}
# Units of length and time, in the entry's own: micrometres and milliseconds, kilometres and minutes, and odd ones.
UNITS = {"small": (1e6, 1e3), "large": (1e-3, 1.0 / 60.0), "odd": (2.54, 0.37)}
MOVED = 1e-13  # relative: the effect of rounding on a start that is written down elsewhere
# Thresholds that are part of a claim (a quasi-α-lattice *is* one within δ = 0.1 d), and shares.
DEFINITIONS, FIXED = ("quasi", "deviation", "mismatch", "agreement"), ("giant", "cohesion", "settle")


class Row(NamedTuple):
    """Claim of an entry whose status differs; without a claim the verdict as a whole."""

    scenario: str
    theorem: str
    claim: str
    variant: str
    there: str  # in the variant
    here: str  # on the machine as it is
    expected: str  # by the catalogue; empty if it expects nothing


def environments(native: Mapping[str, Any]) -> dict[str, dict[str, str]]:
    """Return the environment variables of each variant of machine code that this machine can run."""
    if native["machine"].lower() not in ("x86_64", "amd64"):
        return {}
    has, numpy = set(native["processor"]), native["numpy"]
    found = {f"blas-{core.lower()}": {"OPENBLAS_CORETYPE": core} for core, needs in CORES.items() if needs <= has}
    found["libm"] = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"} if native["libc"] == "glibc" else {}
    found["numba-generic"] = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}
    found["numpy-generic"] = {"NPY_DISABLE_CPU_FEATURES": " ".join(numpy)} if numpy else {}
    if CORES["Haswell"] <= has:
        newer = [one for one in numpy if "AVX512" in one or one == "X86_V4"]
        found["numba-haswell"] = {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": ""}
        found["numpy-haswell"] = {"NPY_DISABLE_CPU_FEATURES": " ".join(newer)} if newer else {}
        found["haswell"] = {**found["blas-haswell"], **found["numba-haswell"], **found["numpy-haswell"]}
    parts = ("blas-prescott", "libm", "numba-generic", "numpy-generic")
    found["generic"] = {name: value for part in parts for name, value in found[part].items()}
    return {name: settings for name, settings in found.items() if settings}


def changes(draws: int) -> dict[str, dict[str, float]]:
    """Return the arguments of `outcome` for each variant of an entry; those that share a run are adjacent."""
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


# ---- in a child, whose environment chooses the machine code


def openblas() -> dict[str, str]:
    """Return the core type of each OpenBLAS in this process whose core can be chosen; empty without /proc."""
    import scipy.linalg  # noqa: F401  # loads an OpenBLAS of its own

    maps = Path("/proc/self/maps")
    lines = maps.read_text().splitlines() if maps.exists() else []
    found = {}
    for path in sorted({line.split(maxsplit=5)[-1] for line in lines if "openblas" in line.rpartition("/")[2]}):
        said = {}
        for what in ("corename", "config"):
            for name in (f"{a}openblas_get_{what}{b}" for a in ("", "scipy_") for b in ("", "64_")):
                if function := getattr(ctypes.CDLL(path), name, None):
                    function.restype = ctypes.c_char_p
                    said[what] = function().decode()
        if "DYNAMIC_ARCH" in said.get("config", ""):
            found[re.sub(r"-[0-9a-f]{8}|\.so.*", "", Path(path).name)] = said["corename"]
    return found


def machine() -> dict[str, Any]:
    """Return the machine code that this process computes with, and the entries of the catalogue."""
    import numpy as np

    from flockana import scenarios, theorem, theorems

    points = (0.1 + 0.0137 * k for k in range(4000))
    values = [(math.exp(x), math.log(x), math.sin(x), math.cos(x), math.pow(x, 1.37)) for x in points]
    known = Path("/proc/cpuinfo")
    flags = re.search(r"^flags\s*:(.*)", known.read_text() if known.exists() else "", re.MULTILINE)
    return {
        "machine": platform.machine(),
        "libc": platform.libc_ver()[0],
        "libm": hashlib.sha256(np.array(values).tobytes()).hexdigest()[:8],  # another digest: another libm
        "openblas": openblas(),
        "numba": os.environ.get("NUMBA_CPU_NAME", "the processor's own"),
        "numpy": np.show_config(mode="dicts")["SIMD Extensions"].get("found", []),  # no key where none is in use
        "processor": flags[1].split() if flags else [],
        "scenarios": scenarios(),
        "fixed": [one for one in theorems() if theorem(one).kind == "fixed"],
    }


def unfit(settings: Mapping[str, str], native: Mapping[str, Any], here: Mapping[str, Any]) -> str:
    """Return why an environment does not have the effect asked for; empty if it has."""
    core, disabled = settings.get("OPENBLAS_CORETYPE"), settings.get("NPY_DISABLE_CPU_FEATURES", "").split()
    if core and not {core, "Katmai" if core == "Prescott" else core} >= set(here["openblas"].values()) > set():
        return f"asked for the core {core}, got {here['openblas']}"
    if "GLIBC_TUNABLES" in settings and here["libm"] == native["libm"]:
        return "libm computes the same with and without AVX2 and FMA"
    if still := set(disabled) & set(here["numpy"]):
        return f"numpy still uses {', '.join(sorted(still))}"
    same = settings and all(here[what] == native[what] for what in ("openblas", "libm", "numba", "numpy"))
    return "this is the machine as it is" if same else ""


def changed_entry(item: Any, draw: int, solver: float, length: float, time: float) -> Any:
    """Return a scenario with moved start, scaled tolerance of the solver or other units; None without a meaning."""
    import numpy as np

    from flockana import rescale
    from flockana.base.errors import ArgumentError
    from flockana.laws.discrete import DiscreteLaw

    if draw:
        generator = np.random.default_rng(draw)
        q0, p0 = (x * (1.0 + MOVED * generator.uniform(-1.0, 1.0, x.shape)) for x in (item.q0, item.p0))
        item = replace(item, q0=q0, p0=p0)
    if (length, time) != (1.0, 1.0):
        try:
            item = rescale(item, length=length, time=time)
        except ArgumentError:  # the law has a rate that is printed as a number
            item = rescale(item, length=length)
    if solver != 1.0:
        if isinstance(item.law, DiscreteLaw):
            return None
        given = {"dt": item.options["dt"]} if item.options.get("method") == "RK4" else {"rtol": 1e-8, **item.options}
        knobs = {name: solver * given[name] for name in ("dt", "rtol", "atol") if given.get(name) is not None}
        item = replace(item, options={**item.options, **knobs})
    return item


_PLAIN = {"draw": 0, "solver": 1.0, "length": 1.0, "time": 1.0}


@lru_cache(maxsize=1)
def _run(name: str, *change: Any) -> Any:
    from flockana import scenario

    item = changed_entry(scenario(name), *change)
    return None if item is None else (item, item.run())


def scaled(thresholds: float, definitions: float) -> Any:
    """Return tolerances with the thresholds that stand for zero, and those that are part of a claim, scaled."""
    from flockana import Tolerances

    kinds, given = dict.fromkeys(DEFINITIONS, definitions) | dict.fromkeys(FIXED, 1.0), Tolerances()
    return replace(given, **{f.name: getattr(given, f.name) * kinds.get(f.name, thresholds) for f in fields(given)})


def outcome(name: str, *, verdicts: bool = True, **change: float) -> dict[str, Any] | None:
    """Run and verify one entry, with a change; None if the change means nothing there."""
    import numpy as np

    from flockana import scenarios, theorem, verify

    tolerances = scaled(change.pop("thresholds", 1.0), change.pop("definitions", 1.0))
    run, expected, residual = None, dict[str, str](), None
    if name not in scenarios():
        if change:
            return None
        found, expected = [verify(name, tolerances=tolerances)], dict(theorem(name).expected)
    else:
        done = _run(name, *(change.get(key, plain) for key, plain in _PLAIN.items()))
        if done is None:
            return None
        item, run = done
        found = item.verify(run, tolerances=tolerances) if verdicts else []
        expected = dict(item.expected) if verdicts else {}
        if "work" in run.extra:
            size = float(np.abs(run.energy()).max()) or 1.0
            residual = float(np.abs(run.energy_residual).max()) / size / scaled(1.0, 1.0).energy
    statuses = {one.theorem: one.status for one in found}
    statuses |= {f"{one.theorem}:{claim.name}": claim.status for one in found for claim in one.claims}
    return {"run": run.status if run else "complete", "statuses": statuses, "expected": expected, "residual": residual}


def child() -> None:
    """Report the machine code, then answer requests: one JSON object a line, until standard input ends."""
    with os.fdopen(os.dup(1), "w", buffering=1) as channel:
        os.dup2(2, 1)  # IPOPT greets on standard output
        channel.write(json.dumps(machine()) + "\n")
        for line in sys.stdin:
            name, asked = json.loads(line)
            faulthandler.dump_traceback_later(LIMIT, exit=True)
            answers = {}
            for label, change in asked.items():
                try:
                    answers[label] = outcome(name, **change)
                except Exception as error:
                    answers[label] = {"run": f"{type(error).__name__}: {error}", "statuses": {}, "expected": {}}
            channel.write(json.dumps(answers) + "\n")


# ---- in the parent


def ask(settings: Mapping[str, str], caches: Path, requests: Sequence[Any]) -> tuple[list[Any], str]:
    """Return the answers of one child, the first of which is its machine, and how it ended if not well."""
    variables = {name: value for name, value in os.environ.items() if name not in LEVERS}
    variables |= {"PYTHONPATH": str(PROJECT)} | dict.fromkeys(_ONE_THREAD, "1") | dict(settings)
    if code := settings.get("NUMBA_CPU_NAME"):
        variables["NUMBA_CACHE_DIR"] = str(caches / code)
    lines = "".join(json.dumps(one) + "\n" for one in requests)
    command = [sys.executable, "-m", "tools.portability", "--child"]
    done = subprocess.run(command, input=lines, capture_output=True, text=True, errors="replace", env=variables)
    answers = [json.loads(line) for line in done.stdout.splitlines(keepends=True) if line.endswith("\n")]
    last = (done.stderr.strip().splitlines() or ["no message"])[-1]
    return answers, f"the child ended with status {done.returncode}: {last}" if done.returncode else ""


def work(settings: Mapping[str, str], caches: Path, names: Sequence[str], asked: Mapping[str, Any]) -> tuple[Any, Any]:
    """Return a child's machine and its answers by entry; of an entry at which it dies the others are not lost."""
    left, found, here = list(names), dict[str, Any](), {}
    while left:
        answers, ended = ask(settings, caches, [(name, asked) for name in left])
        if not answers:
            raise ValueError(ended)
        here = answers[0]
        if ended:
            answers.append({label: {"run": ended, "statuses": {}, "expected": {}} for label in asked})
        found |= dict(zip(left, answers[1:], strict=False))
        left = left[len(answers) - 1 :]
    return here, found


def differences(
    name: str, variant: str, there: Mapping[str, Any], here: Mapping[str, Any], *, share: float | None = None
) -> Iterator[Row]:
    """Yield a row for each claim of an entry that differs from the machine as it is, or from the expected."""
    if there["run"] != here["run"] or there["run"] != "complete":
        yield Row(name, "", "run", variant, there["run"], here["run"], "complete")
    expected = there["expected"] if there["statuses"] else here["expected"]
    keys = dict.fromkeys([*here["statuses"], *there["statuses"], *expected])
    for key in keys if there["statuses"] and here["statuses"] else ():  # the row above says it all
        one, other = (side["statuses"].get(key, "missing") for side in (there, here))
        wanted, (theorem, _, claim) = expected.get(key), key.partition(":")
        # a verdict as a whole follows from its claims: it is a row where it is expected
        if (one != other and (claim or wanted)) or (wanted and one != wanted):
            yield Row(name, theorem, claim, variant, one, other, wanted or "")
    residual = there.get("residual")
    if share is not None and residual is not None and not residual <= share:  # NaN is too much as well
        yield Row(name, "", "energy residual", variant, f"{residual:.2g}", f"{here.get('residual')}", f"<= {share:g}")


def table(rows: Sequence[Row]) -> str:
    """Return rows as text, in columns."""
    widths = [max(map(len, column)) for column in zip(Row._fields, *rows, strict=True)]
    return "".join("  ".join(map(str.ljust, line, widths)).rstrip() + "\n" for line in (Row._fields, *rows))


def arguments() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(prog="python -m tools.portability", description=(__doc__ or "").split("\n\n")[1])
    parser.add_argument("names", nargs="*", metavar="NAME", help="scenarios, and theorems without a run; default: all")
    parser.add_argument("--variants", action="append", metavar="PATTERN", help="such as 'blas-*'; may be repeated")
    parser.add_argument("--list", action="store_true", help="print the variants of this machine and end")
    parser.add_argument("--draws", type=int, default=5, metavar="N", help="moved starts (default 5)")
    parser.add_argument("--residual", type=float, metavar="SHARE", help="share of its tolerance for the energy balance")
    parser.add_argument("--no-verdicts", action="store_true", help="make the runs alone, for their balance of energy")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes (default: cores)")
    parser.add_argument("--caches", type=Path, metavar="DIR", help="keep compiled code of other processors there")
    parser.add_argument("--child", action="store_true", help=argparse.SUPPRESS)
    return parser


def matrix(options: argparse.Namespace, caches: Path) -> int:
    """Work through entries and variants, print what differs, and return the exit status."""
    native = ask({}, caches, ())[0][0]
    known = [*native["scenarios"], *native["fixed"]]
    if unknown := [name for name in options.names if name not in known]:
        raise ValueError(f"no entry is called {' or '.join(unknown)}; there are {', '.join(known)}")
    if options.jobs < 1 or options.draws < 0:
        raise ValueError(f"--jobs {options.jobs} --draws {options.draws}: expected at least 1 and 0")
    where, what = environments(native), changes(options.draws)
    chosen = choose([*what, *where], options.variants or ())
    if options.list:
        sys.stdout.write("".join(f"{name}\n" for name in chosen))
        return 0
    asked = {x: y | {"verdicts": not options.no_verdicts} for x, y in what.items() if x in (NATIVE, *chosen)}
    names, outcomes = options.names or known, dict[str, dict[str, Any]]()
    tasks = [  # with every change on the machine as it is, unchanged in every other environment
        (variant, settings, names[k :: options.jobs], asked if variant == NATIVE else {NATIVE: asked[NATIVE]})
        for variant, settings in {NATIVE: {}, **{x: y for x, y in where.items() if x in chosen}}.items()
        for k in range(options.jobs)
    ]
    with ThreadPoolExecutor(options.jobs) as pool:
        for task, (here, found) in zip(tasks, pool.map(lambda t: work(t[1], caches, *t[2:]), tasks), strict=True):
            variant, settings = task[:2]
            if settings and here and (reason := unfit(settings, native, here)):
                sys.stdout.write(f"{variant} is left out: {reason}\n")
                continue
            for name, answers in found.items():
                for change, one in answers.items():
                    outcomes.setdefault(variant if change == NATIVE else change, {})[name] = one
    rows = [
        row
        for variant, found in outcomes.items()
        for name, there in sorted(found.items())
        if there is not None
        for row in differences(name, variant, there, outcomes[NATIVE][name], share=options.residual)
    ]
    claims = sum(len(one["statuses"]) for one in outcomes.get(NATIVE, {}).values())
    sys.stdout.write(table(rows) + "\n" if rows else "")
    sys.stdout.write(f"{len(rows) or 'no'} rows differ: {len(outcomes)} variants of {claims} statuses\n")
    return 3 if rows else 0


def main(given: Sequence[str] | None = None) -> int:
    """Run the matrix; return the exit status."""
    options = arguments().parse_args(given)
    if options.child:
        child()
        return 0
    with tempfile.TemporaryDirectory(prefix="portability-") as folder:
        try:
            return matrix(options, options.caches.resolve() if options.caches else Path(folder))
        except ValueError as error:
            sys.stderr.write(f"portability: {error}\n")
            return 2
        except KeyboardInterrupt:
            return 130


if __name__ == "__main__":
    sys.exit(main())
