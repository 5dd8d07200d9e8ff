"""Definition 5 of Olfati-Saber (2006), α-flocking, plain and strict, as two checkable statements."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge
from flockana.trajectory import Trajectory


def _settled(run: Trajectory, tolerances: Tolerances) -> Trajectory:
    return run.window(float(run.t[0] + tolerances.settle * (run.t[-1] - run.t[0])), float(run.t[-1]))


def _always(
    name: str, run: Trajectory, margin: npt.NDArray[np.float64], value: npt.NDArray[np.float64], stated: str, what: str
) -> Claim:
    """A claim that must hold at every sample of the window: the worst one decides."""
    worst = int(np.argmin(margin))
    return Claim(
        name,
        judge(float(margin[worst]), 0.0, []),
        computed=float(value[worst]),
        stated=stated,
        margin=float(margin[worst]),
        error=0.0,
        witness={"time": float(run.t[worst])},
        detail=f"{what}: {value[worst]:.4g} at worst, at t = {run.t[worst]:.4g}",
    )


def _common(run: Trajectory, tolerances: Tolerances) -> list[Claim]:
    metrics = run.metrics()
    deviation, mismatch = metrics.deviation_energy.values, metrics.velocity_mismatch.values
    eps1, eps2 = tolerances.deviation, tolerances.mismatch
    return [
        _always("deviation", run, eps1 - deviation, deviation, f"Ẽ <= ε₁ = {eps1:g}", "deviation energy Ẽ"),
        _always("mismatch", run, eps2 - mismatch, mismatch, f"K̃ <= ε₂ = {eps2:g}", "velocity mismatch K̃"),
    ]


def _window(run: Trajectory, part: Trajectory) -> Hypothesis:
    detail = f"from t = {part.t[0]:.4g} to {part.t[-1]:.4g}, at {len(part.t)} samples"
    return Hypothesis("judged over a window", "met", detail=detail)


def _plain(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    part = _settled(run, tolerances)
    share, radius = part.metrics().giant_share.values, part.metrics().cohesion_radius.values
    bound, least = tolerances.cohesion * float(radius[0]), tolerances.giant
    return [_window(run, part)], [
        # shares come in steps of 1/n: a quarter step makes "more than" strict without a margin of 0
        _always("giant", part, share - least - 0.25 / run.n, share, f"C* > {least:g}", "giant component C*"),
        _always("cohesive", part, bound - radius, radius, f"R <= {bound:.4g}", "cohesion radius R"),
        *_common(part, tolerances),
    ]


def _strict(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    part = _settled(run, tolerances)
    connectivity = part.metrics().connectivity.values
    return [_window(run, part)], [
        # C comes in steps of 1/(n − 1): half a step below 1 lies between connected and not
        _always("flock", part, connectivity - 1.0 + 0.5 / max(1, run.n - 1), connectivity, "C = 1", "connectivity C"),
        *_common(part, tolerances),
    ]


THEOREM = (
    Theorem(
        id="alpha-flocking",
        title="The run is α-flocking (Definition 5)",
        statement=(
            "Over [t0, tf] the net keeps a giant component, the group stays cohesive, Ẽ <= ε₁ and K̃ <= ε₂. The source "
            "gives no numbers for 'giant', 'cohesive', ε₁, ε₂; those used are in the tolerances."
        ),
        source="Olfati-Saber 2006, Definition 5",
        kind="trajectory",
        check=_plain,
    ),
    Theorem(
        id="alpha-flocking-strict",
        title="The run is strictly α-flocking (Definition 5)",
        statement="Over [t0, tf] the net is connected, Ẽ <= ε₁ and K̃ <= ε₂.",
        source="Olfati-Saber 2006, Definition 5, strict form",
        kind="trajectory",
        check=_strict,
    ),
)
