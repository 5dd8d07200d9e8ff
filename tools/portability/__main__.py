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
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from fnmatch import fnmatchcase
from itertools import groupby
from pathlib import Path
from typing import Any

from .crew import Child, Unit, WorkerError, carry_out
from .findings import Findings, machine_text, table
from .variants import DRAWS, LEVERS, NATIVE, Change, Environment, changes, environments

UNCHANGED, BAD_INPUT, CHANGED, INTERRUPTED = 0, 2, 3, 130


def arguments() -> argparse.ArgumentParser:
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m tools.portability", description=(__doc__ or "").split("\n\n")[1])
    parser.add_argument("names", nargs="*", metavar="NAME", help="scenarios and theorems by themselves; default: all")
    parser.add_argument("--variants", action="append", metavar="PATTERN", help="such as 'blas-*'; may be repeated")
    parser.add_argument("--list", action="store_true", help="print the variants of this machine and end")
    parser.add_argument("--draws", type=int, default=DRAWS, metavar="N", help=f"moved starts (default {DRAWS})")
    parser.add_argument(
        "--residual", type=float, metavar="SHARE", help="share of its tolerance that the energy balance may use"
    )
    parser.add_argument("--no-verdicts", action="store_true", help="make the runs alone, for their balance of energy")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes (default: cores)")
    parser.add_argument(
        "--caches", type=Path, metavar="DIR", help="keep what numba compiles for other processors there"
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all outcomes there")
    return parser


def plan(names: Sequence[str], where: Sequence[Environment], what: Sequence[Change]) -> list[Unit]:
    """Runs to make: every change on the machine as it is, and every entry unchanged in every other environment.

    Parameters
    ----------
    names : sequence of str
        Entries.
    where : sequence of Environment
        Other machine code.
    what : sequence of Change
        Changes, the first of them none; those that share a run stand together.
    """
    groups = [tuple(group) for _, group in groupby(what, key=lambda one: one.run)]
    native = [Unit(Environment(NATIVE), name, group) for group in groups for name in names]
    return native + [Unit(one, name, (Change(NATIVE),)) for one in where for name in names]


def ask_machine() -> dict[str, Any]:
    """What a child tells of the machine as it is."""
    with tempfile.TemporaryDirectory(prefix="portability-") as folder:
        child = Child(Environment(NATIVE), Path(folder))
        child.close()
        return child.machine


def choose(names: Sequence[str], patterns: Sequence[str]) -> list[str]:
    """The variants that any of some patterns fits; without patterns all but those that change what is claimed.

    Raises
    ------
    ValueError
        If a pattern fits none.
    """
    lost = [one for one in patterns if not any(fnmatchcase(name, one) for name in names)]
    if lost:
        raise ValueError(f"no variant is called {' or '.join(lost)}; there are {', '.join(names)}")
    if not patterns:
        return [name for name in names if not name.startswith("definitions-")]
    return [name for name in names if any(fnmatchcase(name, one) for one in patterns)]


def ensure_sound(options: argparse.Namespace, known: Sequence[str]) -> None:
    """Check the options against what there is.

    Raises
    ------
    ValueError
        If an entry is unknown or a number is too small.
    """
    unknown = [name for name in options.names if name not in known]
    if unknown:
        raise ValueError(f"no entry is called {' or '.join(unknown)}; there are {', '.join(known)}")
    if options.jobs < 1 or options.draws < 0:
        raise ValueError(f"--jobs {options.jobs} --draws {options.draws}: expected at least 1 and 0")


def main(given: Sequence[str] | None = None) -> int:
    """Run the matrix; return the exit status."""
    options = arguments().parse_args(given)
    try:
        native = ask_machine()
        known = [*native["scenarios"], *native["fixed"]]
        ensure_sound(options, known)
        where, notices = environments(native)
        what = changes(options.draws, verdicts=not options.no_verdicts)
        chosen = choose([one.name for one in what] + [one.name for one in where], options.variants or ())
    except (WorkerError, ValueError) as error:
        sys.stderr.write(f"portability: {error}\n")
        return BAD_INPUT
    if options.list:
        sys.stdout.write("".join(f"{name}\n" for name in chosen))
        return UNCHANGED
    ignored = [f"{name}={os.environ[name]} is set, and not used here" for name in LEVERS if name in os.environ]
    sys.stderr.write("".join(f"{notice}\n" for notice in (*ignored, *notices)))
    what = [one for one in what if one.name in (NATIVE, *chosen)]
    units = plan(options.names or known, [one for one in where if one.name in chosen], what)
    findings = Findings(native, Counter(_variant(unit, one) for unit in units for one in unit.changes))
    variants = list(findings.planned)
    try:
        carry_out(units, findings, jobs=options.jobs, caches=options.caches and options.caches.resolve())
    except KeyboardInterrupt:
        _report(findings, variants, options)
        sys.stdout.write("interrupted: some was not tried\n")
        return INTERRUPTED
    return _report(findings, variants, options)


def _variant(unit: Unit, change: Change) -> str:
    return unit.environment.name if change.name == NATIVE else change.name


def _report(findings: Findings, variants: Sequence[str], options: argparse.Namespace) -> int:
    rows = findings.rows(variants, share=options.residual)
    if options.json:
        options.json.write_text(json.dumps(findings.to_dict(rows), indent=1) + "\n")
    for name, machine in findings.machines.items():
        sys.stdout.write(machine_text(name, machine) + "\n")
    for name, reason in findings.left_out.items():
        sys.stdout.write(f"{name} is left out: {reason}\n")
    if rows:
        sys.stdout.write("\n" + table(rows))
    done = [one for one in variants if one not in findings.left_out]
    claims = sum(len(one["statuses"]) for one in findings.outcomes.get(NATIVE, {}).values() if one)
    told = f"{len(rows)} rows differ" if rows else "nothing changed"
    sys.stdout.write(
        f"\n{told}: {len(done)} variants of {claims} statuses, {sum(findings.seconds.values()):.0f} CPU-s\n"
    )
    return CHANGED if rows else UNCHANGED


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # a time limit is no reason to lose what was found
    sys.exit(main())
