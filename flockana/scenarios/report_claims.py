"""Building blocks of scenario reports: claims judged by margins, and component counts."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.errors import UnknownNameError
from flockana.base.natural_scales import Scales
from flockana.base.units import rescale
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory as Trajectory
from flockana.measures.metrics import giant_share
from flockana.measures.nets import components, links
from flockana.scenarios.scenario import Report
from flockana.theorems import Claim as Claim
from flockana.theorems import Tolerances as Tolerances
from flockana.theorems.claims import judged
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.limit_certificates import Certificate, limit_claim

Check = Callable[[Trajectory, Tolerances], Claim]
ROUNDING = 1e-12  # relative, of what a report measures
PANEL = ("connectivity", "cohesion_radius", "normalised_deviation_energy", "normalised_velocity_mismatch")


def report(name: str, text: str) -> Callable[[Check], Report]:
    """Return a decorator that turns a function which judges a run into a named `Report` of a source."""

    def made(check: Check) -> Report:
        return Report(name, text, lambda run, tolerances: replace(check(run, tolerances), name=name))

    return made


def finding(margin: float, detail: str, *, error: float | None = None, **fields: Any) -> Claim:
    """Return the claim of a source's report on a run, judged by its margin alone."""
    # A margin half-way between whole numbers is a count against a bound, and exact; any other is off by its rounding.
    if error is None:
        is_count = margin != 0.0 and float(2.0 * margin).is_integer()
        computed_value = fields.get("computed")
        magnitude = abs(computed_value) if isinstance(computed_value, float | int) else 0.0
        error = 0.0 if is_count else ROUNDING * max(abs(margin), magnitude)
    return judged("", Enclosure.around(margin, error), detail=detail, **fields)


def limit_report(certificate: Certificate, detail: str, *, stated: str = "", **fields: Any) -> Claim:
    """Return the claim of a report on a limit: verified by a certificate, else open, never refuted."""
    return limit_claim("", [], [certificate], stated=stated, detail=detail, **fields)


def in_source_units(scales: Callable[[], Scales], reports: Iterable[Report]) -> tuple[Report, ...]:
    """Return a source's reports on runs, changed to judge each run in the units of the source."""

    def converted(check: Check) -> Check:
        def check_in_source_units(run: Trajectory, tolerances: Tolerances) -> Claim:
            units = scales()
            length_unit, time = units.length / run.scales.length, units.time / run.scales.time
            is_same = abs(length_unit - 1.0) < ROUNDING and abs(time - 1.0) < ROUNDING
            return check(run if is_same else rescale(run, length=length_unit, time=time), tolerances)

        return check_in_source_units

    return tuple(replace(report, check=converted(report.check)) for report in reports)


def rerun(run: Trajectory, law: Any, **options: Any) -> Trajectory:
    """Return the run of another law from the same start over the same time."""
    span = float(run.t[0]), float(run.t[-1])
    return ensure_uninterrupted(simulate(law, run.q[0], run.p[0], span, **options))


def same_accuracy(run: Trajectory) -> dict[str, Any]:
    """Return options of `simulate` that integrate a second run as accurately as the first."""
    return {name: run.stats[name] for name in ("rtol", "atol", "max_step") if run.stats.get(name) is not None}


def component_count(run: Trajectory, k: int = -1) -> int:
    """Return the number of components of the net at sample k of a run."""
    pair = run.law.pair
    assert pair is not None
    return int(components(run.n, links(run.q[k], pair.range)).max()) + 1


def connected(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that the net is connected at the end of a run."""
    count = component_count(run)
    return finding(1.5 - count, f"{count} component(s) at t = {run.t[-1]:g}", computed=count, stated=1)


def fragmented(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that the net falls into several components by the end of a run."""
    count, pair = component_count(run), run.law.pair
    share = giant_share(run.q[-1], pair.range)
    detail = f"{count} component(s) at t = {run.t[-1]:g}, the largest with {share:.0%} of the agents"
    return finding(count - 1.5, detail, computed=count, stated="more than 1")


def component_counts(run: Trajectory) -> npt.NDArray[np.int64]:
    """Return the number of components of the net at each sample of a run, shape (T,)."""
    counts: npt.NDArray[np.int64] = np.rint(run.n - run.metric("connectivity") * (run.n - 1)).astype(np.int64)
    return counts


def has_metric(run: Trajectory, name: str) -> bool:
    """Return whether a run has a metric, without computing the others."""
    try:
        run.metric(name)
    except UnknownNameError:
        return False
    return True
