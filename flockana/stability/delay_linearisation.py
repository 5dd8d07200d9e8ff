"""Linearised flock with delays: characteristic roots, stability, margins."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.short_repr import ShortRepr
from flockana.base.table_export import facts_html, facts_text
from flockana.base.value_checks import ComplexArray, FloatArray
from flockana.laws import Law
from flockana.stability.delay import DelayMargin, DelaySystem, delay_margin, neutral_roots
from flockana.stability.delay_roots import LatePart, error_of_root, rightmost

if TYPE_CHECKING:
    from flockana.stability.damp_table import DampTable
    from flockana.stability.linear_flock import LinearFlock


@dataclass(frozen=True, eq=False)
class DelayLinearisation(ShortRepr):
    """δq''(t) = −Σ_k (K_k δq(t − τ_k) + D_k δq'(t − τ_k)) near an equilibrium, in its moving frame.

    It has infinitely many roots, of which the rightmost decide, and no basis of modes.

    Parameters
    ----------
    law : Law
        The law with its delays.
    instant : Linearisation
        The same flock without delays: its K and D are the sums of the parts.
    parts : tuple of LatePart
        (τ_k, K_k, D_k) by rising delay.

    Examples
    --------
    >>> from flockana import Algorithm2, Delayed, StaticTarget
    >>> from flockana.stability import linearise
    >>> late = linearise(Delayed(Algorithm2(target=StaticTarget((0.0,))), 0.2), [[0.0]])
    >>> late.stable, late.delays, round(late.delay_margin().delay, 4)
    (True, (0.2,), 0.6173)
    """

    law: Law
    instant: LinearFlock = field(repr=False)
    parts: tuple[LatePart, ...] = field(repr=False)

    @property
    def q(self) -> FloatArray:
        """Positions, shape (n, m)."""
        return self.instant.q

    @property
    def p(self) -> FloatArray:
        """Velocities, shape (n, m)."""
        return self.instant.p

    @property
    def residual(self) -> float:
        """Distance of the state from equilibrium, relative to the law's forces."""
        return self.instant.residual

    @property
    def delays(self) -> tuple[float, ...]:
        """Positive delays of the flock."""
        return tuple(delay_term.delay for delay_term in self.parts if delay_term.delay > 0.0)

    @cached_property
    def neutral(self) -> int:
        """Number of characteristic roots at 0, which belong to motions without a restoring force."""
        zero = self.instant.second_order.invariant
        delayed_sum = sum((part.delay * part.stiffness for part in self.parts), np.zeros_like(self.parts[0].stiffness))
        return neutral_roots(zero.kernel, zero.cokernel, self.instant.damping.toarray(), delayed_sum)

    def rightmost(self, count: int = 6, *, nodes: int = 16) -> ComplexArray:
        """Return the rightmost characteristic roots off the neutral ones, largest real part first.

        Parameters
        ----------
        count, nodes : int
            As for `flockana.stability.rightmost_roots`.
        """
        return rightmost(self.parts, self.neutral, nodes=nodes, count=count)

    @cached_property
    def _worst(self) -> tuple[float, float]:
        roots = self.rightmost(8).tolist()
        return max(((s.real, error_of_root(self.parts, s)) for s in roots), key=sum, default=(-inf, 0.0))

    @property
    def stable(self) -> bool:
        """Return whether every root off the neutral ones decays, beyond rounding."""
        return self._worst[0] < -self._worst[1]

    @property
    def decay_rate(self) -> float:
        """Slowest decay rate off the neutral motions, per time unit; negative if something grows."""
        return -float(self.rightmost(1).real.max(initial=-inf))

    @property
    def system(self) -> DelaySystem:
        """Flock as a `DelaySystem` with one free delay; raises for several delays."""
        if len(self.delays) > 1:
            few = ", ".join(f"{delay:g}" for delay in self.delays[:4])
            raise ArgumentError(
                f"the flock has {len(self.delays)} delays ({few}): expected one, or scaled_margin() of them together"
            )
        blank = LatePart(0.0, *(np.zeros_like(self.parts[0].stiffness),) * 2)
        (prompt, late) = (
            next((part for part in self.parts if (part.delay > 0.0) == is_late), blank) for is_late in (False, True)
        )
        zero = self.instant.second_order.invariant
        neutral_count = neutral_roots(zero.kernel, zero.cokernel, prompt.damping + late.damping, late.stiffness)
        return DelaySystem(prompt[1:], late[1:], neutral_count)

    def delay_margin(self, *, progress: bool = False) -> DelayMargin:
        """Return the longest delay for which the flock is stable; for several delays see `scaled_margin`."""
        return delay_margin(self.system, progress=progress)

    def scaled_margin(self, most: float = 20.0) -> float:
        """Return the least common factor on all delays at which a root reaches the imaginary axis.

        Parameters
        ----------
        most : float
            Factor at which the search ends; then infinity is returned. A short loss of stability that begins and ends
            between two trials, 5 % apart, is missed.
        """
        from scipy.optimize import brentq

        def abscissa(factor: float) -> float:
            scaled_terms = [delay_term._replace(delay=factor * delay_term.delay) for delay_term in self.parts]
            return float(rightmost(scaled_terms, self.neutral, count=1).real.max(initial=-inf))

        if not self.instant.stable:
            return 0.0
        before = 0.05
        for factor in np.geomspace(before, most, 1 + int(np.log(most / before) / 0.05)).tolist():
            if abscissa(factor) > 0.0:
                return float(brentq(abscissa, before, factor, rtol=1e-12)) if abscissa(before) < 0.0 else before
            before = factor
        return inf

    def damp(self, count: int = 6, *, settled: float = 0.02) -> DampTable:
        """Return the table of the rightmost roots: see `Linearisation.damp`.

        Parameters
        ----------
        count : int
            Rows.
        settled : float
            Share of a deviation at which it counts as settled.
        """
        from flockana.stability.damp_table import damp_table

        roots = self.rightmost(count)
        return damp_table([(str(k), s) for k, s in enumerate(roots.tolist(), 1)], settled=settled)

    def facts(self) -> dict[str, str]:
        """Return the rows of the printed summary of a delayed flock: sizes, delays, and rightmost roots."""
        roots = [
            f"{s.real:.4g}{f' ± {s.imag:.4g}i' if s.imag else ''}" for s in self.rightmost(6).tolist() if s.imag >= 0
        ]
        return {
            "law": type(self.law).__name__,
            "agents": f"{self.q.shape[0]}, m = {self.q.shape[1]}",
            "delays": ", ".join(f"{delay:g}" for delay in self.delays[:6]),
            "stable": "yes" if self.stable else "no",
            "rightmost roots": ", ".join(roots),
        }

    def __str__(self) -> str:
        return facts_text("DelayLinearisation", self.facts())

    def _repr_html_(self) -> str:
        return facts_html("DelayLinearisation", self.facts())
