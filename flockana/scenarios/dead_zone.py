"""Dead-zone paper's simulation with the missing parameters chosen, and runs at the limits of its claims."""

from typing import Any

import numpy as np

from flockana.base.checks import ensure_positive
from flockana.dynamics.trajectory import Trajectory
from flockana.interactions import DeadZoneInteraction
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.laws.discrete import DiscreteLaw
from flockana.laws.led_dead_zone import LedDeadZoneFlocking
from flockana.laws.semi_implicit import SemiImplicitEuler
from flockana.scenarios.expected import inconclusive, refuted, verified
from flockana.scenarios.findings import finding
from flockana.scenarios.scenario import Report, Scenario
from flockana.theorems import Claim, Tolerances
from flockana.theorems.dead_zone.case import dead_zone_law, final_components, velocities_match
from flockana.theorems.dead_zone.range_limits import thinned
from flockana.theorems.observed import Observed
from flockana.theorems.rounding import EPS
from flockana.theorems.theorem import Status

_PRINTED = "Li, Yuan and Liu, section V: n = 50, r = 15, δ = 4.5, k_δ = 1.3, no more."
DT = 0.01
_SAMPLES = 401
_FIGURE_3 = (0.0, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0)  # shares of the run: Fig. 3 (a)-(h) are eight, times ours


def describe_choices(
    law: DeadZoneFlocking | LedDeadZoneFlocking, box: float, t_end: float, *, flow: bool = False
) -> str:
    """Return a description of every parameter not printed in the paper."""
    pair = law.interaction
    ramp = (
        f"a ramp of width {pair.ramp:g} in place of the jumps beside the dead zone"
        if pair.ramp
        else "the force jumps beside the dead zone, as printed"
    )
    steps = "the flow itself" if flow else f"semi-implicit Euler steps of {DT:g}"
    return (
        f"Ours: r_b = {pair.r_b:g} (d1 = {pair.d1:g}, d2 = {pair.d2:g}), r_d = {pair.r_d:g}, k_r = {pair.k_r:g}, "
        f"η = {pair.eta:g}, k1 = {pair.k1:g}, k2 = {law.k2:g}, a_ij = 1 within r, {ramp}; q uniform in a box of side "
        f"{box:g}, p uniform in [-1, 1]², {steps}, for {t_end:g} time units."
    )


def _law(run: Trajectory) -> DeadZoneFlocking:
    law = dead_zone_law(run)
    assert law is not None
    return law


def _consensus(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that all velocities agree in the limit."""
    seen = Observed.alone(run)
    return velocities_match(seen, final_components(seen, _law(run)), [], name="consensus")


def _together(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that the net is connected at the end of the run."""
    from scipy.sparse.csgraph import minimum_spanning_tree
    from scipy.spatial.distance import pdist, squareform

    r, count = _law(run).interaction.r, final_components(Observed.alone(run), _law(run)).count
    longest = float(minimum_spanning_tree(squareform(pdist(run.q[-1]))).max()) if run.n > 1 else 0.0
    detail = f"{count} component(s) at t = {run.t[-1]:g}: to join all takes links of up to {longest:.4g}, and r = {r:g}"
    error = _rounding(run, r)
    return finding(
        "together", 1.0 - longest / r, detail, computed=count, stated="one component at the end", error=error
    )


def _safe(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that distances stay above half of the distance below which agents repel."""
    d1, at = _law(run).interaction.d1, float(run.metric("min_distance").min())
    ever = at if isinstance(run.law, DiscreteLaw) else run.closest_approach().lower
    seen = ever > 0.5 * d1 and not thinned(run)
    margin = ever / d1 - 0.5 if seen else at / d1 - 0.5 if at < 0.5 * d1 else float("nan")
    detail = f"agents come as near as {ever:.3g}, where repulsion begins at d1 = {d1:g}"
    stated = "safe distances all the time (over d1/2)"
    return finding("safe", margin, detail, computed=ever, stated=stated, error=_rounding(run, d1))


def _lattice(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that the end is an α-lattice within a quasi-lattice's tolerance."""
    from scipy.spatial import KDTree

    if run.n == 1:
        return finding("lattice", float("nan"), "one agent has no neighbour", stated="a lattice")
    nearest = np.asarray(KDTree(run.q[-1]).query(run.q[-1], k=2)[0])[:, 1]
    d1 = _law(run).interaction.d1
    spread = float(np.abs(nearest / d1 - 1.0).max())
    detail = (
        f"nearest neighbours are {nearest.min():.4g} to {nearest.max():.4g} apart, {nearest.mean():.4g} in the mean"
    )
    return finding(
        "lattice",
        tolerances.quasi - spread,
        detail,
        computed=float(nearest.mean()),
        stated=f"d1 = {d1:g}",
        error=_rounding(run, d1),
    )


def _rounding(run: Trajectory, length: float) -> float:
    """Return the rounding error of the distance of two agents, as a share of a length."""
    return 8.0 * EPS * (float(np.abs(run.q).max()) / length + 1.0)


_REPORTS = (
    Report("consensus", "speeds converge to the same value", _consensus),
    Report("together", "the agents swarm together", _together),
    Report("safe", "agents hold safe distances all the time", _safe),
    Report("lattice", "the agents form an α-lattice", _lattice),
)


def _scenario(
    name: str,
    title: str,
    source: str,
    interaction: DeadZoneInteraction,
    seed: int,
    n: int,
    box: float,
    expected: dict[str, Status],
    *,
    flow: bool = False,
    t_end: float = 200.0,
    seeds: int = 0,
    settings: str = "",
) -> Scenario:
    generator = np.random.default_rng(seed)
    box, law = ensure_positive("box", box), DeadZoneFlocking(interaction)
    notes = f"{source} {describe_choices(law, box, t_end, flow=flow)}" + (
        "" if flow else " The eight instants shown are ours."
    )
    options: dict[str, Any] = {} if flow else {"t_eval": np.linspace(0.0, t_end, _SAMPLES)}
    return Scenario(
        name,
        title,
        notes,
        law if flow else SemiImplicitEuler(law, DT),
        generator.uniform(0.0, box, (n, 2)),
        generator.uniform(-1.0, 1.0, (n, 2)),
        (0.0, t_end),
        seed,
        expected,
        _REPORTS,
        options,
        ("li-dead-zone",),
        seeds,
        settings,
        instants=() if flow else tuple(share * t_end for share in _FIGURE_3),
    )


# what holds from every start, and what holds at every seed of these settings; cohesion, the lattice and how parts of a
# wide start end differ from seed to seed; the report gives shares of seeds
_ALWAYS = verified("dead-zone-1-printed:collision", "dead-zone-1-corrected:rate", "dead-zone-1-corrected:distance")
_CONTRACTS = refuted("dead-zone-1-printed", "dead-zone-1-printed:energy")


def _default(seed: int = 0, n: int = 50, box: float = 40.0, ramp: float = 0.25) -> Scenario:
    expected = dict(_ALWAYS)
    if (n, box, ramp) == (50, 40.0, 0.25):  # of 100 seeds 100, 84, 18, 0 become one flock at 40, 60, 80, 150 (L4)
        expected |= _CONTRACTS | verified(
            "dead-zone-1-printed:velocity", "dead-zone-1-corrected", "source:consensus", "source:together"
        )
    title = "Dead zone: 50 agents contract to a lattice of contacts"
    source = _PRINTED + " r_b is chosen so that the flock fits within r."
    many: dict[str, Any] = {"seeds": 200, "settings": "recommended settings: force ramped"}
    return _scenario("dead-zone", title, source, DeadZoneInteraction(ramp=ramp), seed, n, box, expected, **many)


def _wide_lattice(seed: int = 0, n: int = 50, box: float = 40.0, ramp: float = 0.25) -> Scenario:
    expected = dict(_ALWAYS)  # k1 is all that attracts: velocities settle over 1/k1 and longer
    if (n, box, ramp) == (50, 40.0, 0.25):
        expected |= _CONTRACTS | verified("source:together")
    interaction = DeadZoneInteraction(r_b=12.0, k_r=60.0, k1=0.02, ramp=ramp)
    source = _PRINTED + " Here the dead zone ends beyond r, and only k1 attracts."
    title = "Dead zone, large spacing: only k1 attracts, and the flock is wider than r"
    return _scenario("dead-zone-wide-lattice", title, source, interaction, seed, n, box, expected)


def _wide_start(seed: int = 0, n: int = 50, box: float = 150.0, ramp: float = 0.25) -> Scenario:
    expected = dict(_ALWAYS)
    if (n, box, ramp) == (50, 150.0, 0.25):
        expected |= _CONTRACTS | refuted("source:together")
    title = "Dead zone, wide start: the flock stays in pieces"
    source = _PRINTED + " Here the start is wide."
    interaction = DeadZoneInteraction(ramp=ramp)
    return _scenario("dead-zone-wide-start", title, source, interaction, seed, n, box, expected, t_end=800.0)


def _hard(seed: int = 0, n: int = 50, box: float = 40.0) -> Scenario:
    expected = dict(_ALWAYS)
    if (n, box) == (50, 40.0):
        names = "dead-zone-1-printed:velocity", "dead-zone-1-corrected:components", "source:consensus"
        expected |= _CONTRACTS | inconclusive(*names) | verified("source:together")  # contacts keep chattering
    title = "Dead zone with the printed jumps: contacts chatter"
    source = _PRINTED + " Here the jumps are as printed."
    many: dict[str, Any] = {"seeds": 200, "settings": "printed settings: force jumps"}
    return _scenario("dead-zone-hard", title, source, DeadZoneInteraction(ramp=0.0), seed, n, box, expected, **many)


def _flow(seed: int = 0, n: int = 16, box: float = 20.0, ramp: float = 0.25) -> Scenario:
    expected = dict(_ALWAYS)
    if (n, box, ramp) == (16, 20.0, 0.25):
        expected |= _CONTRACTS | verified(
            "dead-zone-1-printed:velocity", "dead-zone-1-corrected", "source:consensus", "source:together"
        )
    title = "Dead zone, the flow itself: 16 agents, energy balance and distances between samples"
    source = f"The continuous law that the other dead-zone runs step: n = {n}; r = 15, δ = 4.5, k_δ = 1.3 as printed."
    interaction = DeadZoneInteraction(ramp=ramp)
    return _scenario("dead-zone-flow", title, source, interaction, seed, n, box, expected, flow=True, t_end=120.0)


SCENARIOS = {
    "dead-zone": _default,
    "dead-zone-wide-lattice": _wide_lattice,
    "dead-zone-wide-start": _wide_start,
    "dead-zone-hard": _hard,
    "dead-zone-flow": _flow,
}
