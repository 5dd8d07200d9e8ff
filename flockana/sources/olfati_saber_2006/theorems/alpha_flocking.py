"""Definition 5 of Olfati-Saber (2006), α-flocking, plain and strict, as two checkable statements."""

from dataclasses import dataclass
from math import floor

import numpy as np

from flockana.theorems import bounds_between_samples
from flockana.theorems.enclosure import Real
from flockana.theorems.hypotheses import has_lattice
from flockana.theorems.search_objectives import bridge
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances, unmet
from flockana.theorems.theorem_toolkit import (
    EPS,
    Enclosure,
    FloatArray,
    Observed,
    condition,
    counted,
    judged,
    run_theorem,
)
from flockana.theorems.tube_claims import enclosed_by

_SHARE = 1e-9  # of an agent: what a share of n agents, as a decimal fraction, may be off by


@dataclass(frozen=True)
class _Window:
    """Final part of a run on which flocking is judged, with one sample before it for bounds."""

    seen: Observed  # Its samples, and that one
    first: int  # The first sample within
    start: float  # When it begins


def _window(seen: Observed, tolerances: Tolerances) -> tuple[Hypothesis, _Window]:
    """Return the final part of a run, on which flocking is judged."""
    t = seen.t
    start = float(t[0] + tolerances.settle * (t[-1] - t[0]))
    before = int(np.searchsorted(t, start, side="right")) - 1
    lead = t[before] < start and not seen.is_map  # a map is nowhere between its steps
    begin = float(t[before]) if lead else start
    part = seen.cached(f"window from {begin!r}", lambda: seen.window(begin, float(t[-1])))
    count = len(part.t) - int(lead)
    detail = f"from t = {part.t[-count]:.4g} to {part.t[-1]:.4g}, at {count} samples"
    return condition("judged over a window", count > int(not lead), detail=detail), _Window(part, int(lead), start)


def _always(name: str, part: _Window, value: Enclosure, over: Enclosure, bound: Real) -> Claim:
    """Return the claim that a quantity stays below a bound, at and between the samples."""
    (symbol, quantity_name), t = _SYMBOLS[name], part.seen.t[part.first :]
    values = value[part.first :]
    largest = Enclosure(values.lo.max(), values.mid.max(), max(values.hi.max(), over.hi.max()))
    worst = int(np.argmax(values.mid))
    return judged(name, bound - largest, computed=float(values.mid[worst])).described(
        stated=f"{symbol} <= {float(Enclosure.of(bound).mid):.4g}",
        witness={"time": float(t[worst])},
        detail=f"{quantity_name} {symbol}: {values.mid[worst]:.4g} at worst, at t = {t[worst]:.4g}",
    )


_SYMBOLS = {
    "cohesive": ("R", "cohesion radius"),
    "deviation": ("Ẽ", "normalised deviation energy"),
    "mismatch": ("K̃", "normalised velocity mismatch, over the law's speed²,"),
}


def _at_most(name: str, part: _Window, counts: tuple[FloatArray, FloatArray, float], most: int, what: str) -> Claim:
    """Return the claim that a whole number never exceeds a bound, at and between the samples."""
    t, interval_count = part.seen.t[part.first :], counts[2]
    smallest, largest = (series[part.first :] for series in counts[:2])
    worst = int(np.argmax(smallest))
    possible_count = max(float(largest.max()), interval_count)
    is_open = smallest[worst] <= most < possible_count
    open_remark = "whether there are ever more is open: a pair comes as near to r as this run can tell"
    return counted(name, most, int(smallest[worst]), int(possible_count), computed=int(smallest[worst])).described(
        stated=f"at most {most}",
        witness={"time": float(t[worst])},
        detail=f"{what}: {int(smallest[worst])} at worst, at t = {t[worst]:.4g}, where at most {most} are allowed"
        + (f"; {open_remark}" if is_open else ""),
    )


def _connected(part: _Window) -> Claim:
    """Return the claim that the net is connected throughout, based on certain links."""
    interval_nets, sample_nets = (
        bounds_between_samples.nets_between(part.seen),
        bounds_between_samples.nets_at(part.seen),
    )
    counts = sample_nets.components_least, sample_nets.components, float(interval_nets.components.max(initial=0.0))
    return _at_most("flock", part, counts, 1, "components")


def _giant(part: _Window, tolerances: Tolerances) -> Claim:
    """Return the claim that one component always has more than a given share of all agents."""
    n = part.seen.n
    interval_nets, sample_nets = (
        bounds_between_samples.nets_between(part.seen),
        bounds_between_samples.nets_at(part.seen),
    )
    fewest = floor(tolerances.giant * n + _SHARE) + 1  # agents that are more than the share
    counts = n - sample_nets.giant_most, n - sample_nets.giant, float(n - interval_nets.giant.min(initial=n))
    return _at_most("giant", part, counts, n - fewest, "agents outside the giant component")


def _common(part: _Window, tolerances: Tolerances) -> list[Claim]:
    """Return the claims Ẽ <= ε₁ on deviation energy and K̃ <= ε₂ on velocity mismatch."""
    seen = part.seen
    (d, r), units = seen.law.lattice, seen.scales.energy
    rounding = 8.0 * EPS * (float(np.abs(seen.run.q).max()) / d + 1.0)
    root_error = 2.0 * seen.shape_error.max(axis=1) / d + rounding  # √Ẽ is a norm of the links' deviations over d
    one_link, at, during = (
        2.0 * (r / d - 1.0) ** 2,
        bounds_between_samples.nets_at(seen),
        bounds_between_samples.nets_between(seen),
    )
    root = Enclosure.around(np.sqrt(seen.run.metric("normalised_deviation_energy")), root_error).clip(0.0)
    deviation = root.square().widened(one_link * at.open_links / (2.0 * at.links + 1.0)).clip(0.0)
    # of links that stay: √Ẽ grows by no more than the largest of their deviations does
    jumps = one_link * during.open_links / (2.0 * during.links + 1.0)
    interval_bound = (
        np.maximum(root.hi[:-1], root.hi[1:]) + bounds_between_samples.stretch_between(seen) / d
    ) ** 2 + jumps
    span_bound = Enclosure(0.0, np.minimum(interval_bound, 1e300), interval_bound)
    return [
        _always("deviation", part, deviation, span_bound, tolerances.deviation),
        _always(
            "mismatch",
            part,
            seen.mismatch / units,
            bounds_between_samples.mismatch_over(seen) / units,
            tolerances.mismatch,
        ),
    ]


def _cohesive(part: _Window, tolerances: Tolerances) -> Claim:
    """Return the claim that the cohesion radius R never exceeds a multiple of its value at the window's start."""
    seen = part.seen
    time_offset = float(seen.t[part.first]) - part.start  # by which its first sample comes later than the window begins
    growth_bound = float(bounds_between_samples.fastest_between(seen)[0]) * time_offset if part.first else 0.0
    bound = tolerances.cohesion * seen.radius[part.first].widened(growth_bound)
    return _always("cohesive", part, seen.radius, bounds_between_samples.radius_over(seen), bound)


def _checked(seen: Observed, tolerances: Tolerances, *, strict: bool) -> Checked:
    window, part = _window(seen, tolerances)
    if unmet(needs := [window]):
        return needs, []
    claims = [_connected(part)] if strict else [_giant(part, tolerances), _cohesive(part, tolerances)]
    return needs, [*claims, *_common(part, tolerances)]


@run_theorem(
    "alpha-flocking",
    title="The run is α-flocking (Definition 5)",
    source="Olfati-Saber 2006, Definition 5",
    law=has_lattice,
    on_motion=True,
    enclosed=enclosed_by("alpha_flocking", f"{__package__}.alpha_flocking_enclosed"),
    claims=("giant", "cohesive", "deviation", "mismatch"),
    leads={"giant": bridge},
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Over [t0, tf] the net keeps a giant component, the group stays cohesive, Ẽ <= ε₁ and K̃ <= ε₂. The source gives
    no numbers for 'giant', 'cohesive', ε₁, ε₂; those used are in the tolerances. One sample is no window.
    """
    return _checked(seen, tolerances, strict=False)


@run_theorem(
    "alpha-flocking-strict",
    title="The run is strictly α-flocking (Definition 5)",
    source="Olfati-Saber 2006, Definition 5, strict form",
    law=has_lattice,
    on_motion=True,
    enclosed=enclosed_by("alpha_flocking_strict", f"{__package__}.alpha_flocking_enclosed"),
    claims=("flock", "deviation", "mismatch"),
    leads={"flock": bridge},
)
def strictly(seen: Observed, tolerances: Tolerances) -> Checked:
    """Over [t0, tf] the net is connected, Ẽ <= ε₁ and K̃ <= ε₂."""
    return _checked(seen, tolerances, strict=True)
