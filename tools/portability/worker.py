"""A child of the matrix: reports its machine code, then runs and verifies the entries that it is asked for.

It is run as a script in an environment of its own. One JSON object a line: requests come by standard input, answers go
to what was standard output. Everything else that libraries print goes to standard error.
"""

from __future__ import annotations

import ctypes
import faulthandler
import hashlib
import importlib
import json
import math
import os
import platform
import re
import sys
import time
from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import casadi
import numpy as np
import scipy.linalg  # noqa: F401 - loads scipy's own OpenBLAS
from numba.core.registry import cpu_target

from flockana import Scenario, Tolerances, Trajectory, Verdict, rescale, scenario, scenarios, theorem, theorems, verify
from flockana.base.errors import ArgumentError
from flockana.laws.discrete import DiscreteLaw

LIMIT = 1800  # seconds for one answer: what takes longer hangs
OTHER_NAMES = {"Prescott": ("Katmai",)}  # under which OpenBLAS reports a core
MOVED = 1e-13  # relative: what rounding does to a start that is written down elsewhere
# These do not stand for zero: they are part of what is claimed (a quasi-α-lattice *is* one within δ = 0.1 d).
DEFINITIONS = ("quasi", "deviation", "mismatch", "agreement")
FIXED = ("giant", "cohesion", "settle")  # shares and factors: halved or doubled they mean nothing


def openblas() -> dict[str, tuple[str, bool]]:
    """Core type of each OpenBLAS in this process, and whether it can be chosen; empty where /proc does not tell."""
    casadi.load_nlpsol("ipopt")  # IPOPT's linear algebra is an OpenBLAS of its own
    maps = Path("/proc/self/maps")
    loaded = maps.read_text().splitlines() if maps.exists() else []
    paths = {line.split(maxsplit=5)[-1] for line in loaded if "openblas" in line.rpartition("/")[2]}
    found = {}
    for path in sorted(paths):
        library = ctypes.CDLL(path)
        core, config = _text(library, "corename"), _text(library, "config")
        if core:
            found[re.sub(r"-[0-9a-f]{8}|\.so.*", "", Path(path).name)] = (core, "DYNAMIC_ARCH" in config)
    return found


def _text(library: ctypes.CDLL, what: str) -> str:
    """What ``openblas_get_...`` says, under the names that it has in numpy's, scipy's and casadi's wheels."""
    for name in (f"{before}openblas_get_{what}{after}" for before in ("", "scipy_") for after in ("", "64_")):
        function = getattr(library, name, None)
        if function is not None:
            function.restype = ctypes.c_char_p
            return str(function().decode())
    return ""


def libm() -> str:
    """Digest of elementary functions at fixed points: another one means another libm."""
    points = (0.1 + 0.0137 * k for k in range(4000))
    values = [(math.exp(x), math.log(x), math.sin(x), math.cos(x), math.pow(x, 1.37)) for x in points]
    return hashlib.sha256(np.array(values).tobytes()).hexdigest()[:8]


def machine() -> dict[str, Any]:
    """What this process computes with."""
    _, name, features = cpu_target.target_context.codegen().magic_tuple()
    core: Any = importlib.import_module("numpy._core._multiarray_umath")
    available = core.__cpu_features__
    return {
        "machine": platform.machine(),
        "libc": platform.libc_ver()[0],
        "libm": libm(),
        "openblas": openblas(),
        "numba": (name, sorted(one[1:] for one in features.split(",") if one.startswith("+"))),
        "numpy": [one for one in core.__cpu_dispatch__ if available.get(one)],
        "processor": sorted(one for one, here in available.items() if here),
        "scenarios": scenarios(),
        "fixed": [one for one in theorems() if theorem(one).kind == "fixed"],
    }


def moved(item: Scenario, draw: int) -> Scenario:
    """The same from start values moved by 1e-13 of each at most."""
    generator = np.random.default_rng(draw)
    q0, p0 = (x * (1.0 + MOVED * generator.uniform(-1.0, 1.0, x.shape)) for x in (item.q0, item.p0))
    return replace(item, q0=q0, p0=p0)


def resolved(item: Scenario, factor: float) -> Scenario | None:
    """The same at other tolerances of the solver (or another fixed step); None for a map, whose step is its law."""
    if isinstance(item.law, DiscreteLaw):
        return None
    given = {"dt": item.options["dt"]} if item.options.get("method") == "RK4" else {"rtol": 1e-8, **item.options}
    knobs = {name: factor * given[name] for name in ("dt", "rtol", "atol") if given.get(name) is not None}
    return replace(item, options={**item.options, **knobs})


def in_units(item: Scenario, length: float, time: float) -> Scenario:
    """The same in other units; of length alone where the law has a rate that is printed as a number."""
    try:
        return rescale(item, length=length, time=time)
    except ArgumentError:
        return rescale(item, length=length)


def scaled(thresholds: float, definitions: float) -> Tolerances:
    """Thresholds that stand for zero, and those that are part of a claim, times factors."""
    kinds = dict.fromkeys(DEFINITIONS, definitions) | dict.fromkeys(FIXED, 1.0)
    given = Tolerances()
    return replace(given, **{f.name: getattr(given, f.name) * kinds.get(f.name, thresholds) for f in fields(given)})


def statuses(verdicts: Iterable[Verdict]) -> dict[str, str]:
    """Status by theorem and by ``"theorem:claim"``, as an entry spells what it expects."""
    found: dict[str, str] = {}
    for one in verdicts:
        found |= {one.theorem: one.status} | {f"{one.theorem}:{claim.name}": claim.status for claim in one.claims}
    return found


def unbalanced(run: Trajectory) -> float | None:
    """Largest residual of the energy balance, in units of what a verdict allows; None where there is no energy."""
    if "work" not in run.extra:
        return None
    size = float(np.abs(run.energy()).max()) or 1.0
    return float(np.abs(run.energy_residual).max()) / size / Tolerances().energy


@lru_cache(maxsize=1)
def _run(name: str, draw: int, solver: float, length: float, time: float) -> tuple[Scenario, Trajectory] | None:
    item = moved(scenario(name), draw) if draw else scenario(name)
    if (length, time) != (1.0, 1.0):
        item = in_units(item, length, time)
    again = item if solver == 1.0 else resolved(item, solver)
    return None if again is None else (again, again.run())


def outcome(
    name: str,
    *,
    draw: int = 0,
    solver: float = 1.0,
    thresholds: float = 1.0,
    definitions: float = 1.0,
    length: float = 1.0,
    time: float = 1.0,
    verdicts: bool = True,
) -> dict[str, Any] | None:
    """Run and verify one entry from a moved start or with numbers times factors; None if that means nothing there."""
    tolerances = scaled(thresholds, definitions)
    if name not in scenarios():
        if (draw, solver, length, time) != (0, 1.0, 1.0, 1.0):
            return None
        alone = statuses([verify(name, tolerances=tolerances)])
        return {"run": "complete", "statuses": alone, "expected": dict(theorem(name).expected)}
    done = _run(name, draw, solver, length, time)
    if done is None:
        return None
    item, run = done
    found, expected = {}, {}
    if verdicts:
        found, expected = statuses(item.verify(run, tolerances=tolerances)), dict(item.expected)
    return {"run": run.status, "statuses": found, "expected": expected, "residual": unbalanced(run)}


def unfit(settings: Mapping[str, str], native: Mapping[str, Any] | None, here: Mapping[str, Any]) -> str:
    """Return why an environment is not the one asked for, or just the machine as it is; empty if all is well."""
    if not settings or native is None:
        return ""
    if core := settings.get("OPENBLAS_CORETYPE"):
        dynamic = {name: one for name, (one, chosen) in here["openblas"].items() if chosen}
        wrong = {name: one for name, one in dynamic.items() if one not in (core, *OTHER_NAMES.get(core, ()))}
        if wrong or not dynamic:
            return f"asked for the core {core}, got {wrong or 'no OpenBLAS whose core can be chosen'}"
    if "GLIBC_TUNABLES" in settings and here["libm"] == native["libm"]:
        return "libm computes the same with and without AVX2 and FMA"
    if here["numba"][0] != settings.get("NUMBA_CPU_NAME", here["numba"][0]):
        return f"asked numba for {settings['NUMBA_CPU_NAME']}, got {here['numba'][0]}"
    if still := set(settings.get("NPY_DISABLE_CPU_FEATURES", "").split()) & set(here["numpy"]):
        return f"numpy still uses {', '.join(sorted(still))}"
    same = all(json.dumps(here[what]) == json.dumps(native[what]) for what in ("openblas", "libm", "numba", "numpy"))
    return "this is the machine as it is" if same else ""


def answer(request: Mapping[str, Any]) -> dict[str, Any]:
    """Return the outcomes of a request ``{"name", "changes": {label: change}}``, by label; errors are not raised."""
    started, found = time.process_time(), {}
    for label, change in request["changes"].items():
        try:
            one = outcome(request["name"], **change)
        except Exception as error:
            one = {"run": f"{type(error).__name__}: {error}", "statuses": {}, "expected": {}}
        if one is not None:
            found[label] = one
    return {"outcomes": found, "seconds": time.process_time() - started}


def main() -> None:
    """Answer until standard input ends."""
    with os.fdopen(os.dup(1), "w", buffering=1) as channel:
        os.dup2(2, 1)  # IPOPT greets on standard output
        told, here = json.loads(sys.stdin.readline()), machine()
        reason = unfit(told["settings"], told["native"], here)
        channel.write(json.dumps(here | {"unfit": reason}) + "\n")
        for line in sys.stdin if not reason else ():
            faulthandler.dump_traceback_later(LIMIT, exit=True)
            channel.write(json.dumps(answer(json.loads(line))) + "\n")


if __name__ == "__main__":
    main()
