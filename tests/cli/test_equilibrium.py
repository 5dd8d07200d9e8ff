import json
from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, AlphaInteraction, CallableTarget, LinearTarget, Scenario, Trajectory
from flockana.base.errors import SolverError
from flockana.equilibria.equilibrium_files import read_equilibrium
from flockana.sources.isola_2024.laws import MSNDiscretisation

COMMAND = ("equilibrium",)


@pytest.fixture
def catalogue(offer):
    """Two agents on a line that begin out of range of each other and come near; their γ-agent moves."""

    def build(seed=0):
        q, law = np.array([[0.0], [9.0 + seed]]), Algorithm2(target=LinearTarget((0.0,), (2.0,)))
        return Scenario("pair", "Two agents", "ours", law, q, 0.0 * q, (0.0, 3.0), seed)

    def other(seed=0):
        q = np.array([[0.0, 0.0], [9.0, 0.0]])
        return Scenario(
            "other", "No gradient", "ours", MSNDiscretisation(Algorithm1(), 0.01), q, 0.0 * q, (0.0, 1.0), seed
        )

    offer(pair=build, other=other)


def test_seven_agents_are_the_hexagon(found):
    one = found("hexagonal-spiral:7")
    assert (one["kind"], one["links"], one["law"], one["solver"]) == ("minimum", 12, "Algorithm1", "Solve_Succeeded")
    assert (one["rigid modes"], one["soft modes"], one["index"], one["strain"]) == (3, 0, 0, 0.0)
    assert one["residual"] < 1e-9
    assert len(one["hessian eigenvalues"]) == 14 - 3
    law, q = Algorithm1(), np.array(one["q"])
    assert one["energy"] == pytest.approx(law.hamiltonian(0.0, q, 0.0 * q), rel=1e-12)
    assert min(one["hessian eigenvalues"]) > 0.0


def test_algorithm_2_presses_and_the_scale_is_the_users(found):
    free, pressed = (found("line:2", "--d", 3, "--algorithm", k) for k in (1, 2))
    assert free["strain"] == 0.0
    assert abs(free["q"][1][0] - free["q"][0][0]) == pytest.approx(3.0, rel=1e-9)
    assert pressed["law"] == "Algorithm2"
    assert 0.0 < pressed["strain"] < 0.5
    assert abs(pressed["q"][1][0] - pressed["q"][0][0]) < 3.0


def test_what_is_saved_is_verified_when_it_is_read(call, found, tmp_path):
    code, out, _ = call("hexagonal-spiral:7", "-o", "seven.json", "--plot", "seven.png")
    assert code == 0
    assert "saved: seven.json" in out
    assert "picture: seven.png" in out
    again = read_equilibrium(tmp_path / "seven.json")
    assert (again.kind, len(again.links), again.law) == ("minimum", 12, Algorithm1())
    assert (tmp_path / "seven.png").stat().st_size > 1000
    assert found("seven.json")["energy"] == pytest.approx(again.energy, rel=1e-12)
    text = (tmp_path / "seven.json").read_text().replace('"minimum"', '"saddle"')
    (tmp_path / "forged.json").write_text(text)
    code, out, err = call("forged.json")
    assert (code, out) == (2, "")
    assert "it claims kind = 'saddle'" in err


def test_the_start_may_be_the_scenarios_or_its_end(call, found, catalogue, tmp_path):
    end = found("pair", "-o", "end.json")
    assert end["links"] == 1
    assert np.mean(end["q"]) == pytest.approx(6.0)  # the γ-agent, held where it is at t = 3
    assert np.mean(found("pair", "--start", "start")["q"]) == pytest.approx(0.0, abs=1e-9)
    assert read_equilibrium(tmp_path / "end.json").energy == pytest.approx(end["energy"], rel=1e-12)


def test_a_saved_run_brings_its_law(found, tmp_path):
    q = np.array([[[0.0, 0.0], [x, 0.0]] for x in (4.0, 5.5)])
    law = Algorithm2(AlphaInteraction(d=5.0, r=7.0), target=LinearTarget((1.0, 0.0), (2.0, 0.0)))
    Trajectory(np.array([0.0, 1.0]), q, 0.0 * q, 0.0 * q, law).save(tmp_path / "run.nc")
    for time, centre in ((0.0, 1.0), (1.0, 3.0)):
        one = found("run.nc", "--time", time)
        assert one["law"] == "Algorithm2"
        np.testing.assert_allclose(np.mean(one["q"], axis=0), [centre, 0.0], atol=1e-9)


def test_a_failed_solve_is_3_one_line_and_no_result(call, monkeypatch, tmp_path):
    def failing(*arguments, **options):
        raise SolverError("no equilibrium found:\nInfeasible_Problem_Detected")

    monkeypatch.setattr("flockana.equilibria.find_equilibrium", failing)
    code, out, err = call("line:3", "-o", "it.json", "--plot", "it.png")
    assert (code, out) == (3, "")
    assert err == "flockana: no equilibrium found: Infeasible_Problem_Detected\n"
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_fails_is_3_and_one_that_is_interrupted_130(call, catalogue, monkeypatch):
    whole = Scenario.run
    for status, expected in (("failed", 3), ("interrupted", 130)):
        monkeypatch.setattr(Scenario, "run", lambda self, s=status, **k: replace(whole(self), status=s, message="why"))
        code, out, err = call("pair")
        assert (code, out, err.count("\n")) == (expected, "", 1)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["ragged.csv"], "ragged.csv, line 2: 1 values, expected 2"),
        (["pairs"], "unknown scenario, file or builder 'pairs'; did you mean 'pair'?"),
        (["line:99999"], "n = 99999: expected at most 30000 agents"),
        (["pair", "--d", "3"], "--d 3.0: pair has a law of its own"),
        (["pair", "--algorithm", "1"], "--algorithm 1: pair has a law of its own"),
        (["pair", "--time", "1"], "--time 1.0: pair has a law of its own"),
        (["other"], "expected a sum of a pair term and others whose forces are gradients"),
    ],
)
def test_bad_input_is_2_and_one_line(refused, catalogue, monkeypatch, tmp_path, arguments, message):
    monkeypatch.setattr(Scenario, "run", lambda *a, **k: pytest.fail("it ran"))
    (tmp_path / "ragged.csv").write_text("0,0\n1\n")
    refused(message, *arguments)


def test_a_target_that_no_file_can_hold_is_held_in_place(found, offer, tmp_path):
    def build(seed=0):
        target = CallableTarget(lambda t: ((5.0 + t,), (1.0,)))
        q = np.array([[0.0], [7.0]])
        return Scenario("moved", "Two", "ours", Algorithm2(target=target), q, 0.0 * q, (2.0, 3.0), seed)

    offer(moved=build)
    one = found("moved", "--start", "start", "-o", "moved.json")
    assert np.mean(one["q"]) == pytest.approx(7.0)
    assert read_equilibrium(tmp_path / "moved.json").kind == one["kind"] == "minimum"


def test_dead_zone_contacts_from_a_scenario_and_from_a_file(call, tmp_path):
    code, out, err = call("dead-zone-flow", "-o", "contacts.json", "--plot", "contacts.png")
    text = " ".join(out.split())
    assert (code, err) == (0, "")
    assert "law DeadZoneFlocking, n = 16" in text
    assert "of a contact's force" in text
    assert "|contact − d1|/d1 at most 0.0" in text
    assert (tmp_path / "contacts.png").exists()
    again = json.loads(call("contacts.json", "--json")[1])
    assert (again["kind"], again["coincident pairs"], 0.0 < again["strain"] < 0.1) == ("minimum", 0, True)


@pytest.mark.slow
def test_a_law_that_is_stepped_is_found_within_and_jumps_are_refused(call):
    code, _, err = call("dead-zone-hard", "--start", "start")
    assert (code, "ramp = 0: contacts sit where the force jumps" in err) == (2, True)
    code, out, _ = call("dead-zone-wide-lattice", "--start", "start", "--json")
    assert (code, json.loads(out)["law"]) == (0, "DeadZoneFlocking")
