"""Common start under many laws, with the theorem of each law and the outcome.

A further law is one more `LawEntry` in the `ONE_START` of a source's scenarios: its name, how it is built for this
start, the theorem that speaks of its runs, and what that promises in a few words.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from flockana.base.module_discovery import source_modules
from flockana.base.value_checks import FloatArray, ensure_known
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.environment import LinearTarget
from flockana.interactions import AlphaInteraction
from flockana.lattice.builders import hexagonal_spiral
from flockana.laws import Algorithm1, Algorithm2, DiscreteLaw, Law
from flockana.measures.metrics import diameter
from flockana.measures.nets import components, links
from flockana.theorems import Status, Verdict, verify

_N, SPEED, _HEADING = 10, 1.0, np.pi / 4.0
_SHAKEN, _TURNED = 0.1, 0.6  # of d, and radians: what chance adds to places and headings
UNTIL = 60.0
RANGE = AlphaInteraction().r
_INSTANTS = 201
_RTOL = 1e-10  # so that what the integration leaves of velocities that agree lies far below what counts as 0


@dataclass(frozen=True)
class LawEntry:
    """Law to be run from a common start, with a theorem about its runs and the expected status."""

    name: str  # of the law, for people
    law: Callable[[FloatArray, FloatArray], Law | DiscreteLaw]  # ``law(q0, p0)`` builds it
    theorem: str  # id of a theorem about its runs
    promise: str  # what the theorem promises, in our words and few of them
    expected: Status | None = None  # status that the theorem has from this start; None where nothing is expected


@dataclass(frozen=True)
class Outcome:
    """Outcome of the common start under one law: the run, and the verdict of the law's theorem."""

    entry: LawEntry  # the law and its theorem
    run: Trajectory
    verdict: Verdict  # of the theorem on the run

    @property
    def velocity_share(self) -> float:
        """Return the ratio of the final to the initial greatest velocity difference."""
        return diameter(self.run.p[-1]) / diameter(self.run.p[0])

    @property
    def position_share(self) -> float:
        """Return the ratio of the final to the initial greatest distance of two agents."""
        return diameter(self.run.q[-1]) / diameter(self.run.q[0])

    @property
    def groups(self) -> int:
        """Number of groups at the end of the run: components of the net of links within a common range."""
        return int(components(self.run.n, links(self.run.q[-1], RANGE)).max()) + 1

    @property
    def least_distance(self) -> float:
        """Return the least distance of two agents at the samples."""
        return float(self.run.metric("min_distance").min())


def one_start(seed: int = 0) -> tuple[FloatArray, FloatArray]:
    """Return (q0, p0) of ten agents near a lattice patch, at one speed, with similar headings."""
    generator, d = np.random.default_rng(seed), AlphaInteraction().d
    q = hexagonal_spiral(_N, d) + generator.uniform(-_SHAKEN * d, _SHAKEN * d, (_N, 2))
    heading = _HEADING + generator.uniform(-_TURNED, _TURNED, _N)
    return q, SPEED * np.stack([np.cos(heading), np.sin(heading)], axis=1)


def follower_of(q: FloatArray, p: FloatArray) -> LinearTarget:
    """Return a γ-agent that starts at the flock's centre of mass with the centre's velocity."""
    position, velocity = q.mean(axis=0).tolist(), p.mean(axis=0).tolist()
    return LinearTarget((position[0], position[1]), (velocity[0], velocity[1]))


def net_of(q: FloatArray) -> tuple[tuple[int, int], ...]:
    """Return the links (i, j) of agents within a common range at the start."""
    return tuple((i, j) for i, j in links(q, RANGE).tolist())


_OWN = (
    LawEntry(
        "Algorithm 1",
        lambda q, p: Algorithm1(),
        "os-1",
        "the energy falls; if the flock stays together, velocities agree, and no two agents collide below the barrier",
        "vacuous",
    ),
    LawEntry(
        "Algorithm 2",
        lambda q, p: Algorithm2(target=follower_of(q, p)),
        "os-3",
        "the flock stays within a bounded distance of the γ-agent, velocities agree, few pairs can collide",
    ),
)


@cache
def entries() -> tuple[LawEntry, ...]:
    """Return the laws that can be compared from one start: Algorithms 1 and 2, and those that sources list."""
    return _OWN + tuple(entry for module in source_modules("scenarios") for entry in getattr(module, "ONE_START", ()))


def compare(names: Iterable[str] | None = None, *, seed: int = 0) -> tuple[Outcome, ...]:
    """Run the common start under each law, and check its theorem."""
    catalogue, start = {entry.name: entry for entry in entries()}, one_start(seed)
    laws = [ensure_known("law", name, tuple(catalogue)) for name in (catalogue if names is None else names)]
    return tuple(_outcome(catalogue[name], *start) for name in laws)


def _outcome(entry: LawEntry, q: FloatArray, p: FloatArray) -> Outcome:
    law = entry.law(q, p)
    run_options: dict[str, Any] = {"t_eval": np.linspace(0.0, UNTIL, _INSTANTS), "rtol": _RTOL}
    run = simulate(law, q, p, (0.0, UNTIL), **({} if law.is_map else run_options))
    return Outcome(entry, run, verify(entry.theorem, run, subject=f"{entry.name}, one start"))
