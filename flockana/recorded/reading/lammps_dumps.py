"""Text dumps of LAMMPS: snapshots with boxes, and unwrapped positions."""

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from io import TextIOWrapper
from itertools import islice, pairwise, takewhile
from pathlib import Path
from typing import Any, Self, TextIO

import numpy as np

from flockana.base.errors import ArgumentError, FileError
from flockana.base.value_checks import FloatArray
from flockana.recorded.reading import opened

AXES = "xyz"
_WORDS = ("element", "typelabel")  # columns of words
_LARGEST = 2**53  # up to which every whole number is a float


@dataclass(frozen=True, eq=False)
class Box:
    """Edge vectors of a simulation box, (3, 3), and which of them are periodic; None if this is not stated."""

    edges: FloatArray
    periodic: tuple[bool, ...] | None

    @classmethod
    def of(cls, words: Sequence[str], rows: FloatArray) -> Self | None:
        """Return the box of an item ``BOX BOUNDS`` and its three lines; None if they are inconsistent.

        Bounds of a tilted box are those of the box around it.

        Examples
        --------
        >>> Box.of(["xy", "xz", "yz", "pp", "pp", "ss"], np.array([[0.0, 12.0, 2.0], [0, 5, 0], [0, 1, 0]])).edges[1]
        array([2., 5., 0.])
        """
        flags = [word for word in words if len(word) == 2 and set(word) <= set("pfsm")]
        periodic = tuple(flag[0] == "p" for flag in flags) if len(flags) == 3 else None
        if "abc" in words:
            return cls(rows[:, :3], periodic) if rows.shape[1] == 4 else None
        if rows.shape[1] not in (2, 3):
            return None
        xy, xz, yz = rows[:, 2] if rows.shape[1] == 3 else np.zeros(3)
        tilt_spans = np.array([np.ptp([0.0, xy, xz, xy + xz]), np.ptp([0.0, yz]), 0.0])
        edges = np.diag(rows[:, 1] - rows[:, 0] - tilt_spans)
        edges[1, 0], edges[2, 0], edges[2, 1] = xy, xz, yz
        return cls(edges, periodic)

    def crossed(self, axes: Sequence[int]) -> list[int]:
        """Return the indices of periodic box edges that have a component along one of the given axes."""
        return [k for k in range(3) if (self.periodic is None or self.periodic[k]) and self.edges[k, list(axes)].any()]


@dataclass(frozen=True, eq=False)
class Snapshot:
    """Snapshot of a dump: step, time, box, columns by name, agents in the order of their ids.

    A column of words, such as element, is NaN.
    """

    step: int
    time: float | None
    box: Box | None
    columns: dict[str, FloatArray]


def read_dump(
    path: Path,
    dt: float | None,
    m: int | None,
    needed: str = "",
    ensure_fits: Callable[[int], object] = lambda m: None,
    *,
    wrapped: bool = False,
) -> dict[str, Any]:
    """Return t, ids, q, steps, and p and u if present or named in `needed`.

    The dimension is passed to `ensure_fits` before places are unwrapped; `wrapped` ones may stay so.
    """
    snapshots = _snapshots(path)
    columns = snapshots[0].columns
    if dt is None and any(each.time is None for each in snapshots):
        raise ArgumentError(f"dt = None: {path} has no times; give the step, or dump with `dump_modify ... time yes`")
    if dt is not None and not needed and not any(each.time is None for each in snapshots):
        raise ArgumentError(f"{path} has times, and dt = {dt:g} is given: expected one of them; leave dt= out")
    t = np.array([each.step * (dt or 0.0) if each.time is None else each.time for each in snapshots])
    if not (np.diff(t) > 0.0).all():
        k = int(np.argmin(np.diff(t)))
        raise FileError(f"{path}: snapshot {k + 1} at t = {t[k + 1]:g} follows t = {t[k]:g}; expected rising times")
    size = _dimension(columns, m, path)
    ensure_fits(size)
    arrays = {"t": t, "ids": columns["id"], "q": np.stack([_places(each, size, path, wrapped) for each in snapshots])}
    for kind, name in (("p", "v"), ("u", "f")):
        if f"{name}x" in columns or kind in needed:
            axes = [f"{name}{axis}" for axis in AXES[:size]]
            if not columns.keys() >= set(axes):
                raise ArgumentError(
                    f"{path} has the columns {', '.join(columns)}: expected {' '.join(axes)} among them"
                )
            arrays[kind] = np.stack([np.stack([each.columns[axis] for axis in axes], axis=1) for each in snapshots])
    return arrays | {"steps": snapshots[-1].step - snapshots[0].step}


def _dimension(columns: Collection[str], m: int | None, path: object) -> int:
    """Return the requested dimension, by default that of the positions in the dump."""
    axis_count = len([*takewhile(lambda axis: {axis, f"{axis}u"} & {*columns}, AXES)])
    if axis_count == 0:
        raise ArgumentError(
            f"{path} has the columns {', '.join(columns)}: expected positions x, y, z or xu, yu, zu "
            "(not scaled ones), such as `dump ... custom N FILE id x y vx vy fx fy`"
        )
    if m is None:
        return axis_count
    if m not in range(1, axis_count + 1):
        raise ArgumentError(f"m = {m!r}: expected 1 to {axis_count}, of which {path} has positions")
    return m


def _places(snapshot: Snapshot, m: int, path: object, may_stay: bool) -> FloatArray:
    """Return the positions of a snapshot, shape (n, m), unwrapped by image flags if present."""
    columns, wrapped_axes = snapshot.columns, [k for k in range(m) if f"{AXES[k]}u" not in snapshot.columns]
    q = np.stack([columns[AXES[k] if k in wrapped_axes else f"{AXES[k]}u"] for k in range(m)], axis=1)
    if snapshot.box is None or not wrapped_axes:
        return q
    images = [k for k in range(3) if f"i{AXES[k]}" in columns]
    lost_axes = [k for k in snapshot.box.crossed(wrapped_axes) if k not in images]
    if lost_axes and not may_stay:
        condition = "is periodic" if snapshot.box.periodic else "may be periodic"
        faces, axes = ", ".join(AXES[k] for k in lost_axes), [AXES[k] for k in wrapped_axes]
        raise ArgumentError(
            f"{path}: the box {condition} in {faces}, and {' '.join(axes)} are wrapped into it: expected "
            f"{' '.join(f'{axis}u' for axis in axes)}, or {' '.join(f'i{AXES[k]}' for k in lost_axes)} beside them; "
            "dump them, run LAMMPS with `boundary s s s`, or give read_recording box=, the periods"
        )
    for k in images:
        q[:, wrapped_axes] += columns[f"i{AXES[k]}"][:, None] * snapshot.box.edges[k, wrapped_axes]
    return q


def _snapshots(path: Path) -> list[Snapshot]:
    """Return the snapshots of a dump, each with the same agents."""
    with opened(path, "a text dump of LAMMPS") as file, TextIOWrapper(file, "utf-8") as text:
        snapshots = list(_parsed(text, path))
    if not snapshots:
        raise FileError(f"{path} holds no snapshot: expected a text dump of LAMMPS, style custom")
    ids = snapshots[0].columns["id"]
    for before, next_snapshot in pairwise(snapshots):
        if next_snapshot.step <= before.step:
            raise FileError(f"{path}: step {next_snapshot.step} follows step {before.step}; expected rising steps")
    for k, snapshot in enumerate(snapshots):
        if snapshot.columns.keys() != snapshots[0].columns.keys() or not np.array_equal(snapshot.columns["id"], ids):
            raise FileError(
                f"{path}: snapshot {k} has {len(snapshot.columns['id'])} agents or columns that are not those of the "
                f"first ({len(ids)}); were agents lost? expected the same agents throughout"
            )
    return snapshots


def _parsed(file: TextIO, path: Path) -> Iterator[Snapshot]:
    """Yield a LAMMPS dump's snapshots, each of which ends with its atoms."""
    step, time, count, box = None, None, None, None
    for line in file:
        if not line.startswith("ITEM:"):
            if line.strip():
                raise FileError(f"{path}: {line.strip()[:40]!r} where an ITEM was expected; is it a damaged dump?")
            continue
        item = line[len("ITEM:") :].split()
        if item[:1] == ["TIMESTEP"]:
            step = _read_integer(file, "step", 0, path)
        elif item[:1] == ["TIME"]:
            time = float(_numbers(file, 1, 1, path)[0, 0])
        elif item[:3] == ["NUMBER", "OF", "ATOMS"]:
            count = _read_integer(file, "number of atoms", 1, path)
        elif item[:2] == ["BOX", "BOUNDS"]:
            box = Box.of(item[2:], _numbers(file, 3, None, path))
            if box is None:
                raise FileError(f"{path}: {line.strip()[:60]!r} has invalid bounds; expected a box of LAMMPS")
        elif item[:1] == ["UNITS"]:
            next(file, "")
        elif item[:1] == ["ATOMS"]:
            if step is None or count is None or "id" not in item or len(set(item)) < len(item):
                raise FileError(
                    f"{path}: atoms without a step, a number or ids, or with a column twice; expected a dump of style "
                    "custom with id"
                )
            yield Snapshot(step, time, box, _columns(file, item[1:], count, path))
            step, time, count, box = None, None, None, None
        else:
            raise FileError(f"{path}: unknown item {line.strip()[:40]!r}; expected a dump of atoms, style custom")
    if step is not None:
        raise FileError(f"{path} ends within the snapshot of step {step}; was it cut off? expected its atoms")


def _columns(file: TextIO, names: list[str], count: int, path: Path) -> dict[str, FloatArray]:
    """Return the columns of a snapshot by name, with agents in the order of their ids."""
    values = _numbers(file, count, len(names), path, words=[k for k, name in enumerate(names) if name in _WORDS])
    columns = {name: values[:, k] for k, name in enumerate(names)}
    order = np.argsort(columns["id"], kind="stable")
    if (np.diff(columns["id"][order]) == 0.0).any():
        raise FileError(f"{path}: a snapshot has two agents of one id; expected each once")
    return {name: column[order] for name, column in columns.items()}


def _read_integer(file: TextIO, name: str, least: int, path: Path) -> int:
    value = float(_numbers(file, 1, 1, path)[0, 0])
    if not least <= value <= _LARGEST or value != int(value):
        raise FileError(f"{path}: {name} {value:g}; expected a whole number >= {least}; is it a damaged dump?")
    return int(value)


def _numbers(file: TextIO, rows: int, width: int | None, path: Path, *, words: Sequence[int] = ()) -> FloatArray:
    """Return the next lines as numbers, (rows, width), NaN for words; raise with a description of the fault."""
    lines = list(islice(file, rows))
    cells = [line.split() for line in lines]
    width = len(cells[0]) if width is None and cells else width
    bad_line = next((line for line, row in zip(lines, cells, strict=True) if len(row) != width), None)
    cut = bool(lines) and not lines[-1].endswith("\n")  # LAMMPS ends every line: the last number may be half of one
    if len(lines) < rows or bad_line is not None or cut:
        text = "the end of the file" if bad_line is None else repr(bad_line.strip()[:60])
        width_text = "" if width is None else f"{width} "
        raise FileError(f"{path}: {text} where {rows} lines of {width_text}numbers were expected; was it cut off?")
    for row in cells:
        for k in words:
            row[k] = "nan"
    try:
        values = np.array(cells, dtype=np.float64)
    except ValueError:
        values = np.array([[_number(cell) for cell in row] for row in cells])
    is_invalid = ~np.isfinite(values)
    is_invalid[:, list(words)] = False
    if is_invalid.any():
        k, j = np.argwhere(is_invalid)[0].tolist()
        raise FileError(
            f"{path}: {cells[k][j]!r} in column {j + 1} of {lines[k].strip()[:60]!r}; expected a finite number; is the "
            "dump damaged, or did the run blow up?"
        )
    return values


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return np.nan
