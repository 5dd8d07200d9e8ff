"""A run as frozen data: times, states, inputs, the law that made it; to xarray and to a file and back."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.checks import FloatArray, ensure_choice, ensure_positive, real_array
from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.base.memory import ResultCache
from flockana.base.scales import Scales
from flockana.base.seals import replace_sealed
from flockana.base.tables import facts_html
from flockana.base.units import rescale
from flockana.base.vectors import centres, lengths
from flockana.dynamics import saved
from flockana.dynamics.between import Between, Course, merged
from flockana.dynamics.tolerance import Floors, ensure_atol, options_in_units, rounding_floors
from flockana.laws.discrete import DiscreteLaw, ensure_law
from flockana.measures.clearance import Clearance, clearance
from flockana.measures.measure import Flock, Measure, Series, measures
from flockana.measures.metrics import cohesion_radius
from flockana.measures.path_bounds import ClosestApproach, closest_approach, cohesion_bound

if TYPE_CHECKING:
    import xarray


PLOTS, PLAYER = "flockana.plots", "flockana.player"  # who draws is named, not imported: this room lies below
_KINDS = {"extra": "series by name", "stats": "facts by name", "between": "a Between, or None"}
STATUSES = ("complete", "interrupted", "failed")


def _frozen_series(name: str, values: Any, samples: int) -> FloatArray:
    """A read-only view of a series of finite real numbers; the caller's array stays as it was."""
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
class Trajectory(ResultCache):
    """A sampled run of `simulate`; made by hand, a recording, which has metrics and plots but no verdicts.

    Parameters
    ----------
    t : ndarray, shape (T,)
        Sample times.
    q, p, u : ndarray, shape (T, n, m)
        Positions, velocities, accelerations at the samples.
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
        ensure_law(self.law)
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
            others = [np.shape(each) for each in (self.t, self.p, self.u)]
        except ValueError:
            raise ArgumentError("t, q, p, u: expected arrays, got rows of different lengths") from None
        if len(shape) != 3 or others != [shape[:1], shape, shape]:
            raise ArgumentError(
                f"t {others[0]}, q {shape}, p {others[1]}, u {others[2]}: "
                "expected shapes (T,), (T, n, m), (T, n, m), (T, n, m)"
            )
        if 0 in shape or shape[2] > 3:
            raise ArgumentError(f"q has shape {shape}: expected T >= 1 samples of n >= 1 agents in m = 1, 2 or 3")
        for name in ("t", "q", "p", "u"):
            object.__setattr__(self, name, _frozen_series(name, getattr(self, name), shape[0]))
        k = int(np.argmin(np.diff(self.t))) if shape[0] > 1 else 0
        if shape[0] > 1 and not self.t[k + 1] > self.t[k]:
            raise ArgumentError(f"t[{k}] = {self.t[k]:g} and t[{k + 1}] = {self.t[k + 1]:g}: expected rising times")
        extra = {str(key): _frozen_series(f"extra[{key!r}]", x, shape[0]) for key, x in self.extra.items()}
        object.__setattr__(self, "extra", extra)
        if self.between is not None:
            self.between.check_fits(self.t, self.q)

    def __repr__(self) -> str:
        """One line: arrays of thousands of numbers tell nobody anything."""
        span, law = f"t = {self.t[0]:g} to {self.t[-1]:g}", type(self.law).__name__
        return f"<Trajectory of {self.n} agents, m = {self.m}, {law}, {len(self.t)} samples, {span}, {self.status}>"

    def facts(self) -> dict[str, str]:
        """Return what a table shows: sizes, times, method and status."""
        steps = f", {self.stats['steps']} steps" if "steps" in self.stats else ""
        return {
            "law": type(self.law).__name__,
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
            return self.law.scales  # type: ignore[no-any-return]
        extent = float(lengths(self.q - centres(self.q)[:, None]).max())
        travel = float(lengths(self.q - self.q[0]).max())
        return Scales(extent or travel or 1.0, float(self.t[-1] - self.t[0]) or 1.0)

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

    @cached_property
    def _flows(self) -> tuple[FloatArray, FloatArray]:
        """(u, dH/dt) of the law at the samples."""
        flows = [self.law.flow(t, q, p) for t, q, p in zip(self.t, self.q, self.p, strict=True)]
        return np.array([u for u, _ in flows]), np.array([rate for _, rate in flows])

    @property
    def n(self) -> int:
        """Number of agents."""
        return int(self.q.shape[1])

    @property
    def m(self) -> int:
        """Dimension of space."""
        return int(self.q.shape[2])

    def energy(self) -> FloatArray:
        """The law's energy H at each sample, shape (T,)."""
        return self._energy.copy()

    @cached_property
    def _energy(self) -> FloatArray:
        return np.array([self.law.hamiltonian(t, q, p) for t, q, p in zip(self.t, self.q, self.p, strict=True)])

    def energy_rate(self) -> FloatArray:
        """dH/dt in closed form at each sample, shape (T,)."""
        return self._flows[1].copy()

    @property
    def energy_residual(self) -> FloatArray:
        """H − ∫ dH/dt less that of the first sample, (T,): what the integration got wrong, by the energy identity.

        Raises
        ------
        ArgumentError
            If the run carries no ``extra["work"]``: its law has no energy, or `simulate` did not make it.
        """
        if "work" not in self.extra:
            raise ArgumentError(
                "this run has no energy balance: it carries no extra['work'], the integral of dH/dt, which simulate "
                "adds where the law has an energy; energy() gives H alone"
            )
        energy, work = self.energy(), self.extra["work"]
        residual: FloatArray = energy - energy[0] - (work - work[0])  # the first may be later than the start
        return residual

    @cached_property
    def floors(self) -> Floors:
        """Least absolute error (place, speed, work) that any sample may carry: the tolerance of one step, or rounding.

        An adaptive solver lets every step be wrong by this much whatever the state, so that positions, velocities and
        the energy balance mean nothing below it. It bounds no error from above: steps add up, and stiff forces at rest
        were seen to shake a flock by 300 times it. A fixed step and a map have no tolerance: only rounding counts.
        """
        energies = [self.extra[name] for name in ("work",) if name in self.extra]
        if energies:
            energies.append(self.energy())
        rounding = rounding_floors(self.t, self.q, self.p, self.u, np.concatenate(energies or [np.empty(0)]))
        allowed = self.stats.get("floors", rounding)
        return Floors(*map(max, allowed, rounding))

    def metrics(self) -> xarray.Dataset:
        """C, R, Ẽ, K̃ and their companions, and the law's own `measures`, over time: a Dataset of dimension ``time``."""
        return self._metrics

    @cached_property
    def _metrics(self) -> xarray.Dataset:
        import xarray

        shown = [self.measure(name) for name in self._metric_names]
        data = {
            it.name: xarray.Variable("time", self.metric(it.name), {"long_name": it.text, "units": it.unit})
            for it in shown
        }
        return xarray.Dataset(data, coords={"time": self.t})

    @property
    def _metric_names(self) -> tuple[str, ...]:
        any_flock = (name for name, it in measures().items() if it.over_time is not None and it.defined(self.law))
        return tuple(dict.fromkeys((*any_flock, *self._own)))

    def measure(self, name: str) -> Measure:
        """What a metric is in words, its unit, how it is drawn.

        Parameters
        ----------
        name : str
            Its name.

        Raises
        ------
        UnknownNameError
            If there is none of that name, neither for any flock nor for this law.
        """
        of_any = measures().get(name)
        if of_any is not None and of_any.over_time is not None:
            return of_any
        if name in self._own:
            text, _, logarithmic = Series(*self._own[name])
            return Measure(name, text, "", logarithmic=logarithmic)
        raise UnknownNameError("metric", name, self._metric_names)

    def metric(self, name: str) -> FloatArray:
        """One of `metrics` over time, shape (T,), at the cost of that one alone.

        Parameters
        ----------
        name : str
            Its name.

        Raises
        ------
        UnknownNameError
            If there is none of that name for this law.
        """
        if name not in self._measured:
            of_any = measures().get(name)
            if of_any is not None and of_any.over_time is not None and of_any.defined(self.law):
                values = of_any.over_time(self._flock)
            elif name in self._own:  # the law is asked last, which may cost more
                given = Series(*self._own[name]).values
                values = np.fromiter(given() if callable(given) else given, float, len(self.t))
            else:
                raise UnknownNameError("metric", name, self._metric_names)
            self._measured[name] = values
        return self._measured[name].copy()

    def __getstate__(self) -> dict[str, Any]:
        """All but what is remembered: a copy can be written to, and some measures are functions that do not travel."""
        return {name: value for name, value in self.__dict__.items() if name not in ("_memory", "_own")}

    @cached_property
    def _measured(self) -> dict[str, FloatArray]:
        return {}

    @cached_property
    def _own(self) -> Mapping[str, Any]:
        return self.law.measures(self.t, self.q, self.p, self.extra)  # type: ignore[no-any-return]

    @cached_property
    def _flock(self) -> Flock:
        return Flock(self.law, self.q, self.p)

    @cached_property
    def end(self) -> Flock:
        """The flock at the last sample."""
        return Flock(self.law, self.q[-1:], self.p[-1:])

    @cached_property
    def path(self) -> Course:
        """The samples and the solver's own steps between them, in order of time: what bounds at all times rest on."""
        return merged(self.t, self.q, self.p, self.u, self.between)

    @property
    def resolved(self) -> bool:
        """Whether the solver's own steps are known, so that the run can be bounded between its samples.

        They are of a run that `simulate` made, of its windows and files, and of a map; of arrays from elsewhere, or a
        dump that left steps out, nothing is known between samples, and bounds at all times are the trivial ones.
        """
        steps = self.stats.get("steps", np.inf)
        return isinstance(self.law, DiscreteLaw) or self.between is not None or len(self.t) - 1 >= steps

    def closest_approach(self) -> ClosestApproach:
        """The closest two agents come, between samples too; intervals are those between samples."""
        return self._closest

    @cached_property
    def _closest(self) -> ClosestApproach:
        if not self.resolved and len(self.t) > 1 < self.n:
            k = slice(at := int(np.argmin(self.metric("min_distance"))), at + 1)
            seen = closest_approach(self.t[k], self.q[k], self.p[k], self.u[k])
            return replace(seen, lower=0.0, lower_by_interval=np.zeros(len(self.t) - 1))
        approach = closest_approach(*self.path)
        return replace(approach, lower_by_interval=self.over_intervals(np.minimum, approach.lower_by_interval))

    def over_intervals(self, reduce: np.ufunc, values: FloatArray) -> FloatArray:
        """Numbers of the path's intervals, shape (..., S), to one for each interval between samples.

        Parameters
        ----------
        reduce : ufunc
            `numpy.maximum`, `numpy.minimum`.
        values : ndarray
            In the order of `path`.
        """
        if self.between is None:
            return values
        reduced: FloatArray = reduce.reduceat(values, np.searchsorted(self.path.t, self.t[:-1]), axis=-1)
        return reduced

    def min_distance(self) -> float:
        """A lower bound of every distance between two agents at every time of the run.

        It holds given the integrator's accuracy, on steps that resolve the motion (`flockana.kernels.paths`), and is 0
        where the steps are not known (`resolved`); the least distance at the samples is ``metric("min_distance")``.
        """
        return self._closest.lower

    def cohesion_bound(self) -> float:
        """An upper bound of the cohesion radius max ‖q_i − q_c‖ at every time of the run, under the same conditions."""
        bounds = self.cohesion_bounds
        return float(bounds.max()) if bounds.size else cohesion_radius(self.q[0])

    @cached_property
    def cohesion_bounds(self) -> FloatArray:
        """That of each interval between samples, shape (T − 1,)."""
        if not self.resolved:
            return np.full(len(self.t) - 1, np.inf)
        return self.over_intervals(np.maximum, cohesion_bound(*self.path))

    def clearance(self) -> Clearance:
        """How close any agent comes to any obstacle of the law, between samples too; infinite without obstacles."""
        return self._clearance

    @cached_property
    def _clearance(self) -> Clearance:
        path, obstacles = self.path, self.law.obstacles
        if self.resolved or len(self.t) == 1 or not obstacles:
            return clearance(path.t, path.q, path.p, path.u, obstacles, path.slack)
        one = (slice(k, k + 1) for k in range(len(self.t)))
        each = (clearance(self.t[k], self.q[k], self.p[k], self.u[k], obstacles) for k in one)
        seen = min(each, key=lambda found: found.reached)
        return replace(seen, lower=-np.inf, lower_by_obstacle=np.full(len(obstacles), -np.inf))

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
        between, stats = None if self.between is None else self.between.within(self.t, self.t[keep]), self.stats
        if self.resolved and self.between is None and "steps" in stats:
            stats = {**stats, "steps": min(stats["steps"], int(keep.sum()) - 1)}
        part = {name: getattr(self, name)[keep] for name in ("t", "q", "p", "u")}
        return replace_sealed(self, **part, extra=extra, between=between, stats=stats)

    def to_xarray(self) -> xarray.Dataset:
        """The run as an `xarray.Dataset` with dimensions time, agent and axis; the law is in the attributes."""
        return saved.to_xarray(self)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the run, law and parameters included, as netCDF-4; an existing file is replaced only when whole.

        Parameters
        ----------
        path : path-like
            File to write.

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
        return saved.save(self.to_xarray(), path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Trajectory:
        """Read what `save` wrote.

        Parameters
        ----------
        path : path-like
            File to read.

        Raises
        ------
        FileError
            If the file is missing, is no netCDF, is not one of ours, is of a newer format, or is damaged.
        """
        return saved.load(cls, path)
