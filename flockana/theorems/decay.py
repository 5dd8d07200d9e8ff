"""Predictions of the linearisation for a flock near its equilibrium, compared with nonlinear runs."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import sqrt
from typing import Any

from flockana.base.errors import ArgumentError, FlockanaError
from flockana.environment.obstacles import Wall
from flockana.environment.targets import StaticTarget
from flockana.equilibria.solve import find_equilibrium
from flockana.interactions import AlphaInteraction
from flockana.lattice import hexagonal_patch
from flockana.lattice.builders import fcc_star
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.stability.decay import Decay, LinearRange, decay, decay_table, linear_range
from flockana.stability.linearisation import Linearisation
from flockana.stability.linearise import linearise
from flockana.theorems.claims import erratum, run_theorem, spectral, undecided
from flockana.theorems.theorem_toolkit import Checked, Claim, FloatArray, Hypothesis, Observed, Tolerances, condition

RANGES = ("hexagon 19, Algorithm 1", "hexagon 19, Algorithm 2")
_MOST = 200  # agents: the spectrum is dense
_KNOWN = 0.1  # of the law's length: to which a recorded last state must be known
_STEPS = 100  # of a solve: an equilibrium beside the last state takes a few
_RANGE_FIELDS = ("exponent", "amplitudes", "deviations", "net_changes", "margin")
_EXPONENT = 0.05  # how far from 2: the first amplitudes still hold a share of the next term


def lattice_equilibria() -> dict[str, Linearisation]:
    """Return linearised flocks of the catalogue: hexagonal patches, an FCC site, a hexagon at a wall."""
    d = AlphaInteraction().d
    nets: dict[str, FloatArray] = {f"hexagon {3 * k * (k + 1) + 1}": hexagonal_patch(k, d) for k in (1, 2, 3)}
    nets["FCC site 13"] = fcc_star(d)
    flocks = {}
    for name, q in nets.items():
        for law in (Algorithm1(), Algorithm2(target=StaticTarget(q.mean(axis=0)))):
            flocks[f"{name}, Algorithm {type(law).__name__[-1]}"] = linearise(law, find_equilibrium(law, q))
    wall = Algorithm3(target=StaticTarget((0.0, 2.0)), obstacles=(Wall((0.0, 0.0), (0.0, 1.0)),))
    start = nets["hexagon 7"] + (0.0, 12.0)
    return flocks | {"hexagon 7 at a wall, Algorithm 3": linearise(wall, find_equilibrium(wall, start))}


def row(rates: Decay) -> dict[str, Any]:
    """Return a row of the table of decay rates as plain data."""
    return {
        "law": rates.law,
        "n": rates.n,
        "m": rates.m,
        "mode": rates.mode.name,
        "frequency": rates.mode.frequency,
        "predicted": rates.predicted,
        "measured": rates.measured,
        "error": rates.error,
        "random, linear": rates.random_linear,
        "random, measured": rates.random_measured,
    }


def _agreement(decays: Sequence[Decay], tolerances: Tolerances) -> list[Claim]:
    """Return the claims about the decay rate along the slowest mode, and late rates from random starts."""
    worst = max(decays, key=lambda each: each.difference)
    other = max(decays, key=lambda each: each.random_difference)
    error = max(each.error / each.predicted for each in decays)
    return [
        spectral("decay", tolerances.agreement - worst.difference, error).described(
            computed={each.name: row(each) for each in decays},
            stated="K̃ falls at twice the decay rate of the slowest mode, along which the flock was displaced",
            witness=worst.name,
            detail=f"measured rates differ from the predicted ones by {worst.difference:.2g} at most ({worst.name}: "
            f"measured {worst.measured:.6g}, predicted {worst.predicted:.6g})",
        ),
        spectral("random", tolerances.agreement - other.random_difference, error).described(
            computed=other.random_measured,
            stated=other.random_linear,
            witness=other.name,
            detail="from random starts K̃ falls late in the run at the linear system's rate, up to "
            f"{other.random_difference:.2g} ({other.name}: measured {other.random_measured:.6g}, predicted "
            f"{other.random_linear:.6g}; the slowest mode alone decays at {other.predicted:.6g})",
        ),
    ]


def _range(ranges: Mapping[str, LinearRange], alpha: AlphaInteraction) -> Claim:
    """Return the claim about the deviation's exponent: the first neglected term is quadratic about a lattice."""
    exponents = [item.exponent for item in ranges.values()]
    margin = _EXPONENT - max(abs(exponent - 2.0) for exponent in exponents)
    error = max(item.exponent_error for item in ranges.values())
    bend = sqrt(1.0 + alpha.eps * alpha.d**2) / alpha.d**2  # σ₁'s argument is 1 where ‖q_ij‖_σ is off by 1
    limits = [f"{name}: 1 % at {x.limit(0.01):.2g} d, 10 % at {x.limit(0.1):.2g} d" for name, x in ranges.items()]
    return spectral("range", margin, error).described(
        computed={
            name: {key.replace("_", " "): getattr(x, key) for key in _RANGE_FIELDS} for name, x in ranges.items()
        },
        stated="a run leaves its linear prediction by a distance that grows as the square of the amplitude",
        witness={"σ₁ bends at": bend, "a link reaches r at": {name: item.margin for name, item in ranges.items()}},
        detail=f"exponents {', '.join(f'{exponent:.3f}' for exponent in exponents)}; deviation of "
        f"{'; '.join(limits)}. σ₁ saturates where a link is off by {bend:.2g} d, and that ends the linear range, long "
        "before a link reaches r",
    )


def _terminal(seen: Observed) -> tuple[Linearisation | None, str]:
    """Return the linearised equilibrium near the run's last state; or None with a reason."""
    law: Any = seen.law
    if type(law) not in (Algorithm1, Algorithm2, Algorithm3):  # a subclass may push otherwise
        return None, f"{type(law).__name__} has no equilibria that are sought here"
    if seen.n > _MOST:
        return None, f"n = {seen.n}: more than {_MOST}"
    if law.target is not None:
        law = replace(law, target=StaticTarget(law.target.position(float(seen.t[-1]))))
    try:
        equilibrium = find_equilibrium(law, seen.end.q, method="descent", max_iter=_STEPS)
        linear = linearise(law, equilibrium)
    except FlockanaError as error:
        return None, str(error)
    return linear, f"residual {linear.residual:.2g}, decay rate {linear.decay_rate:.4g}"


_NAMES = ("decay", "random")


@erratum(
    "linearised-decay",
    title="The linearisation is accurate near lattices",
    source="ours; the statement is textbook knowledge",
    expected={"verified": "decay random range"},
    author="flockana",
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Near a stable equilibrium a flock moves as its linearisation says: a small perturbation along the slowest mode
    dies out at that mode's decay rate σ, K̃ at 2σ (Lyapunov's first method), and the distance from the linear prediction
    grows as the square of the perturbation. Checked on hexagonal patches, an FCC site, and a hexagon at a wall.
    """
    flocks = lattice_equilibria()
    ranges = {name: linear_range(flocks[name], name=name) for name in RANGES}
    return [*_agreement(decay_table(flocks), tolerances), _range(ranges, AlphaInteraction())]


@run_theorem(
    "linearised-decay-terminal",
    title="The linearisation is accurate where a run ends",
    source="ours; the statement is textbook knowledge",
    claims=_NAMES,
    on_motion=True,
    reason="no stable equilibrium to return to",
    author="flockana",
)
def where_a_run_ends(seen: Observed, tolerances: Tolerances) -> Checked:
    """Near a stable equilibrium a flock moves as its linearisation says: a small perturbation along the slowest mode
    dies out at that mode's decay rate σ, K̃ at 2σ (Lyapunov's first method). Checked at the equilibrium that the run's
    last state is near to.
    """
    name, accuracy = "an equilibrium near the last state is stable", seen.accuracy_of_end
    if accuracy > _KNOWN * seen.scales.length:
        requirement = Hypothesis(name, "assumed", detail=f"the last state is known to {accuracy:.2g} only")
        return [requirement], [undecided(item, requirement.detail, [requirement]) for item in _NAMES]
    linear, reason_text = _terminal(seen)
    is_stable = linear is not None and bool(linear.modes) and linear.stable
    conditions = [condition(name, is_stable, detail=reason_text, decided="enclosed")]
    if linear is None or not is_stable:
        return conditions, []
    try:
        rates = decay(linear, name=f"n = {seen.n}, last state")
    except ArgumentError as error:  # it has no shape, or hardly any damping
        return conditions, [undecided(name, f"no rate was measured: {error}") for name in _NAMES]
    return conditions, _agreement([rates], tolerances)
