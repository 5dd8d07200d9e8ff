"""Which claims hold of a flock by its law and start: as `verify` has it where these decide, nothing integrated."""

import time

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError
from flockana.scenarios import scenario
from flockana.theorems.applicability import COLUMNS, applicable_to, start_of
from tests.adversarial.published import published_runs

AS_VERIFIED = {"met": "verified", "unmet": "vacuous", "disproved": "refuted"}


def rows(table):
    """Rows by theorem and claim."""
    return {(row.theorem, row.claim): row for row in table.itertuples()}


@pytest.mark.slow
def test_statuses_are_those_of_verify_wherever_law_and_start_decide():
    """Of the short runs of the catalogue, whose verdicts are kept, nearly half of the claims are known beforehand."""
    decided = claims = 0
    for name in (name for name in published_runs() if len(scenario(name).q0) <= 50):
        table, said = rows(applicable_to(scenario(name))), published_runs()[name]
        for (theorem, claim), row in table.items():
            if theorem not in said or claim not in said[theorem]:
                continue
            claims += 1
            if row.status in AS_VERIFIED:
                decided += 1
                assert said[theorem][claim][0] == AS_VERIFIED[row.status], (name, theorem, claim, row)
    assert (decided >= 0.48 * claims, claims > 300) == (True, True)  # 177 of 362


def test_hypotheses_are_those_that_the_check_itself_states():
    law, q0 = fl.Algorithm1(), np.array([[0.0, 0.0], [7.0, 0.0]])
    start = start_of(law, q0, np.array([[60.0, 0.0], [-60.0, 0.0]]), 0.0)
    needs = fl.theorem("collision-energy").hypotheses(start)
    assert [(need.name, need.status) for need in needs[-2:]] == [("H(0) < c*", "unmet"), ("H(0) < 2 c*", "unmet")]
    row = rows(fl.applicable(law, q0, start.run.p[0]))["collision-energy", "below"]
    assert row.need == f"{needs[-2].name}: {needs[-2].detail}"
    ring = rows(applicable_to(scenario("finite-time-ring")))["finite-time", "some-start"]
    assert (ring.status, ring.margin) == ("unmet", -0.5)  # α = ½ < 1


def test_what_decides_is_said_with_its_number_and_what_would_meet_it():
    fast = [[0.0, 0.0], [7.0, 0.0]], [[60.0, 0.0], [-60.0, 0.0]]
    row = rows(fl.applicable(fl.Algorithm1(), *fast))["collision-energy", "below"]
    c_star = fl.Algorithm1().alpha.c_star * 30.0
    assert row.status == "unmet"
    assert row.need.startswith("H(0) < c*: H(0) = 3600, c* = 1571.5")
    assert row.margin == pytest.approx(c_star - 3600.0, rel=1e-9)
    assert "start slower" in row.remedy
    slow = rows(fl.applicable(fl.Algorithm1(), fast[0]))["os-1", "iii"]
    assert (slow.status, slow.proof, slow.remedy) == ("met", "collisions", "")
    net = rows(fl.applicable(fl.NetConsensus(np.roll(np.eye(6), 1, axis=1), velocity=1.0), np.zeros((6, 1))))
    ring = net["net-consensus", "consensus"]
    assert (ring.status, ring.remedy) == ("unmet", "raise β or lower α")
    assert ring.margin == pytest.approx(1.0 - 1.5)  # ½ cot²(π/6) = 3/2


def test_other_laws_wrapped_ones_and_motions():
    dead = fl.applicable(fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0))), [[0.0, 0.0], [7.0, 0.0]])
    assert not [name for name in dead.theorem if name.startswith("dead-zone")]
    assert set(dead[dead.theorem == "alpha-flocking"].status) == {"needs a run"}
    late = rows(fl.applicable(fl.Delayed(fl.Algorithm1(), 0.1), [[0.0, 0.0], [7.0, 0.0]]))
    assert late
    assert {row.status for row in late.values()} <= {"unmet", "needs a run"}
    told = fl.CallableTarget(lambda t: ((0.0,), (0.0,)))
    informed = fl.Algorithm2(gains=fl.Gains(c1_gamma=(2.0, 0.0), c2_gamma=(2.0, 0.0)), target=told)
    row = rows(fl.applicable(informed, [[0.0], [7.0]]))["su-informed", "energy"]
    assert row.status == "assumed"  # nobody knows what the function does later


def test_fifty_agents_are_answered_without_a_run(monkeypatch):
    monkeypatch.setattr("flockana.dynamics.simulate.simulate", lambda *_, **__: pytest.fail("a run was made"))
    rng = np.random.default_rng(0)
    law, start = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0))), rng.uniform(-20.0, 20.0, (50, 2))
    fl.applicable(law, start)  # compiles
    before = time.process_time()
    table = fl.applicable(law, start)
    assert time.process_time() - before < 1.0
    assert tuple(table.columns) == COLUMNS
    assert table.status.isin(["met", "unmet"]).sum() > 15


def test_what_is_refused():
    with pytest.raises(ArgumentError, match="law = 'law'"):
        fl.applicable("law", [[0.0]])
