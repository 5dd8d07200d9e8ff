"""A planted case: a start whose truth is known, and what a verdict on it may say."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from hypothesis import HealthCheck, settings

from flockana import simulate, verify
from flockana.base.errors import ArgumentError

TRUE = frozenset({"verified", "inconclusive", "vacuous"})
FALSE = frozenset({"refuted", "inconclusive", "vacuous"})
OPEN = frozenset({"inconclusive", "vacuous"})  # true or not: this run cannot tell
ANY = TRUE | FALSE
VERIFIED, REFUTED, VACUOUS = (frozenset({status}) for status in ("verified", "refuted", "vacuous"))


def effort(share: float) -> settings:
    """Settings of a test: a share of the profile's examples, 40 in the sample and thousands in an attack."""
    picky = [HealthCheck.filter_too_much, HealthCheck.too_slow, HealthCheck.data_too_large]
    return settings(max_examples=max(2, round(share * settings.default.max_examples)), suppress_health_check=picky)


@dataclass(frozen=True)
class Case:
    """A law, a start, a span of time and how to integrate it; its text is what a report needs to repeat it."""

    law: Any
    q0: Any
    p0: Any
    until: float
    options: Mapping[str, Any] = field(default_factory=dict)
    since: float = 0.0

    @property
    def rough(self):
        """Whether it is integrated so loosely that its samples need not fit its law."""
        return self.options.get("method") == "RK4" or self.options.get("rtol", 0.0) > 1e-6

    @cached_property
    def run(self):
        """Made once: it remembers its tighter second run for every theorem that asks."""
        return simulate(self.law, self.q0, self.p0, (self.since, self.since + self.until), **self.options)

    def __repr__(self):
        q, p = (np.asarray(state).tolist() for state in (self.q0, self.p0))
        options = "".join(f", {name}={_text(value)}" for name, value in self.options.items())
        span = (self.since, self.since + self.until)
        return f"simulate({self.law!r}, {q}, {p}, {span}{options})"


def _text(value):
    return repr(value.tolist() if isinstance(value, np.ndarray) else value)


def hold(theorem, case, truth, *, may_refuse=False):
    """Fail if a verdict says what is not so; `truth` gives the statuses that each claim may have."""
    __tracebackhide__ = True
    run = case.run
    try:
        verdict = verify(theorem, run)
    except ArgumentError as error:  # its samples do not fit its law: rightly said of a step that is far too large
        if may_refuse:
            return None
        raise AssertionError(f"{theorem} refuses a good run: {error}\n  run: {case!r}") from error
    said = {claim.name: claim for claim in verdict.claims}
    missing = [name for name, allowed in truth.items() if name not in said and "vacuous" not in allowed]
    wrong = [
        f"{theorem}:{name} says {said[name].status}, may be {'/'.join(sorted(allowed))}: {said[name].detail}"
        for name, allowed in truth.items()
        if name in said and said[name].status not in allowed
    ]
    wrong += [f"{theorem}:{name}: there is no such claim" for name in missing]
    wrong += [f"{theorem}:{claim.name}: {text}" for claim in said.values() if (text := ill_founded(claim, run))]
    assert not wrong, "\n".join([*wrong, f"  run: {case!r}", f"  status of the run: {run.status}"])
    return verdict


def ill_founded(claim, run):
    """What no decided claim by computation may do: have a margin of the other sign, or stand on a run that failed."""
    if claim.rigour != "numeric" or claim.status not in ("verified", "refuted"):
        return ""
    if run.status == "failed":
        return f"{claim.status} on a run that failed"
    if claim.margin and (claim.margin > 0.0) != (claim.status == "verified"):
        return f"{claim.status} with a margin of {claim.margin}"
    return ""
