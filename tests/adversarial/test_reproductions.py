"""What once went wrong, one case each, as it was reported: a verdict that was false, a run that should not count."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from flockana import Algorithm3, DeadZoneFlocking, Tolerances, simulate, theorem, theorems, verify
from flockana.base.errors import ArgumentError
from flockana.environment.targets import StaticTarget
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from tests.adversarial.cases import FALSE, TRUE, Case, hold

ORIGIN = StaticTarget((0.0, 0.0))
APART, STILL = np.array([[0.0, 0.0], [8.0, 0.0]]), np.zeros((2, 2))
ON_RUNS = [name for name in theorems() if theorem(name).kind == "trajectory"]
decided = {"verified", "refuted"}


def decides_nothing(name, run):
    """No claim by computation is decided, or the run is refused in words."""
    try:
        verdict = verify(name, run)
    except ArgumentError:
        return
    assert [(c.name, c.status) for c in verdict.claims if c.rigour == "numeric" and c.status in decided] == []


def test_an_error_larger_than_what_it_measures_verifies_nothing():
    """An energy that rises by 5.4 and is off by 211 is not seen to fall."""
    law = DeadZoneFlocking()
    q = np.random.default_rng(1).uniform(0.0, 30.0, (9, 2))
    case = Case(law, q, 0.0 * q, 20.0, {"method": "RK4", "dt": 0.5})
    assert np.abs(case.run.energy_residual).max() > 1.0
    hold("dead-zone-1-printed", case, {"energy": FALSE, "collision": TRUE}, may_refuse=True)
    hold("dead-zone-1-corrected", case, {"rate": TRUE, "balance": TRUE, "distance": TRUE}, may_refuse=True)


@cache
def failed(law, samples):
    run = Case(law, APART, STILL, 1.0, {"t_eval": np.linspace(0.0, 1.0, 5)[:samples]}).run
    return replace(run, status="failed", message="gave up")


@pytest.mark.parametrize("samples", [1, 5])
@pytest.mark.parametrize("name", ON_RUNS)
def test_a_failed_run_verifies_nothing(name, samples):
    for law in (Algorithm1(), Algorithm2(target=ORIGIN), Algorithm3(target=ORIGIN), DeadZoneFlocking()):
        decides_nothing(name, failed(law, samples))


def test_where_samples_fall_does_not_say_how_much_a_flock_has_grown():
    law = Algorithm2(AlphaInteraction(d=7.0, r=7.35), Gains(1.0, 0.0, c1_gamma=0.0, c2_gamma=0.0), StaticTarget((2.1,)))
    q = np.array([[10.155683774987544], [10.155683774987544], [-1.4624173943616945]])
    p = np.array([[-170.43184667306846], [-123.91172034671153], [-70.33036493848445]])
    until = 6.3746247320470095
    for options in ({"t_eval": np.linspace(0.0, until, 700)}, {}, {"method": "LSODA", "rtol": 1e-6}):
        claim = verify("alpha-flocking", simulate(law, q, p, (0.0, until), **options)).claim("cohesive")
        assert claim.status in (("refuted",) if "t_eval" in options else ("refuted", "inconclusive", "vacuous"))


def test_a_lattice_that_breathes_is_none_because_it_is_sampled_at_its_length():
    law = Algorithm1(AlphaInteraction(), Gains(c1_alpha=30.0, c2_alpha=0.0))
    q, p, strict = [[0.0], [7.0]], [[-3.0], [3.0]], Tolerances(deviation=1e-3)
    fine = simulate(law, q, p, (0.0, 3.0), t_eval=np.linspace(0.0, 3.0, 3001))
    gap = fine.q[:, 1, 0] - fine.q[:, 0, 0]
    passes = fine.t[np.flatnonzero((gap[1:] >= 7.0) != (gap[:-1] >= 7.0))]
    run = simulate(law, q, p, (0.0, float(passes[-1])), t_eval=[0.0, *passes[1:]])
    assert run.metric("normalised_deviation_energy").max() < 1e-6
    assert verify("alpha-flocking", run, tolerances=strict).claim("deviation").status == "inconclusive"
    assert verify("alpha-flocking", fine, tolerances=strict).claim("deviation").status == "refuted"
