"""Run as frozen data: times, states, inputs, and the law; conversion to xarray and files."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.integrity_seals import replace_sealed
from flockana.base.natural_scales import LEAST, MOST, Scales
from flockana.base.table_export import facts_html
from flockana.base.units import rescale
from flockana.base.value_checks import FloatArray, ensure_choice, ensure_positive, real_array
from flockana.base.vector_norms import centres, lengths
from flockana.dynamics import saved_runs
from flockana.dynamics.error_tolerances import ensure_atol, options_in_units
from flockana.dynamics.run_quantities import MeasuredRun
from flockana.dynamics.steps_between_samples import Between
from flockana.laws.first_order_law import ensure_any_law

if TYPE_CHECKING:
    import xarray


PLOTS, PLAYER = "flockana.plots", "flockana.player"  # named, not imported: this room is below both
_KINDS = {"extra": "series by name", "stats": "facts by name", "between": "a Between, or None"}
STATUSES = ("complete", "interrupted", "failed")


def _frozen_series(name: str, values: Any, samples: int) -> FloatArray:
    """Return a read-only copy of a series of finite real numbers."""
    array = np.asarray(values)
    if np.ma.is_masked(values):
        raise ArgumentError(f"{name}: expected numbers at all samples, got masked ones")
    if array.dtype.kind not in "fiu" or array.shape[:1] != (samples,):
        raise ArgumentError(f"{name}: expected real numbers at {samples} samples, got {array.dtype} {array.shape}")
    array = np.ascontiguousarray(array, dtype=np.float64).view()
    bad = ~np.isfinite(array)
    if bad.any():
        k = tuple(int(index) for index in np.argwhere(bad)[0])
        raise ArgumentError(f"{name}[{', '.join(map(str, k))}] = {array[k]}: expected finite numbers ({bad.sum()} bad)")
    array.setflags(write=False)
    return array


@dataclass(frozen=True, eq=False)
class Trajectory(MeasuredRun):
    """Sampled run of `simulate`, or a handmade recording, which has metrics and plots but no verdicts.

    Parameters
    ----------
    t : ndarray, shape (T,)
        Sample times.
    q, p, u : ndarray, shape (T, n, m)
        Positions, velocities, accelerations at the samples; of a law of first order d²q/dt² along its motion.
    law : object
        The law that was integrated.
    extra : mapping of str to ndarray
        Further series over time; ``"work"`` is ∫ dH/dt from the start, where the law has an energy.
    status : {"complete", "interrupted", "failed"}
        How the run ended.
    message : str
        In words.
    stats : mapping
        Method, tolerances, numbers of steps and evaluations, seconds.
    between : Between, optional
        The solver's own steps between the samples, from which bounds at all times are made; None if the samples are
        all there is.

    Raises
    ------
    ArgumentError
        On arrays that do not fit each other, numbers that are not real and finite, times that do not rise, an unknown
        status, a step or a tolerance in `stats` that is no number > 0, or something that is no law.
    """

    t: FloatArray
    q: FloatArray
    p: FloatArray
    u: FloatArray
    law: Any
    extra: Mapping[str, FloatArray] = field(default_factory=dict)
    status: str = "complete"
    message: str = ""
    stats: Mapping[str, Any] = field(default_factory=dict)
    between: Between | None = None

    def __post_init__(self) -> None:
        ensure_any_law(self.law)
        for name, kind in (("extra", Mapping), ("stats", Mapping), ("between", Between | None)):
            if not isinstance(getattr(self, name), kind):
                raise ArgumentError(f"{name} = {getattr(self, name)!r}: expected {_KINDS[name]}")
        ensure_choice("status", self.status, STATUSES)
        for name in ("rtol", "dt", "max_step"):
            if self.stats.get(name) is not None:
                ensure_positive(f"stats[{name!r}]", self.stats[name])
        ensure_atol("stats['atol']", self.stats.get("atol"))
        try:
            shape = np.shape(self.q)
            other_shapes = [np.shape(item) for item in (self.t, self.p, self.u)]
        except ValueError:
            raise ArgumentError("t, q, p, u: expected arrays, got rows of different lengths") from None
        if len(shape) != 3 or other_shapes != [shape[:1], shape, shape]:
            raise ArgumentError(
                f"t {other_shapes[0]}, q {shape}, p {other_shapes[1]}, u {other_shapes[2]}: "
                "expected shapes (T,), (T, n, m), (T, n, m), (T, n, m)"
            )
        if 0 in shape or shape[2] > 3:
            raise ArgumentError(f"q has shape {shape}: expected T >= 1 samples of n >= 1 agents in m = 1, 2 or 3")
        for name in ("t", "q", "p", "u"):
            object.__setattr__(self, name, _frozen_series(name, getattr(self, name), shape[0]))
        k = int(np.argmin(np.diff(self.t))) if shape[0] > 1 else 0
        if shape[0] > 1 and not self.t[k + 1] > self.t[k]:
            raise ArgumentError(f"t[{k}] = {self.t[k]:g} and t[{k + 1}] = {self.t[k + 1]:g}: expected rising times")
        extra_series = {str(key): _frozen_series(f"extra[{key!r}]", x, shape[0]) for key, x in self.extra.items()}
        object.__setattr__(self, "extra", extra_series)
        if self.between is not None:
            self.between.check_fits(self.t, self.q)

    def __repr__(self) -> str:
        """Return a one-line description of the run, without its arrays."""
        span, law = f"t = {self.t[0]:g} to {self.t[-1]:g}", self.law.title
        return f"<Trajectory of {self.n} agents, m = {self.m}, {law}, {len(self.t)} samples, {span}, {self.status}>"

    def facts(self) -> dict[str, str]:
        """Return the rows of the table that describes a run: sizes, times, method and status."""
        steps = f", {self.stats['steps']} steps" if "steps" in self.stats else ""
        return {
            "law": self.law.title,
            "agents": f"{self.n}, m = {self.m}",
            "time": f"{self.t[0]:g} to {self.t[-1]:g}, {len(self.t)} samples{steps}",
            "method": str(self.stats.get("method", "recorded")),
            "status": f"{self.status}: {self.message}" if self.message else self.status,
            "smallest distance": f"{self.min_distance():.4g}",
        }

    def _repr_html_(self) -> str:
        return facts_html("Trajectory", self.facts())

    @cached_property
    def scales(self) -> Scales:
        """The law's natural length and time; under a law that has none, the flock's extent and the run's duration."""
        if self.law.scales is not None:
            return self.law.scales
        with np.errstate(over="ignore"):
            extent = float(lengths(self.q - centres(self.q)[:, None]).max())
            largest_travel = float(lengths(self.q - self.q[0]).max())
        length_scale, time = extent or largest_travel or 1.0, float(self.t[-1] - self.t[0]) or 1.0
        return Scales(*np.clip([length_scale, time], LEAST, MOST).tolist())

    def in_units(self, length: float, time: float) -> Trajectory:
        """The same run in other units (`flockana.rescale`).

        Parameters
        ----------
        length, time : float
            Factors.
        """
        powers = {"work": (2, -2)} | dict(getattr(self.law, "extra_units", {}))
        extra = {
            name: series * length ** powers[name][0] * time ** powers[name][1] if name in powers else series
            for name, series in self.extra.items()
        }
        q, p, u = self.q * length, self.p * (length / time), self.u * (length / time**2)
        stats = options_in_units(self.stats, length, time)
        law = rescale(self.law, length=length, time=time)
        between = None if self.between is None else rescale(self.between, length=length, time=time)
        return replace_sealed(self, t=self.t * time, q=q, p=p, u=u, law=law, extra=extra, stats=stats, between=between)

    def animate(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        seconds: float = 10.0,
        fps: float = 15.0,
        velocities: bool = False,
        ranges: bool = False,
    ) -> Any:
        """The run as a film: a notebook shows it, and with a path it is written as GIF or MP4.

        Parameters
        ----------
        path : path-like, optional
            File to write; the film's ``.save(path)`` does the same.
        seconds : float
            Length of the film.
        fps : float
            Frames per second.
        velocities : bool
            Draw arrows.
        ranges : bool
            Draw circles at the range of interaction about the agents, in the plane.

        Returns
        -------
        flockana.plots.Film, or pathlib.Path with a path
        """
        film = import_module(PLOTS).Film(self, seconds, fps, velocities, ranges)
        return film if path is None else film.save(path)

    def player(self, *, height: int = 760, verdicts: Sequence[Any] = ()) -> Any:
        """The run in a player: a notebook shows it, and so does its export as HTML; ``.save(path)`` writes a page.

        Parameters
        ----------
        height : int
            Of its frame in a notebook, in pixels.
        verdicts : sequence of Verdict
            On the run: the instants that their claims point to are marked.

        Returns
        -------
        flockana.player.Player
        """
        return import_module(PLAYER).Player(self, height, verdicts=tuple(verdicts))

    def window(self, start: float, end: float) -> Trajectory:
        """The samples with start ≤ t ≤ end, as a run of their own.

        Parameters
        ----------
        start, end : float
            Times.

        Raises
        ------
        ArgumentError
            If no sample lies between them.
        """
        try:
            start, end = real_array((start, end)).tolist()  # either may be infinite
        except (TypeError, ValueError):
            raise ArgumentError(f"start = {start!r}, end = {end!r}: expected two times") from None
        keep = (self.t >= start) & (self.t <= end)
        if not keep.any():
            raise ArgumentError(
                f"no sample between {start:g} and {end:g}: the run spans {self.t[0]:g} to {self.t[-1]:g}"
            )
        extra = {name: series[keep] for name, series in self.extra.items()}
        if "work" in extra:
            extra["work"] = extra["work"] - extra["work"][0]
        between_samples, stats = None if self.between is None else self.between.within(self.t, self.t[keep]), self.stats
        if self.resolved and self.between is None and "steps" in stats:
            stats = {**stats, "steps": min(stats["steps"], int(keep.sum()) - 1)}
        window_series = {name: getattr(self, name)[keep] for name in ("t", "q", "p", "u")}
        return replace_sealed(self, **window_series, extra=extra, between=between_samples, stats=stats)

    def to_xarray(self) -> xarray.Dataset:
        """The run as an `xarray.Dataset` with dimensions time, agent and axis; the law is in the attributes."""
        return saved_runs.to_xarray(self)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the run, law and parameters included, as netCDF-4; an existing file is replaced only when whole.

        Returns
        -------
        pathlib.Path

        Raises
        ------
        FileError
            If it cannot be written.
        ArgumentError
            If the law holds something that has no written form, such as a user's function.
        """
        return saved_runs.save(self.to_xarray(), path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Trajectory:
        """Read a run from a file written by `save`.

        Raises
        ------
        FileError
            If the file is missing, is no netCDF, is not one of ours, is of a newer format, or is damaged.
        """
        return saved_runs.load(cls, path)
