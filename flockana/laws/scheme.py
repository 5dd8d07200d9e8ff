"""Schemes that step a continuous law by a fixed step: what they have in common."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from flockana.base.checks import FloatArray, ensure_kind, ensure_positive, normalise
from flockana.base.units import Powers
from flockana.laws.discrete import DiscreteLaw, States
from flockana.laws.law import Arrays, Law


@dataclass(frozen=True)
class Scheme(DiscreteLaw):
    """A map that approximates the flow of a law: q' = q + dt p + f dt² u, p' = p + dt u, with f `position_factor`.

    A subclass gives f, or a step of its own.

    Raises
    ------
    ArgumentError
        If the law is no continuous one, or the step not positive.
    """

    law: Law
    dt: float = 0.01

    units: ClassVar[Mapping[str, Powers]] = {"dt": (0, 1)}

    approximates = True

    def __post_init__(self) -> None:
        ensure_kind("law", self.law, Law, "a continuous law such as DeadZoneFlocking()")
        normalise(self, ensure_positive, "dt")

    @property
    def references(self) -> tuple[str, ...]:  # type: ignore[override]  # those of the law that is stepped
        """Keys of the law's bibliography."""
        return self.law.references

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:  # noqa: D102
        # the energy of the law that is stepped; the scheme does not keep its balance
        return self.law.hamiltonian(t, q, p)

    def step(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays) -> States:  # noqa: D102
        u, h, f = self.law.flow(t, q, p)[0], self.dt, float(self.position_factor or 0.0)
        return q + h * p + (f * h * h) * u, p + h * u, u, memory
