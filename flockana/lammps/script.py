"""LAMMPS input script, data file and notes on untranslated parts of a law."""

from dataclasses import dataclass, field

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.lammps.table import KEYWORD, PairTable, adjacency
from flockana.lammps.target_pull import AXES, pull_commands
from flockana.laws.law import Law
from flockana.laws.terms.navigation import Navigation
from flockana.laws.terms.pairs import PairTerm

DATA, TABLE, SCRIPT, DUMP, README = "flock.data", "pair.table", "in.flock", "flock.dump", "README.txt"
_SKIN = 0.2  # of the neighbour list, in ranges of the pair law
_SHELLS, _STEEPEST = 4000, 10.0  # distances at which a weight is fitted to an adjacency, and its largest exponent


@dataclass(frozen=True)
class Clock:
    """Start, step, number of steps, and steps between samples of a run."""

    start: float
    dt: float
    steps: int
    every: int


@dataclass
class Translation:
    """Translation of a law into commands of a LAMMPS script, with its exact, inexact and missing terms."""

    fixes: list[str] = field(default_factory=list)  # commands that add forces
    # a pairwise damping of weight (1 − r/range)^(2 exponent), if one is in the script
    consensus: tuple[float, float] | None = None
    # exact, near, missing: what is the law's own, to the table's error and the step's; what is nearly; what is left out
    exact: list[str] = field(default_factory=list)
    near: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)


def translated(law: Law, m: int, table: PairTable, *, nearest: bool) -> Translation:
    """Translate each term of a law; `nearest` replaces an untranslatable consensus by damping."""
    result = Translation()
    for term in law.terms:
        if isinstance(term, PairTerm):
            result.exact.append(f"pair forces: a table, off by at most {table.force_error:.2g}")
            if table.jumps:
                jump_text = ", ".join(f"{x:g}" for x in table.jumps)
                result.near.append(f"jumps of the force at {jump_text}: over one interval")
            _translate_consensus(term, m, result, nearest=nearest)
        elif isinstance(term, Navigation):
            commands = pull_commands(term)
            if commands is None:
                result.missing.append("the pull to the γ-agent: gains for each agent, or a path that has no formula")
            else:
                result.fixes += commands
                result.exact.append("pull to the γ-agent: fix addforce and fix viscous")
        elif (
            field_ := getattr(term, "field", None)
        ) is None or field_.obstacles:  # else obstacles of which there are none
            result.missing.append(f"{type(term).__name__}: no style of LAMMPS is this force")
    return result


def _translate_consensus(term: PairTerm, m: int, result: Translation, *, nearest: bool) -> None:
    """Translate velocity consensus to dpd/ext/tstat at temperature 0."""
    if term.damping == 0.0:
        return
    exponent, off = nearest_weight(term, m)
    weight = f"dpd/ext/tstat at temperature 0 with weight (1 - r/{term.pair.range:g})^{2.0 * exponent:.4g}"
    if off == 0.0:
        result.consensus = term.damping, 0.0
        result.exact.append("velocity consensus: dpd/ext/tstat at temperature 0, whose weight is 1 as the law's is")
    elif nearest:
        result.consensus = term.damping, exponent
        result.near.append(f"velocity consensus: {weight}, off the law's adjacency by up to {off:.2g}")
    else:
        result.missing.append(
            f"velocity consensus: no style has this adjacency; the nearest is {weight}, off by up to {off:.2g} "
            "(consensus nearest)"
        )


def nearest_weight(term: PairTerm, m: int) -> tuple[float, float]:
    """Return (s, largest error) of the weight (1 − r/range)^2s nearest to the adjacency."""
    from scipy.optimize import minimize_scalar

    x = (np.arange(_SHELLS) + 0.5) / _SHELLS
    weight = adjacency(term, x * term.pair.range)
    if np.all(weight == 1.0):
        return 0.0, 0.0
    shells = x ** (m - 1)

    def apart(s: float) -> float:
        return float(np.sum(shells * ((1.0 - x) ** (2.0 * s) - weight) ** 2))

    s = float(minimize_scalar(apart, bounds=(0.0, _STEEPEST), method="bounded").x)
    return s, float(np.abs((1.0 - x) ** (2.0 * s) - weight).max())


def data_text(q: FloatArray, p: FloatArray, reach: float, title: str) -> str:
    """Return the text of the LAMMPS data file: header, box, one mass, positions and velocities."""
    n, m = q.shape
    low, high = np.full(3, -0.5), np.full(3, 0.5)
    low[:m], high[:m] = q.min(axis=0) - reach, q.max(axis=0) + reach
    if m == 1:
        low[1], high[1] = -reach, reach
    box = "".join(f"{a!r} {b!r} {x}lo {x}hi\n" for a, b, x in zip(low.tolist(), high.tolist(), AXES, strict=True))
    rows = [[" ".join(map(repr, x + [0.0] * (3 - m))) for x in item.tolist()] for item in (q, p)]
    position_text = "".join(f"{k} 1 {row}\n" for k, row in enumerate(rows[0], 1))
    speeds = "".join(f"{k} {row}\n" for k, row in enumerate(rows[1], 1))
    header = f"{title}\n\n{n} atoms\n1 atom types\n\n{box}\n"
    return f"{header}Masses\n\n1 1.0\n\nAtoms # atomic\n\n{position_text}\nVelocities\n\n{speeds}"


def script_text(title: str, m: int, table: PairTable, clock: Clock, result: Translation) -> str:
    """Return the text of the LAMMPS input script, in units lj with masses of 1."""
    points, reach = len(table.r), float(table.r[-1])
    columns = " ".join([*AXES[:m], *(f"v{x}" for x in AXES[:m]), *(f"f{x}" for x in AXES[:m])])
    boundary = ("s f p", "s s p", "s s s")[m - 1]
    lines = [
        f"# {title}",
        *(f"# exact: {text}" for text in result.exact),
        *(f"# nearly: {text}" for text in result.near),
        *(f"# MISSING: {text}" for text in result.missing),
        "units lj",
        f"dimension {3 if m == 3 else 2}",
        f"boundary {boundary}",
        "atom_style atomic",
        f"read_data {DATA}",
        *_pair_commands(points, reach, result),
        f"neighbor {_SKIN * reach!r} bin",
        "neigh_modify every 1 delay 0 check yes",
        f"timestep {clock.dt!r}",
        f"variable t equal {clock.start!r}+step*{clock.dt!r}",
        "fix move all nve",
        *result.fixes,
        *["fix plane all enforce2d"] * (m < 3),
        f"dump flock all custom {clock.every} {DUMP} id type {columns}",
        "dump_modify flock sort id format float %.17g time yes",
        f"thermo {clock.every}",
        f"run {clock.steps}",
    ]
    return "\n".join(lines) + "\n"


def _pair_commands(points: int, reach: float, result: Translation) -> list[str]:
    table = f"{TABLE} {KEYWORD} {reach!r}"
    if result.consensus is None:
        return [f"pair_style table linear {points}", f"pair_coeff 1 1 {table}"]
    gain, s = result.consensus
    return [
        "comm_modify vel yes",
        f"pair_style hybrid/overlay table linear {points} dpd/ext/tstat 0.0 0.0 {reach!r} 1",
        f"pair_coeff 1 1 table {table}",
        f"pair_coeff 1 1 dpd/ext/tstat {gain!r} {gain!r} {s!r} {s!r} {reach!r}",
    ]


_FIRST_ORDER = """
dpd/ext/tstat depends on velocities, which LAMMPS's velocity-Verlet knows half a step late at the forces: its run is of
first order in the timestep where this library's methods are of fourth or higher, so halve the timestep to see how far.
"""


def readme_text(title: str, table: PairTable, clock: Clock, result: Translation) -> str:
    """Return the text of the export folder's README: contents, what LAMMPS computes, how to read the run."""
    sections = [("Exact", result.exact), ("Nearly", result.near), ("Missing", result.missing)]
    listed = "".join(f"{head}:\n" + "".join(f"  - {text}\n" for text in texts) for head, texts in sections if texts)
    order = "" if result.consensus is None else _FIRST_ORDER
    stop = "" if table.r[0] < 1e-3 * table.r[-1] else " LAMMPS stops where two agents come nearer than that."
    return f"""{title}

Run `lmp -in {SCRIPT}` in this folder, or `mpirun -np 8 lmp -in {SCRIPT}`; it writes {DUMP}.
{"Needs the package DPD-BASIC." if result.consensus else "Needs no package beyond the basic ones."}

{SCRIPT}    input script, units lj, all masses 1: lengths and times are those of the law
{DATA}  positions and velocities at the start
{TABLE}  the pair force at {len(table.r)} distances from {table.r[0]:.6g} to {table.r[-1]:.6g}, their squares evenly \
spaced.{stop}
{order}
{listed}
Interpolated linearly, as LAMMPS does it, the table's force is off by at most {table.force_error:.3g} (of at most \
{np.abs(table.force).max():.4g}),
its energy by {table.energy_error:.3g}{", but where the force jumps" if table.jumps else ""}.

LAMMPS integrates by velocity Verlet in {clock.steps} steps of {clock.dt:.6g}: of second order, but of first where \
velocities act,
which it knows half a step late. Halve the step to see what that is worth. Read the run back with

  run = flockana.read_lammps("{DUMP}", law, start={clock.start!r})
  run.extra["force_residual"]   # how far LAMMPS's forces are from the law's, relative to the largest
  run.energy_residual           # how far the energy is from where the law takes it
"""
