"""One common start under many laws, with the theorem on each law and the outcome.

A further law is one more `LawEntry` of `ENTRIES`: its name, how it is built for this start, the theorem that speaks of
its runs, and what that promises in a few words.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray, ensure_known
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.environment import LinearTarget
from flockana.interactions import AlphaInteraction, Gains
from flockana.interactions.log_potential import LogPotential
from flockana.interactions.weights import RationalWeight
from flockana.lattice.builders import hexagonal_spiral
from flockana.laws import (
    Algorithm1,
    Algorithm2,
    CuckerSmale,
    DeadZoneFlocking,
    DiscreteLaw,
    FixedNetFlocking,
    HeadingAveraging,
    Law,
    LinkKeeping,
    ProximityFlocking,
)
from flockana.measures.metrics import diameter
from flockana.measures.nets import components, links
from flockana.theorems import Status, Verdict, verify

_N, _SPEED, _HEADING = 10, 1.0, np.pi / 4.0
_SHAKEN, _TURNED = 0.1, 0.6  # of d, and radians: what chance adds to places and headings
UNTIL = 60.0
RANGE = AlphaInteraction().r
_INSTANTS = 201
_RTOL = 1e-10  # so that what the integration leaves of velocities that agree lies far below what counts as 0
_STRENGTH, _CONSENSUS = 40.0, 1.0  # of Tanner's laws: forces of the size of k/d near d


@dataclass(frozen=True)
class LawEntry:
    """Law for the common start, with a theorem about it."""

    name: str  # of the law, for people
    law: Callable[[FloatArray, FloatArray], Law | DiscreteLaw]  # ``law(q0, p0)`` builds it
    theorem: str  # id of a theorem about its runs
    promise: str  # what the theorem promises, in our words and few of them
    expected: Status | None = None  # status that the theorem has from this start; None where nothing is expected


@dataclass(frozen=True)
class Outcome:
    """Outcome of the start under one law."""

    entry: LawEntry  # the law and its theorem
    run: Trajectory
    verdict: Verdict  # of the theorem on the run

    @property
    def velocity_share(self) -> float:
        """Greatest difference of two velocities at the end over that at the start."""
        return diameter(self.run.p[-1]) / diameter(self.run.p[0])

    @property
    def position_share(self) -> float:
        """Greatest distance of two agents at the end over that at the start."""
        return diameter(self.run.q[-1]) / diameter(self.run.q[0])

    @property
    def groups(self) -> int:
        """Number of components of the net within the common range at the end."""
        return int(components(self.run.n, links(self.run.q[-1], RANGE)).max()) + 1

    @property
    def least_distance(self) -> float:
        """Least distance of two agents at the samples."""
        return float(self.run.metric("min_distance").min())


def one_start(seed: int = 0) -> tuple[FloatArray, FloatArray]:
    """Return (q0, p0) of ten agents near a lattice patch, at one speed, with similar headings."""
    generator, d = np.random.default_rng(seed), AlphaInteraction().d
    q = hexagonal_spiral(_N, d) + generator.uniform(-_SHAKEN * d, _SHAKEN * d, (_N, 2))
    heading = _HEADING + generator.uniform(-_TURNED, _TURNED, _N)
    return q, _SPEED * np.stack([np.cos(heading), np.sin(heading)], axis=1)


def _follower(q: FloatArray, p: FloatArray) -> LinearTarget:
    """Return a γ-agent that starts at the flock's centre with its velocity."""
    place, velocity = q.mean(axis=0).tolist(), p.mean(axis=0).tolist()
    return LinearTarget((place[0], place[1]), (velocity[0], velocity[1]))


def _net(q: FloatArray) -> tuple[tuple[int, int], ...]:
    """Return the links within the common range at the start."""
    return tuple((i, j) for i, j in links(q, RANGE).tolist())


def _informing(some: int, n: int) -> Gains:
    """Return the default gains, with those to the γ-agent for the first agents only."""
    gains, felt = Gains(), np.arange(n) < some
    return replace(gains, c1_gamma=tuple(gains.c1_gamma * felt), c2_gamma=tuple(gains.c2_gamma * felt))


ENTRIES: tuple[LawEntry, ...] = (
    LawEntry(
        "Algorithm 1",
        lambda q, p: Algorithm1(),
        "os-1",
        "the energy falls; if the flock stays together, velocities agree, and no two agents collide below the barrier",
        "vacuous",
    ),
    LawEntry(
        "Algorithm 2",
        lambda q, p: Algorithm2(target=_follower(q, p)),
        "os-3",
        "the flock stays within a bounded distance of the γ-agent, velocities agree, few pairs can collide",
    ),
    LawEntry(
        "Few informed",
        lambda q, p: Algorithm2(gains=_informing(3, len(q)), target=_follower(q, p)),
        "su-informed",
        "three of ten feel the γ-agent: they adopt its velocity, and so do agents that stay linked to them",
    ),
    LawEntry(
        "Dead zone",
        lambda q, p: DeadZoneFlocking(),
        "dead-zone-1-corrected",
        "the saturated energy falls and distances stay above an explicit bound; that velocities agree within each "
        "component is measured, not proved",
    ),
    LawEntry(
        "Cucker and Smale",
        lambda q, p: CuckerSmale(RationalWeight(strength=0.5, decay=0.25, length=RANGE)),
        "cucker-smale",
        "every agent aligns with all others, with a weight that falls slowly (β < ½): a flock from any start",
    ),
    LawEntry(
        "Ha and Liu",
        lambda q, p: CuckerSmale(RationalWeight(strength=4.0, decay=1.0, length=RANGE), mean=True),
        "ha-liu",
        "the weight falls fast (β > ½): a flock if the spread of velocities is below an integral of it",
    ),
    LawEntry(
        "Tanner, fixed net",
        lambda q, p: FixedNetFlocking(_net(q), LogPotential(_STRENGTH, AlphaInteraction().d), k2=_CONSENSUS),
        "tanner-fixed",
        "the links of the start pull at all times: velocities agree, and no two linked agents collide",
    ),
    LawEntry(
        "Tanner, switching",
        lambda q, p: ProximityFlocking(LogPotential(_STRENGTH, AlphaInteraction().d), r=RANGE, k2=_CONSENSUS),
        "tanner-switching",
        "only agents within r pull: the same holds if the net stays connected",
    ),
    LawEntry(
        "Links kept",
        lambda q, p: LinkKeeping(_net(q), r=RANGE),
        "links-kept",
        "a tension without bound at r: no link reaches it, so that a connected net stays connected; nothing keeps "
        "agents apart, and here they meet",
    ),
    LawEntry(
        "Averaged headings",
        lambda q, p: HeadingAveraging(range=RANGE, speed=_SPEED, dt=0.1),
        "jlm-headings",
        "headings agree if the nets are jointly connected over one bounded window of time after the other",
        "verified",
    ),
)


def compare(names: Iterable[str] | None = None, *, seed: int = 0) -> tuple[Outcome, ...]:
    """Run the common start under each law, and check its theorem."""
    known, start = {entry.name: entry for entry in ENTRIES}, one_start(seed)
    chosen = [ensure_known("law", name, tuple(known)) for name in (known if names is None else names)]
    return tuple(_outcome(known[name], *start) for name in chosen)


def _outcome(entry: LawEntry, q: FloatArray, p: FloatArray) -> Outcome:
    law = entry.law(q, p)
    how: dict[str, Any] = {"t_eval": np.linspace(0.0, UNTIL, _INSTANTS), "rtol": _RTOL}
    run = simulate(law, q, p, (0.0, UNTIL), **({} if isinstance(law, DiscreteLaw) else how))
    return Outcome(entry, run, verify(entry.theorem, run, subject=f"{entry.name}, one start"))
