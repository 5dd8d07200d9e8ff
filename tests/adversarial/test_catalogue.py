"""The catalogue's expected statuses, claim by claim, in other units, places, orders and at other tolerances."""

from dataclasses import replace

import numpy as np
import pytest

from flockana import DiscreteLaw, scenario, scenarios
from flockana.base.errors import ArgumentError
from tests.adversarial.cases import Case
from tests.adversarial.published import changes_of_run, published_runs
from tests.adversarial.transforms import UNITS, UnchangedError, delayed_start, in_units, renumbered, rigid

QUICK = {  # one change each in the sample; every change of every scenario in the attack
    "head-on": "micrometres and milliseconds",
    "head-on-collision": "kilometres and hours",
    "five-agents": "turned and moved",
    "zone-tree": "powers of two",
    "zone-path": "renumbered",
    "three-agents-1d": "powers of two",
    "notebook-algorithm2": "kilometres and hours",
    "phase": "micrometres and milliseconds",
    "paper-fragmentation": "half the tolerance",
    "dead-zone-wide-start": "kilometres and hours",
    "minimal-2d": "micrometres and milliseconds",
}


def with_tolerances_times(factor):
    def change(case, rng):
        if isinstance(case.law, DiscreteLaw):
            raise UnchangedError("a map has no tolerance")
        return replace(case, options={**case.options, "rtol": factor * case.options.get("rtol", 1e-8)})

    return change


def turn_and_move(case, rng):
    m = np.shape(case.q0)[1]
    if isinstance(case.law, DiscreteLaw):
        raise UnchangedError("a map may know its place")
    return rigid(case, np.linalg.qr(rng.normal(size=(m, m)))[0], 20.0 * rng.normal(size=m))


CHANGES = {name: (lambda case, rng, by=by: in_units(case, *by)) for name, by in UNITS.items()} | {
    "turned and moved": turn_and_move,
    "moved": lambda case, rng: rigid(case, np.eye(np.shape(case.q0)[1]), 20.0 * rng.normal(size=np.shape(case.q0)[1])),
    "renumbered": lambda case, rng: renumbered(case, rng.permutation(len(case.q0))),
    "later": lambda case, rng: delayed_start(case, 1000.0),
    "half the tolerance": with_tolerances_times(0.5),
    "twice the tolerance": with_tolerances_times(2.0),
    "a hundredth of the tolerance": with_tolerances_times(0.01),
}


@pytest.mark.parametrize("name", published_runs())
def test_short_runs_say_what_was_published(name):
    entry = scenario(name)
    found = changes_of_run(name, entry.verify(entry.run()))
    assert found == [], "if it is meant: python -m tests.adversarial.published"


EVERY = [(name, change) for name in scenarios() for change in CHANGES]
CASES = [pytest.param(*one, marks=() if QUICK.get(one[0]) == one[1] else pytest.mark.attack) for one in EVERY]


@pytest.mark.parametrize(("name", "change"), CASES)
def test_expected_statuses(name, change):
    entry = scenario(name)
    start, end = entry.t_span
    case = Case(entry.law, entry.q0, entry.p0, end - start, entry.options, start)
    try:
        other = CHANGES[change](case, np.random.default_rng(len(name)))
    except (UnchangedError, ArgumentError, TypeError) as why:
        pytest.skip(str(why))
    span, q, p = (other.since, other.since + other.until), np.asarray(other.q0), np.asarray(other.p0)
    changed = replace(entry, law=other.law, q0=q, p0=p, t_span=span, options=other.options, instants=())
    lines = [line for verdict in changed.verify(changed.run()) for line in changed.surprises(verdict)]
    assert lines == []
