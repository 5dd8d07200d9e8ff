"""Cases of the explorer's page: a start with changed parameters and moved agents, as law, flock and Python code."""

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Self

from flockana.base import value_checks
from flockana.base.errors import ArgumentError
from flockana.dynamics.simulate import simulate
from flockana.explore.law_parameters import changed, expression, tree_of
from flockana.explore.page_starts import Start, from_file, from_law, from_scenario
from flockana.laws.first_order_law import first_order, start_velocities

KINDS = ("scenario", "law", "file")
_KEYS = ("kind", "name", "seed", "n", "m", "duration", "changes", "moved")


@dataclass(frozen=True)
class Case:
    """Case of the explorer's page: a start with changed parameters and moved agents."""

    kind: str  # what it starts from
    name: str  # of the scenario or law; a file's path
    seed: int = 0
    n: int = 50  # n, m: Agents and dimensions, of a law
    m: int = 2
    duration: float | None = None  # time to integrate over, if it is not the start's own
    # numbers of the law by path (`flockana.explore.law_parameters`)
    changes: Mapping[str, Any] = field(default_factory=dict)
    moved: Mapping[int, Any] = field(default_factory=dict)  # places of agents by number

    def __post_init__(self) -> None:
        value_checks.ensure_choice("kind", self.kind, KINDS)
        value_checks.ensure_kind("name", self.name, str, "a text")
        value_checks.ensure_seed(self.seed)  # n and m are checked where a law gets its flock
        if self.duration is not None:
            value_checks.ensure_positive("duration", self.duration)
        value_checks.ensure_kind("changes", self.changes, Mapping, "values by name")

    @classmethod
    def of(cls, asked: Any) -> Self:
        """Return the explorer's case that a message of the page describes."""
        if not isinstance(asked, Mapping) or set(asked) - set(_KEYS) or not {"kind", "name"} <= set(asked):
            raise ArgumentError(f"a case has kind, name and some of {', '.join(_KEYS[2:])}: got {str(asked)[:80]}")
        moves = asked.get("moved") or {}
        if not isinstance(moves, Mapping) or not all(str(key).isdecimal() for key in moves):
            raise ArgumentError(f"moved = {str(moves)[:80]}: expected places by the agents' numbers")
        return cls(**{**asked, "changes": asked.get("changes") or {}, "moved": {int(k): moves[k] for k in moves}})

    def start(self) -> Start:
        """Return the law, flock and time span of an explorer's case without the user's changes."""
        if self.kind == "file":
            return from_file(self.name)
        if self.kind == "law":
            return from_law(self.name, n=self.n, m=self.m, seed=self.seed)
        return from_scenario(self.name, seed=self.seed)

    @property
    def parts(self) -> Start:
        """Return law, flock, time span and Python code of the case with its changes; raise if refused."""
        start = self.start()
        tree, lines = tree_of(start.law, self.changes), list(start.lines)
        law, q0 = changed(start.law, tree), start.q0.copy()
        if tree:
            lines.append(f"law = {expression('law', start.law, tree)}")
        for agent, position in sorted(self.moved.items()):
            if agent >= len(q0):
                raise ArgumentError(f"moved agent {agent}: expected one of 0 … {len(q0) - 1}")
            q0[agent] = value_checks.ensure_vector(f"agent {agent}", position, q0.shape[1])
            lines.append(f"q0[{agent}] = {tuple(q0[agent].tolist())}")
        span, options = start.t_span, dict(start.options)
        if self.duration is not None:
            span = value_checks.ensure_time_span((span[0], span[0] + float(self.duration)))
            options.pop("t_eval", None)  # its times are those of another span
            lines += [f"t_span = {span}", 'options.pop("t_eval", None)']
        parts: dict[str, Any] = {"law": law, "q0": q0, "t_span": span, "options": options, "lines": tuple(lines)}
        if first_order(law) is not None:  # its velocities are those of the places
            parts |= {"p0": start_velocities(law, span[0], q0, None), "lines": (*lines, "p0 = None")}
        if self.changes or self.moved or self.duration:
            parts |= {"recorded": None, "source": None}
        return replace(start, **parts)


def program(parts: Start) -> str:
    """Return Python code that simulates and checks the case of a page.

    Examples
    --------
    >>> print(program(Case("scenario", "hexagon", duration=2.0).parts))
    import flockana as fl
    <BLANKLINE>
    item = fl.scenario('hexagon', seed=0)
    ...
    run = fl.simulate(law, q0, p0, t_span, **options)
    ...
    """
    text = "\n".join(parts.lines)
    imports = ["from dataclasses import replace"] if "replace(" in text else []
    imports += ["import numpy as np"] if "np." in text else []
    tols = f", tolerances={parts.tolerances_text}" if parts.tolerances_text else ""
    run = ["run = saved"] if parts.recorded is not None else ["run = fl.simulate(law, q0, p0, t_span, **options)"]
    verdicts = [f"for name in {parts.theorems}:", f"    print(fl.verify(name, run{tols}))"] if parts.theorems else []
    verdicts += ["print(*item.reported(run))"] if parts.source is not None else []
    head = [*imports[:1], *([""] if imports else []), *imports[1:], "import flockana as fl", ""]
    return "\n".join([*head, text, *run, *verdicts]) + "\n"


def run_file(asked: Any) -> bytes:
    """Return the run of a case as netCDF."""
    parts = Case.of(asked).parts
    run = parts.recorded or simulate(parts.law, parts.q0, parts.p0, parts.t_span, **parts.options)
    with tempfile.TemporaryDirectory(prefix="flockana-") as folder:
        return run.save(Path(folder) / "run.nc").read_bytes()
