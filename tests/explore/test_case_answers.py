import json

import numpy as np
import pytest

import flockana as fl
from flockana.explore.case_answers import answer, poles
from flockana.explore.page_case import Case


def told(case, limit=60.0):
    """Everything that is sent, by kind."""
    found = {}
    answer(case, lambda kind, content: found.setdefault(kind, []).append(content), limit=limit, cancelled=lambda: False)
    for kind, contents in found.items():
        if kind != "run":
            json.dumps(contents, allow_nan=False)  # a page reads it
    return found


@pytest.fixture(scope="module")
def pair():
    return told(Case("scenario", "head-on", duration=30.0, changes={"gains.c2_alpha": 3.0}))


def test_the_order_and_the_form(pair):
    assert list(pair) == ["form", "run", "ran", "verdict", "poles", "done"]
    (form,) = pair["form"]
    assert (form["n"], form["m"], form["duration"], form["ratio"]) == (2, 1, 30.0, False)
    by_path = {each["path"]: each for each in form["numbers"]}
    damping = by_path["gains.c2_alpha"]
    assert (damping["value"], damping["usual"]) == (3.0, fl.scenario("head-on").law.gains.c2_alpha)
    assert not {"gains.c1_gamma", "gains.c1_beta"} & set(by_path)  # Algorithm 1 has neither term
    assert "c2_alpha=3.0" in form["python"]


def test_verdicts_are_those_of_verify(pair):
    item = fl.scenario("head-on")
    law = Case("scenario", "head-on", changes={"gains.c2_alpha": 3.0}).parts.law
    run = fl.simulate(law, item.q0, item.p0, (0.0, 30.0))
    for found in pair["verdict"]:
        own = fl.verify(found["theorem"], run)
        assert found["status"] == own.status
        assert [each["name"] for each in found["hypotheses"]] == [each.name for each in own.hypotheses]
        assert [each["status"] for each in found["claims"]] == [each.status for each in own.claims]


def test_poles_and_modes_of_two_agents_on_a_line():
    """Off the translation δ'' = −2 k δ − 2 c δ' with the link's stiffness k and damping c."""
    run = fl.simulate(fl.Algorithm1(), [[0.0], [7.5]], [[0.0], [0.0]], (0.0, 60.0))
    found = poles(run)
    alpha, gains = run.law.alpha, run.law.gains
    slope = 7.0 / np.sqrt(1.0 + alpha.eps * 49.0)  # of the σ-norm at d; the direction n_ij is as long
    k = 2.0 * gains.c1_alpha * alpha.phi_alpha_slope(alpha.d_alpha) * slope**2
    c = 2.0 * gains.c2_alpha * alpha.adjacency(alpha.d_alpha)
    expected = np.roots([1.0, c, k])
    (mode,) = found["modes"]
    assert mode["value"] == pytest.approx([expected[0].real, abs(expected[0].imag)], rel=1e-9)
    assert found["abscissa"] == pytest.approx(expected.real.max(), rel=1e-9)
    assert found["note"].startswith("At the equilibrium")
    np.testing.assert_allclose(np.ravel(mode["real"]), np.array([1.0, -1.0]) / np.sqrt(2.0), atol=1e-6)


def test_away_from_rest_it_says_so():
    run = fl.simulate(fl.Algorithm1(), [[0.0], [7.9]], [[0.0], [0.0]], (0.0, 0.05))
    assert "no equilibrium" in poles(run)["note"]
    assert "map" in poles(fl.scenario("headings-part").run())["note"]


@pytest.mark.slow
def test_the_threshold_is_marked_where_a_pull_squeezes():
    found = told(Case("law", "Algorithm2", n=7, duration=0.2))
    assert found["form"][0]["ratio"] is True
    (bracket,) = found["threshold"]
    assert 3.0 < bracket["low"] < 3.9187944152658702  # of seven agents, found with more halvings
    assert 3.8207337683095197 < bracket["high"] < 5.0
    space = told(Case("law", "Algorithm2", n=4, m=3, duration=0.2))
    assert "in the plane" in space["threshold"][0]["note"]


@pytest.mark.parametrize(
    ("case", "words"),
    [
        (Case("law", "Algorithm1", changes={"alpha.r": 1.0}), "expected r > d"),
        (Case("law", "Algorithm1", changes={"gains.c1_alpha": -1.0}), "expected a gain >= 0"),
        (Case("law", "Algorithm1", n=4000), "4000 agents"),
        (Case("law", "Algorithm1", n=20, moved={0: (0.0, float("inf"))}), "expected finite"),
        ({"kind": "law"}, "a case has kind, name"),
    ],
)
def test_errors_are_the_librarys_own(case, words):
    found = told(case)
    assert words in found["error"][0]["text"]
    assert "run" not in found
    assert list(found)[-1] == "done"


def test_what_the_source_reports_is_told_as_long_as_nothing_is_changed():
    found = told(Case("scenario", "zone-gap"))
    assert [each["id"] for each in found["form"][0]["theorems"]][-1] == "source"
    entry = fl.scenario("zone-gap")
    (own,) = entry.reported(entry.run())
    (said,) = (each for each in found["verdict"] if each["theorem"] == "source")
    assert [(each["name"], each["status"]) for each in said["claims"]] == [(c.name, c.status) for c in own.claims]
    assert all(report.name in said["statement"] for report in entry.reports)
    assert "item.reported(run)" in found["form"][0]["python"]
    moved = told(Case("scenario", "zone-gap", duration=5.0))
    assert "source" not in [each["theorem"] for each in moved.get("verdict", [])]
    assert "reported" not in moved["form"][0]["python"]


def test_verdicts_mark_the_instants_that_their_claims_point_to(pair):
    marks = {each["theorem"]: each["marks"] for each in pair["verdict"]}
    assert [name for _, name in marks["energy"]] == ["energy rate", "energy balance"]
    assert all(0.0 <= time <= 30.0 for each in marks.values() for time, _ in each)


def test_a_newer_question_ends_the_verdicts():
    found, asked = [], []

    def send(kind, content):
        found.append(kind)

    def cancelled():
        asked.append(1)
        return "ran" in found

    with pytest.raises(KeyboardInterrupt):
        answer(Case("scenario", "head-on"), send, limit=60.0, cancelled=cancelled)
    assert found[-1] == "ran"
