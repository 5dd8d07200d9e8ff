"""Schemes that step a continuous law by a fixed step: what they have in common."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from flockana.base.checks import FloatArray, ensure_positive, normalise
from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.laws.discrete import DiscreteLaw
from flockana.laws.law import Law


@dataclass(frozen=True)
class Scheme(DiscreteLaw):
    """A map that approximates the flow of a law; a subclass says how it steps."""

    law: Law
    dt: float = 0.01

    units: ClassVar[Mapping[str, Powers]] = {"dt": (0, 1)}

    approximates = True

    def __post_init__(self) -> None:
        if not isinstance(self.law, Law):
            raise ArgumentError(f"law = {self.law!r}: expected a continuous law such as DeadZoneFlocking()")
        normalise(self, ensure_positive, "dt")

    @property
    def references(self) -> tuple[str, ...]:  # type: ignore[override]  # those of the law that is stepped
        """Keys of the law's bibliography."""
        return self.law.references

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:  # noqa: D102
        # the energy of the law that is stepped; the scheme does not keep its balance
        return self.law.hamiltonian(t, q, p)
