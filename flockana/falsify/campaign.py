"""Search for a run that refutes a theorem's claim, in the neighbourhood of a scenario."""

import logging
from collections.abc import Iterable, Mapping
from concurrent.futures import Executor
from dataclasses import replace
from types import NoneType
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.base.integrity_seals import sealed
from flockana.base.progress import progress_bar
from flockana.base.value_checks import FloatArray, TimeSpan, ensure_count, ensure_kind, ensure_seed
from flockana.falsify.bounded_space import STATE, search_space
from flockana.falsify.cma_search import Search
from flockana.falsify.falsification import Ending, Falsification
from flockana.falsify.point_evaluation import Evaluation, Problem, units
from flockana.recorded.law_parameters import law_parameter
from flockana.scenarios import Flock, Scenario
from flockana.scenarios.flock import as_scenario, chosen
from flockana.theorems import Theorem, Tolerances
from flockana.theorems import theorem as named_theorem
from flockana.theorems.theorem import Lead

_LOG = logging.getLogger("flockana")


def falsify(
    theorem: str | Theorem,
    scenario: str | Scenario | Flock | None = None,
    *,
    law: Any = None,
    q0: Any = None,
    p0: Any = None,
    t_span: TimeSpan | None = None,
    budget: int,
    seed: int = 0,
    claim: str | None = None,
    vary: Iterable[str] = STATE,
    region: Any = None,
    speed: float | None = None,
    parameters: Mapping[str, tuple[float, float]] | None = None,
    surrogate: Lead | None = None,
    tolerances: Tolerances | None = None,
    deepen: bool = False,
    executor: Executor | None = None,
    progress: bool = False,
) -> Falsification:
    """Search initial states and law parameters for a run that refutes a claim, by minimising its margin.

    CMA-ES (restarted with growing populations) in a box about the scenario's start. Where hypotheses are not met the
    search is led back by how far they are missed; a run that fails counts as worse than any other. That nothing is
    found proves nothing. The same arguments give the same result, whoever computes it.

    Parameters
    ----------
    theorem : str or Theorem
        A theorem about runs, of the catalogue or your own.
    scenario : str, Scenario or Flock, optional
        Where the search begins: a name of the catalogue or a flock, built with `seed`, or a scenario.
    law, q0, p0, t_span : optional
        Instead of a scenario: the parts of a `Flock`.
    budget : int
        Runs to make at most, the scenario's own start among them.
    claim : str, optional
        Which claim to break. By default whichever comes nearest, each margin measured by its size at the scenario's
        own start.
    vary : iterable of str
        What of the state is varied: ``"q"``, ``"p"``, both, or none.
    region : float or (low, high), optional
        Of the positions: a distance per axis that every agent may be moved by, or two corners of a box for all. By
        default the box of the scenario's flock, widened by a tenth.
    speed : float, optional
        Bound of each component of a velocity; by default twice the largest at the scenario's start, 1 at rest.
    parameters : mapping of str to (float, float), optional
        Bounds for numbers of the law, by dotted name, such as ``{"gains.c1_gamma": (0.1, 10.0)}``.
    surrogate : callable, optional
        ``surrogate(trajectory, claim) -> float`` in [0, 1], lower the nearer to breaking: it orders runs of equal
        margins, which counts often have. Some claims have one of ours. None is asked where unmet hypotheses lead back.
    deepen : bool
        Use up the budget after a counterexample is found, for a worse one.
    executor : concurrent.futures.Executor, optional
        Evaluates the runs of a generation side by side; a theorem or a surrogate of your own must be importable there.
    progress : bool
        Show a bar with rate, time left and the worst so far, on a terminal.

    Returns
    -------
    Falsification
        On Ctrl-C too, with what was found so far.

    Raises
    ------
    ArgumentError
        On bad input, before anything is searched.

    Examples
    --------
    c* excludes a collision, and twice c* does not:

    >>> safe = falsify("collision-energy", "head-on", claim="below", budget=30)
    >>> safe.found, safe.evaluations, safe.ended
    (False, 30, 'budget')
    >>> falsify("collision-energy", "head-on", claim="twice", budget=100).found
    True
    """
    item = named_theorem(theorem) if isinstance(theorem, str) else theorem
    budget, seed = ensure_count("budget", budget), ensure_seed(seed)
    _ensure_kinds(item, tolerances, surrogate)
    begin = as_scenario(chosen(scenario, law=law, q0=q0, p0=p0, t_span=t_span), seed)
    space = search_space(begin, vary=vary, region=region, speed=speed, parameters=parameters)
    problem = Problem(space, theorem, tolerances or Tolerances(), claim, surrogate)
    run, verdict = problem.judged(begin)  # with the scenario's own start, which gives the margins their units
    if verdict is not None:
        if claim not in (None, *(names := [entry.name for entry in verdict.claims])):
            raise UnknownNameError("claim", claim, names)
        problem = replace(problem, scales=units(verdict))
        if item.law is not None and not parameters and [h.status for h in verdict.hypotheses] == ["unmet"]:
            missed = verdict.hypotheses[0]  # about the law alone, which a search of starts does not change
            raise ArgumentError(
                f"{item.id} on {begin.name}: {missed.name} ({missed.detail}), which no start meets; expected a theorem "
                "about this law: applicable(law, q0, p0) lists them"
            )
    record = _Record()
    record.add(None, problem.graded(run, verdict))
    if record.unmet:
        texts = "; ".join(record.unmet.values())
        _LOG.warning("%s on %s: no claim at its own start, which does not meet: %s", item.id, begin.name, texts)
    search = Search(space.start, seed)
    ending: Ending = "budget"
    with progress_bar(budget, enabled=progress, steady=True) as advance:
        try:
            while len(record.rows) < budget and (deepen or record.best.status != "refuted"):
                points = search.ask()
                batch, grades = points[: budget - len(record.rows)], []
                for point, evaluation in zip(batch, (executor.map if executor else map)(problem, batch), strict=True):
                    grades.append(evaluation.grade)
                    record.add(point, evaluation)
                    advance(
                        len(record.rows), f"{item.id} on {begin.name}, worst: {record.best.claim} {record.best.status}"
                    )
                    if evaluation.status == "refuted" and not deepen:
                        break
                if len(grades) == len(points):
                    search.tell(grades)
        except KeyboardInterrupt:
            ending = "interrupted"
    if record.best.status == "refuted" and not deepen:
        ending = "found"
    case, best_case = begin if record.point is None else space.case(record.point), record.best
    name = best_case.claim or claim or ""
    margins, statuses = record.columns(name)
    result = Falsification(
        theorem=item.id,
        claim=name,
        case=case,
        parameters={x: float(law_parameter(case.law, x)) for x in space.parameters},
        verdict=best_case.verdict,
        margins=margins,
        statuses=statuses,
        seed=seed,
        budget=budget,
        restarts=search.restarts,
        ended=ending,
        message=record.message,
        unmet=tuple(record.unmet or {}),
    )
    return sealed(result)


def _ensure_kinds(theorem: Any, tolerances: Any, surrogate: Any) -> None:
    ensure_kind("theorem", theorem, Theorem, "a name of the catalogue or a Theorem")
    if theorem.kind != "trajectory":
        raise ArgumentError(f"{theorem.id} is not about a run: expected a theorem about motion, such as os-1")
    ensure_kind("tolerances", tolerances, (Tolerances, NoneType), "flockana.Tolerances(...)")
    if surrogate is not None and not callable(surrogate):
        raise ArgumentError(f"surrogate = {surrogate!r}: expected a function of a trajectory and a claim")


class _Record:
    """Statuses and margins of a theorem's claims over all runs of a search, and the worst case so far."""

    def __init__(self) -> None:
        self.rows: list[dict[str, tuple[str, float]]] = []
        self.best, self.message = Evaluation(np.inf), ""
        self.point: FloatArray | None = None  # the scenario's own start
        self.unmet: dict[str, str] | None = None  # hypotheses that are unmet in all verdicts, and unmet in words

    def add(self, point: FloatArray | None, evaluation: Evaluation) -> None:
        claims = () if evaluation.verdict is None else evaluation.verdict.claims
        judged = {c.name: np.nan if c.status == "vacuous" or c.margin is None else float(c.margin) for c in claims}
        self.rows.append({c.name: (c.status, judged[c.name]) for c in claims})
        self.message = evaluation.message or self.message
        if evaluation.verdict is not None:
            unmet = {h.name: h for h in evaluation.verdict.hypotheses if h.status == "unmet"}
            if self.unmet is None:
                self.unmet = {name: f"{name} ({h.detail})" if h.detail else name for name, h in unmet.items()}
            self.unmet = {name: text for name, text in self.unmet.items() if name in unmet}
        if evaluation.grade < self.best.grade:
            self.best, self.point = evaluation, point

    def columns(self, claim: str) -> tuple[dict[str, FloatArray], dict[str, tuple[str, ...]]]:
        """Return margins and statuses by claim, NaN and "failed" for failed runs."""
        names = list(dict.fromkeys(name for row in self.rows for name in row)) or [claim]
        defaults = [("vacuous" if row else "failed", np.nan) for row in self.rows]
        table = {name: [row.get(name, none) for row, none in zip(self.rows, defaults, strict=True)] for name in names}
        margins = {name: np.array([margin for _, margin in column]) for name, column in table.items()}
        return margins, {name: tuple(status for status, _ in column) for name, column in table.items()}
