"""Quantities of a run: energies, metrics over time, and bounds at all times from its steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.base.result_cache import ResultCache
from flockana.base.value_checks import FloatArray
from flockana.dynamics.error_tolerances import ErrorFloors, rounding_floors
from flockana.dynamics.steps_between_samples import Between, Course, merged
from flockana.laws.first_order_law import VelocityLaw
from flockana.measures.clearance import Clearance, clearance
from flockana.measures.measure import Flock, Measure, Series, measures
from flockana.measures.metrics import cohesion_radius
from flockana.measures.path_bounds import ClosestApproach, closest_approach, cohesion_bound

if TYPE_CHECKING:
    import xarray


class MeasuredRun(ResultCache):
    """Base class of `Trajectory`: cached quantities computed from samples, steps and law."""

    if TYPE_CHECKING:
        t: FloatArray
        q: FloatArray
        p: FloatArray
        u: FloatArray
        law: Any
        extra: Mapping[str, FloatArray]
        stats: Mapping[str, Any]
        between: Between | None

    @cached_property
    def _flows(self) -> tuple[FloatArray, FloatArray]:
        """(u, dH/dt) of the law at the samples; a law of first order has no energy."""
        first_order = isinstance(self.law, VelocityLaw)
        flows = [
            (self.law.acceleration(t, q), np.nan) if first_order else self.law.flow(t, q, p)
            for t, q, p in zip(self.t, self.q, self.p, strict=True)
        ]
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
        """H(t) − H(t0) − ∫ dH/dt at each sample, shape (T,): the integration's error, by the energy identity.

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
    def floors(self) -> ErrorFloors:
        """Least error (position, speed, work) to expect at any sample: the tolerance of one step, or rounding.

        An adaptive solver lets every step be wrong by this much whatever the state, so that positions, velocities and
        the energy balance mean nothing below it. It bounds no error from above: steps add up, and stiff forces at rest
        were seen to shake a flock by 300 times it. A fixed step and a map have no tolerance: only rounding counts.
        """
        energies = [self.extra[name] for name in ("work",) if name in self.extra]
        if energies:
            energies.append(self.energy())
        rounding = rounding_floors(self.t, self.q, self.p, self.u, np.concatenate(energies or [np.empty(0)]))
        allowed = self.stats.get("floors", rounding)
        return ErrorFloors(*map(max, allowed, rounding))

    def metrics(self) -> xarray.Dataset:
        """Measures of the run over time, and the law's own, as a Dataset of dimension ``time``."""
        return self._metrics

    @cached_property
    def _metrics(self) -> xarray.Dataset:
        import xarray

        series = [self.measure(name) for name in self._metric_names]
        data = {
            it.name: xarray.Variable("time", self.metric(it.name), {"long_name": it.text, "units": it.unit})
            for it in series
        }
        return xarray.Dataset(data, coords={"time": self.t})

    @property
    def _metric_names(self) -> tuple[str, ...]:
        general_names = (name for name, it in measures().items() if it.over_time is not None and it.defined(self.law))
        return tuple(dict.fromkeys((*general_names, *self._own)))

    def measure(self, name: str) -> Measure:
        """Return a metric's description: its text, unit and style of drawing.

        Raises
        ------
        UnknownNameError
            If there is none of that name, neither for any flock nor for this law.
        """
        known_measure = measures().get(name)
        if known_measure is not None and known_measure.over_time is not None:
            return known_measure
        if name in self._own:
            text, _, logarithmic = Series(*self._own[name])
            return Measure(name, text, "", logarithmic=logarithmic)
        raise UnknownNameError("metric", name, self._metric_names)

    def metric(self, name: str) -> FloatArray:
        """Return one of `metrics` over time, shape (T,), without computing the others.

        Raises
        ------
        UnknownNameError
            If there is none of that name for this law.
        """
        if name not in self._measured:
            known_measure = measures().get(name)
            if known_measure is not None and known_measure.over_time is not None and known_measure.defined(self.law):
                values = known_measure.over_time(self._flock)
            elif name in self._own:  # the law is asked last, which may cost more
                own_values = Series(*self._own[name]).values
                values = np.fromiter(own_values() if callable(own_values) else own_values, float, len(self.t))
            else:
                raise UnknownNameError("metric", name, self._metric_names)
            self._measured[name] = values
        return self._measured[name].copy()

    def __getstate__(self) -> dict[str, Any]:
        """Return the run's data for pickling, without cached results."""
        return {name: value for name, value in self.__dict__.items() if name not in ("_memory", "_own")}

    @cached_property
    def _measured(self) -> dict[str, FloatArray]:
        return {}

    @cached_property
    def _own(self) -> Mapping[str, Any]:
        return self.law.measures(self.t, self.q, self.p, self.extra)

    @cached_property
    def _flock(self) -> Flock:
        return Flock(self.law, self.q, self.p)

    @cached_property
    def end(self) -> Flock:
        """The flock at the last sample."""
        return Flock(self.law, self.q[-1:], self.p[-1:])

    @cached_property
    def path(self) -> Course:
        """Samples and solver steps in order of time, the basis of bounds at all times."""
        return merged(self.t, self.q, self.p, self.u, self.between)

    @property
    def resolved(self) -> bool:
        """Whether the solver's steps are known, so that bounds between samples exist.

        They are of a run that `simulate` made, of its windows and files, and of a map; of arrays from elsewhere, or a
        dump that left steps out, nothing is known between samples, and bounds at all times are the trivial ones.
        """
        steps = self.stats.get("steps", np.inf)
        return bool(self.law.is_map) or self.between is not None or len(self.t) - 1 >= steps

    def closest_approach(self) -> ClosestApproach:
        """Return the closest approach of two agents, between samples too, for each interval between samples."""
        return self._closest

    @cached_property
    def _closest(self) -> ClosestApproach:
        if not self.resolved and len(self.t) > 1 < self.n:
            k = slice(closest_index := int(np.argmin(self.metric("min_distance"))), closest_index + 1)
            nearest = closest_approach(self.t[k], self.q[k], self.p[k], self.u[k])
            return replace(nearest, lower=0.0, lower_by_interval=np.zeros(len(self.t) - 1))
        approach = closest_approach(*self.path)
        return replace(approach, lower_by_interval=self.over_intervals(np.minimum, approach.lower_by_interval))

    def over_intervals(self, reduce: np.ufunc, values: FloatArray) -> FloatArray:
        """Reduce values on the intervals between solver steps to one for each interval between samples.

        Parameters
        ----------
        reduce : ufunc
            `numpy.maximum`, `numpy.minimum`.
        values : ndarray
            In the order of `path`.
        """
        if self.between is None:
            return values
        interval_values: FloatArray = reduce.reduceat(values, np.searchsorted(self.path.t, self.t[:-1]), axis=-1)
        return interval_values

    def min_distance(self) -> float:
        """A lower bound of every distance between two agents at every time of the run.

        It holds given the integrator's accuracy, on steps that resolve the motion (`flockana.kernels.quintic_paths`).
        It is 0 where steps are not known (`resolved`); the least distance at the samples is ``metric("min_distance")``.
        """
        return self._closest.lower

    def cohesion_bound(self) -> float:
        """An upper bound of max ‖q_i − q_c‖ at every time, under the conditions of `min_distance`."""
        bounds = self.cohesion_bounds
        return float(bounds.max()) if bounds.size else cohesion_radius(self.q[0])

    @cached_property
    def cohesion_bounds(self) -> FloatArray:
        """Upper bound of the cohesion radius over each interval between samples, shape (T − 1,)."""
        if not self.resolved:
            return np.full(len(self.t) - 1, np.inf)
        return self.over_intervals(np.maximum, cohesion_bound(*self.path))

    def clearance(self) -> Clearance:
        """Return the least clearance of agents from obstacles, between samples too; infinite without obstacles."""
        return self._clearance

    @cached_property
    def _clearance(self) -> Clearance:
        path, obstacles = self.path, self.law.obstacles
        if self.resolved or len(self.t) == 1 or not obstacles:
            return clearance(path.t, path.q, path.p, path.u, obstacles, path.slack)
        slices = (slice(k, k + 1) for k in range(len(self.t)))
        clearances = (clearance(self.t[k], self.q[k], self.p[k], self.u[k], obstacles) for k in slices)
        approach = min(clearances, key=lambda found: found.reached)
        return replace(approach, lower=-np.inf, lower_by_obstacle=np.full(len(obstacles), -np.inf))
