"""Laws that are maps from step to step."""

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from flockana.base.errors import ArgumentError, format_value
from flockana.base.natural_scales import Scales
from flockana.base.override_checks import ensure_consistent
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray
from flockana.laws.law import Arrays, Law, LawOfMotion

IndexArray = npt.NDArray[np.int64]
States = tuple[FloatArray, FloatArray, FloatArray, Arrays]  # next q, next p, applied u, next memory


class DiscreteLaw(LawOfMotion):
    """Law that is a map from one step to the next.

    A subclass is a frozen dataclass with a step `dt` and `step`. Its state may carry more than (q, p): `memory` maps
    names to arrays, is passed along, and is recorded over time in `Trajectory.extra`. A run holds the state at
    t0 + k dt and the input that brought it there; between its steps a map has no state. `extra_units` tells the powers
    of length and time of what is remembered, where it is no pure number.

    Attributes
    ----------
    position_factor : float or None
        f of a map q' = q + dt p + f dt² u, p' = p + dt u, u the input of `continuous` at the start of the step: what
        `linearise` needs to know. None of any other map.
    stability_function : tuple of float or None
        Coefficients r of a map whose step is Σ r_k (h A)^k where `continuous` is linear with the matrix A.
    in_place : bool
        Whether agents move one after the other, and each sees those before it already moved.
    """

    position_factor: float | None = None
    stability_function: tuple[float, ...] | None = None
    in_place: bool = False

    dt: float
    is_map = True
    approximates: ClassVar[bool] = False  # whether it integrates `law`, and is no law of its own
    steps_at_once: ClassVar[int] = 1  # at most, however quick they are
    private: ClassVar[tuple[str, ...]] = ()  # names in the memory that a run does not record
    extra_units: ClassVar[Mapping[str, Powers]] = {}

    @property
    def continuous(self) -> Law | None:
        """Continuous law that the map discretises, its parameter `law`; None without one."""
        inner = vars(self).get("law")
        return inner if isinstance(inner, Law) else None

    def averaging_matrix(self, q: FloatArray, heading: FloatArray) -> Any:
        """Return the derivative of the next headings by the headings, shape (n, n); None unless headings are mapped.

        Parameters
        ----------
        heading : ndarray, shape (n,)
            Headings, in radians.
        """
        return None

    @property
    def scales(self) -> Scales | None:
        """Length and time scales of the discretised law."""
        return None if self.continuous is None else self.continuous.scales

    def check_dimension(self, m: int) -> None:  # noqa: D102
        if self.continuous is not None:
            self.continuous.check_dimension(m)

    def check_start(self, q: FloatArray, p: FloatArray) -> None:  # noqa: D102
        if self.continuous is not None:
            self.continuous.check_start(q, p)

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Arrays) -> Mapping[str, Any]:  # noqa: D102
        return {} if self.continuous is None else self.continuous.measures(t, q, p, extra)

    @abstractmethod
    def step(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays) -> States:
        """Return (next q, next p, applied input u, next memory) of one step from t to t + dt, unchecked.

        Parameters
        ----------
        memory : mapping of str to ndarray
            What else the law remembers.
        """

    def iterate(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays, steps: int) -> States:
        """Return states, inputs and memories of `steps` successive steps, stacked along a first axis.

        A law whose step costs less than a call from Python, and does not hang on the time, overrides both; it must
        give what `step` gives, to the bit.

        Parameters
        ----------
        memory : mapping of str to ndarray
            What else the law remembers.
        steps : int
            How many, at least 1.
        """
        times = t + self.dt * np.arange(float(steps))
        return self._step_by_step(times, q, p, memory, np.arange(1, steps + 1))

    def visit(self, times: FloatArray, q: FloatArray, p: FloatArray, memory: Arrays, wanted: IndexArray) -> States:
        """Return states, inputs and memories after selected steps, for given start times of all steps.

        Once the state is not finite it stays so, as the steps in between are not seen. At most `steps_at_once` are
        asked for at a time.

        Parameters
        ----------
        times : ndarray, shape (K,)
            Beginnings of the steps.
        memory : mapping of str to ndarray
            What else the law remembers.
        wanted : ndarray of int, shape (S,)
            The steps whose results are returned, numbered from 1, rising; the last of them is the last that is made.
        """
        if type(self).iterate is DiscreteLaw.iterate:
            return self._step_by_step(times, q, p, memory, wanted)
        *states, series = self.iterate(float(times[0]), q, p, memory, int(wanted[-1]))
        qs, ps, us = (values[wanted - 1] for values in states)
        return qs, ps, us, {name: values[wanted - 1] for name, values in series.items()}

    def _step_by_step(
        self, times: FloatArray, q: FloatArray, p: FloatArray, memory: Arrays, wanted: IndexArray
    ) -> States:
        """Return states, inputs and memories after selected steps, by repeated calls of `step`."""
        states, memories, marks, is_lost = [], [], set(wanted.tolist()), False
        for k, t in enumerate(times[: wanted[-1]].tolist(), 1):
            if not is_lost:
                q, p, u, memory = self.step(t, q, p, memory)
                is_lost = not (np.isfinite(q).all() and np.isfinite(p).all())
            if k in marks:
                states.append((q, p, u))
                memories.append({name: np.array(value) for name, value in memory.items()})
        series_arrays = [np.stack(series) for series in zip(*states, strict=True)]
        series = {name: np.stack([item[name] for item in memories]) for name in memory}
        return series_arrays[0], series_arrays[1], series_arrays[2], series

    def start(self, q: FloatArray, p: FloatArray) -> Arrays:
        """Return what the map remembers beside (q, p) before the first step; nothing by default."""
        return {}


def is_own_map(law: Any) -> bool:
    """Return whether a law is a map that does not discretise a continuous law."""
    return isinstance(law, DiscreteLaw) and law.continuous is None


def ensure_law(law: Any) -> Law | DiscreteLaw:
    """Return `law` if it is a law or a map; raise otherwise.

    Raises
    ------
    ArgumentError
        If it is no `Law` and no `DiscreteLaw`, or of first order; a class instead of an instance is named as such. If
        it, or what it is made of, defines a method anew that the integrators would ignore.
    """
    if isinstance(law, Law | DiscreteLaw):
        ensure_consistent(law)
        return law
    if isinstance(law, LawOfMotion):
        raise ArgumentError(
            f"law = {format_value(law)}: a law of first order; expected one of second order or a map, such as "
            "Algorithm2(target=StaticTarget((0, 0)))"
        )
    hint = "; did you forget the parentheses?" if isinstance(law, type) else ""
    raise ArgumentError(
        f"law = {format_value(law)}: expected a law such as Algorithm2(target=StaticTarget((0, 0))){hint}"
    )
