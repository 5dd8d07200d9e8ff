"""Sources of positions: saved runs, CSV files, equilibria, and builders such as ``square:4x5``."""

from __future__ import annotations

import csv
import os
from dataclasses import dataclass
from io import StringIO
from math import isfinite, prod
from pathlib import Path
from typing import Any

import numpy as np

from flockana import lattice
from flockana.base.errors import ArgumentError, FileError, UnknownNameError
from flockana.base.files import ensure_path, read_text_file
from flockana.base.value_checks import FloatArray, ensure_positive

D, KAPPA = 7.0, 1.2  # where neither the user nor a law says
_MOST = 10**6  # agents that a builder makes at most
_FILES = (".nc", ".csv", ".json")
BUILDERS = {"line": "N", "triangular": "N", "hexagonal-spiral": "N", "hexagonal-patch": "RINGS"}
BUILDERS |= {"square": "ROWSxCOLS", "honeycomb": "ROWSxCOLS"}
BUILDERS |= dict.fromkeys(("simple-cubic", "fcc", "hcp", "bcc"), "NXxNYxNZ")


@dataclass(frozen=True, eq=False)
class Source:
    """Positions of agents with their lattice scale d and interaction range r."""

    name: str  # what was asked for
    q: FloatArray  # shape (n, m)
    d: float  # d, r: Scale and interaction range
    r: float
    law: Any = None  # the law that came with the positions
    t: float = 0.0  # when they were taken
    max_ratio: float | None = None  # of a builder: largest κ at which its pattern is an α-lattice
    p: FloatArray | None = None  # velocities, shape (n, m), of a saved run


def read_source(name: str, *, d: float | None = None, r: float | None = None, time: float | None = None) -> Source:
    """Read the positions of agents from a file, or build them by a pattern's name."""
    path = ensure_path(name)
    d, r = (None if v is None else ensure_positive(key, v) for key, v in (("--d", d), ("--r", r)))
    law: Any = None
    p: FloatArray | None = None
    t, ratio = 0.0, None
    if path.suffix == ".nc":
        q, p, law, t = _sample(path, time)
    elif time is not None:
        raise ArgumentError(f"--time {time:g}: {name} is no saved run (.nc) and has no time; leave it out")
    elif path.suffix == ".json":
        from flockana.equilibria.equilibrium_files import read_equilibrium

        equilibrium = read_equilibrium(path)
        q, law = equilibrium.q, equilibrium.law
    elif path.suffix in _FILES or os.path.exists(path):
        q = read_csv(path)
    else:
        ensure_source(name)
        q, ratio = build(name, D if d is None else d)
    law = integrated_law(law)
    own_d, own_r = law_scales(law)
    if r is None:  # the law's ratio to the scale is kept
        r = own_r if d is None else (own_r / own_d if ratio is None else KAPPA) * d
    return Source(name, np.ascontiguousarray(q), own_d if d is None else d, r, law, t, ratio, p)


def integrated_law(law: Any) -> Any:
    """Return the continuous law behind a scheme; other laws and None unchanged."""
    return law.continuous if getattr(law, "approximates", False) else law


def law_scales(law: Any) -> tuple[float, float]:
    """Return (d, r) for measuring a law's lattices; r is 1.2 d if most pairs within r have no preferred length.

    The contacts of the dead-zone law sit at d₁ (erratum L8), its other pairs in a band.

    Examples
    --------
    >>> from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
    >>> law_scales(DeadZoneFlocking())
    (3.5, 4.2)
    """
    if law is None or law.pair is None:
        return D, KAPPA * D
    d: float = law.pair.length
    return law.lattice or (d, KAPPA * d)


def _sample(path: Path, time: float | None) -> tuple[FloatArray, FloatArray, Any, float]:
    from flockana.dynamics.trajectory import Trajectory

    run = Trajectory.load(path)
    first_time, last_time = float(run.t[0]), float(run.t[-1])
    if time is not None and not first_time <= time <= last_time:
        raise ArgumentError(f"--time {time:g}: expected a time of the run, {first_time:g} to {last_time:g}")
    k = -1 if time is None else int(np.argmin(np.abs(run.t - time)))
    return run.q[k], run.p[k], run.law, float(run.t[k])


def ensure_source(name: str, more: tuple[str, ...] = ()) -> None:
    """Raise on a name that is neither an existing file nor a builder."""
    path, builder = ensure_path(name), name.partition(":")[0]
    if path.suffix not in _FILES and builder not in BUILDERS and not os.path.exists(path):
        raise UnknownNameError("scenario, file or builder" if more else "file or builder", builder, (*more, *BUILDERS))


def build(text: str, d: float) -> tuple[FloatArray, float]:
    """Return positions of a builder such as ``fcc:2x2x2``, and the largest κ at which they are an α-lattice."""
    name, _, size_text = text.partition(":")
    form, function = BUILDERS[name], name.replace("-", "_")
    sizes = size_text.split("x")
    if len(sizes) != len(form.split("x")) or not all(k.isascii() and k.isdigit() for k in sizes):
        raise ArgumentError(f"{text!r}: expected {name}:{form}, with whole numbers")
    counts = [int(k[:20]) for k in sizes]  # enough to tell that it is too large
    if (3 * counts[0] ** 2 if form == "RINGS" else prod(counts)) > _MOST:
        raise ArgumentError(f"{text!r}: expected a size of at most {_MOST} agents")
    return getattr(lattice, function)(*counts, d), lattice.max_ratio(function)


def read_csv(path: Path) -> FloatArray:
    """Return positions from a CSV with a row per agent, one to three columns, with or without a header."""
    try:
        rows = csv.reader(StringIO(read_text_file(path).removeprefix("\ufeff"), newline=""))
        lines = [(k, row) for k, row in enumerate(rows, 1) if any(cell.strip() for cell in row)]
    except (UnicodeDecodeError, csv.Error) as error:
        raise FileError(f"cannot read {path}: {error}; expected a CSV of positions") from error
    if lines and not any(_is_number(cell) for cell in lines[0][1]):
        lines = _positions_by_header(path, lines[0][1], lines[1:])
    if not lines:
        raise FileError(f"{path} holds no positions: expected a row of 1 to 3 numbers for each agent")
    columns = len(lines[0][1])
    if columns > 3:
        raise FileError(f"{path} has {columns} columns: expected 1 to 3, the coordinates of an agent")
    for k, row in lines:
        if len(row) != columns:
            raise FileError(f"{path}, line {k}: {len(row)} values, expected {columns} as in the first row")
        bad_cell = next((cell for cell in row if not (_is_number(cell) and isfinite(float(cell)))), None)
        if bad_cell is not None:
            raise FileError(f"{path}, line {k}: {bad_cell!r}, expected finite numbers with commas between them")
    return np.array([[float(cell) for cell in row] for _, row in lines])


def _positions_by_header(
    path: Path, header: list[str], lines: list[tuple[int, list[str]]]
) -> list[tuple[int, list[str]]]:
    """Return the position columns that a header names; all columns where no name is known."""
    from flockana.recorded.reading.column_names import is_header, layout_of

    if not any(map(is_header, header)):
        return lines
    layout = layout_of(header, str(path))
    if layout.time is not None or "q" not in layout.long:
        raise FileError(f"{path} holds {', '.join(header)}: expected positions at one time; observe reads recordings")
    columns = [header.index(name) for name in layout.long["q"]]
    for k, row in lines:
        if len(row) != len(header):
            raise FileError(f"{path}, line {k}: {len(row)} values, expected {len(header)} as in the header")
    return [(k, [row[i] for i in columns]) for k, row in lines]


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
