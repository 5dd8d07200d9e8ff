"""Scenarios of the R² notebook, with its tenfold push below 0.05 as an option."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from flockana.base.vector_norms import lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.environment import StaticTarget
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws import Algorithm1, Algorithm2
from flockana.measures.nets import link_lengths, links
from flockana.measures.path_bounds import contacts
from flockana.scenarios import report_claims as findings
from flockana.scenarios.scenario_builders import Report, Scenario, Status, refuted, vacuous, verified
from flockana.solvers.taylor_step import TaylorStep
from flockana.sources.notebook_r2.laws import MIN_DISTANCE, PushedAlgorithm1, PushedAlgorithm2
from flockana.theorems import Claim, Tolerances
from flockana.theorems.limit_certificates import Certificate

_FOLLOWED = 0.01  # of d: how near to the flow steps are that follow it
_RELAXED = 0.1  # of ‖u_α‖ at the start
_UNIT_FORCE = {"stiffness": 1.0, "damping": 1.0}
_FOLLOWS = 0.01  # ‖u_γ‖ in the notebook's units that counts as following
_UNIT = {"c1_alpha": 1.0, "c2_alpha": 1.0}
_PUSHED: dict[Any, Any] = {Algorithm1: PushedAlgorithm1, Algorithm2: PushedAlgorithm2}
_SWITCH = _PUSHED | {pushed: plain for plain, pushed in _PUSHED.items()}


def _integrator(law: Algorithm1 | Algorithm2) -> dict[str, Any]:
    """Return solver options: a fixed step with the push, whose jump at 0.05 stalls adaptive steps."""
    return {"method": "RK4", "dt": 0.005} if isinstance(law, PushedAlgorithm1 | PushedAlgorithm2) else {}


def _other(run: Trajectory) -> Trajectory:
    """Return the run from the same start with the extra repulsion of close pairs switched on or off."""
    law = run.law
    shared_options = {"alpha": law.alpha, "gains": law.gains} | ({} if law.target is None else {"target": law.target})
    other_law = _SWITCH[type(law)](**shared_options)
    return findings.rerun(run, other_law, **(_integrator(other_law) or findings.same_accuracy(run)))


@findings.report("push", "a tenfold push below 0.05 keeps agents apart")
def _push(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that the extra repulsion keeps agents farther apart; vacuous where no pair comes close enough."""
    contact_times = contacts(run.t, run.q, run.p, run.u, tol=MIN_DISTANCE)
    if not contact_times:  # then the run is the same with the push and without it
        closest = run.closest_approach().distance
        detail = f"the push never acts: no two agents come closer than {closest:.3g}"
        return Claim("push", "vacuous", computed=closest, stated=f"< {MIN_DISTANCE:g} without the push", detail=detail)
    runs = [run, _other(run)]
    if isinstance(run.law, PushedAlgorithm1 | PushedAlgorithm2):
        runs.reverse()
    near = [r.closest_approach() for r in runs]
    plain, pushed = (item.distance for item in near)
    error_bound = sum(item.distance - item.lower for item in near) + findings.ROUNDING * float(np.abs(run.q).max())
    end_distance = float(np.linalg.norm(runs[0].q[-1] - runs[1].q[-1], axis=1).max())
    detail = (
        f"{len(contact_times)} pair(s) of this run come within {MIN_DISTANCE:g}; the closest approach is {plain:.3g} "
        f"without the push and {pushed:.3g} with it, and final positions differ by up to {end_distance:.3g}"
    )
    return findings.finding(pushed - plain, detail, computed=pushed, stated=f"> {plain:.6g}", error=error_bound)


@findings.report("follows", "agents take on the γ-agent's velocity")
def _velocity_follows(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report the printed fall of one agent's ‖u_γ‖ to below 0.001 by the last of 150 steps."""
    # With c1γ = 0 and c2γ > 0 the energy falls by all relative motion, and the mean velocity follows exponentially: in
    # the end every agent has the γ-agent's velocity. Whether this run is long enough to see it is what is looked at.
    pull = run.law.gains.c2_gamma * np.linalg.norm(run.p[-1] - run.law.target.state(float(run.t[-1]))[1], axis=1)
    median = float(np.median(pull))
    certificate = Certificate(max(-1.0, 1.0 - median / _FOLLOWS), "that is what counts as following")
    detail = f"‖u_γ‖ at the end is {median:.2g} in the median and {pull.max():.2g} at most"
    return findings.limit_report(certificate, detail, computed=median, stated=f"below {_FOLLOWS:g}")


@findings.report("unit-direction", "n_ij is a normalised direction")
def _unit_directions(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that n_ij is a unit vector: its length ‖Δ‖/√(1 + ε‖Δ‖²) is below 1/√ε."""
    alpha = run.law.alpha
    distances = link_lengths(run.q[0], links(run.q[0], alpha.r))
    n = distances / np.sqrt(1.0 + alpha.eps * distances**2)
    deviation = float(np.abs(n - 1.0).max())
    detail = (
        f"‖n_ij‖ of the {n.size} links at the start is {n.min():.3g} to {n.max():.3g}; it is 0 at coincidence and "
        f"could come near 1/√ε = {1.0 / np.sqrt(alpha.eps):.3g}"
    )
    return findings.finding(-deviation, detail, computed=deviation, stated="‖n_ij‖ = 1")


@findings.report("goal", "agents move toward the common goal")
def _goal(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that agents move toward a common goal; with c1γ = 0 the law does not contain q_r."""
    position = run.law.target.position(0.0)
    first, last = (float(np.linalg.norm(run.q[k].mean(axis=0) - position)) for k in (0, -1))
    detail = (
        f"the centre of mass is {first:.3g} from q_r at the start and {last:.3g} at the end: with c1γ = 0 nothing "
        "draws it there, and it drifts away with p_r"
    )
    return findings.finding((first - last) / run.scales.length, detail, computed=last, stated=f"below {first:.4g}")


@findings.report("relaxes", "‖u_α‖ shrinks to about a hundredth")
def _pairs_relax(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report the printed fall of the pair force u_α from about 5 to about 0.03, averaged over agents."""
    law = run.law
    first, last = (
        float(np.linalg.norm(law.terms[0].pair.forces(run.q[k], run.p[k], **_UNIT_FORCE)[0], axis=1).mean())
        for k in (0, -1)
    )
    detail = f"mean ‖u_α‖ falls from {first:.3g} to {last:.2g}"
    return findings.finding(_RELAXED - last / first, detail, computed=last / first, stated=f"<= {_RELAXED:g}")


@findings.report("flow", "the notebook's own steps follow the flow")
def _follows_flow(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that the notebook's steps follow the flow of the same law to 1 % of d."""
    law = run.law.law
    flow = findings.rerun(run, law, t_eval=run.t, **_integrator(law))
    distances = lengths(run.q - flow.q).max(axis=1) / law.alpha.d
    deviating_samples = np.flatnonzero(distances > _FOLLOWED)
    time_text = f"from t = {run.t[deviating_samples[0]]:.3g} on" if deviating_samples.size else "at no time"
    energy, flow_energy = run.energy()[-1], flow.energy()[-1]
    detail = (
        f"an agent is more than {_FOLLOWED:.0%} of d from the flow's {time_text}, and up to "
        f"{distances.max():.3g} d later; the run ends in {findings.component_count(run)} components, the flow in "
        f"{findings.component_count(flow)}, at energies of {energy:.5g} and {flow_energy:.5g}"
    )
    worst = float(distances.max())
    return findings.finding(_FOLLOWED - worst, detail, computed=worst, stated=f"within {_FOLLOWED:g} d of the flow")


def _scenario(
    name: str,
    text: tuple[str, str],
    law: Algorithm1 | Algorithm2,
    n: int,
    end: float,
    seed: int,
    expected: dict[str, Status],
    *reports: Report,
    shipped: dict[str, Status],
) -> Scenario:
    generator, references = np.random.default_rng(seed), ("notebook-r2", "olfati-saber-2006")
    q, p = generator.uniform(0.0, 13.0, (n, 2)), generator.standard_normal((n, 2))
    judged, run_options, span = findings.in_source_units(lambda: law.scales, reports), _integrator(law), (0.0, end)
    return Scenario(name, *text, law, q, p, span, seed, expected, judged, run_options, references, shipped=shipped)


def _algorithm1(seed: int = 0, push: bool = False) -> Scenario:
    alpha, gains = AlphaInteraction(d=1.9, r=2.8, eps=0.1, h=0.4, a=7.0, b=9.0), Gains(**_UNIT)
    law = PushedAlgorithm1(alpha, gains) if push else Algorithm1(alpha, gains)
    # the start is not connected, so Theorem 1 says nothing; whether the push ever acts differs from start to start
    expected = vacuous("os-1", "os-5-terminal:i") | refuted("source:unit-direction")
    if not push:
        expected |= verified("energy")
    shipped_statuses = refuted("alpha-flocking-strict", "alpha-flocking-strict:flock")
    text = (
        "R² notebook: 27 agents, Algorithm 1, unequal attraction and repulsion",
        "R² notebook, Algorithm 1: n = 27, d = 1.9, r = 2.8, ε = 0.1, h = 0.4, a = 7, b = 9, no gains "
        "(unit), q uniform in [0, 13]², p standard normal, 5 time units. The notebook steps by 0.05; this is the flow.",
    )
    reports = _push, _unit_directions
    return _scenario("notebook-algorithm1", text, law, 27, 5.0, seed, expected, *reports, shipped=shipped_statuses)


def _algorithm2(seed: int = 0, push: bool = False) -> Scenario:
    alpha = AlphaInteraction(d=1.7, r=2.5, eps=0.01, h=0.2, a=7.0, b=15.0)
    gains, target = Gains(**_UNIT, c1_gamma=0.0, c2_gamma=0.5), StaticTarget((5.0, 5.0), (0.7, 0.1))
    law = PushedAlgorithm2(alpha, gains, target) if push else Algorithm2(alpha, gains, target)
    # c1γ = 0: nothing draws the agents together, and of Theorem 3 only (iv) remains, which needs no c1γ
    expected = verified("alpha-flocking-strict:deviation") | vacuous("os-5-terminal:i") | refuted("source:goal")
    if not push:
        expected |= vacuous("os-3:i", "os-3:ii", "os-3:iii")
        expected |= verified("energy", "os-3", "os-3:iv-printed")
    shipped_statuses = verified("alpha-flocking-strict:mismatch", "source:follows", "source:relaxes")
    text = (
        "R² notebook: 35 agents, Algorithm 2 with velocity feedback only",
        "R² notebook, Algorithm 2: n = 35, d = 1.7, r = 2.5, ε = 0.01, h = 0.2, a = 7, b = 15, unit gains, c1γ = 0, "
        "c2γ = 0.5, γ-agent fixed at (5, 5) with p_r = (0.7, 0.1), q uniform in [0, 13]², p standard normal, 15 time "
        "units. The notebook steps by 0.1; this is the continuous system.",
    )
    reports = _push, _velocity_follows, _pairs_relax, _goal
    return _scenario("notebook-algorithm2", text, law, 35, 15.0, seed, expected, *reports, shipped=shipped_statuses)


def _map(flow: Callable[..., Scenario], dt: float) -> Callable[[int], Scenario]:
    """Return the builder of the notebook's run as published: with its own steps and extra repulsion."""

    def build(seed: int = 0) -> Scenario:
        item = flow(seed, push=True)
        law: Any = item.law
        name, title = f"{item.name}-map", f"{item.title}, by the notebook's own steps"
        description = f"q + p dt + ½ u dt², p + u dt with dt = {dt:g}, and the tenfold push below 0.05."
        source_text = f"{item.source.rpartition('. ')[0]}. As published: {description}"
        item = replace(item, name=name, title=title, source=source_text, law=TaylorStep(law, dt), options={})
        reports = findings.in_source_units(lambda: law.scales, (_follows_flow,))
        return replace(item, expected=refuted("source:flow"), shipped={}, reports=reports)

    return build


SCENARIOS: dict[str, Callable[..., Scenario]] = {
    "notebook-algorithm1": _algorithm1,
    "notebook-algorithm2": _algorithm2,
    "notebook-algorithm1-map": _map(_algorithm1, 0.05),
    "notebook-algorithm2-map": _map(_algorithm2, 0.1),
}
