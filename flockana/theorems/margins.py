"""Delays that a flock bears near its equilibrium, and what gains of its own for each agent gain."""

from __future__ import annotations

from typing import Any

import numpy as np

from flockana.environment.targets import StaticTarget
from flockana.equilibria.solve import find_equilibrium
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_patch, hexagonal_spiral
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.stability.delay import DelaySystem, delay_margin, delay_system, rightmost_roots, root_error
from flockana.stability.design import GainDesign, design_gains, gain_problem
from flockana.stability.rounding import eigen
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge

_WHAT = {"all": "all terms delayed", "pairs": "terms between agents delayed"}
_WORTH = 0.01  # gain in the rate that is called one: both searches end at roots that coalesce, and near the best only
_CUSP = 1e-4
_AROUND = 0.02  # of the margin: how far to either side stability is looked at
_DESIGNS: tuple[tuple[str, int, dict[str, str], str], ...] = (
    ("printed", 12, {"rotation": "counted"}, "matrix as printed, rotation counted"),
    ("apart", 12, {"rotation": "apart"}, "rotation set apart"),
    ("simplified", 30, {"form": "simplified"}, "simplified form, without ∇²V"),
)


def _delays(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    """Margins by a sweep over frequency; to either side, roots by a discretisation that knows nothing of them."""
    claims = []
    for law in (Algorithm1(), Algorithm2(target=StaticTarget((0.0, 0.0)))):
        kind = type(law).__name__[-1]
        q = find_equilibrium(law, hexagonal_patch(1, law.alpha.length)).q
        for delayed in ("all", "pairs"):
            system = delay_system(law, q, delayed=delayed)
            found = delay_margin(system)
            (below, one), (above, two) = (
                _rightmost(system, factor * found.delay) for factor in (1.0 - _AROUND, 1.0 + _AROUND)
            )
            margin, error = min((-below, one), (above, two))
            claims.append(
                Claim(
                    f"algorithm-{kind}-{delayed}",
                    judge(margin, error, []),
                    computed={"n": len(q), "delay": found.delay, "frequency": found.frequency},
                    stated="the rightmost root has Re s < 0 just below the margin and Re s > 0 just above",
                    margin=margin,
                    error=error,
                    witness={"Re s below": below, "Re s above": above},
                    detail=f"hexagon of {len(q)}, Algorithm {kind}, {_WHAT[delayed]}: stable up to τ* = "
                    f"{found.delay:.5g}, then a swing at {found.frequency:.4g} rad per time unit; Re s = {below:.2g} "
                    f"at 0.98 τ*, {above:+.2g} at 1.02 τ*",
                )
            )
    return [], claims


def _rightmost(system: DelaySystem, delay: float) -> tuple[float, float]:
    """The largest real part of a characteristic root, and its error."""
    root = complex(rightmost_roots(system, delay, count=2)[0])
    return root.real, root_error(system, root, delay)


def _designs(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    """The question of Montanari and others, at a size that takes seconds."""
    claims = []
    for name, n, options, words in _DESIGNS:
        alpha, gains = AlphaInteraction(), Gains()
        kind: dict[str, Any] = dict(options)
        found = design_gains(gain_problem(hexagonal_spiral(n, alpha.d), alpha=alpha, gains=gains, **kind), starts=1)
        margin, error = found.ratio - 1.0 - _WORTH, _ratio_error(found)
        claims.append(
            Claim(
                name,
                # a search that finds little refutes nothing
                "verified" if judge(margin, error, []) == "verified" else "inconclusive",
                computed={"n": n, "alike": found.rate_homogeneous, "per agent": found.rate_heterogeneous},
                stated="gains of its own for each agent make the slowest mode die out faster than one pair for all, by "
                f"more than {_WORTH:.0%}",
                margin=margin,
                error=error,
                witness={"ratio": found.ratio},
                detail=f"n = {n}, {words}, gains within [0, 5]: decay rate {found.rate_homogeneous:.4f} alike, at "
                f"least {found.rate_heterogeneous:.4f} per agent, {100.0 * (found.ratio - 1.0):.2g} % faster",
            )
        )
    return [], claims


def _ratio_error(found: GainDesign) -> float:
    """Of the ratio of the two rates, from the rounding of the eigenvalues that certify them.

    At the best gains roots coalesce, and a rate depends on them as a root: where they are found to 2e-9, it is to 1e-4.
    """
    slow = []
    for gains in (found.homogeneous, found.heterogeneous):
        values, _, errors = eigen(found.problem.matrix(gains))
        k = int(np.argmax(values.real))
        slow.append(float(errors[k]) / abs(float(values[k].real)))
    return found.ratio * (sum(slow) + _CUSP)


THEOREM = (
    Theorem(
        id="delay-margin",
        title="The delay at which a flock loses stability",
        statement=(
            "If what agents know of each other, or of everything, is τ old, the linearised flock is stable below a "
            "delay margin τ* and unstable just above it. τ* is found by a sweep over frequency, the roots to either "
            "side by a discretisation of the delayed state (Breda, Maset, Vermiglio)."
        ),
        source="ours",
        kind="fixed",
        check=_delays,
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
        check=_designs,
        references=("montanari-2025", "olfati-saber-2006"),
        expected={
            "heterogeneous-gains:printed": "verified",
            "heterogeneous-gains:apart": "inconclusive",
            "heterogeneous-gains:simplified": "verified",
        },
    ),
)
