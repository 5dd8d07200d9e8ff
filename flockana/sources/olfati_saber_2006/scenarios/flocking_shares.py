"""Shares of seeds for which Algorithms 1 and 2 flock, from the paper's start of 40 agents."""

from typing import Any

import numpy as np

from flockana.environment import LinearTarget
from flockana.laws import Algorithm1, Algorithm2
from flockana.measures.metrics import velocity_mismatch
from flockana.scenarios.report_claims import ROUNDING, Claim, Tolerances, Trajectory, component_count, finding, report
from flockana.scenarios.scenario_builders import Builder, Report, entry, verified
from flockana.sources.olfati_saber_2006.scenarios.free_space import random_start

_N, _SEEDS = 40, 200  # a tenth of a second each


@report("flocks", "the run ends as one flock with matched velocities")
def _flocks(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Return whether the run ends connected, with matching velocities."""
    components = component_count(run)
    mismatch = velocity_mismatch(run.p[-1]) / (run.n * run.scales.energy)
    text = f"{components} component(s) at t = {run.t[-1]:g}, K̃ = {mismatch:.2g} of the square of the law's speed"
    stated_text = f"one component, K̃ <= {tolerances.mismatch:g}"
    if components > 1:
        return finding(1.5 - components, text, computed=components, stated=stated_text)
    return finding(tolerances.mismatch - mismatch, text, computed=components, stated=stated_text, error=ROUNDING)


@report("fragments", "it rarely flocks: the run does not end as one flock")
def _fragments(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Return whether the run ends in several components, or with different velocities."""
    flock = _flocks.check(run, tolerances)
    assert flock.margin is not None
    stated_text = f"several components, or K̃ > {tolerances.mismatch:g}"
    return finding(-flock.margin, flock.detail, computed=flock.computed, stated=stated_text, error=flock.error)


def _share(name: str, law: Algorithm1 | Algorithm2, claim: str, *, end: float, report: Report) -> Builder:
    title = f"{_N} agents, {type(law).__name__[:-1]} {type(law).__name__[-1]}: in how many seeds do they flock?"
    source_text = (
        f"Olfati-Saber 2006 says that {claim}; nothing is printed of how often. The start is that of Fig. 12 (n = "
        f"40, q normal with variance 2500, p uniform in [-2, -1]²), {end:g} time units; gains and seeds are ours."
    )
    more: dict[str, Any] = {"seeds": _SEEDS, "settings": "printed parameters of Fig. 12, gains ours"}
    more |= {"options": {"t_eval": np.array([0.0, end])}, "shipped": verified(f"source:{report.name}")}
    return entry(name, title, source_text, law, lambda seed: random_start(seed, _N, 2), end, {}, (report,), **more)


_FOLLOWING = Algorithm2(target=LinearTarget((200.0, 30.0), (5.0, 0.0)))
_RARELY = "Algorithm 1 rarely flocks and often fragments"
SCENARIOS = {
    "algorithm1-flocks": _share("algorithm1-flocks", Algorithm1(), _RARELY, end=15.0, report=_fragments),
    "algorithm2-flocks": _share("algorithm2-flocks", _FOLLOWING, "Algorithm 2 flocks", end=40.0, report=_flocks),
}
