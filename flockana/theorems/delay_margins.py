"""Delay margins of flocks: the delay at which stability is lost."""

from flockana.environment.targets import StaticTarget
from flockana.equilibria.solve import find_equilibrium
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.stability.delay import DelaySystem, delay_margin, scalar_margin
from flockana.stability.delay_roots import rightmost_roots, root_error
from flockana.stability.law_studies import delay_system
from flockana.theorems.theorem_toolkit import EPS, Claim, Tolerances, erratum, spectral

_WHAT = {
    "all": "all terms delayed",
    "pairs": "terms between agents delayed",
    "neighbours": "only what is heard of other agents delayed",
}
_ALIKE = 1e-9  # relative, of the sweep's margin and the closed form's
_AROUND = 0.02  # of the margin: how far to either side stability is looked at


def _pair(law: Algorithm1) -> Claim:
    """Return the claim that the sweep finds the closed-form delay of two agents on a line."""
    system = delay_system(law, find_equilibrium(law, [[0.0], [law.alpha.length]]).q, delayed="all")
    stiffness, damping = (float(matrix[0, 0] - matrix[0, 1]) for matrix in system.late)
    swept_delay, exact = delay_margin(system).delay, scalar_margin(stiffness, damping).delay
    deviation = abs(swept_delay - exact) / exact
    return spectral("pair", _ALIKE - deviation, 64.0 * EPS, proof="second-order-modes").described(
        computed={"sweep": swept_delay, "closed form": exact},
        stated="τ* = atan2(ωd, k)/ω with ω² = ½(d² + √(d⁴ + 4k²))",
        detail=f"k = {stiffness:.5g}, d = {damping:.4g}: τ* = {exact:.6g}; a sweep over frequency finds it to "
        f"{deviation:.1g} of its value",
    )


def _delay(law: Algorithm1 | Algorithm2, delayed: str) -> Claim:
    """Return the claim on a delay margin from a frequency sweep, checked by roots on either side."""
    kind, q = type(law).__name__[-1], find_equilibrium(law, hexagonal_patch(1, law.alpha.length)).q
    system = delay_system(law, q, delayed=delayed)
    critical = delay_margin(system)
    below, error_below = _rightmost(system, (1.0 - _AROUND) * critical.delay)
    root_above, error_above = _rightmost(system, (1.0 + _AROUND) * critical.delay)
    return spectral(f"algorithm-{kind}-{delayed}", *min((-below, error_below), (root_above, error_above))).described(
        computed={"n": len(q), "delay": critical.delay, "frequency": critical.frequency},
        stated="the rightmost root has Re s < 0 just below the margin and Re s > 0 just above",
        witness={"Re s below": below, "Re s above": root_above},
        detail=f"hexagon of {len(q)}, Algorithm {kind}, {_WHAT[delayed]}: stable up to τ* = "
        f"{critical.delay:.5g}, then a swing at {critical.frequency:.4g} rad per time unit; Re s = {below:.2g} "
        f"at 0.98 τ*, {root_above:+.2g} at 1.02 τ*",
    )


def _rightmost(system: DelaySystem, delay: float) -> tuple[float, float]:
    """Return the largest real part of a characteristic root, and its error."""
    root = complex(rightmost_roots(system, delay, count=2)[0])
    return root.real, root_error(system, root, delay)


@erratum(
    "delay-margin",
    title="The delay at which a flock loses stability",
    source="ours",
    expected={
        "verified": " ".join(["pair", *(f"algorithm-{kind}-{delay_kind}" for kind in (1, 2) for delay_kind in _WHAT)])
    },
    author="flockana",
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """If what agents know of each other, or of everything, is τ old, the linearised flock is stable below a delay
    margin τ* and unstable just above it. τ* is found by a sweep over frequency, the roots on either side of it by a
    discretisation of the delayed state (Breda, Maset, Vermiglio). For two agents on a line τ* has a closed form.
    """
    laws = Algorithm1(), Algorithm2(target=StaticTarget((0.0, 0.0)))
    return [*(_delay(law, delay_kind) for law in laws for delay_kind in _WHAT), _pair(laws[0])]
