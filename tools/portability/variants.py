"""What the matrix varies: the machine code that a process gets, and what is changed in an entry."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

NATIVE = "native"
DRAWS = 5
# Units of length and time, in the entry's own: micrometres and milliseconds, kilometres and minutes, and odd ones.
UNITS: dict[str, tuple[float, float]] = {"small": (1e6, 1e3), "large": (1e-3, 1.0 / 60.0), "odd": (2.54, 0.37)}
# What chooses machine code, or block sizes, from outside; a child has these from its environment alone.
LEVERS = (
    *("OPENBLAS_CORETYPE", "OPENBLAS_L2_SIZE", "GLIBC_TUNABLES", "NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES"),
    *("NUMBA_CACHE_DIR", "NPY_DISABLE_CPU_FEATURES", "NPY_ENABLE_CPU_FEATURES"),
)
# OpenBLAS core types, what a processor must have for each, and other names under which OpenBLAS reports it.
CORES: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "Prescott": ((), ("Katmai",)),
    "Nehalem": (("SSE42",), ()),
    "Sandybridge": (("AVX",), ()),
    "Haswell": (("AVX2", "FMA3"), ()),
    "SkylakeX": (("AVX512F", "AVX512_SKX"), ()),
}
OLD_LIBM = "glibc.cpu.hwcaps=-AVX2,-FMA"


@dataclass(frozen=True)
class Environment:
    """Machine code that a process gets: environment variables, by name.

    Parameters
    ----------
    name : str
        Of the variant.
    settings : mapping of str to str
        Environment variables.
    """

    name: str
    settings: Mapping[str, str] = field(default_factory=dict, hash=False)

    @property
    def code(self) -> str:
        """Whose machine code numba writes; empty for that of the processor at hand."""
        return self.settings.get("NUMBA_CPU_NAME", "")


@dataclass(frozen=True)
class Change:
    """What is changed in an entry, machine code apart.

    Parameters
    ----------
    name : str
        Of the variant.
    draw : int
        Which start moved by a relative 1e-13; 0 for the entry's own.
    solver, thresholds, definitions : float
        Factors: of the solver's tolerances, of thresholds that stand for zero, of those that are part of a claim.
    length, time : float
        Factors of all numbers that are lengths, or times.
    verdicts : bool
        Whether the runs are judged.
    """

    name: str
    draw: int = 0
    solver: float = 1.0
    thresholds: float = 1.0
    definitions: float = 1.0
    length: float = 1.0
    time: float = 1.0
    verdicts: bool = True

    @property
    def run(self) -> tuple[float, ...]:
        """Changes with the same of this share a run."""
        return self.draw, self.solver, self.length, self.time

    def request(self) -> dict[str, Any]:
        """As a worker is asked for it."""
        data = asdict(self)
        del data["name"]
        return data


def environments(native: Mapping[str, Any]) -> tuple[list[Environment], list[str]]:
    """Every environment that this machine can give beside its own, and notices of those that it cannot.

    Parameters
    ----------
    native : mapping
        What a worker tells of the machine as it is.
    """
    if native["machine"].lower() not in ("x86_64", "amd64"):
        return [], [f"machine code is not varied: {native['machine']} is no x86-64"]
    has, found, notices = set(native["processor"]), [], []
    for core, (needs, _) in CORES.items():
        missing = [one for one in needs if one not in has]
        if missing:
            notices.append(f"blas-{core.lower()} is left out: the processor has no {', '.join(missing)}")
        else:
            found.append(Environment(f"blas-{core.lower()}", {"OPENBLAS_CORETYPE": core}))
    libm = {"GLIBC_TUNABLES": OLD_LIBM} if native["libc"] == "glibc" else {}
    if libm:
        found.append(Environment("libm", libm))
    else:
        notices.append(f"libm is left out: it is varied through glibc, and this is {native['libc'] or 'another libc'}")
    generic = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}
    none = _without(native["numpy"])
    found += [Environment("numba-generic", generic), Environment("numpy-generic", none)]
    if {"AVX2", "FMA3"} <= has:
        haswell = {"NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": ""}
        some = _without([one for one in native["numpy"] if "AVX512" in one or one == "X86_V4"])
        found += [Environment("numba-haswell", haswell), Environment("numpy-haswell", some)]
        found.append(Environment("haswell", {"OPENBLAS_CORETYPE": "Haswell", **haswell, **some}))
    found.append(Environment("generic", {"OPENBLAS_CORETYPE": "Prescott", **libm, **generic, **none}))
    return [one for one in found if one.settings], notices


def _without(features: Sequence[str]) -> dict[str, str]:
    return {"NPY_DISABLE_CPU_FEATURES": " ".join(features)} if features else {}


def changes(draws: int = DRAWS, *, verdicts: bool = True) -> list[Change]:
    """Every change of an entry: nothing, other tolerances and thresholds, other units, moved starts.

    Parameters
    ----------
    draws : int
        Number of moved starts.
    verdicts : bool
        Whether runs are judged; else they are made for their balance of energy alone.
    """
    found = [Change(NATIVE)]
    for label, factor in (("halved", 0.5), ("doubled", 2.0)):
        found.append(Change(f"thresholds-{label}", thresholds=factor))
        found.append(Change(f"definitions-{label}", definitions=factor))
    for label, factor in (("halved", 0.5), ("doubled", 2.0)):
        found.append(Change(f"solver-{label}", solver=factor))
    found += [Change(f"units-{label}", length=length, time=time) for label, (length, time) in UNITS.items()]
    found += [Change(f"moved-{draw}", draw=draw) for draw in range(1, draws + 1)]
    return [replace(one, verdicts=verdicts) for one in found]


def no_effect(environment: Environment, native: Mapping[str, Any], here: Mapping[str, Any]) -> str:
    """Why an environment is not what its name says, or nothing but the machine as it is; empty if all is well.

    Parameters
    ----------
    environment : Environment
        As asked for.
    native, here : mapping
        What workers tell of the machine as it is, and in this environment.
    """
    wanted = environment.settings
    if "OPENBLAS_CORETYPE" in wanted:
        core = wanted["OPENBLAS_CORETYPE"]
        dynamic = {name: one for name, (one, chosen) in here["openblas"].items() if chosen}
        wrong = {name: one for name, one in dynamic.items() if one not in (core, *CORES[core][1])}
        if wrong or not dynamic:
            return f"asked for the core {core}, got {wrong or 'no OpenBLAS whose core can be chosen'}"
    if "GLIBC_TUNABLES" in wanted and here["libm"] == native["libm"]:
        return "libm computes the same with and without AVX2 and FMA"
    if "NUMBA_CPU_NAME" in wanted and here["numba"][0] != wanted["NUMBA_CPU_NAME"]:
        return f"asked numba for {wanted['NUMBA_CPU_NAME']}, got {here['numba'][0]}"
    still = set(wanted.get("NPY_DISABLE_CPU_FEATURES", "").split()) & set(here["numpy"])
    if still:
        return f"numpy still uses {', '.join(sorted(still))}"
    if all(here[what] == native[what] for what in ("openblas", "libm", "numba", "numpy")):
        return "this is the machine as it is"
    return ""
