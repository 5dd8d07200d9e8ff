"""Scenarios of Olfati-Saber (2006), Figures 10 to 13, and three more with the same parameters."""

from collections.abc import Callable, Mapping
from functools import partial
from itertools import pairwise
from math import cos, pi, sin, sqrt
from types import MappingProxyType

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.environment import LinearTarget, StaticTarget
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws import Algorithm1, Algorithm2
from flockana.measures.metrics import coincident_pairs, deviation_energy
from flockana.measures.nets import components, link_lengths, links
from flockana.scenarios.lazy_start import lazy_array
from flockana.scenarios.report_claims import ROUNDING, connected, finding, fragmented, limit_report, report
from flockana.scenarios.scenario_builders import (
    OURS,
    Builder,
    Report,
    Scenario,
    Start,
    Status,
    entry,
    inconclusive,
    refuted,
    vacuous,
    verified,
)
from flockana.theorems import Claim, Tolerances
from flockana.theorems.attraction_basin import attraction
from flockana.theorems.gamma_agent_checks import consistent
from flockana.theorems.limit_certificates import Certificate

_OURS = (
    "The gains are not printed and are ours (c1α = 30, c2α = 2√30, c1γ = 1.1, c2γ = 2√1.1), as are the seed and the "
    "end time, by which the motion has converged."
)
_FLOCKS = (
    verified("energy", "os-3", "os-3:i", "os-3:ii", "os-3:iii", "os-3:iv-printed")
    | vacuous("os-3:iv-none")
    | verified("alpha-flocking", "alpha-flocking-strict")
    | vacuous("os-5-terminal:i")  # λJ strains every lattice
    | verified("source")
)
_RESTS = ("os-3", "os-3:ii")  # what some starts have not settled by the end of the run


@report("lattice-like", "the flock ends as a quasi-lattice (Fig. 18: Ẽ small)")
def _ends_as_lattice(run: Trajectory, tolerances: Tolerances) -> Claim:
    d, r = run.law.alpha.d, run.law.alpha.r
    deviation = deviation_energy(run.q[-1], d, r) / d**2
    lengths = link_lengths(run.q[-1], links(run.q[-1], r))
    detail = (
        f"Ẽ = {deviation:.3g} at the end (a link is off d by {100.0 * sqrt(deviation):.2g} % in root mean square); the "
        f"{lengths.size} links are {lengths.min():.4g} to {lengths.max():.4g} long for d = {d:g}, squeezed inwards"
    )
    margin = tolerances.deviation - deviation
    stated_text = f"Ẽ <= {tolerances.deviation:g}"
    return finding(margin, detail, computed=deviation, stated=stated_text, error=ROUNDING)


@report("matched", "velocities match (Fig. 18: K̃ goes to 0)")
def _ends_matched(run: Trajectory, tolerances: Tolerances) -> Claim:
    series, basin = run.metric("normalised_velocity_mismatch"), attraction(run.law, run.q[-1], run.p[-1])
    detail = f"velocity mismatch K̃ goes from {series[0]:.3g} to {series[-1]:.3g} at t = {run.t[-1]:g}"
    return limit_report(basin.certificate, detail, computed=float(series[-1]), stated="K̃ -> 0")


@report("topology", "the net changes on the way")
def _topology_changes(run: Trajectory, tolerances: Tolerances) -> Claim:
    nets = [{*map(tuple, links(q, run.law.alpha.r).tolist())} for q in run.q]
    changes = sum(a != b for a, b in pairwise(nets))
    kept_link_count = len(nets[0] & nets[-1])
    detail = (
        f"the net differs between {changes} pairs of successive samples; of {len(nets[0])} links at the start "
        f"{kept_link_count} are among the {len(nets[-1])} at the end"
    )
    return finding(changes - 0.5, detail, computed=changes, stated="> 0")


@report("mismatched", "velocities do not match (Fig. 18(b): K̃ stays away from 0)")
def _stays_mismatched(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that velocity mismatch K̃ never falls to a small share of K̃(0) in the second half."""
    series = run.metric("normalised_velocity_mismatch")
    late_values = series[run.t >= 0.5 * (run.t[0] + run.t[-1])]
    share = float(late_values.min() / series[0])
    detail = (
        f"normalised velocity mismatch K̃ is {series[-1]:.3g} at t = {run.t[-1]:g}, and never below {share:.2g} of "
        "its start in the second half: the fragments move apart"
    )
    stated_text = f"K̃ > {tolerances.agreement:g} K̃(0)"
    margin = share - tolerances.agreement
    return finding(margin, detail, computed=share, stated=stated_text, error=ROUNDING)


@report("expands", "the cohesion radius grows (Fig. 18(b): R)")
def _expands(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that the cohesion radius R grows throughout the second half of the run."""
    radius = run.metric("cohesion_radius")
    late_values = radius[run.t >= 0.5 * (run.t[0] + run.t[-1])]
    rise = float(np.diff(late_values).min() / run.scales.length)
    description = "rises" if rise > 0.0 else "does not rise"
    detail = f"R goes from {radius[0]:.4g} to {radius[-1]:.4g}, and {description} at every sample of the second half"
    return finding(rise, detail, computed=float(radius[-1]), stated="R rises")


@report("links", "the deviation energy of the fragments is small (Fig. 18(b): Ẽ)")
def _links_settle(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that the links kept by fragments relax: each fragment is a lattice."""
    deviation = run.metric("normalised_deviation_energy")
    detail = f"Ẽ goes from {deviation[0]:.3g} to {deviation[-1]:.2g}: the fragments keep links of length d"
    margin, end = tolerances.deviation - float(deviation[-1]), float(deviation[-1])
    return finding(margin, detail, computed=end, stated=f"Ẽ <= {tolerances.deviation:g}", error=ROUNDING)


@report("meets", "the group meets at the γ-agent")
def _centre_converges(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that the centre of mass converges to the γ-agent, in the law's scales."""
    target = [run.law.target.state(float(t)) for t in run.t]
    away, slip = (
        np.linalg.norm(x.mean(axis=1) - np.array([state[k] for state in target]), axis=1) / unit
        for k, (x, unit) in enumerate(((run.q, run.scales.length), (run.p, run.scales.speed)))
    )
    gains, target = run.law.gains, run.law.target
    uniform = isinstance(target, StaticTarget | LinearTarget) and consistent(run).status == "met"
    is_damped = not gains.per_agent and gains.c1_gamma > 0.0 and gains.c2_gamma > 0.0
    exact = "(q_c − q_r)'' + c2γ (q_c − q_r)' + c1γ (q_c − q_r) = 0"
    certificate = Certificate(1.0, exact) if uniform and is_damped else Certificate(-1.0, "the γ-agent accelerates")
    detail = f"the centre of mass ends {away[-1]:.2g} d from the γ-agent, at {slip[-1]:.2g} of the law's speed"
    stated_text = "both -> 0"
    return limit_report(certificate, detail, computed=float(away[-1]), stated=stated_text)


@report("coincide", "pairs of agents end in the same place (erratum E11)")
def _coincide(run: Trajectory, tolerances: Tolerances) -> Claim:
    tol = tolerances.contact * run.law.alpha.d
    pairs = coincident_pairs(run.q[-1], tol)
    clusters = np.bincount(components(run.n, links(run.q[-1], tol)))
    detail = f"{pairs} pairs coincide at t = {run.t[-1]:g}, in clusters of up to {clusters.max()} agents"
    return finding(pairs - 0.5, detail, computed=pairs, stated="more than 0")


_CONNECTED = report("connected", "the net ends connected (Fig. 18: C = 1)")(connected)
_FRAGMENTS = report("fragments", "the net ends in several components")(fragmented)


def random_start(seed: int, n: int, m: int) -> Start:
    """Return the paper's start: q normal with variance 2500 per coordinate, p uniform in [−2, −1]^m."""
    generator = np.random.default_rng(seed)
    return generator.normal(0.0, 50.0, (n, m)), generator.uniform(-2.0, -1.0, (n, m))


def _following(
    name: str,
    title: str,
    source: str,
    reports: tuple[Report, ...],
    *,
    n: int,
    end: float,
    m: int = 2,
    more: Mapping[str, Status] = MappingProxyType({}),
    shipped: tuple[str, ...] = (),
) -> Builder:
    q_r, p_r = np.zeros(m), np.zeros(m)
    q_r[:2], p_r[0] = (200.0, 30.0), 5.0
    law, statuses = Algorithm2(target=LinearTarget(q_r, p_r)), {**_FLOCKS, **more}
    shipped_statuses = {key: statuses.pop(key) for key in shipped}
    text, draw = f"{source} {_OURS}", partial(random_start, n=n, m=m)
    return entry(name, title, text, law, draw, end, statuses, reports, shipped=shipped_statuses)


def _fragmentation(seed: int = 0) -> Scenario:
    """Build the scenario of Fig. 12, whose run violates the hypothesis of Theorem 1."""
    title = "Fig. 12: 40 agents without a γ-agent fall apart"
    source = f"Olfati-Saber 2006, Fig. 12 and 18(b): n = 40, Algorithm 1, q and p as in Fig. 10. {_OURS}"
    expected = verified("energy") | vacuous("os-1")
    expected |= refuted("alpha-flocking", "alpha-flocking-strict", "alpha-flocking-strict:flock")
    expected |= verified("os-5-terminal:extension", "source:fragments")
    reports = (_FRAGMENTS, _stays_mismatched, _expands, _links_settle)
    law, start, span = Algorithm1(), random_start(seed, 40, 2), (0.0, 40.0)
    shipped = verified("source:expands", "source:links")
    return Scenario("paper-fragmentation", title, source, law, *start, span, seed, expected, reports, shipped=shipped)


def _collapse(seed: int = 0) -> Scenario:
    """Build the scenario of erratum E11: Theorem 3 holds, but the flock collapses and is no lattice."""
    gains = Gains(c1_alpha=1.0, c2_alpha=1.0, c1_gamma=1.0, c2_gamma=1.0)
    title = "Unit gains: 150 agents are squeezed until pairs coincide"
    source_text = (
        "Ours, on the slides' summary that Algorithm 2 yields a lattice: parameters, q and p of Fig. 10, all gains 1, "
        "a γ-agent at rest at the origin."
    )
    law, start = Algorithm2(gains=gains, target=StaticTarget((0.0, 0.0))), random_start(seed, 150, 2)
    span = (0.0, 180.0)
    expected = verified("energy", "os-3", "os-3:i", "os-3:ii", "os-3:iii")
    expected |= refuted("alpha-flocking", "alpha-flocking:deviation", "alpha-flocking-strict")
    expected |= verified("alpha-flocking-strict:flock") | vacuous("os-5-terminal:i")
    expected |= refuted("E11", "E11:printed") | verified("E11:minimum", "source")
    return Scenario("collapse", title, source_text, law, *start, span, seed, expected, (_coincide,), references=OURS)


def _hexagon(seed: int = 0) -> Scenario:
    """Build the scenario that meets Theorem 1's hypotheses: connected throughout, H(0) < c*."""
    alpha, generator = AlphaInteraction(), np.random.default_rng(seed)
    ring = [(cos(k * pi / 3.0), sin(k * pi / 3.0)) for k in range(6)]
    q = alpha.d * np.array([(0.0, 0.0), *ring]) + generator.uniform(-0.2, 0.2, (7, 2))
    title = "Seven agents near a hexagon, with less energy than a collision costs"
    source_text = (
        "Ours: a hexagonal patch of side d = 7, each coordinate displaced by up to 0.2, velocities up to 0.3 per axis, "
        "Algorithm 1 with the default gains. H(x(0), v(0)) is below c* and below that of every disconnected "
        "state that we know."
    )
    law = Algorithm1(alpha=alpha)
    p = generator.uniform(-0.3, 0.3, (7, 2))
    expected = verified("energy", "os-1", "os-1:i", "os-1:ii", "os-1:iii", "os-5-terminal", "os-5-terminal:i")
    expected |= verified("alpha-flocking", "alpha-flocking-strict", "linearised-decay-terminal")
    return Scenario("hexagon", title, source_text, law, q, p, (0.0, 30.0), seed, expected, references=OURS)


def _three_agents(seed: int = 0) -> Scenario:
    """Return the scenario of erratum E13: three agents, two pairs of which coincide one after the other."""
    alpha = AlphaInteraction(a=5e4, b=5e4)
    gains = Gains(c1_alpha=1.0, c2_alpha=1.0, c1_gamma=0.01, c2_gamma=0.01)
    p0 = lazy_array((3, 1), lambda: np.array([[sqrt(5.6 * alpha.c_star)], [0.0], [0.0]]))
    title = "Three agents on a line: one agent runs through both others"
    source_text = (
        "Ours, on Theorem 3(iv): q = (-12, 0, 30), p = (√(5.6 c*), 0, 0), a = b = 50000, c1α = c2α = 1, "
        "c1γ = c2γ = 0.01, a γ-agent at rest at 0; other parameters as in the paper. The start is fixed."
    )
    law = Algorithm2(alpha=alpha, gains=gains, target=StaticTarget((0.0,)))
    # (iii) holds by its proof, though velocities have not matched by then
    expected = verified("energy", "os-3:i", "os-3:iii", "os-3:iv-instant") | inconclusive("os-3:ii")
    expected |= refuted("os-3", "os-3:iv-printed") | vacuous("os-3:iv-none", "os-5-terminal:i")
    expected |= refuted("E13", "E13:printed") | verified("E13:corrected")
    start = np.array([[-12.0], [0.0], [30.0]]), p0
    return Scenario("three-agents-1d", title, source_text, law, *start, (0.0, 0.05), seed, expected, references=OURS)


SCENARIOS: dict[str, Callable[..., Scenario]] = {
    "paper-flocking": _following(
        "paper-flocking",
        "Fig. 10: 150 agents gather and follow a γ-agent",
        "Olfati-Saber 2006, Fig. 10: n = 150, Algorithm 2, d = 7, r = 8.4, ε = 0.1, a = b = 5, h = 0.2, q normal with "
        "variance 2500, p uniform in [-2, -1]², γ-agent from (200, 30) at (5, 0).",
        (_CONNECTED, _ends_as_lattice, _ends_matched),
        n=150,
        end=60.0,
        more=verified("linearised-decay-terminal"),
    ),
    "paper-dynamic-topology": _following(
        "paper-dynamic-topology",
        "Fig. 11: 100 agents whose net changes while they flock",
        "Olfati-Saber 2006, Fig. 11 and 18(a): n = 100, otherwise as Fig. 10.",
        (_topology_changes, _CONNECTED, _ends_as_lattice, _ends_matched),
        n=100,
        end=50.0,
        shipped=(*_RESTS, "source"),
    ),
    "paper-fragmentation": _fragmentation,
    "paper-rendezvous-3d": _following(
        "paper-rendezvous-3d",
        "Fig. 13: 50 agents meet in space",
        "Olfati-Saber 2006, Fig. 13: n = 50, m = 3, Algorithm 2. The start (as Fig. 10, in three dimensions) and the "
        "γ-agent, from (200, 30, 0) at (5, 0, 0), are ours.",
        (_centre_converges, _CONNECTED, _ends_as_lattice),
        n=50,
        m=3,
        end=60.0,
        shipped=_RESTS,
    ),
    "collapse": _collapse,
    "hexagon": _hexagon,
    "three-agents-1d": _three_agents,
}
