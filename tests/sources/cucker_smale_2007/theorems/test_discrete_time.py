"""The Cucker-Smale law in steps: the bound of the step, on both sides, and what a step too long does."""

import numpy as np
import pytest

from flockana import CuckerSmale, ExplicitEuler, RationalWeight, SemiImplicitEuler, TaylorStep, simulate, verify
from tests.theorems.made_up import hypothesis, statuses

Q, P = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]]), np.array([[0.3, 0.0], [-0.1, 0.2], [0.0, -0.4]])
CLAIMS = ("bounded", "rate", "velocities")


def run(scheme, h, *, steps=40, mean=False, decay=0.25):
    law = scheme(CuckerSmale(RationalWeight(2.0, decay, 1.0), mean=mean), h)
    return simulate(law, Q, P, (0.0, h * steps))


@pytest.mark.parametrize("scheme", [ExplicitEuler, SemiImplicitEuler, TaylorStep])
@pytest.mark.parametrize(
    ("h", "mean", "said"), [(0.1, False, "verified"), (0.5, True, "verified"), (0.2, False, "vacuous")]
)
def test_short_steps_flock(scheme, h, mean, said):
    """λ = nK = 6 of plain sums, 2 of means."""
    verdict = verify("cucker-smale-steps", run(scheme, h, mean=mean))
    need = hypothesis(verdict, "h λ")
    assert need.status == ("met" if said == "verified" else "unmet")
    assert need.margin == pytest.approx(1.0 - h * (2.0 if mean else 6.0))
    assert statuses(verdict) == dict.fromkeys(CLAIMS, said)


def test_each_step_takes_at_least_its_share():
    """‖v‖ falls by 1 − hφ(x_M) or more in each step, and a step too long does not even shrink it."""
    found = run(SemiImplicitEuler, 0.1)
    stated = verify("cucker-smale-steps", found).claim("rate").stated
    phi = float(stated.rsplit("= ", 1)[1])
    v = np.linalg.norm(found.p - found.p.mean(axis=1, keepdims=True), axis=(1, 2))
    assert ((v[1:] / v[:-1])[v[1:] > 1e-9] <= 1.0 - 0.1 * phi).all()
    long = run(SemiImplicitEuler, 0.9, steps=4, decay=0.0)
    assert np.linalg.norm(long.p[-1] - long.p[-1].mean(axis=0)) > 10.0 * np.linalg.norm(P - P.mean(axis=0))


def test_the_flow_is_no_run_in_steps():
    verdict = verify("cucker-smale-steps", simulate(CuckerSmale(), Q, P, (0.0, 1.0)))
    assert statuses(verdict) == dict.fromkeys(CLAIMS, "vacuous")
