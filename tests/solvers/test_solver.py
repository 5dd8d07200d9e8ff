"""A solver is one class: Ralston's method and Tsit5, through simulate, verify, linearise as maps, and files."""

from functools import cache

import numpy as np
import pytest

import flockana as fl
from flockana.lattice import hexagonal_patch

LAW = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
Q = hexagonal_patch(1, 7.0) + np.linspace(-0.3, 0.3, 14).reshape(7, 2)
P = 0.1 * Q[::-1]


class Ralston(fl.FixedStep):
    """Ralston's method of order 2 with the least error bound (Ralston 1962)."""

    order = 2
    a = ((), (2 / 3,))
    b = (1 / 4, 3 / 4)


class Tsit5(fl.AdaptivePair):
    """Tsitouras' pair of order 5(4) (Computers & Mathematics with Applications 62, 2011, table 1)."""

    order = 5
    a = (
        (),
        (0.161,),
        (-0.008480655492356989, 0.335480655492357),
        (2.8971530571054935, -6.359448489975075, 4.3622954328695815),
        (5.325864828439257, -11.748883564062828, 7.4955393428898365, -0.09249506636175525),
        (5.86145544294642, -12.92096931784711, 8.159367898576159, -0.071584973281401, -0.028269050394068383),
    )
    b = (
        0.09646076681806523, 0.01, 0.4798896504144996, 1.379008574103742, -3.290069515436081, 2.324710524099774,
    )  # fmt: skip
    error = (
        -0.00178001105222577714, -0.0008164344596567469, 0.007880878010261995, -0.1447110071732629,
        0.5823571654525552, -0.45808210592918697, 0.015151515151515152,
    )  # fmt: skip
    error_order = 4


class Plain(fl.Algorithm2):
    """Algorithm 2, which the library must step in Python."""

    def flow(self, t, q, p):
        """As it was."""
        return super().flow(t, q, p)


@cache
def exact():
    return fl.simulate(LAW, Q, P, (0.0, 1.0), rtol=1e-12, t_eval=[0.37, 1.0]).q


@pytest.mark.parametrize("law", [LAW, Plain(target=LAW.target)], ids=["compiled", "in Python"])
def test_an_adaptive_pair_integrates_a_law(law):
    run = fl.simulate(law, Q, P, (0.0, 1.0), method=Tsit5(), rtol=1e-9, t_eval=[0.37, 1.0])
    assert run.stats["method"] == "Tsit5"
    np.testing.assert_allclose(run.q, exact(), rtol=0.0, atol=1e-7)
    known = law is LAW  # a theorem does not know a class of one's own
    assert (fl.verify("energy", fl.simulate(law, Q, P, (0.0, 1.0), method=Tsit5())).status == "verified") is known


@pytest.mark.slow
@pytest.mark.parametrize("law", [LAW, Plain(target=LAW.target)], ids=["compiled", "in Python"])
@pytest.mark.parametrize("kind", [Ralston, fl.Heun, fl.RK4, fl.ExplicitEuler, fl.SemiImplicitEuler, fl.TaylorStep])
def test_errors_of_fixed_steps_fall_by_the_order(law, kind):
    """Of the law (checked steps) and of the map alike; a halved step leaves 2^-order of the error."""
    for run in (
        lambda dt: fl.simulate(law, Q, P, (0.0, 1.0), method=kind(dt), t_eval=[1.0]),
        lambda dt: fl.simulate(fl.FixedSteps(law, kind(dt)), Q, P, (0.0, 1.0), t_eval=[1.0]),
    ):
        coarse, fine = (float(np.abs(run(dt).q[-1] - exact()[-1]).max()) for dt in (1 / 256, 1 / 512))
        assert np.log2(coarse / fine) == pytest.approx(kind.order, abs=0.25)


def test_a_map_is_verified_and_saved(tmp_path):
    law = Ralston(LAW, 0.01)
    run = fl.simulate(law, Q, P, (0.0, 1.0))
    assert law == fl.FixedSteps(LAW, Ralston(0.01))
    again = fl.Trajectory.load(run.save(tmp_path / "run.nc"))
    assert again.law == law
    np.testing.assert_array_equal(again.q, run.q)
    claims = {claim.name: claim for claim in fl.verify("energy", run).claims}
    assert claims["steps-defect"].status == "verified"


@pytest.mark.parametrize("kind", [Ralston, fl.Heun, fl.RK4])
def test_a_linearised_map_is_the_stability_function_of_the_flows_matrix(kind):
    rest = fl.find_equilibrium(LAW, hexagonal_patch(1, 7.0))
    flow, steps = fl.linearise(LAW, rest), fl.linearise(kind(LAW, 0.02), rest)
    z = 0.02 * flow.A
    expected = sum(np.linalg.matrix_power(z, k) / [1, 1, 2, 6, 24][k] for k in range(kind.order + 1))
    np.testing.assert_allclose(steps.A, expected, rtol=0.0, atol=1e-12)
    moved = [fl.FixedSteps(LAW, kind(0.02)).step(0.0, rest.q + d, 0.0 * d, {})[0] for d in (1e-6 * Q, -1e-6 * Q)]
    change = (moved[0] - moved[1]).ravel() / 2e-6
    np.testing.assert_allclose(change, steps.A[:14, :14] @ Q.ravel(), rtol=0.0, atol=1e-6)
    apart = np.abs(steps.multipliers[:, None] - np.linalg.eigvals(steps.A))
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-6
    assert steps.stable
    assert len(steps.zero_modes) == len(flow.zero_modes)
    held = np.block([[z, 0.02 * np.eye(28)[:, 14:]], [np.zeros((14, 42))]])  # a force that lasts the step
    series = sum(np.linalg.matrix_power(held, k) / [1, 1, 2, 6, 24][k] for k in range(kind.order + 1))
    np.testing.assert_allclose(steps.B, series[:28, 28:], rtol=0.0, atol=1e-14)
