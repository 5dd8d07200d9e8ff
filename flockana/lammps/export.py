"""Export of a folder for LAMMPS: data file, tabulated pair style, input script, and notes on missing parts."""

import os
import re
from collections.abc import Iterable
from dataclasses import dataclass
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np

from flockana.base import value_checks
from flockana.base.errors import ArgumentError, FileError
from flockana.base.files import ensure_path, ensure_target, write_atomic
from flockana.lammps import script
from flockana.lammps.table import inner_cutoff, pair_table
from flockana.laws.discrete import ensure_law
from flockana.laws.law import Law
from flockana.laws.law_with_start import WithStart
from flockana.laws.terms.pairs import PairTerm
from flockana.measures.metrics import min_distance

CONSENSUS = ("missing", "nearest")
_STEP = 0.02  # by default, in the law's own time
_MOST_POINTS = 10**7
# first line of each file, which identifies an earlier export that may be replaced
_FIRST_LINE = re.compile(rb"(# )?\d+ agents of \w+, t = \S+ to \S+\s*|# UNITS: lj CONTRIBUTOR: flockana\s*")
_LONGEST_LINE = 1000  # bytes; ours are shorter


@dataclass(frozen=True)
class LammpsExport:
    """Result of `export_lammps`: files written and untranslated parts."""

    folder: Path  # where
    files: tuple[Path, ...]  # input script, data file, table, and a text on what they hold
    # force_error, energy_error: Largest error of a pair's tabulated force and energy, as LAMMPS interpolates them
    force_error: float
    energy_error: float
    exact: tuple[str, ...]  # exact, near, missing: what the script does of the law exactly, nearly, and not at all
    near: tuple[str, ...]
    missing: tuple[str, ...]
    dt: float  # step of the script
    steps: int  # how many


def export_lammps(
    law: Any,
    q0: Any = None,
    p0: Any = None,
    t_span: value_checks.TimeSpan | None = None,
    folder: str | os.PathLike[str] = "",
    *,
    points: int = 20_000,
    inner: float | None = None,
    dt: float | None = None,
    samples: int = 200,
    consensus: str = "missing",
    seed: int = 0,
) -> LammpsExport:
    """Write law, start and run for LAMMPS: data file, tabulated pair style, input script, README.txt.

    The pair force and the pull to a γ-agent are the law's own but for the errors stated. A velocity consensus of
    constant weight is dpd/ext/tstat at temperature 0; any other is left out and said to be, or replaced by the nearest
    of that kind. `read_lammps` reads the run back.

    Parameters
    ----------
    law : Law, Flock or Scenario
        A sum of terms with a pair term, such as Algorithm 1, 2 or 3; a flock has a start and a time span, too.
    q0, p0 : array_like, shape (n, m), or callable
        Initial positions and velocities, or functions of the seed; at rest by default.
    folder : path
        Folder to write to; it is made if it is not there. An export from before is replaced, another's file is not.
    points : int
        Distances in the table.
    inner : float, optional
        First distance of the table, in the user's length unit; by default next to nothing, or a quarter of the
        pair law's length where its force is infinite at 0. LAMMPS stops where two agents come nearer.
    dt : float, optional
        Step, at most; by default a fiftieth of the law's own time. The last step ends on time.
    samples : int
        Snapshots to write, beside the start.
    consensus : {"missing", "nearest"}
        What to do with a velocity consensus that LAMMPS has no style for.
    seed : int
        Seed of a start that is drawn.

    Raises
    ------
    ArgumentError
        On a law without a pair term, bad input, or two agents nearer than the table's first distance.
    FileError
        If the folder cannot be written, or holds a file of these names that is no export: then nothing is written.

    Examples
    --------
    >>> import tempfile
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     result = export_lammps(Algorithm1(), [[0.0, 0.0], [8.0, 0.0]], [[0.0, 0.0]] * 2, (0.0, 1.0), folder)
    >>> [path.name for path in result.files], result.force_error < 1e-4, len(result.missing)
    (['in.flock', 'flock.data', 'pair.table', 'README.txt'], True, 1)
    """
    if isinstance(law, WithStart):
        law, q0, p0, t_span = law.law_and_start(seed)
    law, term = _translatable(law)
    folder = ensure_path(folder, action="write to", remedy="choose another folder")
    _ensure_own(folder / name for name in (script.SCRIPT, script.DATA, script.TABLE, script.README))
    q0, p0 = value_checks.draw_start(q0, p0, value_checks.ensure_seed(seed))
    law.check_dimension(q0.shape[1])
    law.check_start(q0, p0)
    points, samples = _count("points", points, 2, _MOST_POINTS), _count("samples", samples, 1, 10**9)
    value_checks.ensure_known("choice of consensus", consensus, CONSENSUS)
    first_distance = _first_distance(term, q0, inner)
    start, end = value_checks.ensure_time_span(t_span)
    clock = _clock(law, start, end, dt, samples)
    table = pair_table(term, points, first_distance)
    result = script.translated(law, q0.shape[1], table, nearest=consensus == "nearest")
    title = f"{len(q0)} agents of {law.title}, t = {start:g} to {end:g}"
    texts = {
        script.SCRIPT: script.script_text(title, q0.shape[1], table, clock, result),
        script.DATA: script.data_text(q0, p0, term.pair.range, title),
        script.TABLE: table.text(),
        script.README: script.readme_text(title, table, clock, result),
    }
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"cannot make {str(folder)!r}: {error.strerror or error}; choose another folder") from error
    files = tuple(write_atomic(folder / name, text, remedy="choose another folder") for name, text in texts.items())
    exact, near_texts, missing = (tuple(item) for item in (result.exact, result.near, result.missing))
    errors = table.force_error, table.energy_error
    return LammpsExport(folder, files, *errors, exact, near_texts, missing, clock.dt, clock.steps)


def _translatable(law: Any) -> tuple[Law, PairTerm]:
    """Return the continuous law and its pair term; raise if the law cannot be exported to LAMMPS."""
    ensure_law(law)
    continuous_law = law.continuous
    term = None if continuous_law is None else continuous_law.term(PairTerm)
    if continuous_law is None or term is None:
        raise ArgumentError(
            f"{law.title} has no pair term for LAMMPS to tabulate: expected a sum of terms with one, such as "
            "Algorithm1, Algorithm2 or DeadZoneFlocking"
        )
    if not np.isfinite(term.pair.range):
        raise ArgumentError(f"the pair law reaches to {term.pair.range}: expected a finite range, where a table ends")
    return continuous_law, term


def _count(name: str, value: Any, least: int, most: int) -> int:
    number = value_checks.ensure_finite_scalar(name, value)
    if number != int(number) or not least <= number <= most:
        raise ArgumentError(f"{name} = {value!r}: expected a whole number from {least} to {most}")
    return int(number)


def _first_distance(term: PairTerm, q: value_checks.FloatArray, inner: float | None) -> float:
    first = inner_cutoff(term) if inner is None else value_checks.ensure_positive("inner", inner)
    if first >= term.pair.range:
        raise ArgumentError(f"inner = {first:g}: expected less than the range {term.pair.range:g}")
    nearest = min_distance(q) if len(q) > 1 else np.inf
    if nearest < first:
        raise ArgumentError(
            f"two agents start {nearest:.3g} apart, nearer than the table's first distance {first:.3g}: give a smaller "
            "inner, or move them apart"
        )
    return first


def _clock(law: Law, start: float, end: float, dt: float | None, samples: int) -> script.Clock:
    """Return a clock of equal steps of at most dt that end on time, equally many between samples."""
    if dt is None and law.scales is None:
        raise ArgumentError(f"dt = None: {law.title} has no time of its own; give a step")
    longest = (
        _STEP * law.scales.time if dt is None and law.scales is not None else value_checks.ensure_positive("dt", dt)
    )
    stride = max(1, ceil((end - start) / (longest * samples) * (1.0 - 1e-12)))
    return script.Clock(start, (end - start) / (samples * stride), samples * stride, stride)


def _ensure_own(paths: Iterable[Path]) -> None:
    """Raise if one of the given paths exists and is not a file of an earlier export."""
    for path in paths:
        if not os.path.lexists(path):
            continue
        try:
            with ensure_target(path, remedy="choose another folder").open("rb") as file:
                match = _FIRST_LINE.fullmatch(file.readline(_LONGEST_LINE))
        except FileNotFoundError:  # a link to nowhere
            match = None
        except FileError:
            raise
        except OSError as error:
            raise FileError(f"cannot read {path}: {error.strerror or error}; choose another folder") from error
        if match is None:
            raise FileError(
                f"{path} exists and is not from an export for LAMMPS: nothing is written, so that it is kept; "
                "choose another folder, or move it away"
            )
