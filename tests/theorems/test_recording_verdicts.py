"""Recordings are judged within their stated accuracy: as runs of the same law are, or not at all."""

from dataclasses import replace

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError
from flockana.recorded.follows_law import following
from flockana.recorded.matching_windows import windows
from flockana.theorems.collisions import energy_within_accuracy
from flockana.theorems.observed_run import Observed
from flockana.theorems.recording_verdicts import DEFINITIONS, observed_recording
from tests.recorded.written import LAW, P0, Q0, own_run

T = np.linspace(0.0, 6.0, 151)


@pytest.fixture(scope="module")
def own():
    return own_run(T)


@pytest.fixture(scope="module")
def verdict(own):
    return fl.verify("os-3", fl.Recording(T, *own, bound=1e-6, source="own code"), law=LAW)


@pytest.mark.slow
def test_a_users_own_run_by_scipy_is_decided_as_our_run_is(own, verdict):
    run = fl.verify("os-3", fl.simulate(LAW, Q0, P0, (0.0, 6.0), t_eval=T))
    assert {c.name: c.status for c in verdict.claims} == {c.name: c.status for c in run.claims}
    assert {"i", "ii", "iii"} <= {c.name for c in verdict.claims if c.status == "verified"}
    assert verdict.hypotheses[0].name == "the samples follow the law"
    assert verdict.hypotheses[0].status == "met"
    assert "recording (own code)" in verdict.subject
    assert verdict.rigour == "numeric"


def unmet(rec, law=LAW, theorem="os-3"):
    found = fl.verify(theorem, rec, law=law)
    assert found.status == "vacuous"
    assert {c.status for c in found.claims} == {"vacuous"}
    assert found.hypotheses[0].status == "unmet"
    return found.hypotheses[0].detail


@pytest.mark.slow
def test_another_form_a_changed_sample_and_a_random_walk_are_unmet_with_the_place(own):
    other = own_run(T, pull_per_axis=True)
    assert "is off by" in unmet(fl.Recording(T, *other, bound=1e-6))
    q = own[0].copy()
    q[70, 5, 0] += 1e-3
    text = unmet(fl.Recording(T, q, own[1], bound=1e-6))
    assert "agent 5 at t = 2.8" in text or "agent 5 at t = 2.84" in text
    walk = np.cumsum(np.random.default_rng(0).normal(size=own[0].shape), axis=0)
    assert "is off by" in unmet(fl.Recording(T, walk, np.zeros(walk.shape), bound=1e-3))
    assert "is off by" in unmet(fl.Recording(T, *own, bound=1e-6), fl.Algorithm1(), "os-1")


@pytest.mark.slow
@pytest.mark.parametrize("accuracy", [{}, {"bound": 1e-6, "estimated": True}])
def test_an_accuracy_that_is_not_stated_decides_nothing(own, accuracy):
    found = fl.verify("os-3", fl.Recording(T, *own, **accuracy), law=LAW)
    assert found.hypotheses[0].status == "assumed"
    assert not {"verified", "refuted"} & {c.status for c in found.claims}


@pytest.mark.slow
def test_a_wide_bound_is_met_and_decides_what_has_room(own):
    rec = fl.Recording(T, own[0] + 0.2, own[1], bound=0.3, p_bound=0.3)
    found = fl.verify("os-3", rec, law=LAW)
    assert found.hypotheses[0].status == "met"
    assert found.claim("i").status == "verified"
    assert found.claim("ii").status == "inconclusive"


def test_errors_of_all_agents_may_add_up():
    """Each number is off by its bound, in the direction that moves the middle agent most."""
    law, q, s = fl.Algorithm1(), fl.lattice.hexagonal_patch(1, 7.0), 0.01
    middle = int(np.argmin(np.linalg.norm(q - q.mean(axis=0), axis=1)))
    t = np.array([0.0, 0.05])
    run = fl.simulate(law, q, np.zeros(q.shape), (0.0, 0.05), t_eval=t)
    a, b = (x.toarray()[2 * middle].reshape(-1, 2) for x in law.derivatives(0.0, q, np.zeros(q.shape)))
    nudges = [s * x / np.maximum(np.linalg.norm(x, axis=1, keepdims=True), 1e-300) for x in (a, b)]
    places, speeds = (np.stack([x[0] + nudge, x[1]]) for x, nudge in zip((run.q, run.p), nudges, strict=True))
    speeds[1, middle, 0] -= s
    assert following(fl.Recording(t, places, speeds, bound=1.001 * s, p_bound=1.001 * s), law).status == "met"
    speeds[1, middle, 0] -= 100.0 * s
    rec = fl.Recording(t, places, speeds, bound=1.001 * s, p_bound=1.001 * s)
    assert f"p of agent {middle} at t = 0.05 is off" in following(rec, law).detail


@pytest.mark.slow
def test_a_start_that_splines_do_not_tell_is_found_from_the_first_samples(monkeypatch):
    """A repulsion between the first two samples: the spline's velocity is far off, and all samples at once mislead."""
    t, law = 0.05 * np.arange(18), fl.Algorithm1()
    run = fl.simulate(law, [[0.0, 0.0], [7.0, 0.0], [3.0, 6.0]], np.zeros((3, 2)), (0.0, t[-1]), t_eval=t)
    noise = np.random.default_rng(0).normal(0.0, 1e-4, run.q.shape)

    def far_windows(*args):
        off = np.repeat([0.0, 60.0], 6) * np.tile([1.0, -1.0, -1.0, 1.0, 1.0, 1.0], 2)
        return [replace(part, start=part.start + off) for part in windows(*args)]

    monkeypatch.setattr("flockana.recorded.follows_law.windows", far_windows)
    assert following(fl.Recording(t, run.q + noise, sd=1e-4), law).status == "met"


@pytest.mark.slow
def test_enclosures_hold_every_flock_that_the_accuracy_allows(own):
    from flockana.recorded.follows_law import following
    from flockana.theorems.recording_verdicts import observed_recording

    rng, bound = np.random.default_rng(5), 0.01
    rec = fl.Recording(T, *own, bound=bound, p_bound=bound)
    seen = observed_recording(rec, LAW, following(rec, LAW))
    for _ in range(20):
        ways = rng.normal(size=(2, *own[0].shape))
        ways *= bound / np.linalg.norm(ways, axis=3, keepdims=True)
        q, p = own[0] + ways[0], own[1] + ways[1]
        energies = [LAW.energy(t, a, b) for t, a, b in zip(T.tolist(), q, p, strict=True)]
        for found, true in ((seen.energy, energies), (seen.radius, [fl.cohesion_radius(x) for x in q])):
            assert ((found.lo <= true) & (true <= found.hi)).all()
    assert seen.energy.half_width.max() < 0.2 * np.abs(seen.energy.mid).max()  # no excess


@pytest.mark.slow
def test_noise_gives_statistical_verdicts_and_a_foreign_law_is_unmet():
    t = np.linspace(0.0, 2.0, 101)
    rng = np.random.default_rng(1)
    (q, _), (other, _) = own_run(t), own_run(t, pull_per_axis=True)
    noise = rng.normal(0.0, 0.02, q.shape)
    found = fl.verify("os-3", fl.Recording(t, q + noise, sd=0.02), law=LAW)
    assert found.hypotheses[0].status == "met"
    assert found.claim("i").status == "verified"
    assert found.claim("i").rigour == "statistical"
    assert "times the stated noise" in unmet(fl.Recording(t, other + noise, sd=0.02))


def test_schemes_are_laws_of_recordings_too():
    law = fl.TaylorStep(LAW, 0.01)
    run = fl.simulate(law, Q0, P0, (0.0, 1.0))
    rec = fl.Recording(run.t, run.q, run.p, bound=1e-9)
    assert fl.verify("alpha-flocking", rec, law=law).hypotheses[0].status == "met"
    assert "is off by" in unmet(rec, LAW)


@pytest.mark.slow
def test_without_a_theorem_all_that_apply_are_judged(own, verdict):
    rec = fl.Recording(T, *own, bound=1e-6, source="own code")
    found = {one.theorem: one for one in fl.verify(None, rec, law=LAW)}
    assert {"os-3", "energy", "alpha-flocking"} <= set(found)
    assert "os-1" not in found
    assert found["os-3"].summary == verdict.summary
    assert all(one.hypotheses[0].name == "the samples follow the law" for one in found.values())


def test_definitions_about_samples_need_no_law(own):
    rec = fl.Recording(T, *own, bound=1e-6)
    assert [one.theorem for one in fl.verify(None, rec, d=7.0, r=8.4)] == list(DEFINITIONS)
    found = fl.verify("alpha-flocking", rec, d=7.0, r=8.4)
    assert [c.status for c in found.claims] == ["verified"] * 4
    assert "at its samples" in found.subject
    last = fl.verify("os-5-terminal", rec, d=7.0, r=8.4)
    assert last.claim("extension").status == "verified"
    vague = fl.Recording(T, *own, bound=1.5)
    assert fl.verify("os-5-terminal", vague, d=7.0, r=8.4).claim("extension").status == "vacuous"
    crossed = np.array([[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]]) * 3.0
    two = fl.Recording([0.0, 1.0], np.stack([crossed] * 2), np.zeros((2, 4, 2)), bound=1e-3)
    statuses = {c.status for c in fl.verify("os-5-terminal", two, d=7.0, r=8.4).claims}
    assert "refuted" not in statuses


def test_what_is_missing_is_said(own):
    rec, q = fl.Recording(T, *own, bound=1e-6), own[0].copy()
    q[3, 2] = np.nan
    for name, given, how, message in (
        ("os-3", rec, {}, r"os-3 is about a law: expected verify\('os-3', recording, law="),
        ("alpha-flocking", rec, {}, r"expected law=\.\.\., or the scale d and the range r"),
        ("E1", rec, {"law": LAW}, "not about motion"),
        ("os-3", rec, {"law": LAW, "d": 7.0}, "law and d or r are given"),
        ("os-3", rec, {"law": LAW, "q0": Q0}, "a recording: expected"),
        ("os-3", fl.Recording(T, q, own[1]), {"law": LAW}, "a verdict needs every agent at every sample, and agent 2"),
        ("os-3", rec.window(0.0, 0.0), {"law": LAW}, "one sample shows no motion"),
    ):
        with pytest.raises(ArgumentError, match=message):
            fl.verify(name, given, **how)


def test_the_energy_of_a_start_is_enclosed_over_the_balls_of_its_samples():
    """Against a thousand states within the accuracy; a pair at its balance is off by what its own potential says."""
    law, rng = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0))), np.random.default_rng(1)
    q, p = rng.uniform(0.0, 15.0, (5, 2)), rng.normal(size=(5, 2))
    run = fl.simulate(law, q, p, (0.0, 0.5), t_eval=np.linspace(0.0, 0.5, 11))
    rec = fl.Recording(run.t, run.q, run.p, bound=0.05)
    seen = observed_recording(rec, law, following(rec, law))
    best, allowed = law.structural_energy(seen.run.q[0], seen.run.p[0]), energy_within_accuracy(seen, 0)
    worst = 0.0
    for _ in range(1000):
        ways = (x / np.linalg.norm(x, axis=1)[:, None] for x in rng.normal(size=(2, 5, 2)))
        x, v = (0.5 * w * e[0][:, None] for w, e in zip(ways, (seen.shape_error, seen.speed_error), strict=True))
        worst = max(worst, abs(law.structural_energy(seen.run.q[0] + x, seen.run.p[0] + v) - best))
    assert 0.0 < worst < allowed < 100.0 * worst
    assert energy_within_accuracy(Observed.of(run), 0) == 0.0


@pytest.mark.slow
def test_of_a_last_state_that_is_not_known_no_equilibrium_is_near(own):
    """It was that of the law's own solution, however wide the stated bound."""
    for bound, status in ((1e-6, "met"), (1e30, "assumed")):
        verdict = fl.verify("linearised-decay-terminal", fl.Recording(T, *own, bound=bound), law=LAW)
        assert verdict.hypotheses[-1].status == status
        assert {c.status for c in verdict.claims} == {"verified" if status == "met" else "inconclusive"}
