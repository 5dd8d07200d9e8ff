"""A user's own flock: a law, a start and a time span, accepted wherever a scenario of the catalogue is."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import draw_start, ensure_seed, ensure_state, ensure_time_span
from flockana.dynamics.predicates import ensure_run
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.first_order_law import ensure_any_law, start_velocities
from flockana.laws.law_with_start import WithStart
from flockana.recorded.law_parameters import with_parameter
from flockana.scenarios.scenario import Scenario
from flockana.scenarios.scenario import scenario as named_scenario
from flockana.theorems import Theorem, Tolerances, verify
from flockana.theorems.evidence import NotEvidence
from flockana.theorems.run_verdicts import RunEvidence, theorems_about
from flockana.theorems.verdicts import Verdicts
from flockana.theorems.verification import T_SPAN, ensure_tolerances

_SOURCE = "a flock of the user's own"


@dataclass(frozen=True, eq=False)
class Flock(NotEvidence, WithStart):
    """A law with a start and a time span.

    Parameters
    ----------
    q0, p0 : array_like, shape (n, m), or callable
        Positions and velocities, or a function of a seed that returns them; by default at rest, or of a `VelocityLaw`
        its velocities. A `q0` that returns two arrays gives both.
    options : mapping
        Further arguments of `simulate`, such as ``{"rtol": 1e-6}``.

    Examples
    --------
    >>> import numpy as np
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> flock = Flock(Algorithm1(), lambda seed: 6.0 * np.random.default_rng(seed).normal(size=(5, 2)), t_span=(0, 1))
    >>> flock.scenario(seed=1).q0.shape, flock.run(seed=1).status
    ((5, 2), 'complete')
    """

    advice = "trajectory is a Flock: expected flock.run(seed), or flock.verify(seed)"

    law: Any
    q0: Any
    p0: Any = None
    t_span: tuple[float, float] = T_SPAN
    options: Mapping[str, Any] = field(default_factory=dict)
    name: str = "own flock"

    def __post_init__(self) -> None:
        ensure_any_law(self.law)
        object.__setattr__(self, "t_span", ensure_time_span(self.t_span))
        if not (self.drawn or self.p0 is None):
            ensure_state(self.q0, self.p0)

    def __repr__(self) -> str:
        begin, end = self.t_span
        agents = "a drawn start" if self.drawn else f"{len(self.q0)} agents"
        return f"<Flock {self.name!r}: {agents}, {self.law.title}, t = {begin:g} to {end:g}>"

    @property
    def drawn(self) -> bool:
        """Whether the start depends on a seed."""
        return callable(self.q0) or callable(self.p0)

    def start(self, seed: int = 0) -> tuple[Any, Any]:
        """Return the flock's initial positions and velocities, each of shape (n, m)."""
        law, t0 = self.law, self.t_span[0]
        return draw_start(self.q0, self.p0, ensure_seed(seed), lambda q: start_velocities(law, t0, q, None))

    def law_and_start(self, seed: int) -> tuple[Any, Any, Any, tuple[float, float]]:  # noqa: D102
        return self.law, *self.start(seed), self.t_span

    def scenario(self, seed: int = 0, **parameters: Any) -> Scenario:
        """Return the flock as a scenario.

        Parameters
        ----------
        **parameters
            Numbers of the law by dotted name, such as ``{"gains.c1_gamma": 2.0}``.
        """
        law, (q, p) = self.law, self.start(seed)
        for path, value in parameters.items():
            law = with_parameter(law, path, value)
        return Scenario(self.name, self.name, _SOURCE, law, q, p, self.t_span, seed, options=self.options)

    def run(self, seed: int = 0, *, progress: bool = False) -> Trajectory:
        """Simulate the flock."""
        return self.scenario(seed).run(progress=progress)

    def theorems(self, seed: int = 0) -> tuple[str, ...]:
        """Return the ids of the theorems about the flock's law."""
        return theorems_about(self.law, *self.start(seed), self.t_span[0])

    def verify(
        self,
        seed: int = 0,
        *,
        theorems: Sequence[str | Theorem] | None = None,
        tolerances: Tolerances | None = None,
        progress: bool = False,
    ) -> Verdicts:
        """Simulate the flock and check theorems about its law.

        Parameters
        ----------
        theorems : sequence of str or Theorem, optional
            What is checked, own claims too; by default every theorem that is about the law.
        """
        run = self.run(seed, progress=progress)
        if theorems is not None:
            return verify([*theorems], run, tolerances=tolerances, subject=self.name)
        return RunEvidence(run).judge_all(ensure_tolerances(tolerances), self.name, progress=progress)


def chosen(scenario: Any = None, *, law: Any = None, q0: Any = None, p0: Any = None, t_span: Any = None) -> Any:
    """Return the given scenario, or a flock from a law and a start."""
    parts = {key: v for key, v in {"law": law, "q0": q0, "p0": p0, "t_span": t_span}.items() if v is not None}
    if scenario is not None and parts:
        raise ArgumentError(f"a scenario and {', '.join(parts)}: expected the one or the other")
    if scenario is None and not {"law", "q0"} <= parts.keys():
        raise ArgumentError(f"got {', '.join(parts) or 'no flock'}: expected a scenario, or law=..., q0=...")
    return Flock(**parts) if scenario is None else scenario


def as_scenario(given: Any, seed: int = 0) -> Scenario:
    """Return a scenario from a name, a flock or a scenario."""
    if isinstance(given, str):
        return named_scenario(given, seed)
    if isinstance(given, Flock):
        return given.scenario(seed)
    if not isinstance(given, Scenario):
        raise ArgumentError(f"scenario = {given!r}: expected a name of the catalogue, a Scenario or a Flock")
    return given


def run_of(given: Any = None, *, seed: int = 0, **parts: Any) -> Trajectory:
    """Return a given run, or simulate a scenario, its name, a flock, or the parts of a flock."""
    item = chosen(given, **parts)
    return as_scenario(item, seed).run() if isinstance(item, str | Flock | Scenario) else ensure_run(item)
