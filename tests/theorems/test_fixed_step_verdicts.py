"""What theorems on motion say of schemes: of the energy, that it rises by no more than the scheme's own defect."""

import numpy as np
import pytest

import flockana as fl
from flockana.theorems.catalogue import catalogue
from flockana.theorems.fixed_step_verdicts import claims_on_steps, scheme_note
from tests.recorded.written import LAW, P0, Q0


def circling():
    """Two agents far apart that circle the target, on springs of stiffness 2, under explicit Euler steps of 0.1."""
    law = fl.Algorithm2(gains=fl.Gains(c1_gamma=2.0, c2_gamma=0.0), target=fl.StaticTarget((0.0, 0.0)))
    q0, p0 = np.array([[50.0, 0.0], [-50.0, 0.0]]), np.array([[0.0, 70.0], [0.0, -70.0]])
    return fl.simulate(fl.ExplicitEuler(law, 0.1), q0, p0, (0.0, 5.0))


def test_the_defect_of_explicit_euler_on_springs_is_its_closed_form():
    """Each step multiplies ½ Σ‖p‖² + Σ‖q‖² by 1 + 2 h², and the flow keeps it."""
    run = circling()
    start = 0.5 * np.sum(run.p[0] ** 2) + np.sum(run.q[0] ** 2)
    found = fl.verify("energy", run)
    assert found.status == "vacuous"
    assert [found.claim(name).status for name in ("rate", "balance")] == ["vacuous", "vacuous"]
    falls = found.claim("steps-fall")
    assert (falls.status, falls.by) == ("refuted", "flockana")
    assert falls.computed == pytest.approx(start * 1.02**49 * 0.02 / run.energy()[-1])
    assert f"{start * (1.02**50 - 1.0):.3g} in all" in falls.detail
    assert found.claim("steps-defect").status == "verified"
    assert found.claim("steps-defect").computed == pytest.approx(0.0, abs=1e-8)


def test_a_scheme_whose_law_damps_may_lose_energy_all_the_same():
    run = fl.simulate(fl.TaylorStep(LAW, 0.01), Q0, P0, (0.0, 0.5))
    found = fl.verify("energy", run)
    assert [found.claim(name).status for name in ("steps-fall", "steps-defect")] == ["verified", "verified"]
    assert "our extension" in found.summary
    assert found.hypotheses[0].status == "unmet"
    assert "in steps of 0.01 of Algorithm2 by TaylorStep" in found.hypotheses[0].detail
    assert "energy" in {one.theorem for one in fl.verify(None, run)}
    assert fl.verify("os-3", run).hypotheses[0].name == "the law acts in continuous time"


def test_theorem_6_speaks_of_steps_where_its_hypotheses_hold():
    law = fl.Algorithm3(target=fl.StaticTarget((30.0, 0.0)), obstacles=(fl.Sphere((15.0, 0.0), 3.0),))
    outside = fl.simulate(fl.SemiImplicitEuler(law, 0.01), [[0.0, 0.0], [0.0, 7.0]], np.zeros((2, 2)), (0.0, 2.0))
    assert fl.verify("os-6", outside).claim("steps-defect").status == "verified"
    ahead = fl.Algorithm3(target=fl.LinearTarget((30.0, 0.0), (1.0, 0.0)), obstacles=law.obstacles)
    led = fl.simulate(fl.SemiImplicitEuler(ahead, 0.01), [[0.0, 0.0], [0.0, 7.0]], np.zeros((2, 2)), (0.0, 0.5))
    assert fl.verify("os-6", led).claim("steps-defect").status == "vacuous"


def test_every_theorem_on_motion_says_what_it_says_of_schemes():
    for item in catalogue().values():
        assert (scheme_note(item) != "") == (item.kind == "trajectory")
    assert "definition" not in scheme_note(catalogue()["energy"])
    assert set(claims_on_steps()) <= set(catalogue())
