"""Scenarios of γ-agents with dynamics: one leader, and peers that each follow a copy."""

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.environment import Copies, Spring, SystemTarget
from flockana.interactions import AlphaInteraction
from flockana.lattice.builders import hexagonal_spiral
from flockana.laws import Algorithm2, PeerToPeer
from flockana.scenarios.report_claims import ROUNDING, connected, finding, fragmented, report
from flockana.scenarios.scenario_builders import OURS, Builder, Start, entry, verified
from flockana.theorems import Claim, Tolerances
from flockana.theorems.energy import balance
from flockana.theorems.gamma_agent_checks import consistent
from flockana.theorems.observed_run import Observed

_N = 8
_DRIFT = 4.0  # by which the copies of the two halves differ from the true velocity, across the way


@report("consistent", "p_r is the true velocity of q_r")
def _velocity_is_true(run: Trajectory, tolerances: Tolerances) -> Claim:
    condition = consistent(run)
    margin = 0.5 if condition.status == "met" else -0.5
    deviation = -float(condition.margin or 0.0)
    return finding(margin, f"mean dq_r/dt is p_r to {deviation:.2g}", computed=deviation, stated="dq_r/dt = p_r")


@report("predicted", "copies part, or meet, as the linear theory says")
def _copies_as_predicted(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Compare the copies with d'' = −(k + k₁) d − (b + k₂) d' for the distance d from their mean."""
    copies, t = run.law.copies, float(run.t[-1] - run.t[0])
    offsets, speed = (np.array(x) - np.mean(x, axis=0) for x in (copies.q, copies.p))
    k, b = copies.position_coupling, copies.velocity_coupling  # f_r = 0
    predicted = offsets + speed * t
    if k > 0.0:  # critically damped, b² = 4k
        predicted = (offsets + (speed + 0.5 * b * offsets) * t) * np.exp(-0.5 * b * t)
    centre = copies.state(float(run.t[-1]))[0]
    centre = centre - centre.mean(axis=0)
    off, size = float(np.abs(centre - predicted).max()), run.scales.length
    apart = float(np.linalg.norm(centre, axis=1).max())
    detail = f"copies end up to {apart:.3g} from their mean, as the linear theory says to {off:.1g}"
    return finding(1e-6 - off / size, detail, computed=apart, stated="the linear theory's, to 1e-6 d", error=ROUNDING)


@report("centre", "the centre of mass follows the mean of the copies")
def _centre_follows(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that the centre of mass follows the mean of the copies as a critically damped system."""
    law = run.law
    position, speeds = (x.mean(axis=0) for x in law.copies.state(float(run.t[0])))
    away, slip = run.q[0].mean(axis=0) - position, run.p[0].mean(axis=0) - speeds
    rate, t = 0.5 * float(law.gains.c2_gamma), float(run.t[-1] - run.t[0])
    predicted_value = (away + (slip + rate * away) * t) * np.exp(-rate * t)
    offset = run.q[-1].mean(axis=0) - law.copies.state(float(run.t[-1]))[0].mean(axis=0)
    off = float(np.abs(offset - predicted_value).max()) / run.scales.length
    detail = (
        f"the centre of mass ends {float(np.linalg.norm(offset)):.2g} from the mean of the copies, as a critically "
        f"damped follower does to {off:.1g} d"
    )
    return finding(
        1e-4 - off, detail, computed=off, stated="q_c'' = −c1γ (q_c − q̄_r) − c2γ (p_c − p̄_r)", error=ROUNDING
    )


@report("balance", "H with the true velocities of the copies balances")
def _balanced(run: Trajectory, tolerances: Tolerances) -> Claim:
    return balance(Observed.alone(run), [], tolerances)


_TWO_HALVES = report("apart", "the flock falls into two halves")(fragmented)


def _start(seed: int) -> Start:
    """Return eight agents near a lattice patch, almost at rest, sorted by y."""
    generator, d = np.random.default_rng(seed), AlphaInteraction().d
    q = hexagonal_spiral(_N, d) + generator.uniform(-0.2, 0.2, (_N, 2))
    return q[np.argsort(q[:, 1])], generator.uniform(-0.3, 0.3, (_N, 2))


def _system() -> Builder:
    law = Algorithm2(target=SystemTarget((30.0, 0.0), (0.0, 6.0), Spring((0.0, 0.0), 1.0, reach=8.0)))
    title = "A γ-agent that is a system of its own leads eight agents round"
    source_text = (
        "Ours, on the γ-agent q_r' = p_r, p_r' = f_r(q_r, p_r): f_r = −x/√(1 + ‖x‖²/64), a spring whose pull is "
        "bounded, from (30, 0) at (0, 6); Algorithm 2 with the default gains, eight agents near a lattice about the "
        "origin, each coordinate displaced by up to 0.2, velocities up to 0.3."
    )
    expected = verified("energy", "os-3:i", "source")
    return entry("gamma-system", title, source_text, law, _start, 30.0, expected, (_velocity_is_true,), references=OURS)


def _peers(name: str, title: str, *, coupling: float) -> Builder:
    """Return the scenario builder of agents with γ-agent copies that differ in velocity between two halves."""
    damping = 2.0 * np.sqrt(coupling)
    coupling_text = f"Each copy is drawn to the mean of all by k₁ = {coupling:g}, k₂ = {damping:g}."
    source_text = (
        "Ours, on Fig. 7 (a virtual leader against peer-to-peer copies of the γ-agent): eight agents near a "
        "lattice, each with a copy of the γ-agent of its own, f_r = 0, all copies from (10, 0) at (2, 0), but for "
        "-4 across the way in one half of the flock and +4 in the other; default gains. "
        + (coupling_text if coupling else "The copies are not coupled, and part.")
    )
    end = report("together", "the flock stays one")(connected) if coupling else _TWO_HALVES
    reports = (_copies_as_predicted, end, _centre_follows, _balanced)
    positions, speed = np.tile([10.0, 0.0], (_N, 1)), np.repeat([[2.0, -_DRIFT], [2.0, _DRIFT]], _N // 2, axis=0)
    couplings = {"position_coupling": coupling, "velocity_coupling": damping}
    law = PeerToPeer(Copies(positions, speed, Spring((0.0, 0.0), 0.0), **couplings))
    return entry(name, title, source_text, law, _start, 25.0, verified("source"), reports, references=OURS)


SCENARIOS: dict[str, Builder] = {
    "gamma-system": _system(),
    "gamma-copies-apart": _peers("gamma-copies-apart", "Copies of the γ-agent that part tear the flock", coupling=0.0),
    "gamma-copies-coupled": _peers(
        "gamma-copies-coupled", "Coupled copies of the γ-agent keep the flock", coupling=1.0
    ),
}
