"""Figures 9 and 14 to 17 of Olfati-Saber (2006): flocks among obstacles, and runs of our own for Theorem 6."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import inf
from types import MappingProxyType
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.environment.capsule import Capsule
from flockana.environment.obstacles import Obstacle, Sphere
from flockana.environment.targets import LinearTarget, StaticTarget, Target
from flockana.interactions import BetaInteraction, Gains
from flockana.laws.algorithm3 import Algorithm3
from flockana.measures.clearance import ConstrainedLattice, constrained_lattice
from flockana.scenarios.findings import ROUNDING, component_counts, finding, in_source_units, in_the_end
from flockana.scenarios.scenario import SOURCE, Report, Scenario
from flockana.theorems import Claim, Tolerances
from flockana.theorems.limits import Certificate
from flockana.theorems.theorem import Status

# The pull on an agent saturates at c1γ, so that it nears the γ-agent at c1γ/c2γ at most. With Algorithm 2's 1.1 and
# 2√1.1 that is 0.5: a flock of spread 50 would need some 300 time units to gather. With c1γ = 30 agents coincide.
GAINS = Gains(c1_gamma=12.0, c2_gamma=2.0)
_OURS = (
    "No gains are printed; ours, for all runs with obstacles, are c1α = 30, c2α = 2√30, c1β = 1500, c2β = 2√1500, "
    "c1γ = 12, c2γ = 2: the pull is bounded, so agents near the γ-agent at c1γ/c2γ = 6 at most. Agents that would "
    "start inside an obstacle or closer than d' are drawn again."
)
_SEGMENT = 400  # points on the straight way to the γ-agent that are looked at

_SPLIT = [
    Sphere((float(x), float(y)), float(radius))
    for x, y, radius in zip((100, 110, 120, 130, 150, 160), (20, 60, 40, -20, 40, 0), (10, 4, 2, 5, 5, 3), strict=True)
]
_GAP = [Sphere((150.0, 30.0), 25.0), Sphere((150.0, 100.0), 25.0)]
_BAR = [Capsule((60.0, -40.0), (60.0, 40.0), 5.0)]
_CUP = [
    Capsule((60.0, -20.0), (60.0, 20.0), 4.0),
    Capsule((60.0, 20.0), (25.0, 32.0), 4.0),
    Capsule((60.0, -20.0), (25.0, -32.0), 4.0),
]
_BALLS = [Sphere((60.0, 0.0, 0.0), 15.0), Sphere((70.0, 30.0, 10.0), 10.0), Sphere((100.0, -15.0, 0.0), 10.0)]


def free_start(
    seed: int, n: int, centre: Sequence[float], spread: float, obstacles: Sequence[Obstacle], *, room: float
) -> tuple[FloatArray, FloatArray]:
    """The paper's random start about a centre, with agents too near an obstacle drawn again until none is.

    Examples
    --------
    >>> wall = Sphere((0.0, 0.0), 3.0)
    >>> q, p = free_start(0, 50, (0.0, 0.0), 5.0, [wall], room=1.0)
    >>> bool(wall.clearance(q).min() >= 1.0), bool(-2.0 <= p.min() <= p.max() <= -1.0)
    (True, True)
    """
    generator = np.random.default_rng(seed)
    m = len(centre)
    q, p = generator.normal(centre, spread, (n, m)), generator.uniform(-2.0, -1.0, (n, m))
    while (near := np.any([obstacle.clearance(q) < room for obstacle in obstacles], axis=0)).any():
        q[near] = generator.normal(centre, spread, (int(near.sum()), m))
    return q, p


def _stays_clear(run: Trajectory, tolerances: Tolerances) -> Claim:
    """No agent enters: by the lower bound of all clearances; one that is inside at a point of its path refutes it."""
    least = run.clearance()
    rounding = ROUNDING * float(np.abs(run.q).max())
    margin = least.reached if least.reached < -rounding else least.lower
    error = rounding if margin > 0.0 or margin == least.reached else inf
    detail = (
        f"agent {least.agent} comes closest, {least.reached:.4g} from obstacles[{least.obstacle}] at "
        f"t = {least.time:.4g}; no agent is closer than {least.lower:.4g} to any at any time"
    )
    witness = {"agent": least.agent, "obstacle": least.obstacle, "time": least.time}
    return finding("clear", margin, detail, computed=least.lower, stated="> 0", error=error, witness=witness)


def _splits(run: Trajectory, tolerances: Tolerances) -> Claim:
    counts = component_counts(run)
    whole = np.flatnonzero(counts == 1)
    if whole.size == 0:
        return finding("splits", -1.0, f"the net is never connected: at least {counts.min()} components", stated=1)
    after = counts[whole[0] :]
    most, apart = int(after.max()), run.t[whole[0] :][after > 1]
    detail = f"connected from t = {run.t[whole[0]]:.4g}" + (
        f"; in up to {most} components between t = {apart[0]:.4g} and {apart[-1]:.4g}" if most > 1 else " to the end"
    )
    return finding("splits", min(most, 2) - 1.5, detail, computed=most, stated="1, then more than 1")


def _rejoins(run: Trajectory, tolerances: Tolerances) -> Claim:
    """One flock at the end of the run: open, for where agents are by then hangs on the last bit of their start."""
    counts = component_counts(run)
    apart = np.flatnonzero(counts > 1)
    detail = f"{counts[-1]} component(s) at t = {run.t[-1]:g}"
    if counts[-1] == 1 and apart.size:
        detail += f", connected again from t = {run.t[apart[-1] + 1]:.4g} on"
    certificate = Certificate(-1.0, "the net at one instant of a motion that forgets its start is no limit")
    return in_the_end("rejoins", certificate, detail, computed=int(counts[-1]), stated="1")


def _passed_between(run: Trajectory) -> int:
    """How many agents cross x = 150 between the two spheres of the gap."""
    before = run.q[:-1, :, 0] < 150.0
    crossing = before & (run.q[1:, :, 0] >= 150.0)
    row, agent = np.nonzero(crossing)
    last = np.full(run.n, -1)
    np.maximum.at(last, agent, row)
    y = run.q[np.maximum(last, 0) + 1, np.arange(run.n), 1]
    return int(np.sum((last >= 0) & (y > 55.0) & (y < 75.0)))


def _gets_past(run: Trajectory, tolerances: Tolerances) -> Claim:
    x = run.q[-1, :, 0]
    detail = f"{int((x > 175.0).sum())} of {run.n} agents are beyond both spheres, the last one at x = {x.min():.4g}"
    margin = float(np.clip(x.min() - 175.0, -25.0, 25.0))  # a sphere's radius is enough: how far agents get varies
    return finding("past", margin, detail, computed=float(x.min()), stated="x > 175 for all")


def _squeezes(run: Trajectory, tolerances: Tolerances) -> Claim:
    through = _passed_between(run)
    detail = f"{through} of {run.n} agents go through the gap, of width 20; the others round the outside of the spheres"
    margin = float(np.clip(through - 0.5 * run.n, -0.1 * run.n, 0.1 * run.n))  # a tenth is enough: the number varies
    return finding("squeezes", margin, detail, computed=through, stated="more than half")


def blocked(q: FloatArray, target: FloatArray, obstacles: Sequence[Obstacle]) -> FloatArray:
    """Which agents have an obstacle on the straight way to the γ-agent, shape (n,).

    Examples
    --------
    >>> q = np.array([[0.0, 0.0], [0.0, 9.0]])
    >>> blocked(q, np.array([10.0, 0.0]), [Sphere((5.0, 0.0), 1.0)]).tolist()
    [True, False]
    """
    share = np.linspace(0.0, 1.0, _SEGMENT)[:, None, None]
    way = (q + share * (target - q)).reshape(-1, q.shape[1])
    hit = np.any([obstacle.contains(way) for obstacle in obstacles], axis=0)
    found: FloatArray = hit.reshape(_SEGMENT, len(q)).any(axis=0)
    return found


def _traps(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Held back: behind an obstacle at the end, and slower than what counts as a standstill for the last tenth."""
    held = blocked(run.q[-1], run.law.target.position(float(run.t[-1])), run.law.obstacles)
    last = run.t >= run.t[-1] - 0.1 * (run.t[-1] - run.t[0])
    limit = tolerances.agreement * run.law.gains.c1_gamma * run.law.alpha.unit / run.law.gains.c2_gamma
    slow = np.linalg.norm(run.p[last], axis=2).max(axis=0) < limit
    count = int((held & slow).sum())
    detail = (
        f"until t = {run.t[-1]:g} {count} of {run.n} agents rest (slower than {limit:.3g}, {tolerances.agreement:g} of "
        "the speed at which agents near the γ-agent) with an obstacle on the straight way to the γ-agent"
    )
    certificate = Certificate(1.0 if count else -1.0, "that is a count" if count else "none does, as yet")
    return in_the_end("trapped", certificate, detail, computed=count, stated="more than 0")


def _rests(run: Trajectory, tolerances: Tolerances) -> Claim:
    """It comes to rest: hardly any speed is left, and hardly any force on agents at rest where they are.

    With a γ-agent at rest and c2γ > 0 every motion dies out, as H falls by c2γ Σ‖p_i‖² at least; what is open is when.
    So one instant will do here, of small speeds and forces together: it is no turning point of a swing for ever. Near
    stiff obstacles the solver's last digits are worth as much force: the calmest instant of the last tenth is taken.
    """
    law, late = run.law, np.flatnonzero(run.t >= run.t[-1] - 0.1 * (run.t[-1] - run.t[0]))
    still = np.zeros_like(run.p[0])
    forces = np.array([np.linalg.norm(law.acceleration(run.t[k], run.q[k], still), axis=1).max() for k in late])
    forces, speeds = forces / run.scales.force, np.linalg.norm(run.p[late], axis=2).max(axis=1) / run.scales.speed
    lefts = np.maximum(forces / tolerances.force, speeds / np.sqrt(tolerances.velocity))
    calmest = int(np.argmin(lefts))
    t, force, speed = (float(series[calmest]) for series in (run.t[late], forces, speeds))
    left = max(float(lefts[calmest]), 1e-300)
    damped = Certificate(float(np.clip(-np.log(left), -1.0, 1.0)), f"{left:.2g} of what counts as none")
    none = Certificate(-1.0, "without damping by the γ-agent it may never")
    detail = f"at t = {t:g} the largest force is {force:.2g} of the law's, the largest speed {speed:.2g}"
    certificate = damped if law.gains.c2_gamma > 0.0 else none
    return in_the_end("rests", certificate, detail, computed=force, stated=f"force <= {tolerances.force:g} at rest")


def _measured(run: Trajectory) -> tuple[ConstrainedLattice, float, str]:
    """How far the end is from a constrained α-lattice, relative to d and d' too, and in words."""
    law = run.law
    found = constrained_lattice(run.q[-1], law.obstacles, alpha=law.alpha, beta=law.beta)
    strain = max(found.alpha_error / law.alpha.d, found.beta_error / law.beta.d)
    detail = (
        f"{found.beta_links} β-agents are d' away but for {found.beta_error:.3g}, {found.links} links d long but for "
        f"{found.alpha_error:.3g}: relative to d' and d {strain:.2g} at most"
    )
    return found, strain, detail


def _touches(run: Trajectory, tolerances: Tolerances) -> Claim:
    found, _, detail = _measured(run)
    return finding("in-touch", found.beta_links - 0.5, detail, computed=found.beta_links, stated="β-neighbours")


def _constrained(run: Trajectory, tolerances: Tolerances) -> Claim:
    _, strain, detail = _measured(run)
    margin = (tolerances.quasi - strain) / tolerances.quasi
    certificate = Certificate(float(np.clip(margin, -1.0, 1.0)), f"quasi is up to {tolerances.quasi:g}")
    return in_the_end("constrained-lattice", certificate, detail, computed=strain, stated=f"<= {tolerances.quasi:g}")


_CLEAR = Report("clear", "no agent enters an obstacle", _stays_clear)
_RESTS = Report("rests", "the group comes to rest in an equilibrium among the obstacles", _rests)
_TOUCHES = Report("in-touch", "it rests against obstacles; how near it is to a constrained α-lattice", _touches)
_LATTICE = Report("constrained-lattice", "it rests as a quasi constrained α-lattice", _constrained)
_TRAPPED = Report("trapped", "the obstacle holds agents back from the γ-agent (Fig. 9)", _traps)
_DESCENDS: dict[str, Status] = {"energy": "verified", "os-6": "verified", "os-6:rate": "verified"}
_STATIC: dict[str, Status] = {**_DESCENDS, "source": "verified"}
_MOVING: dict[str, Status] = {"energy": "verified", "energy:rate": "vacuous", "os-6": "vacuous"}


def _reported(*names: str) -> dict[str, Status]:
    """What a source reports and a run confirms."""
    return dict.fromkeys((f"{SOURCE}:{name}" for name in names), "verified")


def _large(end: float) -> dict[str, Any]:
    """Of the large runs not every step is kept; their balance of energy stays within 2e-7 of it."""
    return {"rtol": 1e-7, "atol": 1e-9, "t_eval": np.linspace(0.0, end, round(20.0 * end) + 1)}


def _entry(
    name: str,
    title: str,
    source: str,
    *,
    obstacles: Sequence[Obstacle],
    target: Target,
    centre: Sequence[float],
    n: int,
    end: float,
    expected: Mapping[str, Status],
    reports: tuple[Report, ...],
    spread: float = 50.0,
    shipped: Mapping[str, Status] = MappingProxyType({}),
) -> tuple[str, Callable[[int], Scenario]]:
    law = Algorithm3(gains=GAINS, target=target, obstacles=tuple(obstacles))

    def build(seed: int = 0) -> Scenario:
        start = free_start(seed, n, centre, spread, law.obstacles, room=BetaInteraction().d)
        text = f"{source} {_OURS}"
        options = _large(end) if n > 100 else {}
        asked = tuple(replace(one, check=in_source_units(law.scales, one.check)) for one in (_CLEAR, *reports))
        span = (0.0, end)
        return Scenario(name, title, text, law, *start, span, seed, expected, asked, options, shipped=shipped)

    return name, build


SCENARIOS: dict[str, Callable[..., Scenario]] = dict(
    [
        _entry(
            "paper-split-rejoin",
            "Figs. 14, 15: 150 agents split around six discs and rejoin",
            "Olfati-Saber 2006, Figs. 14 and 15: n = 150, Algorithm 3, six discs, a γ-agent through (200, 30) at "
            "(5, 0), variance 2500. The start is ours: about the γ-agent, 200 before the first disc, for a flock that "
            "starts about the origin cannot gather before it is among the discs.",
            obstacles=_SPLIT,
            target=LinearTarget((-100.0, 30.0), (5.0, 0.0)),
            centre=(-100.0, 30.0),
            n=150,
            end=80.0,
            expected={**_MOVING, **_reported("clear", "splits"), "source:rejoins": "inconclusive"},
            reports=(
                Report("splits", "the flock, connected before, splits around the obstacles", _splits),
                Report("rejoins", "behind the obstacles it is one flock again", _rejoins),
            ),
        ),
        _entry(
            "paper-squeezing",
            "Figs. 16, 17: 150 agents squeeze through a gap between two discs",
            "Olfati-Saber 2006, Figs. 16 and 17: n = 150, Algorithm 3, two discs of radius 25 that leave a gap of 20. "
            "The start and the γ-agent, through the middle of the gap and (230, 60) at 5 along x, are ours.",
            obstacles=_GAP,
            target=LinearTarget((-120.0, 81.875), (5.0, -0.3125)),
            centre=(-120.0, 81.875),
            n=150,
            end=115.0,
            expected={**_MOVING, **_reported("clear", "squeezes", "past"), "source:rejoins": "inconclusive"},
            reports=(
                Report("squeezes", "the flock goes through the gap", _squeezes),
                Report("past", "all agents get past the obstacles", _gets_past),
                Report("rejoins", "behind the gap it is one flock again", _rejoins),
            ),
        ),
        _entry(
            "paper-trapped",
            "Fig. 9(a): a non-convex arrangement traps the flock",
            "Olfati-Saber 2006, Fig. 9(a): three bars that form a cup, open towards the flock, before a static "
            "γ-agent. The figure prints no numbers; all are ours.",
            obstacles=_CUP,
            target=StaticTarget((120.0, 0.0)),
            centre=(-20.0, 0.0),
            n=40,
            spread=20.0,
            end=100.0,
            expected=_STATIC,
            reports=(_TRAPPED, _RESTS, _TOUCHES),
        ),
        _entry(
            "paper-trapped-convex",
            "Fig. 9(b): a convex obstacle traps the flock",
            "Olfati-Saber 2006, Fig. 9(b): a bar across the way to a static γ-agent, flatter than circles about it. "
            "The figure prints no numbers; all are ours.",
            obstacles=_BAR,
            target=StaticTarget((120.0, 0.0)),
            centre=(0.0, 0.0),
            n=40,
            spread=20.0,
            end=150.0,
            expected=_STATIC,
            reports=(_TRAPPED, _RESTS, _TOUCHES, _LATTICE),
        ),
        _entry(
            "spheres-3d",
            "Theorem 6 in space: 40 agents pass three spheres and rest against one",
            "Ours, on Olfati-Saber 2006, Theorem 6 with p_d = 0: m = 3, a static γ-agent beside a sphere.",
            obstacles=_BALLS,
            target=StaticTarget((110.0, 0.0, 0.0)),
            centre=(0.0, 0.0, 0.0),
            n=40,
            spread=25.0,
            end=150.0,
            expected={**_DESCENDS, **_reported("clear")},
            shipped={"source": "verified"},
            reports=(_RESTS, _TOUCHES),
        ),
        _entry(
            "told-velocity-ahead",
            "Theorem 6 with p_d ≠ 0: a flock ahead of the γ-agent is pulled back",
            "Ours, on Olfati-Saber 2006, Theorem 6 as printed, q_r fixed at 0 and p_r = p_d = (5, 0) all the same.",
            obstacles=[Sphere((40.0, 3.0), 8.0)],
            target=StaticTarget((0.0, 0.0), (5.0, 0.0)),
            centre=(80.0, 0.0),
            n=30,
            spread=15.0,
            end=100.0,
            expected={"energy": "verified", **_reported("clear")},
            shipped={"os-6": "verified", "os-6:rate": "verified"},  # of some starts condition (76) is broken
            reports=(),
        ),
        _entry(
            "told-velocity-behind",
            "Theorem 6 with p_d ≠ 0: a flock that comes from behind breaks condition (76)",
            "Ours, on Olfati-Saber 2006, Theorem 6 as printed, q_r fixed at (80, 0) and p_r = p_d = (5, 0).",
            obstacles=[Sphere((40.0, 3.0), 8.0)],
            target=StaticTarget((80.0, 0.0), (5.0, 0.0)),
            centre=(0.0, 0.0),
            n=30,
            spread=15.0,
            end=100.0,
            expected={"energy": "verified", "energy:rate": "vacuous", "source": "verified"},
            shipped={"os-6": "vacuous"},  # of some starts (76) is open
            reports=(),
        ),
    ]
)
