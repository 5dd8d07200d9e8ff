"""Eigenvalues of the linearised flock, and poles of its centre of mass, as one gain varies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import ComplexArray, FloatArray, ensure_known, ensure_nonnegative, ensure_points
from flockana.equilibria.solve import find_equilibrium
from flockana.interactions import Gains
from flockana.laws import Algorithm1, Algorithm2, ensure_one_gain
from flockana.stability.centre_transfer import CentreOfMass
from flockana.stability.delay import delay_margin
from flockana.stability.law_studies import delay_system, law_blocks

if TYPE_CHECKING:
    from control import TransferFunction

GAINS = ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma")


@dataclass(frozen=True)
class Sweep:
    """Eigenvalues of a flock or of its centre of mass, as branches against one gain."""

    name: str
    values: FloatArray  # shape (L,)
    eigenvalues: ComplexArray  # shape (L, M): one column per branch, joined by continuity
    neutral: int  # columns in front that stay at 0: rigid motions that nothing holds

    @property
    def abscissa(self) -> FloatArray:
        """Return the largest real part of eigenvalues at each gain, neutral ones left out; NaN without others."""
        nonzero_eigenvalues = self.eigenvalues.real[:, self.neutral :]
        return nonzero_eigenvalues.max(axis=1) if nonzero_eigenvalues.shape[1] else np.full(len(self.values), np.nan)


def gain_sweep(law: Algorithm1 | Algorithm2, q: Any, name: str, values: Any, *, follow: bool = True) -> Sweep:
    """Return eigenvalues of Algorithm 1 or 2 about an equilibrium as one gain varies.

    Equilibria of Algorithm 2 move with c1γ/c1α: they are followed, each found from the last; with ``follow=False`` the
    configuration stays, and at what is then no equilibrium rotations need not be neutral.

    Parameters
    ----------
    law : Algorithm1 or Algorithm2
        The law; its other gains stay.
    q : array_like, shape (n, m)
        Equilibrium at the first value, or near it.
    values : array_like, shape (L,)
        Its values, rising.
    follow : bool
        Find the equilibrium anew at every value.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> law = Algorithm2(target=StaticTarget((0.0,)))
    >>> sweep = gain_sweep(law, [[0.0]], "c1_gamma", [1.0, 2.0])
    >>> [round(float(x), 6) for x in (sweep.eigenvalues[1] * sweep.eigenvalues[1].conj()).real]
    [2.0, 2.0]
    """
    rows: list[ComplexArray] = []
    neutral_count, levels = 0, _rising(values)
    for scaled_law, positions in _followed(law, q, name, levels, follow=follow):
        flock = law_blocks(scaled_law, positions, strict=follow)
        roots = np.linalg.eigvals(flock.matrix()).astype(np.complex128)
        roots = roots[np.argsort(np.abs(roots), kind="stable")]
        count = flock.neutral.shape[1] + flock.drifting.shape[1]
        roots[:count] = 0.0  # a defective zero rounds to about 1e-8
        neutral_count = count if not rows else min(neutral_count, count)
        rows.append(_joined(rows[-1], roots) if rows else roots)
    return Sweep(name, levels, np.array(rows), neutral_count)


def centre_locus(gains: Gains, name: str, values: Any) -> tuple[Sweep, TransferFunction]:
    """Return the root locus of the centre of mass over c1γ or c2γ, and the open loop L(s).

    L = 1/(s² + c2γ s) for c1γ and s/(s² + c1γ) for c2γ: what `control.root_locus` takes.

    Parameters
    ----------
    gains : Gains
        The other gain of the two is used.
    values : array_like, shape (L,)
        Its values, rising.

    Examples
    --------
    >>> locus, loop = centre_locus(Gains(c2_gamma=2.0), "c1_gamma", [0.0, 1.0, 2.0])
    >>> locus.eigenvalues.round(6).tolist()
    [[(-2+0j), 0j], [(-1+0j), (-1+0j)], [(-1-1j), (-1+1j)]]
    """
    import control

    ensure_one_gain(gains)
    ensure_known("gain", name, GAINS[2:])
    levels = _rising(values)
    rows: list[ComplexArray] = []
    for level in levels.tolist():
        roots = CentreOfMass(replace(gains, **{name: level})).poles + 0.0
        rows.append(_joined(rows[-1], roots) if rows else roots)
    loops = {"c1_gamma": ([1.0], [1.0, gains.c2_gamma, 0.0]), "c2_gamma": ([1.0, 0.0], [1.0, 0.0, gains.c1_gamma])}
    return Sweep(name, levels, np.array(rows), 0), control.TransferFunction(*loops[name])


def _rising(values: Any) -> FloatArray:
    levels = np.array([ensure_nonnegative("values", x) for x in np.ravel(values)])
    if levels.size == 0 or np.any(np.diff(levels) <= 0.0):
        raise ArgumentError(f"values = {values!r}: expected rising gains")
    return levels


def _joined(before: ComplexArray, after: ComplexArray) -> ComplexArray:
    """Return the eigenvalues `after`, reordered so that each continues its branch of `before`."""
    from scipy.optimize import linear_sum_assignment

    return after[linear_sum_assignment(np.abs(before[:, None] - after[None, :]) ** 2)[1]]


@dataclass(frozen=True)
class MarginSweep:
    """Delay margin against one gain."""

    name: str
    values: FloatArray  # shape (L,)
    # margins, frequencies: shape (L,): τ* and the frequency of the oscillation there; infinite and NaN where no delay
    # does harm
    margins: FloatArray
    frequencies: FloatArray
    delayed: str  # which terms are delayed


def margin_sweep(law: Algorithm1 | Algorithm2, q: Any, name: str, values: Any, *, delayed: str = "all") -> MarginSweep:
    """Return the delay margin of an equilibrium that is followed as one gain varies.

    Parameters
    ----------
    law, q, name, values
        As of `gain_sweep`.
    delayed : {"all", "pairs", "neighbours"}
        As in `delay_system`.

    Examples
    --------
    The more damping is delayed, the less delay it bears:

    >>> from flockana.environment.targets import StaticTarget
    >>> margins = margin_sweep(Algorithm2(target=StaticTarget((0.0,))), [[0.0]], "c2_gamma", [1.0, 4.0, 16.0])
    >>> bool(margins.margins[1] < margins.margins[0] and margins.margins[2] < margins.margins[1])
    True
    """
    levels = _rising(values)
    delays = [delay_margin(delay_system(*item, delayed=delayed)) for item in _followed(law, q, name, levels)]
    margins, frequencies = (np.array([getattr(x, kind) for x in delays]) for kind in ("delay", "frequency"))
    return MarginSweep(name, levels, margins, frequencies, delayed)


def _followed(
    law: Any, q: Any, name: str, levels: FloatArray, *, follow: bool = True
) -> Iterator[tuple[Algorithm1 | Algorithm2, FloatArray]]:
    """Yield a law for each value of one gain, with its equilibrium continued from the previous one."""
    if not isinstance(law, Algorithm1 | Algorithm2):
        raise ArgumentError(f"law = {format_value(law)}: expected Algorithm1(...) or Algorithm2(...)")
    ensure_known("gain", name, GAINS[:2] if law.target is None else GAINS)
    q = ensure_points("q", getattr(q, "q", q))  # of an equilibrium
    for level in levels.tolist():
        scaled_law = replace(law, gains=replace(law.gains, **{name: level}))
        q = np.array(find_equilibrium(scaled_law, q).q) if follow else q
        yield scaled_law, q
