"""Definition 5 of Olfati-Saber (2006), α-flocking, plain and strict, as two checkable statements."""

from __future__ import annotations

from dataclasses import dataclass
from math import floor, inf

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.discrete import DiscreteLaw
from flockana.theorems.claims import judged
from flockana.theorems.from_tube import enclosed_by
from flockana.theorems.hypotheses import condition, has_lattice
from flockana.theorems.leads import bridge
from flockana.theorems.rounding import EPS, frame_error, spread_error
from flockana.theorems.sampling import (
    fastest_between,
    mismatch_between,
    nets_at,
    nets_between,
    radius_between,
    stretch_between,
)
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances, unmet

_SHARE = 1e-9  # of an agent: what a share of n agents, as a decimal fraction, may be off by


@dataclass(frozen=True)
class _Window:
    """A part of a run, with the sample before it if it begins between two: bounds between samples begin there.

    Attributes
    ----------
    run : Trajectory
        Its samples, and that one.
    first : int
        The first sample within.
    start : float
        When it begins.
    """

    run: Trajectory
    first: int
    start: float


def _window(run: Trajectory, tolerances: Tolerances) -> tuple[Hypothesis, _Window]:
    """The part of a run that is judged: flocking is defined over a time, which one instant is not."""
    start = float(run.t[0] + tolerances.settle * (run.t[-1] - run.t[0]))
    before = int(np.searchsorted(run.t, start, side="right")) - 1
    lead = run.t[before] < start and not isinstance(run.law, DiscreteLaw)  # a map is nowhere between its steps
    begin = float(run.t[before]) if lead else start
    part = run.remembered(f"window from {begin!r}", lambda: run.window(begin, float(run.t[-1])))
    count = len(part.t) - int(lead)
    detail = f"from t = {part.t[-count]:.4g} to {part.t[-1]:.4g}, at {count} samples"
    return condition("judged over a window", count > 1, detail=detail), _Window(part, int(lead), start)


def _always(name: str, part: _Window, value: FloatArray, bound: float, error: FloatArray, between: FloatArray) -> Claim:
    """A claim that a quantity stays below a bound: broken at one sample, or kept at all of them and in between."""
    (symbol, what), t = _SYMBOLS[name], part.run.t[part.first :]
    value, error = value[part.first :], error[part.first :]
    worst = int(np.argmax(value - error))
    if not value[worst] - error[worst] > bound:
        worst = int(np.argmax(value + error))
        between = np.maximum(between - value[worst], 0.0)
        error = error + float(between.max(initial=0.0))
    return judged(
        name,
        bound - float(value[worst]),
        float(error[worst]),
        computed=float(value[worst]),
        stated=f"{symbol} <= {bound:.4g}",
        witness={"time": float(t[worst])},
        detail=f"{what} {symbol}: {value[worst]:.4g} at worst, at t = {t[worst]:.4g}",
    )


_SYMBOLS = {
    "cohesive": ("R", "cohesion radius"),
    "deviation": ("Ẽ", "normalised deviation energy"),
    "mismatch": ("K̃", "normalised velocity mismatch, over the law's speed²,"),
}


def _never_more(name: str, part: _Window, counts: tuple[FloatArray, FloatArray, float], most: int, what: str) -> Claim:
    """A claim that a number never exceeds a bound, in whole numbers (at samples at least, at most; between)."""
    t, between = part.run.t[part.first :], counts[2]
    least, largest = (series[part.first :] for series in counts[:2])
    worst = int(np.argmax(least))
    broken = least[worst] > most
    worst = worst if broken else int(np.argmax(largest))
    margin = most + 0.5 - (float(least[worst]) if broken else max(float(largest[worst]), between))
    certain = broken or margin > 0.0
    near = "whether there are ever more is open: a pair comes as near to r as this run can tell"
    return judged(
        name,
        margin,
        0.0 if certain else inf,
        computed=int(least[worst]),
        stated=f"at most {most}",
        witness={"time": float(t[worst])},
        detail=f"{what}: {int(least[worst])} at worst, at t = {t[worst]:.4g}, where {most} may be"
        + ("" if certain else f"; {near}"),
    )


def _connected(part: _Window) -> Claim:
    """The claim that the net is connected throughout, by links that are certain."""
    between, at = nets_between(part.run), nets_at(part.run)
    counts = at.components_least, at.components, float(between.components.max(initial=0.0))
    return _never_more("flock", part, counts, 1, "components")


def _giant(part: _Window, tolerances: Tolerances) -> Claim:
    """The claim that a component keeps more than a share of the agents, by links that are certain."""
    run = part.run
    between, at = nets_between(run), nets_at(run)
    fewest = floor(tolerances.giant * run.n + _SHARE) + 1  # agents that are more than the share
    counts = run.n - at.giant_most, run.n - at.giant, float(run.n - between.giant.min(initial=run.n))
    return _never_more("giant", part, counts, run.n - fewest, "agents outside the giant component")


def _common(part: _Window, tolerances: Tolerances) -> list[Claim]:
    """The claims Ẽ <= ε₁ and K̃ <= ε₂; a link that may come or go between samples, or by rounding, adds to Ẽ."""
    run = part.run
    (d, r), units = run.law.lattice, run.scales.energy
    deviation, mismatch = run.metric("normalised_deviation_energy"), run.metric("normalised_velocity_mismatch") / units
    rounding = 8.0 * EPS * (float(np.abs(run.q).max()) / d + 1.0)
    error = 2.0 * np.sqrt(deviation) * rounding + rounding**2 + 4.0 * EPS * run.n * deviation
    one_link = 2.0 * (r / d - 1.0) ** 2
    at, during = nets_at(run), nets_between(run)
    error += one_link * at.open_links / (2.0 * at.links + 1.0)
    jumps = one_link * during.open_links / (2.0 * during.links + 1.0)
    own = spread_error(run.p) / (run.n * units)
    # of links that stay: √Ẽ is a norm of their deviations, and grows by no more than the largest of them does
    ends = np.sqrt(np.maximum(deviation[:-1], deviation[1:]))
    between = (ends + stretch_between(run) / d) ** 2 + jumps
    return [
        _always("deviation", part, deviation, tolerances.deviation, error, between),
        _always("mismatch", part, mismatch, tolerances.mismatch, own, mismatch_between(run) / units),
    ]


def _cohesive(part: _Window, tolerances: Tolerances) -> Claim:
    """The claim that R never exceeds a multiple of its value at the start of the window."""
    run = part.run
    radius = run.metric("cohesion_radius")
    after = float(run.t[part.first]) - part.start  # by which its first sample comes later than the window begins
    grown = fastest_between(run)[0] * after if part.first else 0.0
    error = np.full(len(run.t), 4.0 * frame_error(run.q) + tolerances.cohesion * grown)
    bound = tolerances.cohesion * float(radius[part.first])
    return _always("cohesive", part, radius, bound, error, radius_between(run))


def _given(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], _Window]:
    window, part = _window(run, tolerances)
    return [has_lattice(run), window], part


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    needs, part = _given(run, tolerances)
    if unmet(needs):
        return needs, []
    return needs, [_giant(part, tolerances), _cohesive(part, tolerances), *_common(part, tolerances)]


def _check_strict(run: Trajectory, tolerances: Tolerances) -> Checked:
    needs, part = _given(run, tolerances)
    return needs, [] if unmet(needs) else [_connected(part), *_common(part, tolerances)]


THEOREM = (
    Theorem(
        id="alpha-flocking",
        title="The run is α-flocking (Definition 5)",
        statement=(
            "Over [t0, tf] the net keeps a giant component, the group stays cohesive, Ẽ <= ε₁ and K̃ <= ε₂. The source "
            "gives no numbers for 'giant', 'cohesive', ε₁, ε₂; those used are in the tolerances. One "
            "sample is no window."
        ),
        source="Olfati-Saber 2006, Definition 5",
        kind="trajectory",
        check=_check,
        enclosed=enclosed_by("alpha_flocking", "flocking_enclosed"),
        claims=("giant", "cohesive", "deviation", "mismatch"),
        leads={"giant": bridge},
    ),
    Theorem(
        id="alpha-flocking-strict",
        title="The run is strictly α-flocking (Definition 5)",
        statement="Over [t0, tf] the net is connected, Ẽ <= ε₁ and K̃ <= ε₂.",
        source="Olfati-Saber 2006, Definition 5, strict form",
        kind="trajectory",
        check=_check_strict,
        enclosed=enclosed_by("alpha_flocking_strict", "flocking_enclosed"),
        claims=("flock", "deviation", "mismatch"),
        leads={"flock": bridge},
    ),
)
