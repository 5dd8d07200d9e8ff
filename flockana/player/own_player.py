"""Player of a user's own flock."""

from collections.abc import Sequence
from typing import Any

from flockana.base.value_checks import TimeSpan
from flockana.dynamics.trajectory import Trajectory
from flockana.player import Player
from flockana.scenarios import Flock, Scenario
from flockana.scenarios.flock import run_of
from flockana.theorems import Verdict


def player(
    trajectory: Trajectory | Flock | Scenario | str | None = None,
    *,
    law: Any = None,
    q0: Any = None,
    p0: Any = None,
    t_span: TimeSpan | None = None,
    seed: int = 0,
    height: int = 760,
    verdicts: Sequence[Verdict] = (),
) -> Player:
    """Return an interactive player of a run, or of a flock that is simulated first.

    A notebook shows it, and so does its export as HTML; ``.save(path)`` writes a page.

    Parameters
    ----------
    trajectory : Trajectory, Flock, Scenario or str, optional
        The run, or what is simulated first: a flock, a scenario or its name.
    law, q0, p0, t_span : optional
        Instead of it: the parts of a `Flock`.
    seed : int
        Seed of a start that is drawn.
    height : int
        Height of its frame in a notebook, in pixels.
    verdicts : sequence of Verdict
        Verdicts on the run: the instants that their claims point to are marked.

    Examples
    --------
    >>> from flockana import Algorithm1
    >>> player(law=Algorithm1(), q0=[[0.0, 0.0], [8.0, 0.0]], t_span=(0.0, 1.0))
    <Player of <Trajectory of 2 agents, m = 2, Algorithm1, 43 samples, t = 0 to 1, complete>>
    """
    run = run_of(trajectory, law=law, q0=q0, p0=p0, t_span=t_span, seed=seed)
    return Player(run, height, verdicts=tuple(verdicts))
