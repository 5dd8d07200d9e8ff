"""What the MSN project reports, judged on planted runs whose truth is plain."""

from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm2, AlphaInteraction, Gains, StaticTarget, Tolerances, Trajectory, connectivity, simulate
from flockana.scenarios import scenario
from flockana.sources.isola_2024.scenarios.reports import DT, REPORTS, STATIC

LAW = Algorithm2(AlphaInteraction(d=15.0, r=18.0), Gains(), StaticTarget((0.0, 0.0)))


def judged(case, name, q, p=None):
    """A report's claim on places (T, n, 2) at iterations 0, 100, 200 ..."""
    check = next(report.check for report in (*REPORTS.get(case, ()), *STATIC) if report.name == name)
    q = np.asarray(q, dtype=float)
    run = Trajectory(100 * DT * np.arange(len(q)), q, 0.0 * q if p is None else p, 0.0 * q, LAW)
    return check(run, Tolerances())


def row(*x):
    return [(each, 0.0) for each in x]


@pytest.mark.parametrize(("case", "last"), [(3, 1), (4, 1)])
def test_an_agent_that_leaves_the_net_for_one_sample_has_separated(case, last):
    together, apart = row(0.0, 15.0, 30.0), row(0.0, 15.0, 34.0)
    claim = judged(case, "separated", [apart, together, apart, together])
    assert (claim.status, claim.computed) == ("verified", last)
    assert judged(case, "separated", [apart, together, together]).status == "refuted"  # the start does not count


def test_the_fast_agent_is_told_with_its_neighbours():
    q = np.array([row(0.0, 15.0, 30.0)] * 3)
    p = np.zeros_like(q)
    p[2, 1] = (9.0, 0.0)
    assert "has 2 neighbours, 15 from the γ-agent, where the flock is 0 to 30" in judged(4, "separated", q, p).detail


@pytest.mark.parametrize(
    ("width", "status"), [(30.0, "verified"), (40.0, "verified"), (61.0, "refuted"), (19.0, "refuted")]
)
def test_width_against_the_period(width, status):
    claim = judged(3, "width", [row(0.0, 999.0), row(0.0, width), row(5.0, 5.0 + width)])
    assert (claim.status, claim.computed) == (status, pytest.approx(width / 40.0))


def test_full_rank_counts_every_sample():
    assert judged(2, "full-rank", [row(0.0, 15.0)] * 3).status == "verified"
    claim = judged(2, "full-rank", [row(0.0, 15.0), row(0.0, 20.0), row(0.0, 15.0)])
    assert (claim.status, claim.computed) == ("refuted", 0.0)


def test_coincident_pairs_are_counted():
    assert judged(0, "coincide", [row(0.0, 15.0, 15.0)]).computed == 1
    assert judged(0, "coincide", [row(0.0, 15.0, 15.0)]).status == "verified"
    assert judged(0, "coincide", [row(0.0, 15.0, 15.1)]).status == "refuted"


def test_a_wide_start_is_less_connected_than_a_narrow_one():
    claim = judged(3, "less-connected", [row(0.0, 15.0), row(0.0, 15.0)])
    assert claim.status == "verified"
    assert claim.computed == (pytest.approx(0.967, abs=5e-4), 1.0)  # measured apart, by another program
    assert "1.00 in this run" in claim.detail


@pytest.mark.parametrize(("gains", "steps"), [({}, 15), ({"gains": Gains(*6 * (1.0,))}, 113)])
def test_steps_until_the_nets_of_cases_3_and_4_are_connected(gains, steps):
    """What the project says of its coefficients and 3000 iterations (misprint-14)."""
    for case in (3, 4):
        entry = scenario(f"msn-case{case}-printed")
        law = replace(entry.law, law=replace(entry.law.law, **gains))
        run = simulate(law, entry.q0, entry.p0, (0.0, (steps + 2) * law.dt))
        assert [connectivity(q, 18.0) == 1.0 for q in run.q[steps - 1 : steps + 2]] == [False, True, True]


def test_agents_of_case_2_take_as_long_to_slow_as_to_speed_up():
    entry, t = scenario("msn-case2"), np.linspace(0.0, 4.0, 1601)
    run = simulate(entry.law, entry.q0, entry.p0, (0.0, 4.0), t_eval=t)
    speed = np.linalg.norm(run.p, axis=2)
    way = np.concatenate([np.zeros((1, run.n)), np.cumsum(np.linalg.norm(np.diff(run.q, axis=0), axis=2), axis=0)])
    top, agents = speed.argmax(axis=0), np.arange(run.n)
    still = np.array([k + speed[k:, i].argmin() for i, k in enumerate(top)])
    assert abs(t[still] / t[top] - 2.0).max() == pytest.approx(0.04, abs=0.005)
    assert abs(way[still, agents] / way[top, agents] - 2.0).max() == pytest.approx(0.02, abs=0.002)
