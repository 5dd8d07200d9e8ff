"""Claims of sources about flocks among obstacles."""

from collections.abc import Sequence
from math import inf

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.environment import Obstacle
from flockana.measures.clearance import ConstrainedLattice, constrained_lattice
from flockana.scenarios.report_claims import ROUNDING, component_counts, finding, limit_report, report
from flockana.theorems import Claim, Tolerances
from flockana.theorems.limit_certificates import Certificate

_SEGMENT = 400  # points on the straight way to the γ-agent that are looked at


@report("clear", "no agent enters an obstacle")
def stays_clear(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that no agent enters an obstacle, by the lower bound of clearances; a point inside refutes it."""
    clearance = run.clearance()
    rounding = ROUNDING * float(np.abs(run.q).max())
    margin = clearance.reached if clearance.reached < -rounding else clearance.lower
    error = rounding if margin > 0.0 or margin == clearance.reached else inf
    detail = (
        f"agent {clearance.agent} comes closest, {clearance.reached:.4g} from obstacles[{clearance.obstacle}] at "
        f"t = {clearance.time:.4g}; no agent is closer than {clearance.lower:.4g} to any at any time"
    )
    witness = {"agent": clearance.agent, "obstacle": clearance.obstacle, "time": clearance.time}
    return finding(margin, detail, computed=clearance.lower, stated="> 0", error=error, witness=witness)


@report("splits", "the flock, connected before, splits around the obstacles")
def splits(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that the net is connected at first, and disconnected later."""
    counts = component_counts(run)
    whole = np.flatnonzero(counts == 1)
    if whole.size == 0:
        return finding(-1.0, f"the net is never connected: at least {counts.min()} components", stated=1)
    after = counts[whole[0] :]
    most, apart = int(after.max()), run.t[whole[0] :][after > 1]
    detail = f"connected from t = {run.t[whole[0]]:.4g}" + (
        f"; in up to {most} components between t = {apart[0]:.4g} and {apart[-1]:.4g}" if most > 1 else " to the end"
    )
    return finding(min(most, 2) - 1.5, detail, computed=most, stated="1, then more than 1")


@report("rejoins", "behind the obstacles it is one flock again")
def rejoins(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that the flock is connected at the end; open where this depends on rounding of the start."""
    counts = component_counts(run)
    split_rows = np.flatnonzero(counts > 1)
    detail = f"{counts[-1]} component(s) at t = {run.t[-1]:g}"
    if counts[-1] == 1 and split_rows.size:
        detail += f", connected again from t = {run.t[split_rows[-1] + 1]:.4g} on"
    certificate = Certificate(-1.0, "the net at one instant decides no limit")
    return limit_report(certificate, detail, computed=int(counts[-1]), stated="1")


def _passed_between(run: Trajectory) -> int:
    """Return the number of agents that cross x = 150 between the two spheres of the gap."""
    was_before = run.q[:-1, :, 0] < 150.0
    crossing = was_before & (run.q[1:, :, 0] >= 150.0)
    row, agent = np.nonzero(crossing)
    last_rows = np.full(run.n, -1)
    np.maximum.at(last_rows, agent, row)
    y = run.q[np.maximum(last_rows, 0) + 1, np.arange(run.n), 1]
    return int(np.sum((last_rows >= 0) & (y > 55.0) & (y < 75.0)))


@report("past", "all agents get past the obstacles")
def gets_past(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that all agents are beyond both spheres of the gap at the end."""
    x = run.q[-1, :, 0]
    detail = f"{int((x > 175.0).sum())} of {run.n} agents are beyond both spheres, the last one at x = {x.min():.4g}"
    margin = float(np.clip(x.min() - 175.0, -25.0, 25.0))  # a sphere's radius is enough: how far agents get varies
    return finding(margin, detail, computed=float(x.min()), stated="x > 175 for all")


@report("squeezes", "the flock goes through the gap")
def squeezes(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that more than half of the agents pass the gap between the two spheres."""
    through = _passed_between(run)
    detail = f"{through} of {run.n} agents go through the gap, of width 20; the others round the outside of the spheres"
    margin = float(np.clip(through - 0.5 * run.n, -0.1 * run.n, 0.1 * run.n))  # a tenth is enough: the number varies
    return finding(margin, detail, computed=through, stated="more than half")


def blocked(q: FloatArray, target: FloatArray, obstacles: Sequence[Obstacle]) -> FloatArray:
    """Return whether each agent has an obstacle on its straight path to the γ-agent, shape (n,)."""
    share = np.linspace(0.0, 1.0, _SEGMENT)[:, None, None]
    line_points = (q + share * (target - q)).reshape(-1, q.shape[1])
    hit = np.any([obstacle.contains(line_points) for obstacle in obstacles], axis=0)
    blocked_agents: FloatArray = hit.reshape(_SEGMENT, len(q)).any(axis=0)
    return blocked_agents


@report("trapped", "the obstacle holds agents back from the γ-agent (Fig. 9)")
def traps(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that agents stand still behind an obstacle at the end."""
    is_held = blocked(run.q[-1], run.law.target.position(float(run.t[-1])), run.law.obstacles)
    is_final = run.t >= run.t[-1] - 0.1 * (run.t[-1] - run.t[0])
    limit = tolerances.agreement * run.law.gains.c1_gamma * run.law.alpha.unit / run.law.gains.c2_gamma
    is_slow = lengths(run.p[is_final]).max(axis=0) < limit
    count = int((is_held & is_slow).sum())
    detail = (
        f"until t = {run.t[-1]:g} {count} of {run.n} agents rest (slower than {limit:.3g}, {tolerances.agreement:g} of "
        "the speed at which agents near the γ-agent) with an obstacle on the straight way to the γ-agent"
    )
    certificate = Certificate(1.0 if count else -1.0, "counted in this run" if count else "none so far")
    return limit_report(certificate, detail, computed=count, stated="more than 0")


@report("rests", "the group comes to rest in an equilibrium among the obstacles")
def rests(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that the flock comes to rest, with small speeds and small forces."""
    # With a γ-agent at rest and c2γ > 0 every motion dies out, as H falls by c2γ Σ‖p_i‖² at least; what is open is
    # when. So one instant will do here, of small speeds and forces together: it is no turning point of a swing for
    # ever. Near stiff obstacles the solver's last digits are worth as much force: the calmest instant of the last tenth
    # is taken.
    law, late = run.law, np.flatnonzero(run.t >= run.t[-1] - 0.1 * (run.t[-1] - run.t[0]))
    zero_velocity = np.zeros_like(run.p[0])
    forces = np.array([np.linalg.norm(law.acceleration(run.t[k], run.q[k], zero_velocity), axis=1).max() for k in late])
    forces, speeds = forces / run.scales.force, lengths(run.p[late]).max(axis=1) / run.scales.speed
    lefts = np.maximum(forces / tolerances.force, speeds / np.sqrt(tolerances.velocity))
    calmest_index = int(np.argmin(lefts))
    t, force, speed = (float(series[calmest_index]) for series in (run.t[late], forces, speeds))
    left = max(float(lefts[calmest_index]), 1e-300)
    damped_certificate = Certificate(float(np.clip(-np.log(left), -1.0, 1.0)), f"{left:.2g} of the thresholds of rest")
    free_certificate = Certificate(-1.0, "without damping by the γ-agent it may never come to rest")
    detail = f"at t = {t:g} the largest force is {force:.2g} of the law's, the largest speed {speed:.2g}"
    certificate = damped_certificate if law.gains.c2_gamma > 0.0 else free_certificate
    return limit_report(certificate, detail, computed=force, stated=f"force <= {tolerances.force:g} at rest")


def _measured(run: Trajectory) -> tuple[ConstrainedLattice, float, str]:
    """Return the end's errors against a constrained α-lattice, the largest relative one, and a description."""
    law = run.law
    end = constrained_lattice(run.q[-1], law.obstacles, alpha=law.alpha, beta=law.beta)
    strain = max(end.alpha_error / law.alpha.d, end.beta_error / law.beta.d)
    detail = (
        f"{end.beta_links} β-agents are d' away but for {end.beta_error:.3g}, {end.links} links d long but for "
        f"{end.alpha_error:.3g}: relative to d' and d {strain:.2g} at most"
    )
    return end, strain, detail


@report("in-touch", "it rests against obstacles; how near it is to a constrained α-lattice")
def touches(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that an agent rests within the range of an obstacle, at distance d'."""
    end, _, detail = _measured(run)
    return finding(end.beta_links - 0.5, detail, computed=end.beta_links, stated="β-neighbours")


@report("constrained-lattice", "it rests as a quasi constrained α-lattice")
def constrained(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that the end is a quasi constrained α-lattice."""
    _, strain, detail = _measured(run)
    margin = (tolerances.quasi - strain) / tolerances.quasi
    certificate = Certificate(float(np.clip(margin, -1.0, 1.0)), f"quasi is up to {tolerances.quasi:g}")
    return limit_report(certificate, detail, computed=strain, stated=f"<= {tolerances.quasi:g}")
