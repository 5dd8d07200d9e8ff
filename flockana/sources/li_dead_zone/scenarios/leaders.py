"""Dead-zone law with several leaders and pinned agents: the paper's conclusion, simulated (erratum L9)."""

import numpy as np

from flockana.base.value_checks import FloatArray, ensure_finite_scalar
from flockana.environment import LinearTarget
from flockana.scenarios.report_claims import Claim, Tolerances, Trajectory, component_count, finding, report
from flockana.scenarios.scenario_builders import Scenario, refuted, verified
from flockana.solvers.semi_implicit_euler import SemiImplicitEuler
from flockana.sources.li_dead_zone.laws.with_leaders import LedDeadZoneFlocking
from flockana.sources.li_dead_zone.scenarios.published_run import DT, describe_choices

_N, _PINNED, _BOX, _SPEED, _END = 30, 10, 25.0, 1.0, 60.0


def _law(run: Trajectory) -> LedDeadZoneFlocking:
    law = run.law.continuous
    assert isinstance(law, LedDeadZoneFlocking)
    return law


def _slip(run: Trajectory) -> FloatArray:
    """Return each agent's velocity error to its leader, relative to half the leaders' velocity difference."""
    law = _law(run)
    leader_velocity = law.ties.led(float(run.t[-1]))[1]
    parting_speed = 0.5 * float(np.linalg.norm(law.leaders[1].rate(0.0) - law.leaders[0].rate(0.0)))
    speed_ratios: FloatArray = np.linalg.norm(run.p[-1] - leader_velocity, axis=1) / parting_speed
    return speed_ratios


def _carried_off(run: Trajectory) -> int:
    """Return the number of agents whose final velocity is closer to that of a leader not their own."""
    return int((_slip(run) > 1.0).sum())


@report("same-leader", "agents with the same leader match velocities")
def _same(run: Trajectory, tolerances: Tolerances) -> Claim:
    lost, pinned = _carried_off(run), int((_slip(run)[list(_law(run).pinned)] > 1.0).sum())
    detail = (
        f"{lost} of {run.n} agents, {pinned or 'none'} of them pinned, move with the other leader's group at the end"
    )
    return finding(0.5 - lost, detail, computed=lost, stated="0 agents away from their leader")


@report("different-leaders", "agents with different leaders do not match")
def _different(run: Trajectory, tolerances: Tolerances) -> Claim:
    lost_count = _carried_off(run)
    is_mixed = lost_count * (run.n - lost_count) > 0
    detail = (
        f"{lost_count} agents match their neighbours of the other leader, as pair forces hold together whoever is near"
        if is_mixed
        else "no agent moves with one of another leader"
    )
    return finding(-0.5 if is_mixed else 0.5, detail, computed=lost_count, stated="they do not match")


@report("pinned", "pinned agents follow their leaders")
def _pinned(run: Trajectory, tolerances: Tolerances) -> Claim:
    worst = float(_slip(run)[list(_law(run).pinned)].max())
    detail = f"a pinned agent's velocity is off its leader's by {worst:.2g} at most, of half that at which leaders part"
    return finding(1.0 - worst, detail, computed=worst, stated="pinned agents follow their leader")


@report("parts", "the flock ends in one part for each leader")
def _parts(run: Trajectory, tolerances: Tolerances) -> Claim:
    count = component_count(run)
    detail = f"{count} component(s) at t = {run.t[-1]:g}"
    return finding(0.5 - abs(count - 2), detail, computed=count, stated="one part for each leader")


@report("within-r", "no agent is farther than r from its leader (Theorem 1)")
def _within_r(run: Trajectory, tolerances: Tolerances) -> Claim:
    off = run.metric("leader_distance")
    r = _law(run).interaction.r
    k = int(off.argmax())
    detail = f"an agent is {off[k]:.4g} from its leader at t = {run.t[k]:g}, {off[-1]:.4g} at the end; r = {r:g}"
    return finding(1.0 - float(off[k]) / r, detail, computed=float(off[k]), stated="never more than r")


_REPORTS = (_same, _different, _pinned, _parts, _within_r)


def _leaders(seed: int = 0, gap: float = -_BOX) -> Scenario:
    """Return the scenario of two groups with a leader each, in one box or in two adjacent boxes."""
    shift = max(0.0, _BOX + ensure_finite_scalar("gap", gap))
    generator, group = np.random.default_rng(seed), np.arange(_N) % 2
    q, p = generator.uniform(0.0, _BOX, (_N, 2)), generator.uniform(-1.0, 1.0, (_N, 2))
    q[group == 1, 0] += shift
    start = [(0.5 * _BOX + number * shift, 0.5 * _BOX) for number in (0, 1)]
    leaders = [LinearTarget(at, (direction * _SPEED, 0.0)) for at, direction in zip(start, (-1.0, 1.0), strict=True)]
    law = LedDeadZoneFlocking(leaders=leaders, group=group.tolist(), pinned=range(_PINNED), c1=2.0, c2=3.0)
    expected = verified("source:pinned", "source:parts")
    if shift == 0.0:
        expected |= refuted("source:same-leader", "source:different-leaders", "source", "source:within-r")
    elif gap >= law.interaction.r:
        expected |= verified("source:same-leader", "source:different-leaders")
    where = "in one box" if shift == 0.0 else f"in boxes of side {_BOX:g}, {gap:g} apart"
    title = "Dead zone, two leaders: a third of the agents pinned, the others follow nearby agents"
    source_text = (
        "Li, Yuan and Liu, sections IV and VI, in words only: agents with different leaders do not match, and to pin a "
        "fraction is enough where the leaders' acceleration is known. Equation (9) has neither; the three terms are "
        f"ours, and so are: {_N} agents, every other one with the second leader, {where}, {_PINNED} pinned with c1 = 2 "
        f"and c2 = 3, leaders that start in the middle and part at {_SPEED:g} each way. r = 15, δ = 4.5, k_δ = 1.3 as "
        f"printed. {describe_choices(law, _BOX, _END)}"
    )
    steps = SemiImplicitEuler(law, DT)
    options = {"t_eval": np.linspace(0.0, _END, 121)}
    name, references = "dead-zone-leaders", ("li-dead-zone",)
    return Scenario(name, title, source_text, steps, q, p, (0.0, _END), seed, expected, _REPORTS, options, references)


SCENARIOS = {"dead-zone-leaders": _leaders}
