"""The delay at which a flock loses stability, and how much faster a flock settles with gains for each agent."""

from __future__ import annotations

from typing import Any

import numpy as np

from flockana.environment.targets import StaticTarget
from flockana.equilibria.solve import find_equilibrium
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_patch, hexagonal_spiral
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.stability.delay import DelaySystem, delay_margin, delay_system, rightmost_roots, root_error, scalar_margin
from flockana.stability.design import GainDesign, design_gains, gain_problem
from flockana.stability.rounding import eigen
from flockana.theorems.claims import judged
from flockana.theorems.rounding import EPS
from flockana.theorems.theorem import Checked, Claim, Theorem, Tolerances

_WHAT = {
    "all": "all terms delayed",
    "pairs": "terms between agents delayed",
    "neighbours": "only what is heard of other agents delayed",
}
_WORTH = 0.01  # gain in the rate that counts: both searches end at roots that coalesce, and near the best only
_CUSP = 1e-4  # relative error of a rate at coalescing roots
_ALIKE = 1e-9  # relative, of the sweep's margin and the closed form's
_AROUND = 0.02  # of the margin: how far to either side stability is looked at
_DESIGNS: tuple[tuple[str, int, dict[str, Any], str], ...] = (
    ("printed", 12, {"rotation": "counted"}, "matrix as printed, rotation counted"),
    ("apart", 12, {"rotation": "apart"}, "rotation set apart"),
    ("simplified", 30, {"form": "simplified"}, "simplified form, without ∇²V"),
)


def _check_delays(tolerances: Tolerances) -> Checked:
    laws = Algorithm1(), Algorithm2(target=StaticTarget((0.0, 0.0)))
    return [], [*(_delay(law, delayed) for law in laws for delayed in _WHAT), _pair(laws[0])]


def _pair(law: Algorithm1) -> Claim:
    """Two agents on a line have one mode beside uniform motion: the sweep must find the closed form's delay."""
    system = delay_system(law, find_equilibrium(law, [[0.0], [law.alpha.length]]).q, delayed="all")
    stiffness, damping = (float(matrix[0, 0] - matrix[0, 1]) for matrix in system.late)
    swept, exact = delay_margin(system).delay, scalar_margin(stiffness, damping).delay
    off = abs(swept - exact) / exact
    return judged(
        "pair",
        _ALIKE - off,
        64.0 * EPS,
        computed={"sweep": swept, "closed form": exact},
        stated=f"τ* = atan2(ωd, k)/ω with ω² = ½(d² + √(d⁴ + 4k²)), to {_ALIKE:g} of it",
        proof="second-order-modes",
        detail=f"k = {stiffness:.5g}, d = {damping:.4g}: τ* = {exact:.6g}, off by {off:.1g} of it",
    )


def _delay(law: Algorithm1 | Algorithm2, delayed: str) -> Claim:
    """A delay margin by a sweep over frequency, and to either side of it roots by discretising the delayed state."""
    kind, q = type(law).__name__[-1], find_equilibrium(law, hexagonal_patch(1, law.alpha.length)).q
    system = delay_system(law, q, delayed=delayed)
    critical = delay_margin(system)
    below, error_below = _rightmost(system, (1.0 - _AROUND) * critical.delay)
    above, error_above = _rightmost(system, (1.0 + _AROUND) * critical.delay)
    return judged(
        f"algorithm-{kind}-{delayed}",
        *min((-below, error_below), (above, error_above)),
        computed={"n": len(q), "delay": critical.delay, "frequency": critical.frequency},
        stated="the rightmost root has Re s < 0 just below the margin and Re s > 0 just above",
        witness={"Re s below": below, "Re s above": above},
        detail=f"hexagon of {len(q)}, Algorithm {kind}, {_WHAT[delayed]}: stable up to τ* = "
        f"{critical.delay:.5g}, then a swing at {critical.frequency:.4g} rad per time unit; Re s = {below:.2g} "
        f"at 0.98 τ*, {above:+.2g} at 1.02 τ*",
    )


def _rightmost(system: DelaySystem, delay: float) -> tuple[float, float]:
    """The largest real part of a characteristic root, and its error."""
    root = complex(rightmost_roots(system, delay, count=2)[0])
    return root.real, root_error(system, root, delay)


def _check_designs(tolerances: Tolerances) -> Checked:
    return [], [_design(*case) for case in _DESIGNS]


def _design(name: str, n: int, options: dict[str, Any], words: str) -> Claim:
    """The gain in rate that a search finds, at a size that takes seconds; one that finds little refutes nothing."""
    alpha = AlphaInteraction()
    problem = gain_problem(hexagonal_spiral(n, alpha.d), alpha=alpha, gains=Gains(), **options)
    best = design_gains(problem, starts=1)
    return judged(
        name,
        best.ratio - 1.0 - _WORTH,
        _ratio_error(best),
        refutes=False,
        computed={"n": n, "alike": best.rate_homogeneous, "per agent": best.rate_heterogeneous},
        stated="gains of its own for each agent make the slowest mode die out faster than one pair for all, by "
        f"more than {_WORTH:.0%}",
        witness={"ratio": best.ratio},
        detail=f"n = {n}, {words}, gains within [0, 5]: decay rate {best.rate_homogeneous:.4f} alike, at "
        f"least {best.rate_heterogeneous:.4f} per agent, {100.0 * (best.ratio - 1.0):.2g} % faster",
    )


def _ratio_error(design: GainDesign) -> float:
    """Error of the ratio of the two rates, from the rounding of the eigenvalues that certify them.

    At the best gains roots coalesce, and a rate depends on them as a root: where they are found to 2e-9, it is to 1e-4.
    """
    slow = []
    for gains in (design.homogeneous, design.heterogeneous):
        values, _, errors = eigen(design.problem.matrix(gains))
        k = int(np.argmax(values.real))
        slow.append(float(errors[k]) / abs(float(values[k].real)))
    return design.ratio * (sum(slow) + _CUSP)


THEOREM = (
    Theorem(
        id="delay-margin",
        title="The delay at which a flock loses stability",
        statement=(
            "If what agents know of each other, or of everything, is τ old, the linearised flock is stable below a "
            "delay margin τ* and unstable just above it. τ* is found by a sweep over frequency, the roots to either "
            "side by a discretisation of the delayed state (Breda, Maset, Vermiglio). Of two agents on a line τ* has a "
            "closed form."
        ),
        source="ours",
        kind="fixed",
        check=_check_delays,
        expected={"delay-margin": "verified"},
    ),
    Theorem(
        id="heterogeneous-gains",
        title="Do gains of its own for each agent make a faster flock?",
        statement=(
            "Per-agent c1γ and c2γ within bounds can make the slowest mode of the linearised flock decay faster than "
            "any gains alike. The printed matrix holds the flock's rotation, which no flock at rest does: with the "
            "rotation set apart the gain nearly vanishes."
        ),
        source="Montanari, Barioni, Duan, Motter, Optimal flock formation induced by agent heterogeneity",
        kind="fixed",
        check=_check_designs,
        references=("montanari-2025", "olfati-saber-2006"),
        expected={
            "heterogeneous-gains:printed": "verified",
            "heterogeneous-gains:apart": "inconclusive",
            "heterogeneous-gains:simplified": "verified",
        },
    ),
)
