"""Law with a disturbance: a force in time, a table, a sinusoid, white noise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import KW_ONLY, dataclass, replace
from functools import cached_property
from math import inf, pi
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.units import scaled_fields
from flockana.base.value_checks import FloatArray, ensure_finite_scalar, ensure_nonnegative, ensure_numbers, normalise
from flockana.kernels import push_kernels as kernel
from flockana.kernels.listed_pairs import no_energy
from flockana.laws.law import Law
from flockana.laws.law_features import Feature
from flockana.laws.terms.term import Compiled, Derivatives, TermKernel
from flockana.laws.wrapper_base import Step, View, Wrapper, input_of, normal_numbers
from flockana.measures.centre_frame import moving_frame

_NOISE = 0  # channel of random numbers


@dataclass(frozen=True)
class Disturbed(Wrapper):
    """u + w: agents are pushed by w(t) = force + swing sin(2π frequency t + phase) + table, and by white noise.

    A force that is a function of time cannot be saved to a file; a table can. An integrator with steps of its own may
    step over a push that is shorter than these: then give `simulate` a `max_step` shorter than the push.

    White noise of intensity s gives a velocity of variance s² t in each coordinate after the time t. Without noise the
    law stays a continuous one, which every method integrates; with noise it is stepped (`simulate(..., dt=)`).

    Parameters
    ----------
    force : array_like, shape (m,) or (n, m), or callable
        Acceleration that is constant, or a function t -> w(t) of that shape: the same for all agents, or one for each.
    swing : array_like, shape (m,) or (n, m)
        Amplitude of an acceleration that swings.
    times, table : array_like, shapes (K,) and (K, m) or (K, n, m)
        Rising times and accelerations there, linear in between; the first holds before, the last afterwards.
    frequency : float
        Cycles per time unit.
    phase : float
        In radians.
    intensity : float
        s >= 0, in length over time to the power 3/2.

    Raises
    ------
    ArgumentError
        On a negative intensity, forces that are none, or a table without times.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> wind = Disturbed(Algorithm1(), force=(0.5, 0.0))
    >>> wind.acceleration(0.0, [[0.0, 0.0]], [[0.0, 0.0]]).tolist()
    [[0.5, 0.0]]
    >>> gust = Disturbed(Algorithm1(), times=(0.0, 1.0), table=((0.0, 0.0), (4.0, 0.0)))
    >>> gust.push(0.25).tolist(), Disturbed(Algorithm1(), force=lambda t: (t, 0.0)).push(3.0).tolist()
    ([1.0, 0.0], [3.0, 0.0])
    """

    law: Law
    _: KW_ONLY
    force: Any = None
    swing: Any = None
    times: Any = None
    table: Any = None
    frequency: float = 0.0
    phase: float = 0.0
    intensity: float = 0.0
    seed: int = 0

    units: ClassVar[Mapping[str, tuple[float, float]]] = {
        **{"force": (1, -2), "swing": (1, -2), "table": (1, -2)},
        **{"times": (0, 1), "frequency": (0, -1), "intensity": (1, -1.5)},
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, axis_count in (("force", 1), ("swing", 1), ("times", 1), ("table", 2)):
            if not callable(getattr(self, name)) or name != "force":
                object.__setattr__(self, name, _pushes(name, getattr(self, name), axis_count))
        if (self.times is None) != (self.table is None) or len(self.times or ()) != len(self.table or ()):
            raise ArgumentError(
                f"times has {len(self.times or ())} numbers and table {len(self.table or ())} rows: expected the same"
            )
        if self.times is not None and (np.ndim(self.times) != 1 or (np.diff(self.times) <= 0.0).any()):
            raise ArgumentError(f"times = {format_value(self.times)}: expected rising times, one for each row of table")
        normalise(self, ensure_nonnegative, "frequency", "intensity")
        normalise(self, ensure_finite_scalar, "phase")

    @property
    def stepped(self) -> bool:  # type: ignore[override]
        """Whether noise requires fixed steps."""
        return self.intensity > 0.0

    def _pushed(self) -> Iterator[tuple[str, Any]]:
        """Yield the name and value of each external force at time 0, of shape (m,) or (n, m)."""
        first_row = None if self.table is None else self.table[0]
        arguments = {"force": self._called(0.0), "swing": self.swing, "table": first_row}
        yield from ((name, push) for name, push in arguments.items() if push is not None)

    def check_dimension(self, m: int) -> None:  # noqa: D102
        super().check_dimension(m)
        for name, push in self._pushed():
            if np.shape(push)[-1] != m:
                raise ArgumentError(f"{name} has {np.shape(push)[-1]} components, the agents {m}: expected the same")

    def check_agents(self, n: int) -> None:  # noqa: D102
        super().check_agents(n)
        for name, push in self._pushed():
            if np.ndim(push) == 2 and len(push) != n:
                raise ArgumentError(f"{name} has {len(push)} rows and there are {n} agents: expected one for each")

    def in_units(self, length: float, time: float) -> Disturbed:
        """Return the law in other units (`flockana.rescale`).

        Parameters
        ----------
        length, time : float
            Factors of lengths and times.
        """
        if not callable(self.force):
            return Disturbed(**scaled_fields(self, length, time))
        called, rest = self._called, replace(self, force=None)
        return replace(rest.in_units(length, time), force=lambda t: length / time**2 * np.asarray(called(t / time)))

    def _called(self, t: float) -> Any:
        """Return the external force, constant or called at a time; None without a force."""
        return _pushes(f"force({t:g})", self.force(t), 1) if callable(self.force) else self.force

    def features(self) -> tuple[Feature, ...]:
        """Return the narrowest features of the law and of the disturbance in time; unknown for a function."""
        times = [inf, *np.diff([] if self.times is None else self.times)]
        swings = 0.25 / self.frequency if self.swing is not None and self.frequency > 0.0 else inf
        width = None if callable(self.force) else float(min(swings, *times))
        return (*super().features(), Feature("the disturbance", "time", width))

    def push(self, t: float) -> FloatArray:
        """Return the disturbance w(t) without its noise, shape (m,) or (n, m); 0 without a force."""
        total: FloatArray = np.zeros(1)
        if self.force is not None:
            total = total + np.asarray(self._called(t))
        if self.swing is not None:
            total = total + np.asarray(self.swing) * np.sin(2.0 * pi * self.frequency * t + self.phase)
        if self.times is not None:
            times, rows = self._table
            k = min(max(int(np.searchsorted(times, t)), 1), len(times) - 1) if len(times) > 1 else 0
            share = (t - times[k - 1]) / (times[k] - times[k - 1]) if k else 1.0
            share = min(max(share, 0.0), 1.0)
            total = total + (1.0 - share) * rows[k - 1] + share * rows[k]
        return total

    @cached_property
    def _table(self) -> tuple[FloatArray, FloatArray]:
        return np.array(self.times), np.array(self.table)

    def input(self, step: Step, view: View) -> FloatArray:  # noqa: D102
        u = input_of(self.law, step, view)
        return u if self.force is None and self.swing is None and self.times is None else u + self.push(view.t)

    def kick(self, step: Step, shape: tuple[int, ...]) -> FloatArray | None:  # noqa: D102
        if not self.intensity:
            return None
        return self.intensity * step.h**0.5 * step.normal(self.seed, _NOISE, shape)

    def _kicks(self, first: int, count: int, h: float, shape: tuple[int, int]) -> FloatArray:
        """Return the velocity changes by noise in `count` steps of length h from step `first` on, stacked."""
        if not self.intensity:
            return np.zeros((count, *shape))
        return self.intensity * h**0.5 * normal_numbers(self.seed, _NOISE, shape, first, count)

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        if self.stepped:
            return super().flow(t, q, p)
        u, rate = self.law.flow(t, q, p)
        push = np.broadcast_to(self.push(t), q.shape)
        velocity = moving_frame(p) if self.moving else p
        return u + push, rate + float(np.sum(push * velocity))

    def compiled(self, m: int) -> Compiled | None:  # noqa: D102
        return None if self.stepped else self.compiled_push(m)

    def compiled_push(self, m: int) -> Compiled | None:
        """Return the compiled law with the external force, as `compiled` does, but without its noise."""
        inner = self.law.compiled_push(m)
        form = None if callable(self.force) or self.times else inner
        if form is None:
            return None
        kernel_parameters = kernel.numbers(form.moving, *self._rows(m), 2.0 * pi * self.frequency)
        term = TermKernel(kernel.act, no_energy, kernel_parameters, np.empty((0, 0)), 0.0)
        return form._replace(terms=(*form.terms, term))

    def _rows(self, m: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the constant force and the amplitudes of cos ωt and sin ωt, each (1, m) or (n, m)."""
        force, swing = (np.zeros((1, m)) if x is None else np.atleast_2d(x) for x in (self.force, self.swing))
        force, swing = np.broadcast_arrays(force, swing)
        return force, np.sin(self.phase) * swing, np.cos(self.phase) * swing

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Derivatives:  # noqa: D102
        return self.law.derivatives(t, q, p)


def _pushes(name: str, value: Any, least: int) -> Any:
    """Return finite numbers with `least` or `least + 1` axes as nested tuples; None stays None."""
    if value is None:
        return None
    shape = "(K, m) or (K, n, m)" if least == 2 else "(K,)" if name == "times" else "(m,) for all agents or (n, m)"
    array = ensure_numbers(name, value, f"finite components, {shape}")
    if array.ndim not in (least, least + 1) or not array.size or not np.isfinite(array).all():
        raise ArgumentError(f"{name} = {format_value(value)}: expected finite components, {shape}")
    return _as_tuples(array)


def _as_tuples(array: FloatArray) -> Any:
    return tuple(array.tolist()) if array.ndim == 1 else tuple(map(_as_tuples, array))
