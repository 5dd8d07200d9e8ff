"""Fixed-step methods, and maps that apply them to laws."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil, isclose
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.override_checks import overrides_consistently
from flockana.base.value_checks import FloatArray, ensure_fits, ensure_kind, ensure_positive, normalise
from flockana.kernels.fixed_steps import Coefficients, fixed_steps
from flockana.kernels.verlet_list import Pairs, no_pairs, with_room
from flockana.laws.delayed_law import Delayed
from flockana.laws.discrete import DiscreteLaw, IndexArray, States
from flockana.laws.first_order_law import first_order
from flockana.laws.law import Arrays, Law, LawOfMotion
from flockana.laws.wrapper_base import Step, View, Wrapper, WrappingLaw, input_of, needs_steps, wrappers_within
from flockana.solvers.hermite_past import Past, Row
from flockana.solvers.solver import Limits, Rate, Rows, Solver
from flockana.solvers.stepper import FixedStepper
from flockana.solvers.tableau import Tableau, tableau_of_steps

_STEPPED = SimpleNamespace(__module__="flockana.solvers.wrapped_steps", __qualname__="Stepped")
_WHOLE = 1e-9  # relative: how far from a whole number of steps a clock may be


@dataclass(frozen=True)
class _Stepwise(Solver):
    """Base class of solvers with a fixed step, for typing; separate from `FixedStep.__new__`."""

    dt: float  # type: ignore[misc]  # of an instance here

    units: ClassVar[Any] = {"dt": (0, 1)}

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "dt")


class FixedStep(_Stepwise):
    """Explicit one-step method with a fixed step.

    A subclass gives coefficients: stage s is the rate at y + h Σ_j a_sj K_j and t + h Σ_j a_sj, the step ends at
    y + h Σ_j b_j K_j. A method with one stage may say instead how far positions lead: q' = q + h p + f h² u.

    ``simulate(law, ..., method=RK4(0.01))`` integrates the law: steps are checked, shortened and land on the times
    asked for. ``FixedSteps(law, RK4(0.01))`` is a map, whose steps are exactly `dt` long; ``RK4(law, 0.01)`` is short
    for it.

    Parameters
    ----------
    dt : float
        Step, in time units.

    Attributes
    ----------
    a, b : sequences of floats
        Weights of the stages, a row each, and of the step; by default those of one stage.
    position_factor : float or None
        f of a method with one stage; None of others.
    """

    a: ClassVar[Rows] = ((),)
    b: ClassVar[Sequence[float]] = (1.0,)
    position_factor: ClassVar[float | None] = None
    order_of_wrapped: ClassVar[int] = 0  # by which files name it where it steps a wrapped law

    def __new__(cls, *given: Any, **named: Any) -> Any:
        """Return the solver, or, if a law is given, the map that steps the law by the solver."""
        law, *settings = (named.pop("law"), *given) if "law" in named else given or (None,)
        stepped_law: Any = law
        if not isinstance(law, LawOfMotion):
            return super().__new__(cls)
        return FixedSteps(stepped_law, cls(*settings, **named) if settings or named else cls(0.01))

    @cached_property
    def tableau(self) -> Tableau:
        """Coefficients of the Runge-Kutta method, for compiled steps."""
        return tableau_of_steps(self.a, self.b, self.position_factor or 0.0)

    @property
    def stability_function(self) -> tuple[float, ...]:
        """Coefficients of the stability function R(z) = 1 + Σ_k bᵀ Aᵏ⁻¹ 1 zᵏ of a step."""
        a, b = self.tableau.a[:-1, :-1], self.tableau.a[-1, :-1]
        powers = [np.linalg.matrix_power(a, k) @ np.ones(len(b)) for k in range(len(b))]
        return (1.0, *(float(b @ power) for power in powers))

    def open(self, rate: Rate, t: float, y: FloatArray, f: FloatArray, limits: Limits) -> Any:  # noqa: D102
        return FixedStepper(self.tableau, rate, t, y, f, limits)


@dataclass(frozen=True)
class FixedSteps(DiscreteLaw):
    """Map that integrates a law with steps of exactly `dt`, without checks or repetition.

    What it claims is about the map. ``simulate(law, ..., method=RK4(0.01))`` is evidence about the law instead: there
    steps are checked, shortened and land on the times asked for. ``RK4(law, 0.01)`` is short for
    ``FixedSteps(law, RK4(0.01))``.

    A law with delays, clocks or noise is run by such a map in any case. Steps must divide delays and sampling periods;
    the past between steps is a Hermite cubic.

    Parameters
    ----------
    law : Law
        What is stepped.
    solver : FixedStep
        Method and step, such as ``RK4(0.01)``.

    Raises
    ------
    ArgumentError
        If the law is no continuous one, the solver has no fixed step, a step does not divide a delay or period, or the
        law is noisy and the solver takes no noise.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.solvers.heun import Heun
    >>> FixedSteps(Algorithm1(), Heun(0.1)).dt, Heun(Algorithm1(), 0.1) == FixedSteps(Algorithm1(), Heun(0.1))
    (0.1, True)
    """

    law: Law
    solver: FixedStep

    approximates = True
    steps_at_once = 4096
    private = ("step", "past", "held")

    def __post_init__(self) -> None:
        ensure_kind("law", self.law, Law, "a continuous law of second order such as DeadZoneFlocking()")
        ensure_kind("solver", self.solver, FixedStep, "a solver with a fixed step, such as RK4(0.01)")
        dt = self.dt
        for clock in (clock for wrapper in self._wrappers for clock in wrapper.clocks):
            if clock / dt < 1.0 - _WHOLE or not isclose(clock / dt, round(clock / dt), rel_tol=_WHOLE):
                raise ArgumentError(
                    f"dt = {dt:g}: expected a step that divides the delay or period {clock:g}, such as "
                    f"{clock / max(1, ceil(clock / dt)):.12g}"
                )
        if self._first_order and self.solver.position_factor:
            raise ArgumentError(f"{self.solver.name}: {self.law.title} is of first order; expected RK4 or Heun")
        core: Any = self.law
        while isinstance(core, WrappingLaw):  # whose switches are those of the law within
            core = core.law
        if type(core).switches is not LawOfMotion.switches:
            raise ArgumentError(
                f"{core.title}: steps of exactly dt would lead over its switches; expected simulate(law, ..., "
                "method=RK4(dt)), whose steps end there, and no delay or clock around it"
            )
        for delayed_wrapper in self._late:
            delayed_wrapper._ensure_remembered(self._memory)
        if self.noisy and not self.solver.takes_noise:
            raise ArgumentError(
                f"{self.solver.name}: {type(self.law).__name__} draws random numbers; expected a solver that takes "
                "noise, such as Heun(dt) or EulerMaruyama(dt)"
            )

    @property
    def spelling(self) -> tuple[Any, Mapping[str, Any]] | None:
        """Class and arguments that files store: the solver's class, called with a law; None for a subclass."""
        if type(self) is not FixedSteps:
            return None
        arguments = {"law": self.law, "dt": self.dt}
        if self._wrappers and self.solver.order_of_wrapped:  # as files of format 1 have it
            return _STEPPED, arguments | {"order": self.solver.order_of_wrapped}
        return type(self.solver), arguments

    @property
    def title(self) -> str:
        """Name of the law in messages and tables: that of the solver's class."""
        return type(self.solver).__name__ if type(self) is FixedSteps else type(self).__name__

    @property
    def dt(self) -> float:  # type: ignore[override]  # the solver's
        """Length of a time step, in time units."""
        return self.solver.dt

    @property
    def position_factor(self) -> float | None:  # type: ignore[override]  # the solver's
        """Factor f of q' = q + h p + f h² u; None for solvers with more stages and laws with memory."""
        return None if needs_steps(self.law) else self.solver.position_factor

    @property
    def stability_function(self) -> tuple[float, ...] | None:  # type: ignore[override]  # the solver's
        """Coefficients r of R: a step of a linear law with matrix A is Σ r_k (h A)^k; None with memory."""
        return None if needs_steps(self.law) else self.solver.stability_function

    @property
    def noisy(self) -> bool:
        """Whether the law draws random numbers."""
        return any(wrapper.noisy for wrapper in self._wrappers)

    @property
    def references(self) -> tuple[str, ...]:  # type: ignore[override]  # those of the law that is stepped
        """Keys of the law's bibliography."""
        return self.law.references

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:  # noqa: D102
        # the energy of the law that is stepped, whose balance the map does not keep
        return self.law.hamiltonian(t, q, p)

    def check_agents(self, n: int) -> None:  # noqa: D102
        self.law.check_agents(n)

    @cached_property
    def _wrappers(self) -> tuple[Wrapper, ...]:
        return wrappers_within(self.law)

    @cached_property
    def _first_order(self) -> bool:
        return first_order(self.law) is not None

    @cached_property
    def _late(self) -> tuple[Delayed, ...]:
        return tuple(wrapper for wrapper in self._wrappers if isinstance(wrapper, Delayed))

    @cached_property
    def _memory(self) -> float:
        """Longest time into the past from which the law uses states; nested delays add up."""
        return sum(wrapper.memory for wrapper in self._wrappers)

    @cached_property
    def past_steps(self) -> int:
        """Number of stored steps of a law with memory, the present one included; 0 without memory."""
        return 2 + ceil(self._memory / self.dt - _WHOLE) if self._memory > 0.0 else 0

    def start(self, q: FloatArray, p: FloatArray) -> Arrays:
        """Return the stored past at the start of a run: a delayed law's history, else uniform motion."""
        if not needs_steps(self.law):
            return {}
        rows = (self.past_steps, *q.shape)
        ensure_fits("the past of a delay", (4, *rows), "take a shorter delay or longer steps")
        past_states = np.empty((0, 4, *q.shape))
        if self.past_steps:
            with_history = next((item for item in self._late if item.history_t is not None), self._late[0])
            past_times = self.dt * np.arange(1.0 - self.past_steps, 1.0)
            if self._first_order and with_history.history_t is None:
                q, p = np.zeros_like(q), q
            past_positions, speeds, push = with_history._past(past_times, q, p)
            if self._first_order and with_history.history_t is not None:
                speeds, push = past_positions, speeds
            past_states = np.stack([past_positions, speeds, push, push], axis=1)
        return {"step": np.array(0.0), "past": past_states, "held": np.empty((0, *q.shape))}

    def step(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays) -> States:  # noqa: D102
        q, p, u, next_memory = self._made(np.array([t]), q, p, memory, np.array([1]))
        return q[0], p[0], u[0], {name: values[-1] for name, values in next_memory.items()}

    def iterate(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays, steps: int) -> States:  # noqa: D102
        if overrides_consistently(type(self), "iterate", ("step", "start")):
            return self._made(t + self.dt * np.arange(float(steps)), q, p, memory, np.arange(1, steps + 1))
        return super().iterate(t, q, p, memory, steps)

    def visit(self, times: FloatArray, q: FloatArray, p: FloatArray, memory: Arrays, wanted: IndexArray) -> States:  # noqa: D102
        if overrides_consistently(type(self), "visit", ("iterate", "step", "start")):
            return self._made(times, q, p, memory, wanted)
        visit_method = super().visit if type(self).iterate is not FixedSteps.iterate else self._step_by_step
        return visit_method(times, q, p, memory, wanted)

    def _made(self, times: FloatArray, q: FloatArray, p: FloatArray, memory: Arrays, wanted: IndexArray) -> States:
        """Return (q, p, u, memory) after the requested steps: by the law itself, compiled code, or Python."""
        if self._first_order:  # positions are stepped as velocities of other laws are, by the rate that these give
            rate, q, p, next_memory = self._interpreted(times, np.zeros_like(q), q, memory, wanted)
            return q, p, rate, next_memory
        block = self.law.block(self.solver)
        if block is not None and (states := block(times, q, p, wanted)) is not None:
            return *states, {}
        samples = self._compiled(times, q, p, memory, wanted)
        return self._interpreted(times, q, p, memory, wanted) if samples is None else samples

    def _compiled(
        self, times: FloatArray, q: FloatArray, p: FloatArray, memory: Arrays, wanted: IndexArray
    ) -> States | None:
        """Return states after the requested steps from compiled code; None if not compiled or too many pairs."""
        (n, m), steps = q.shape, int(wanted[-1])
        if (form := self.law.compiled_push(m)) is None:
            return None
        system = form.system((float(times[0]), np.zeros(m), np.zeros(m)), n, m)
        reach, system = system.reach[0], system._replace(reach=(0.0, 0.0))
        table, kicks = self.solver.tableau, np.empty((0, n * m))
        if memory:
            first = int(memory["step"])
            pushes = (one._kicks(first, steps, self.dt, (n, m)) for one in self._wrappers if one.noisy)  # type: ignore[attr-defined]
            kicks = sum(pushes, np.zeros((steps, n, m))).reshape(steps, n * m)
            next_memory = {"step": np.array([float(first + steps)]), "past": np.empty((1, 0, 4, n, m))}
            memory = next_memory | {"held": np.full((1, len(self._wrappers), n, m), np.nan)}
        method = Coefficients(
            table.a, table.c, table.stages, self.solver.position_factor is not None, table.lead, self.dt, reach
        )
        y, output = np.concatenate([q.ravel(), p.ravel(), [0.0]]), np.empty((3, len(wanted), n, m))
        wanted = np.asarray(wanted)
        pairs: Pairs | None = no_pairs(n, m)
        while not fixed_steps(times, y.copy(), kicks, wanted, method, system, pairs, output):
            if (pairs := with_room(pairs)) is None:  # type: ignore[arg-type]
                return None
        return output[0], output[1], output[2], memory

    def _interpreted(
        self, times: FloatArray, q: FloatArray, p: FloatArray, memory: Arrays, wanted: IndexArray
    ) -> States:
        """Return the states after the requested steps, made one by one in Python."""
        shape, first_step = q.shape, int(memory["step"]) if memory else 0
        past = Past(deque([tuple(row) for row in memory["past"]] if memory else [], self.past_steps or 1), self.dt)
        held_inputs = {k: item for k, item in enumerate(memory["held"], 1) if np.isfinite(item).all()} if memory else {}
        now = Step(first_step, self.dt, lambda _: (q, p), held_inputs)
        samples, row = np.empty((3, len(wanted), *shape)), 0
        for k, t in enumerate(times[: wanted[-1]].tolist()):
            now.number, now.begins = first_step + k, True
            if self.past_steps:
                now.past = past.seen_at(t)
            q, p, u, departs = self._advance(now, t, q, p, past)
            if self.past_steps:
                past.rows.append((q, p, departs, departs))
            if k + 1 == wanted[row]:
                samples[:, row] = q, p, u
                row += 1
        if not memory:
            return samples[0], samples[1], samples[2], {}
        stored_inputs = np.full((len(self._wrappers), *shape), np.nan)
        for key, value in now.held.items():
            stored_inputs[key - 1] = value
        next_memory = {"step": np.array(float(first_step + int(wanted[-1]))), "held": stored_inputs}
        next_memory["past"] = np.array(past.rows) if self.past_steps else np.empty((0, 4, *shape))
        return samples[0], samples[1], samples[2], {name: value[None] for name, value in next_memory.items()}

    def _advance(self, now: Step, t: float, q: FloatArray, p: FloatArray, past: Past) -> Row:
        """Return (q, p, input of the step, input at its end) after one step."""
        h, factor, table = self.dt, self.solver.position_factor, self.solver.tableau
        u = input_of(self.law, now, View(t, q, p))
        now.begins = False
        if self.past_steps:
            past.begin(u, first=now.number == 0)
        kicks = (wrapper.kick(now, p.shape) for wrapper in self._wrappers)
        kick = sum((item for item in kicks if item is not None), 0.0)
        speeds, inputs = [p], [u]
        for s in range(1, table.stages):
            stage_position = q + h * _combination(table.a[s], speeds)
            speeds.append(p + h * _combination(table.a[s], inputs) + kick)
            inputs.append(input_of(self.law, now, View(t + table.c[s] * h, stage_position, speeds[-1])))
        u, next_velocities = _combination(table.a[-1], inputs), p + h * _combination(table.a[-1], inputs)
        if factor is None:
            q = q + h * _combination(table.a[-1], speeds)
        else:  # velocities first, where positions follow them
            q = q + h * next_velocities if factor == 1.0 else q + h * p + (factor * h * h) * u
        if self._first_order:  # the rate of the velocity is in the place that is free
            return (inputs[-1] - inputs[0]) / h, next_velocities, inputs[-1], inputs[-1]
        return q, next_velocities + kick, u, inputs[-1]


def _combination(weights: FloatArray, parts: Sequence[FloatArray]) -> FloatArray:
    """Return Σ weights_j parts_j over the nonzero weights."""
    total: Any = 0.0
    for weight, part in zip(weights.tolist(), parts, strict=False):
        if weight:
            total = total + weight * part
    return total
