"""Input-to-state stability: a bounded disturbance leaves a flock near its certified equilibrium."""

from typing import Any, NamedTuple

import numpy as np

from flockana.base.errors import FlockanaError
from flockana.equilibria.solve import find_equilibrium
from flockana.laws.disturbed_law import Disturbed
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.measures.centre_frame import moving_frame
from flockana.theorems.claims import conclude, run_theorem
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Status, Tolerances
from flockana.theorems.theorem_toolkit import Enclosure, FloatArray, Observed, condition

_CLAIMS, _PROOF = ("stays", "ultimate"), "disturbed-basins"
_SLACK = 1e-12  # relative: rounding of a force's length
_LAST = 0.2  # of the run: what is its end
_SAMPLES = 40  # that are looked at in all
_MOST = 7  # agents of which a basin is proved within seconds


class _Case(NamedTuple):
    """Ultimate bound and initial state in units of ℓ, the length unit of σ₁."""

    bound: Any  # UltimateBound
    q: FloatArray
    p: FloatArray
    unit: float


def _law(seen: Observed) -> Hypothesis:
    law = seen.law
    core: Any = law.law if type(law) is Disturbed else None
    name = "Algorithm 1 or 2 is disturbed by a bounded force, the same gains for all"
    if type(core) in (Algorithm1, Algorithm2) and callable(law.force):
        return Hypothesis(name, "unmet", detail="no bound is known of a force that is a function: expected a table")
    if type(core) not in (Algorithm1, Algorithm2) or law.intensity or core.gains.per_agent:
        return Hypothesis(name, "unmet", detail=f"the law is {law.title}, expected Disturbed(Algorithm2(...))")
    return Hypothesis(name, "met")


def largest_push(law: Disturbed, shape: tuple[int, int]) -> float:
    """Return a bound of √Σ‖d_i − mean‖² at all times, for a disturbance d without noise."""
    parts = [(part,) for part in (law.force, law.swing) if part is not None]  # each at the times when it is largest
    parts += [] if law.table is None else [law.table]  # linear between its rows
    magnitudes = (max(np.linalg.norm(moving_frame(np.broadcast_to(row, shape))) for row in part) for part in parts)
    return float(sum(magnitudes)) * (1.0 + _SLACK)


def _case(seen: Observed) -> tuple[Hypothesis, _Case | None]:
    """Return the hypothesis on the start and the disturbance, and the case if it is met."""
    from flockana.certified.basin import certify
    from flockana.certified.disturbed_bound import ultimate_bound
    from flockana.certified.structural_potential import in_lengths_of_unit

    law, unit = seen.law, getattr(seen.law.law.alpha, "unit", 1.0)
    q, p = seen.given.q[0] / unit, seen.given.p[0] / unit
    name = "the start lies in a certified basin, too deep for the disturbance to leave"
    if len(q) > _MOST:
        text = f"{len(q)} agents: expected at most {_MOST}, of which a basin is proved here"
        return condition(name, False, detail=text, decided="enclosed"), None
    try:
        basin = certify(find_equilibrium(in_lengths_of_unit(law.law), q))
        bound = ultimate_bound(basin, largest_push(law, q.shape) / unit)
    except FlockanaError as error:
        return condition(name, False, detail=f"no basin: {error}", decided="enclosed"), None
    largest, push = unit * float(bound.largest), unit * float(bound.disturbance)
    margin, unit_text = largest - push, "" if unit == 1.0 else " (the law in lengths of ℓ, rounded)"
    detail = f"‖d‖ <= {push:.4g}, and {largest:.4g} could drive the flock out{unit_text}"
    if not bound.stays or not bound.holds(q, p):
        text = detail if not bound.stays else f"{detail}; the start is not certainly deep enough in the basin"
        return condition(name, False, margin, text, decided="enclosed"), None
    return condition(name, True, margin, detail, decided="enclosed"), _Case(bound, q, p, unit)


def _stays(seen: Observed, case: _Case) -> Claim:
    """Return the proved claim that the flock stays in the basin, with the run's samples for comparison."""
    basin, unit = case.bound.basin, case.unit
    radius, separation = unit * float(basin.radius), unit * float(basin.distance)
    claim = _nearer(seen, case, "stays", 0, radius)
    return claim.described(
        stated=f"nearer than {radius:.4g} to the orbit at all times, no two agents within {separation:.4g}",
        detail=f"proved by the Lyapunov function of the basin; at the samples at most {claim.computed:.3g} away",
    )


def _ultimate(seen: Observed, case: _Case) -> Claim:
    """Return the proved claim of the ultimate bound, with the end of the run for comparison."""
    from flint import arb, ctx

    from flockana.certified.balls import ball
    from flockana.certified.basin import DIGITS

    bound, run, basin = case.bound, seen.given, case.bound.basin
    distance, speed = case.unit * float(bound.distance), case.unit * float(bound.speed)
    first_index = int(np.searchsorted(run.t, run.t[-1] - _LAST * (run.t[-1] - run.t[0])))
    with ctx.workdps(DIGITS):
        excess = max(basin.above(case.q, case.p)[1], arb(0))
        elapsed_time = ball(float(run.t[first_index]) - float(run.t[0]))
        start = (ball(basin.overshoot) * excess).sqrt() * (-ball(basin.rate) * elapsed_time).exp()
        distance_limit = case.unit * float((start + ball(bound.excess).sqrt()) * (2 / ball(basin.curvature)).sqrt())
    claim = _nearer(seen, case, "ultimate", first_index, distance_limit)
    return claim.described(
        stated=f"in the end at most {distance:.4g} from the orbit, with speeds of at most {speed:.4g}",
        witness={"allowed by then": distance_limit},
        detail=f"in the last fifth of the run at most {claim.computed:.3g} from the orbit; proved are "
        f"{distance:.4g} in the end, and {distance_limit:.4g} by then",
    )


def _nearer(seen: Observed, case: _Case, name: str, first: int, allowed: float) -> Claim:
    """Return a proved claim that the flock is nearer to the orbit than a bound, with samples for comparison."""
    basin, run, unit = case.bound.basin, seen.given, case.unit
    sample_indices = np.unique(np.linspace(first, len(run.t) - 1, _SAMPLES).astype(int))
    distances = [basin.above(run.q[k] / unit, run.p[k] / unit)[0] for k in sample_indices]  # upper bounds
    distance = unit * max(map(float, distances))
    error = float(np.linalg.norm(seen.shape_error[sample_indices], axis=1).max())
    margin = Enclosure(allowed - distance - error, allowed - distance, np.maximum(allowed, allowed - distance))
    sample_status: Status = "verified" if margin.lo > 0.0 else "inconclusive"
    return conclude(name, sample_status, margin, about="all", proof=_PROOF, computed=distance)


@run_theorem(
    "disturbed-basin",
    title="A bounded disturbance leaves a flock near its certified equilibrium",
    source="ours",
    law=_law,
    claims=_CLAIMS,
    author="flockana",
    wrapped=True,
    references=("olfati-saber-2006",),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """If a disturbance d of the accelerations, minus its mean over the agents, is at most W at all times, a flock under
    Algorithm 1 or 2 that starts deep enough in a certified basin stays in it, and is eventually within W c/(α √(1 − e))
    √(2/λ) of the orbit of the equilibrium: the strict Lyapunov function of the basin falls at the rate α wherever it is
    larger than (W c/α)².
    """
    requirement, case = _case(seen)
    return [requirement], [] if case is None else [_stays(seen, case), _ultimate(seen, case)]
