"""Switching laws: each acts in turn for its length of time, for nets on a schedule."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_finite_scalar, ensure_fits, ensure_numbers, normalise
from flockana.interactions.distance_functions import LawFunction
from flockana.laws.first_order_law import VelocityLaw
from flockana.laws.law import Law, LawOfMotion
from flockana.laws.wrapper_base import needs_steps


@dataclass(frozen=True)
class _Turns:
    """Base class of laws that act in turn, of either order."""

    laws: Any
    lengths: Any
    since: float = 0.0

    units: ClassVar[Mapping[str, Powers]] = {"lengths": (0, 1), "since": (0, 1)}
    kind: ClassVar[Any] = LawOfMotion

    def __post_init__(self) -> None:
        laws = self.laws if isinstance(self.laws, tuple | list) else (self.laws,)
        for k, law in enumerate(laws):
            plain = isinstance(law, self.kind) and not (law.obstacles or law.located or needs_steps(law))
            if not plain or isinstance(law, _Turns):
                raise ArgumentError(
                    f"laws[{k}] is of type {type(law).__name__}: expected a {self.kind.__name__} without obstacles, "
                    "delays, clocks or jumps of its own"
                )
        wanted = f"{len(laws)} times > 0, one for each law, of which the last may be infinite"
        lengths = ensure_numbers("lengths", self.lengths, wanted)
        if len(laws) == 0 or lengths.shape != (len(laws),) or not (lengths > 0.0).all() or np.isinf(lengths[:-1]).any():
            raise ArgumentError(f"lengths = {format_value(self.lengths)}: expected {wanted}")
        object.__setattr__(self, "laws", tuple(laws))
        object.__setattr__(self, "lengths", tuple(lengths.tolist()))
        normalise(self, ensure_finite_scalar, "since")

    @cached_property
    def _ends(self) -> FloatArray:
        return np.concatenate([[0.0], np.cumsum(self.lengths)])

    def _begin(self, turn: int) -> float:
        """Return the time at which a turn begins, where turns are numbered from 0."""
        rounds, law_index = divmod(turn, len(self.laws))
        return self.since + float(self._ends[law_index] + (rounds * self._ends[-1] if rounds else 0.0))

    def _turn(self, t: float) -> int:
        """Return the number of the turn, counted from 0, at a time; the earlier turn at a switch."""
        turn_number = len(self.laws) * max(0, int((t - self.since) / self._ends[-1]) - 1)
        while self._begin(turn_number + 1) < t:
            turn_number += 1
        return turn_number

    def acting(self, t: float) -> Any:
        """Return the acting law at a time; at a switch the earlier one, before `since` the first."""
        return self.laws[self._turn(t) % len(self.laws)]

    def switches(self, start: float, stop: float) -> FloatArray:
        count = len(self.laws) * ((stop - start) / float(self._ends[-1]) + 1.0)
        ensure_fits("the times of switches", (int(min(count, 1e18)),), "take a shorter span or longer turns")
        turn_number, times = self._turn(start) + 1, []
        while (time := self._begin(turn_number)) < stop:
            times.append(time)
            turn_number += 1
        return np.array(times)

    @property
    def references(self) -> tuple[str, ...]:
        """Keys of all laws' bibliographies."""
        return tuple(dict.fromkeys(key for law in self.laws for key in law.references))

    @property
    def scales(self) -> Scales | None:
        scales_of_first: Scales | None = self.laws[0].scales
        return scales_of_first

    @property
    def surfaces(self) -> tuple[float | tuple[float, ...], ...]:
        return tuple(dict.fromkeys(surface for law in self.laws for surface in law.surfaces))

    @property
    def poles(self) -> tuple[float, ...]:
        return tuple(dict.fromkeys(pole for law in self.laws for pole in law.poles))

    def _functions(self) -> tuple[LawFunction, ...]:
        return tuple(function for law in self.laws for function in law.functions)

    def check_dimension(self, m: int) -> None:
        for law in self.laws:
            law.check_dimension(m)

    def check_agents(self, n: int) -> None:
        for law in self.laws:
            law.check_agents(n)

    def check_start(self, q: FloatArray, p: FloatArray) -> None:
        for law in self.laws:
            law.check_start(q, p)


@dataclass(frozen=True)
class InTurn(_Turns, Law):  # type: ignore[override]
    """Laws of second order that act in turn, each for its length of time, round after round.

    `simulate` ends a step at each switch, where the earlier law still acts. It has no energy.

    Parameters
    ----------
    laws : sequence of Law
        Without obstacles, delays, clocks or jumps of their own.
    lengths : sequence of float
        How long each acts; if the last is infinite there is one round.
    since : float
        When the first turn begins; before it the first law acts.

    Raises
    ------
    ArgumentError
        On laws of another kind, or lengths that do not fit them.

    Examples
    --------
    >>> from flockana import NetConsensus
    >>> hears, heard = NetConsensus([[0, 0], [1, 0]]), NetConsensus([[0, 1], [0, 0]])
    >>> law = InTurn((hears, heard), (1.0, 2.0))
    >>> law.switches(0.0, 5.0).tolist(), law.acting(3.5) is hears
    ([1.0, 3.0, 4.0], True)
    """

    kind = Law
    functions = property(_Turns._functions)

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        return self.acting(t).flow(t, q, p)[0], float("nan")

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Any:
        """Return (∂u/∂q, ∂u/∂p) of the law that acts at a time."""
        return self.acting(t).derivatives(t, q, p)


@dataclass(frozen=True)
class VelocityInTurn(_Turns, VelocityLaw):  # type: ignore[override]
    """Laws of first order that act in turn, as `InTurn` of laws of second order.

    Parameters
    ----------
    laws : sequence of VelocityLaw
        Without obstacles or jumps of their own.
    lengths : sequence of float
        How long each acts; if the last is infinite there is one round.
    since : float
        When the first turn begins; before it the first law acts.

    Examples
    --------
    >>> from flockana import AverageConsensus
    >>> law = VelocityInTurn([AverageConsensus([[0, 0], [1, 0]]), AverageConsensus([[0, 1], [0, 0]])], (1.0, 1.0))
    >>> law.velocity(1.5, np.array([[0.0], [1.0]])).tolist()
    [[1.0], [0.0]]
    """

    kind = VelocityLaw
    functions = property(_Turns._functions)

    def velocity(self, t: float, q: FloatArray) -> FloatArray:  # noqa: D102
        v: FloatArray = self.acting(t).velocity(t, q)
        return v

    def slopes(self, t: float, q: FloatArray) -> Any:
        """Return ∂velocity/∂q of the law that acts at a time."""
        return self.acting(t).slopes(t, q)

    def acceleration(self, t: float, q: FloatArray) -> FloatArray:
        """Return d²q/dt² along the motion of the acting law at a time."""
        u: FloatArray = self.acting(t).acceleration(t, q)
        return u
