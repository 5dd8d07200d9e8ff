"""Table of measures of runs, as time series and as single numbers.

A file of this package that defines ``MEASURES`` adds to it: `Trajectory.metrics`, ensembles and plots then know them.
What only the runs of one law have is in that law's `measures`.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from math import nan
from typing import Any, NamedTuple

from flockana.base.module_discovery import modules, source_modules
from flockana.base.value_checks import FloatArray
from flockana.measures.metrics import nets


@dataclass(frozen=True, eq=False)
class Flock:
    """Flock at several instants, under its law."""

    law: Any
    q: FloatArray  # q, p: shape (T, n, m)
    p: FloatArray

    @cached_property
    def nets(self) -> FloatArray:
        """Connectivity C, largest-component share C* and (given a lattice scale d) deviation energy E, (3, T)."""
        r = self.law.pair.range
        d = r if self.law.lattice is None else self.law.lattice[0]
        return nets(self.q, d, r)


class Series(NamedTuple):
    """Time series that a law defines for its own runs: text, values or a function for them, and axis scale."""

    text: str
    values: FloatArray | Callable[[], FloatArray]
    logarithmic: bool = False


def any_law(law: Any) -> bool:
    """Return True: the measure is defined for every law."""
    return True


def has_range(law: Any) -> bool:
    """Return whether the law has an interaction range, and so a net."""
    return law.pair is not None


def has_lattice(law: Any) -> bool:
    """Return whether the law has a lattice scale d and an interaction range r."""
    return law.lattice is not None


@dataclass(frozen=True)
class Measure:
    """Measure of runs, such as connectivity, with its text, unit and functions."""

    name: str  # its name in `Trajectory.metrics` and in ensembles
    text: str  # what it is, for people
    unit: str = "1"
    # ``over_time(flock) -> ndarray of shape (T,)``: its value at each instant of a `Flock`
    over_time: Callable[[Flock], FloatArray] | None = None
    # ``of_run(trajectory) -> float``: what an ensemble keeps of a run; by default the value at the end
    of_run: Callable[[Any], float] | None = None
    of_run_text: str = ""  # what that is, where it is not the value at the end
    defined: Callable[[Any], bool] = any_law  # ``defined(law)``: whether it makes sense
    logarithmic: bool = False  # draw it on a logarithmic axis
    at_most_one: bool = False  # it is a share or a cosine, so that its axis ends at 1

    @property
    def label(self) -> str:
        """Axis label: text and unit."""
        return self.text if self.unit in ("", "1") else f"{self.text} ({self.unit})"

    @property
    def summary(self) -> str:
        """Label of the measure's summary number."""
        return self.of_run_text or f"{self.text}, at the end"

    def number(self, run: Any) -> float:
        """Return the number that summarises a run in an ensemble; NaN if undefined for the law."""
        if not self.defined(run.law):
            return nan
        if self.of_run is not None:
            return float(self.of_run(run))
        return nan if self.over_time is None else float(self.over_time(run.end)[0])


@cache
def measures() -> Mapping[str, Measure]:
    """Return all measures by name, from the ``MEASURES`` of the files of this package."""
    all_modules = (*modules("flockana.measures"), *source_modules("measures"))
    return {item.name: item for module in all_modules for item in getattr(module, "MEASURES", ())}
