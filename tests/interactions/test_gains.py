"""Per-agent gains: one gain per agent in every place that reads c1γ or c2γ."""

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from flockana import Algorithm2, Algorithm3, Gains, Sphere, find_equilibrium, simulate, verify
from flockana.base.errors import ArgumentError
from flockana.base.serialize import from_data, to_data
from flockana.environment.targets import CircleTarget, LinearTarget, RescaledVelocity, StaticTarget
from flockana.equilibria.final_state import terminal_state
from flockana.equilibria.gradient_flow import gradient_flow
from flockana.equilibria.ipopt_program import Program
from flockana.equilibria.potential import Potential
from flockana.equilibria.solve import all_pairs
from flockana.lattice import hexagonal_patch
from flockana.sources.isola_2024.laws import MSNDiscretisation
from tests.refused import refused

RNG = np.random.default_rng(5)
N = 7
Q = hexagonal_patch(1, 7.0) + 0.3 * RNG.standard_normal((N, 2))
P = RNG.standard_normal((N, 2))
C1, C2 = RNG.uniform(0.2, 2.0, N), RNG.uniform(0.2, 3.0, N)
SOME = Gains(c1_alpha=2.0, c2_alpha=0.7, c1_gamma=C1, c2_gamma=C2)
ONE = Gains(c1_alpha=2.0, c2_alpha=0.7, c1_gamma=0.9, c2_gamma=1.3)
SAME = replace(ONE, c1_gamma=[0.9] * N, c2_gamma=(1.3,) * N)
CIRCLE = RescaledVelocity(CircleTarget((1.0, 2.0), 3.0, 0.2), 0.4)


def law2(gains, target=CIRCLE):
    return Algorithm2(gains=gains, target=target)


def law3(gains, target=CIRCLE):
    return Algorithm3(gains=gains, target=target, obstacles=(Sphere((14.0, 0.0), 3.0),))


def test_arrays_are_kept_as_tuples_that_hash_compare_pickle_and_serialise():
    assert SOME.c1_gamma == tuple(C1.tolist())
    assert isinstance(Gains(c1_gamma=np.float64(2.0)).c1_gamma, float)
    assert SOME.pull.shape == (N, 1)
    assert (SOME.per_agent, ONE.per_agent, ONE.pull) == (True, False, 0.9)
    assert len({SOME, replace(SOME), SAME, ONE}) == 3
    assert pickle.loads(pickle.dumps(SOME)) == SOME
    assert from_data(json.loads(json.dumps(to_data(SOME)))) == SOME


test_bad_gains = refused(
    ({"c1_gamma": [1.0, -2.0]}, r"c1_gamma\[1\] = -2: expected a gain >= 0"),
    ({"c2_gamma": []}, r"c2_gamma has shape \(0,\): expected one number, or one for each agent"),
    ({"c1_gamma": [[1.0]]}, r"c1_gamma has shape \(1, 1\): expected one number, or one"),
    make=Gains,
)


@pytest.mark.parametrize("law", [law2, law3])
def test_a_wrong_number_of_gains_is_refused_at_every_entrance(law):
    short = law(replace(SOME, c1_gamma=C1[:5]))
    message = "c1_gamma has 5 gains but there are 7 agents: expected one per agent"
    for enter in (
        lambda: short.acceleration(0.0, Q, P),
        lambda: short.energy(0.0, Q, P),
        lambda: short.stiffness(Q),
        lambda: simulate(short, Q, P, (0.0, 0.1)),
        lambda: find_equilibrium(short, Q),
    ):
        with pytest.raises(ArgumentError, match=message):
            enter()


@pytest.mark.parametrize("law", [law2, law3])
def test_each_agent_feels_its_own_gain(law):
    """u(c1γ_i, c2γ_i) of agent i is what it feels when all have its gains."""
    u = law(SOME).acceleration(0.3, Q, P)
    for i in range(N):
        alike = law(replace(SOME, c1_gamma=float(C1[i]), c2_gamma=float(C2[i])))
        np.testing.assert_allclose(u[i], alike.acceleration(0.3, Q, P)[i], rtol=1e-13)


def test_the_rate_of_the_energy_is_the_symbolic_one():
    """One agent with its own gains under a γ-agent with speed s ≠ p_r: the γ-part of dH/dt by sympy, exactly."""
    q, p, q_r, p_r, s, c1, c2 = sp.symbols("q p q_r p_r s c1 c2")
    energy = c1 * (q - q_r) ** 2 / 2 + p**2 / 2
    u = -c1 * (q - q_r) - c2 * (p - p_r)
    rate = sp.diff(energy, q) * p + sp.diff(energy, p) * u + sp.diff(energy, q_r) * s
    assert sp.expand(rate - (-c2 * p * (p - p_r) - c1 * (q - q_r) * s)) == 0
    values = {q: 1.5, p: -0.5, q_r: 0.25, p_r: 0.75 * 0.4, s: 0.75, c1: 1.25, c2: 2.0}
    law = law2(Gains(c1_gamma=[1.25], c2_gamma=[2.0]), RescaledVelocity(LinearTarget((0.25,), (0.75,)), 0.4))
    assert law.energy_rate(0.0, [[1.5]], [[-0.5]]) == pytest.approx(float(rate.subs(values)), rel=1e-14)
    assert law.energy(0.0, [[1.5]], [[-0.5]]) == pytest.approx(float(energy.subs(values)), rel=1e-14)


@pytest.mark.parametrize("law", [law2, law3])
@pytest.mark.parametrize("target", [CIRCLE, StaticTarget((1.0, 2.0))])
def test_the_energy_balances_along_runs(law, target):
    run = simulate(law(SOME, target), Q, P, (0.0, 4.0), rtol=1e-10, atol=1e-12)
    assert np.abs(run.energy_residual).max() < 1e-7 * np.abs(run.energy()).max()
    verdict = verify("energy", run)
    assert verdict.claim("balance").status == "verified"
    assert verdict.claim("rate").status == ("verified" if isinstance(target, StaticTarget) else "vacuous")


def test_theorems_that_need_one_gain_say_so():
    run = simulate(law2(SOME), Q, P, (0.0, 6.0))
    for theorem, name in (("os-3", "one c1γ and one c2γ for all agents"), ("E11", "one c1γ for all agents")):
        verdict = verify(theorem, run)
        assert verdict.status == "vacuous"
        assert [h.status for h in verdict.hypotheses if h.name == name] == ["unmet"]
    assert verify("E12", run).status == "vacuous"


def test_equilibria_are_minima_of_the_potential_that_knows_each_gain():
    law = law2(SOME, StaticTarget((1.0, 2.0)))
    found = find_equilibrium(law, Q)
    assert (found.kind, found.rigid_modes) == ("minimum", 1)  # the rotation about the γ-agent; no translation
    assert np.abs(law.acceleration(0.0, found.q, np.zeros_like(Q))).max() < 1e-8
    np.testing.assert_allclose(C1 @ (found.q - [1.0, 2.0]) / C1.sum(), 0.0, atol=1e-9)  # pair forces cancel
    potential = Potential(law)
    listed = potential.listed_energy(found.q, find_equilibrium(law, Q).links)
    off = N * (N - 1) // 2 * SOME.c1_alpha * law.alpha.far_potential
    assert listed + off == pytest.approx(found.energy, rel=1e-12)


def test_what_lives_in_the_moving_frame_refuses_them():
    law = law2(SOME, StaticTarget((1.0, 2.0)))
    for enter in (
        lambda: law.structural_energy(Q, P),
        lambda: gradient_flow(law, Q),
        lambda: terminal_state(law, Q, P),
        lambda: MSNDiscretisation(law, dt=0.1),
    ):
        with pytest.raises(ArgumentError, match="given per agent: expected one of each"):
            enter()


def test_the_program_that_ipopt_solves_knows_each_gain():
    """Gradient and Hessian as IPOPT gets them against the law's own, in the program's units."""
    law = law2(SOME, StaticTarget((1.0, 2.0)))
    program = Program(Potential(law), (N, 2), all_pairs(N), 1)
    slope, upper = (np.array(part) for part in program.derivatives(Q.ravel() / program.d))
    force = law.acceleration(0.0, Q, np.zeros_like(Q)).ravel()
    np.testing.assert_allclose(slope.ravel() * program.unit / program.d, -force, atol=1e-10)
    hessian = np.triu(upper) * program.unit / program.d**2
    np.testing.assert_allclose(hessian, np.triu(law.stiffness(Q).toarray()), atol=1e-9)
