"""Scenarios of explicit Euler with the paper's steps of 0.01 to 0.03."""

import numpy as np

from flockana.environment import LinearTarget
from flockana.laws import Algorithm2
from flockana.measures.metrics import velocity_mismatch
from flockana.scenarios.report_claims import Claim, Tolerances, Trajectory, connected, finding, report, rerun
from flockana.scenarios.scenario_builders import Builder, Start, entry, refuted, verified
from flockana.solvers.taylor_step import TaylorStep
from flockana.sources.olfati_saber_2006.scenarios.free_space import random_start

_N, _END = 40, 40.0
_SETTLED = 1e-6  # of K̃ at the start


_one_flock = report("connected", "the net ends connected")(connected)


@report("settles", "velocities match")
def _settles(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Return the claim that K̃ falls to a small share of K̃(0); its detail gives the continuous flow's K̃."""
    start, end = (velocity_mismatch(run.p[k]) / run.n for k in (0, -1))
    law = run.law.continuous
    assert law is not None
    true_mismatch = velocity_mismatch(rerun(run, law, t_eval=run.t[[0, -1]]).p[-1]) / run.n
    detail = f"K̃ goes from {start:.3g} to {end:.3g} by steps of {run.law.dt:g}, to {true_mismatch:.2g} by the flow"
    return finding(_SETTLED - end / start, detail, computed=end / start, stated=f"K̃ <= {_SETTLED:g} K̃(0)")


def _start(seed: int) -> Start:
    return random_start(seed, _N, 2)


def _stepped(name: str, dt: float, *, settles: bool) -> Builder:
    law = TaylorStep(Algorithm2(target=LinearTarget((200.0, 30.0), (5.0, 0.0))), dt)
    statuses = verified("source:connected") | (verified if settles else refuted)("source:settles")
    title = f"{_N} agents of Algorithm 2 by steps of {dt:g}, as printed"
    source_text = (
        "Olfati-Saber 2006 prints a step of 0.01 to 0.03 s and no scheme. Here q + p dt + ½ u dt², p + u dt, all "
        f"agents at once, dt = {dt:g}; parameters, start and γ-agent of Fig. 10 with n = {_N}; the gains, on "
        "which the largest stable step depends, are ours. The other scenarios of the paper integrate the flow."
    )
    end = dt * np.ceil(_END / dt)
    return entry(name, title, source_text, law, _start, end, {}, (_one_flock, _settles), shipped=statuses)


SCENARIOS = {
    "paper-step-0.01": _stepped("paper-step-0.01", 0.01, settles=True),
    "paper-step-0.03": _stepped("paper-step-0.03", 0.03, settles=False),
}
