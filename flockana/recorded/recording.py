"""Recorded flock: samples, gaps, and accuracy."""

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, fields, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
import numpy.typing as npt

from flockana.base.errors import ArgumentError, FileError, format_value
from flockana.base.files import atomic_write, ensure_path
from flockana.base.result_cache import ResultCache
from flockana.base.units import times
from flockana.base.value_checks import FloatArray, ensure_flag, ensure_known, normalise
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.discrete import ensure_law
from flockana.recorded.accuracy import Accuracy, Kind, band, ensure_error
from flockana.recorded.complete_parts import largest_complete_part
from flockana.recorded.unknown_law import UnknownLaw, scaled_alpha
from flockana.recorded.velocities import filled, with_velocities

if TYPE_CHECKING:
    import xarray

_FARTHEST = 1e50  # size of a number whose fifth power, as smoothing takes it, is finite
_ERRORS = ("bound", "sd", "p_bound", "p_sd")
_UNITS = dict.fromkeys(("q", "bound", "sd"), (1, 0)) | dict.fromkeys(("p", "p_bound", "p_sd"), (1, -1))
_UNITS |= {"t": (0, 1), "u": (1, -2)}


@dataclass(frozen=True, eq=False)
class Recording(ResultCache):
    """Samples of a recorded flock, with gaps as NaN and the accuracy of its numbers.

    Parameters
    ----------
    t : array_like, shape (T,)
        Sample times, rising.
    q : array_like, shape (T, n, m)
        Positions; NaN where an agent was not seen.
    p, u : array_like, shape (T, n, m), optional
        Velocities and accelerations. At a map's sample, u is the input that is applied from there on.
    bound : float or array_like of shape (T, n), optional
        Largest distance of a recorded position from the true one; 0 for numbers that are exact but for rounding.
    sd : float or array_like of shape (T, n), optional
        Standard deviation of each coordinate, independent and Gaussian; instead of `bound`. Enclosures are the band
        that holds of all samples at once with probability 0.99, and verdicts have the rigour "statistical".
    p_bound, p_sd : float or array_like of shape (T, n), optional
        The same of velocities; by default those of the positions over the interval between samples.
    estimated : bool
        Whether the accuracy was estimated from the data: then it decides nothing.
    smoothed : bool
        Whether velocities come from positions (`with_velocities`): then verdicts and fits rest on the positions alone.
    ids : sequence of str, optional
        Names of the agents; by default their numbers.
    source : str
        Where it comes from.
    read_as : sequence of str
        Which column of the source became what, and from which unit, as `read_recording` says.

    Raises
    ------
    ArgumentError
        On arrays that do not fit each other, infinite numbers, times that do not rise, an agent that is never seen, or
        an accuracy given twice.

    Examples
    --------
    >>> rec = Recording([0.0, 0.1], [[[0.0], [7.0]], [[0.1], [np.nan]]], bound=1e-3)
    >>> rec.n, rec.gaps
    (2, 1)
    """

    t: FloatArray
    q: FloatArray
    p: FloatArray | None = None
    u: FloatArray | None = None
    _: KW_ONLY
    bound: Any = None
    sd: Any = None
    p_bound: Any = None
    p_sd: Any = None
    estimated: bool = False
    smoothed: bool = False
    ids: Sequence[str] = ()
    source: str = ""
    read_as: Sequence[str] = ()

    def __post_init__(self) -> None:
        q = _with_gaps("q", self.q)
        if q.ndim != 3 or 0 in q.shape or q.shape[2] > 3:
            raise ArgumentError(
                f"q has shape {q.shape}: expected (T, n, m), T >= 1 samples of n >= 1 agents in m = 1, 2 or 3"
            )
        t = np.ascontiguousarray(_with_gaps("t", self.t))
        if t.shape != q.shape[:1] or np.isnan(t).any():
            raise ArgumentError(
                f"t has shape {t.shape}: expected {len(q)} times without gaps, one for each sample of q"
            )
        if (time_faults := ~(np.diff(t) > 0.0)).any():
            k = int(np.argmax(time_faults))
            raise ArgumentError(f"t[{k}] = {t[k]:g} and t[{k + 1}] = {t[k + 1]:g}: expected rising times; sort them")
        arrays = {"t": t, "q": q} | {k: _with_gaps(k, getattr(self, k)) for k in "pu" if getattr(self, k) is not None}
        for name, array in arrays.items():
            if name in "pu" and array.shape != q.shape:
                raise ArgumentError(f"{name} has shape {array.shape}: expected {q.shape}, as q has")
            object.__setattr__(self, name, _frozen(array))
        unseen = np.flatnonzero(~self.present.any(axis=0))
        if unseen.size:
            raise ArgumentError(f"q[:, {unseen[0]}] is NaN throughout: expected agents that are seen; leave it out")
        self._check_accuracy()
        object.__setattr__(self, "read_as", tuple(map(str, self.read_as)))
        object.__setattr__(self, "ids", tuple(str(i) for i in self.ids) or tuple(map(str, range(self.n))))
        if len(self.ids) != self.n:
            raise ArgumentError(f"ids has {len(self.ids)} names: expected {self.n}, one for each agent")

    def _check_accuracy(self) -> None:
        ensure_flag("estimated", self.estimated)
        ensure_flag("smoothed", self.smoothed)
        errors = [
            name for name in _ERRORS if getattr(self, name) is not None and not (self.smoothed and name == "p_sd")
        ]
        if len({name.removeprefix("p_") for name in errors}) > 1:
            raise ArgumentError(
                f"{' and '.join(errors)} are given: expected one kind of accuracy, bound and p_bound, or sd and p_sd"
            )
        normalise(self, lambda name, value: ensure_error(name, value, self.q.shape[:2]), *_ERRORS)

    def __repr__(self) -> str:
        gaps = f", {self.gaps} gaps" if self.gaps else ""
        start, end = (f"{x:.{_digits(self.t)}g}" for x in (self.t[0], self.t[-1]))
        text = f"Recording of {self.n} agents, m = {self.m}, {len(self.t)} samples, t = {start} to {end}{gaps}"
        reading_text = f"; read as {'; '.join(self.read_as)}" if self.read_as else ""
        return f"<{text}, {self.accuracy}{reading_text}>"

    @property
    def n(self) -> int:
        """Number of agents."""
        return int(self.q.shape[1])

    @property
    def m(self) -> int:
        """Dimension of space."""
        return int(self.q.shape[2])

    @property
    def interval(self) -> float:
        """Median interval between samples; 1 for a single sample."""
        return float(np.median(np.diff(self.t))) if len(self.t) > 1 else 1.0

    @cached_property
    def present(self) -> npt.NDArray[np.bool_]:
        """Whether an agent was seen at a sample, shape (T, n)."""
        return ~np.isnan(self.q[:, :, 0])

    @property
    def gaps(self) -> int:
        """Number of positions that are missing."""
        return int((~self.present).sum())

    @cached_property
    def accuracy(self) -> Accuracy:
        """Error bounds (half widths) of recorded positions and velocities, and whether stated or estimated."""
        if self.bound is None and self.sd is None:
            return Accuracy(np.inf, np.inf, "unknown")
        kind: Kind = "estimated" if self.estimated or self.smoothed else "sd" if self.bound is None else "bound"
        width = band(2 * self.q.shape[0] * self.n, self.m)
        position_error, speed = self.bound, self.p_bound
        if position_error is None:
            position_error = times(self.sd, width)
        if position_error is not self.bound or self.smoothed:
            speed = times(self.p_sd, width)
        return Accuracy(position_error, position_error / self.interval if speed is None else speed, kind)

    def window(self, start: float, end: float) -> Self:
        """Return the recording restricted to the samples between two times.

        Parameters
        ----------
        start, end : float
            First and last time.

        Raises
        ------
        ArgumentError
            If there is no sample in between.
        """
        return self.select(samples=(self.t >= start) & (self.t <= end))

    def select(self, *, samples: Any = slice(None), agents: Any = None) -> Self:
        """Return the recording restricted to some samples of some agents.

        Parameters
        ----------
        samples : index array, bool array or slice
            Which samples.
        agents : index array, bool array, slice or sequence of str, optional
            Which agents, by number or name; by default those that are seen at some of the samples.
        """
        if agents is None:
            agents = self.present[samples].any(axis=0)
        elif not isinstance(agents, slice) and np.asarray(agents).dtype.kind in "UO":
            agents = [self.ids.index(ensure_known("agent", str(name), self.ids)) for name in agents]
        change: dict[str, Any] = {"t": self.t[samples], "ids": np.array(self.ids)[agents].tolist()}
        if not (len(change["t"]) and len(change["ids"])):
            raise ArgumentError("no sample or no agent is left: expected a selection that holds one")
        for name in ("q", "p", "u", *_ERRORS):
            value = getattr(self, name)
            change[name] = value[samples][:, agents] if isinstance(value, np.ndarray) else value
        return replace(self, **change)

    def complete(self) -> Self:
        """Return the gap-free part with most positions: a window, and the agents seen throughout it."""
        samples, agents = largest_complete_part(self.present)
        return self.select(samples=samples, agents=agents)

    def to_xarray(self) -> "xarray.Dataset":
        """Return an `xarray.Dataset` as in the package `movement`: position over time, space, individuals."""
        from flockana.recorded.dataset import dataset_of

        return dataset_of(self)

    def in_units(self, length: float, time: float) -> Self:
        """Return the same recording in other units (`flockana.rescale`).

        Parameters
        ----------
        length, time : float
            Factors of lengths and times.
        """
        return replace(self, **{k: times(getattr(self, k), length**a * time**b) for k, (a, b) in _UNITS.items()})

    def ensure_complete(self, purpose: str) -> None:
        """Raise if there are gaps, naming the first one.

        Parameters
        ----------
        purpose : str
            What needs every agent.
        """
        if self.gaps:
            k, i = (int(x) for x in np.argwhere(~self.present)[0])
            raise ArgumentError(
                f"{purpose} needs every agent at every sample, and agent {self.ids[i]} is missing at t = "
                f"{self.t[k]:g} ({self.gaps} gaps): take complete(), choose by window(start, end) or "
                "select(samples=, agents=), or fill gaps by filled(most_acceleration=)"
            )

    def filled(self, *, most_acceleration: float | None = None, longest: float | None = None) -> "Recording":
        """Return the recording with gaps filled, each filled position with an error bound for all allowed motions.

        Parameters
        ----------
        most_acceleration : float, optional
            Largest acceleration that an agent can have; without it gaps stay open, as the samples bound no motion that
            was not seen.
        longest : float, optional
            Longest gap that is filled, in time.
        """
        return filled(self, most_acceleration, longest)

    def with_velocities(self) -> "Recording":
        """Return the recording with velocities and accelerations from its positions, by smoothing splines.

        Beside a gap they are what the samples on that side say; of fewer than four samples between gaps they are NaN.
        """
        return with_velocities(self)

    @property
    def measured(self) -> "Recording":
        """Recording without velocities derived from its positions; the recording itself if there are none."""
        return replace(self, p=None, u=None, p_sd=None, smoothed=False) if self.smoothed else self

    def metrics(self, *, d: float, r: float) -> "xarray.Dataset":
        """Return measures of the flock over time, each with its error as ``<name>_error``.

        Parameters
        ----------
        d, r : float
            Scale and interaction range that nets and lattices are measured with.
        """
        from flockana.recorded.recorded_measures import measured

        return measured(self, d, r)

    def trajectory(self, law: Any = None, *, d: float | None = None, r: float | None = None) -> Trajectory:
        """Return the samples as a `Trajectory` for plots, films and the player, not for verdicts.

        Parameters
        ----------
        law : Law, optional
            A law whose links and obstacles are drawn.
        d, r : float, optional
            Without a law: scale and interaction range, d = r/1.2 by default.

        Raises
        ------
        ArgumentError
            If there are gaps.
        """
        self.ensure_complete("a trajectory")
        rec = self if self.p is not None else self.with_velocities()
        assert rec.p is not None
        if np.isnan(rec.p).any():
            raise ArgumentError(f"{len(rec.t)} samples: expected 4 or more in a row for velocities, or velocities")
        speed = float(np.sqrt(np.nanmean(rec.p**2) * rec.m))
        if law is None:
            alpha = None if d is None and r is None else scaled_alpha(d, r)
            length_scale = 1.0 if alpha is None else alpha.length
            law = UnknownLaw(alpha, length_scale / speed if speed > 0.0 else self.interval, self.interval)
        u = np.zeros(rec.q.shape) if rec.u is None else np.nan_to_num(rec.u)
        return Trajectory(rec.t, rec.q, rec.p, u, ensure_law(law), {}, "complete", f"recorded: {self.source}")

    def save(self, path: Any) -> Path:
        """Write an npz file from which `read_recording` restores the recording with its accuracy.

        Parameters
        ----------
        path : path
            The file, which ends in .npz.

        Raises
        ------
        FileError
            If it cannot be written.
        """
        if ensure_path(path, action="write").suffix != ".npz":
            raise FileError(f"cannot write {str(path)!r}: expected a name that ends in .npz")
        values = {field.name: getattr(self, field.name) for field in fields(self) if field.name != "read_as"}
        with atomic_write(path) as partial:
            np.savez_compressed(partial, **{name: value for name, value in values.items() if value is not None})
        return Path(path)

    def player(self, *, d: float | None = None, r: float | None = None, height: int = 760) -> Any:
        """Return the recording in the player: a notebook shows it, ``.save(path)`` writes a page.

        Parameters
        ----------
        d, r : float, optional
            Scale and interaction range.
        height : int
            Height of its frame in a notebook, in pixels.
        """
        return self.trajectory(d=d, r=r).player(height=height)


def ensure_recording(rec: Any) -> Recording:
    """Return `rec` if it is a recording, or raise."""
    if not isinstance(rec, Recording):
        raise ArgumentError(f"rec = {format_value(rec):.80}: expected a Recording, such as read_recording(file) gives")
    return rec


def recording_of(run: Trajectory, **accuracy: Any) -> Recording:
    """Return the samples of a run as a recording."""
    u = None if run.law.is_map else run.u
    return Recording(run.t, run.q, run.p, u, source=f"a run of {run.law.title}", **accuracy)


def _digits(t: FloatArray) -> int:
    """Return the number of digits needed to distinguish the first and last time."""
    span = float(np.ptp(t))
    return int(min(max(4, 4 + np.ceil(np.log10(np.abs(t).max() / span))), 17)) if span > 0.0 else 6


def _with_gaps(name: str, values: Any) -> FloatArray:
    """Return real numbers with masked ones and NaN as gaps; raise on anything else and on infinities."""
    try:
        masked = isinstance(values, np.ma.MaskedArray)
        array = np.array(np.ma.filled(values.astype(np.float64), np.nan) if masked else values)
    except (ValueError, TypeError):
        raise ArgumentError(f"{name}: expected an array of numbers, got rows of different lengths") from None
    if array.dtype.kind not in "fiu":
        raise ArgumentError(f"{name}: expected real numbers, got {format_value(array.dtype.name)}")
    array = array.astype(np.float64)
    if (is_far := np.abs(array) > _FARTHEST).any():
        at = tuple(np.argwhere(is_far)[0].tolist())
        where, limit = ", ".join(map(str, at)), f"{_FARTHEST:g}"
        raise ArgumentError(f"{name}[{where}] = {array[at]:g}: expected numbers up to {limit} in size, NaN for a gap")
    return array


def _frozen(array: FloatArray) -> FloatArray:
    """Return a read-only array; a vector with a NaN component becomes NaN as a whole."""
    array = np.ascontiguousarray(array)
    if array.ndim == 3:
        array[np.isnan(array).any(axis=2)] = np.nan
    array.setflags(write=False)
    return array
