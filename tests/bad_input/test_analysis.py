import inspect

import numpy as np
import pytest

import flockana as fl
from flockana import Scenario, find_equilibrium
from flockana.scenarios.scenario import catalogue
from tests.bad_input.values import (
    COUNTS,
    LAW,
    NAMES,
    NAN,
    NUMBERS,
    POINTS,
    POSITIVE,
    RUN,
    SIZES,
    P,
    Q,
    refused,
    rows,
    without,
)

OTHERS = {"none": None, "a text": "x", "a number": 3}
OF_KIND = {bool: without(NUMBERS, "a truth value", "numpy's truth value"), int: COUNTS, float: NUMBERS}
LINEAR = fl.linearise(LAW, find_equilibrium(LAW, Q))


def ensemble(scenario="three-agents-1d", seeds=(0,), **options):
    return fl.ensemble(scenario, seeds, **({"theorems": ["energy"], "jobs": 1} | options))


def falsify(theorem="energy", scenario="three-agents-1d", **options):
    return fl.falsify(theorem, scenario, **({"budget": 1} | options))


def made(**change):
    return Scenario(
        **({"name": "x", "title": "x", "source": "x", "law": LAW, "q0": Q, "p0": P, "t_span": (0, 1)} | change)
    )


def options_of(build):
    """The options of a scenario whose defaults tell their kind."""
    options = {key: one.default for key, one in inspect.signature(build).parameters.items() if key != "seed"}
    return [(key, default) for key, default in options.items() if type(default) in OF_KIND]


def cases():
    yield "find_equilibrium q0", POINTS, lambda v: find_equilibrium(LAW, v)
    yield "find_equilibrium law", OTHERS, lambda v: find_equilibrium(v, Q)
    yield "find_equilibrium max_iter", COUNTS, lambda v: find_equilibrium(LAW, Q, max_iter=v)
    yield "find_equilibrium method", {"unknown": "x", "a number": 3}, lambda v: find_equilibrium(LAW, Q, method=v)
    yield "linearise equilibrium", POINTS, lambda v: fl.linearise(LAW, v)
    yield "linearise p", without(POINTS, "none"), lambda v: fl.linearise(LAW, Q, v)
    yield "linearise law", OTHERS, lambda v: fl.linearise(v, Q)
    yield "slowest_modes", OTHERS, lambda v: fl.slowest_modes(v, 2)
    yield "slowest_modes count", SIZES, lambda v: fl.slowest_modes(LINEAR, v)
    yield "theorem", without(NAMES, "a list"), fl.theorem
    yield "verify theorem", without(NAMES, "a list", "none"), lambda v: fl.verify(v, RUN)
    yield "verify run", {"a text": "x", "a number": 3, "a list": [1]}, lambda v: fl.verify("energy", v)
    yield "verify tolerances", {"a mapping": {}, "a number": 3}, lambda v: fl.verify("energy", RUN, tolerances=v)
    yield "verify q", POINTS, lambda v: fl.verify("os-5", q=v, d=7.0, r=8.4)
    yield "verify d", POSITIVE, lambda v: fl.verify("os-5", q=Q, d=v, r=8.4)
    yield "verify r", POSITIVE, lambda v: fl.verify("os-5", q=Q, d=7.0, r=v)
    yield "scenario", without(NAMES, "a list"), fl.scenario
    seeds = {"a text": "x", "negative": -1, "a fraction": 1.5, "none": None, "a truth value": True, "a list": [1]}
    yield "scenario seed", seeds, lambda v: fl.scenario("paper-flocking", v)
    yield "scenario option", {"unknown": {"x": 1}}, lambda v: fl.scenario("phase", 0, **v)
    for name, build in catalogue().items():
        for option, default in options_of(build):
            yield f"{name} {option}", OF_KIND[type(default)], lambda v, n=name, o=option: fl.scenario(n, **{o: v})
            if option in ("n", "m", "informed"):
                yield f"{name} {option} size", SIZES, lambda v, n=name, o=option: fl.scenario(n, **{o: v})
    yield "Scenario law", OTHERS | {"a class": fl.Algorithm1}, lambda v: made(law=v)
    yield "Scenario name", without(OTHERS, "a text") | {"nothing": ""}, lambda v: made(name=v)
    yield "Scenario q0", POINTS | {"more agents": Q + Q}, lambda v: made(q0=v)
    yield "Scenario p0", POINTS | {"more agents": Q + Q}, lambda v: made(p0=v)
    yield "Scenario t_span", OTHERS | {"backwards": (1.0, 0.0), "nan": (0.0, NAN)}, lambda v: made(t_span=v)
    yield "Scenario seed", without(COUNTS, "zero"), lambda v: made(seed=v)
    statuses = OTHERS | {"no status": {"energy": "fine"}, "none of them": {"energy": None}}
    yield "Scenario expected", statuses, lambda v: made(expected=v)
    yield "Scenario shipped", statuses, lambda v: made(shipped=v)
    unknown = {"no theorem": {"no-such": "refuted"}, "no theorem's claim": {"no-such:i": "refuted"}}
    yield "Scenario expected theorem", unknown, lambda v: made(expected=v).run()
    yield "Scenario shipped theorem", unknown, lambda v: made(seed=1, shipped=v).run()
    yield "Scenario instants", {"outside": (2.0,)}, lambda v: made(instants=v)
    several = {"none": None, "a text": "ab", "negative": [-1], "fractions": [0.5], "none of them": [], "twice": [1, 1]}
    yield "ensemble seeds", several | {"a number": 3, "truth values": [True]}, lambda v: ensemble(seeds=v)
    yield "ensemble scenario", OTHERS, lambda v: ensemble(v)
    yield "ensemble theorems", {"unknown": ["x"], "a number": 3}, lambda v: ensemble(theorems=v)
    stores = {"a number": 3, "null byte": "a\0b", "a folder": "/", "bytes": b"x", "a device": "/dev/null"}
    yield "ensemble store", stores, lambda v: ensemble(store=v)
    options = {"a list": [1], "unknown": {"x": 1}, "a text": "x", "nan": {"n": NAN}}
    yield "ensemble parameters", options, lambda v: ensemble("phase", parameters=v)
    yield "falsify budget", without(COUNTS, "none"), lambda v: falsify(budget=v)
    yield "falsify theorem", without(NAMES, "a list") | {"of no run": "E8"}, falsify
    yield "falsify scenario", OTHERS, lambda v: falsify("energy", v)
    yield "falsify vary", OTHERS, lambda v: falsify(vary=v)
    yield "falsify claim", {"unknown": "x", "a number": 3}, lambda v: falsify(claim=v)
    yield "falsify region", without(NUMBERS, "none", "two numbers"), lambda v: falsify(region=v)
    yield "falsify speed", without(NUMBERS, "none"), lambda v: falsify(speed=v)
    counts = {"negative": (-1, 3), "more": (4, 3), "nan": (NAN, 3), "a text": ("a", 3), "none": (None, 3)}
    yield "clopper_pearson", counts, lambda v: fl.clopper_pearson(*v)
    yield "clopper_pearson level", POSITIVE | {"per cent": 95.0}, lambda v: fl.clopper_pearson(1, 3, level=v)
    yield "shares", {"none": None, "a number": 3}, fl.shares
    yield "cite", OTHERS, fl.cite
    runs = OTHERS | {"a list": [], "a law": LAW}
    yield "animate", runs, lambda v: fl.animate(v, "it.gif")
    yield "compose obstacles", OTHERS | {"no axis": np.array(1.0)}, lambda v: fl.compose(obstacles=v)


@pytest.mark.parametrize(("table", "call"), rows(cases()))
def test_what_is_none_is_refused(table, call):
    refused(table, call)


def test_agents_that_begin_at_one_place_are_told_in_the_result():
    start = [[0.0, 0.0], [0.0, 0.0], [7.0, 0.0]]
    found = find_equilibrium(LAW, start, strict=False)
    assert "1 pair of agents began at one place" in found.message
    assert "pair" not in find_equilibrium(LAW, Q).message
    assert fl.linearise(LAW, np.array(start), allow_residual=True).coincident_pairs == 1
    assert LINEAR.coincident_pairs == 0
    crowd = find_equilibrium(LAW, [[0.0, 0.0]] * 3, strict=False)
    assert "3 pairs of agents began at one place" in crowd.message
