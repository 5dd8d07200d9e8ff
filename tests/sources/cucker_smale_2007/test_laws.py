"""Velocity consensus alone: its force, power, Jacobian and compiled form, of all pairs or within a range."""

from dataclasses import dataclass
from math import inf

import numpy as np
import pytest

import flockana as fl
from flockana.laws.sum_of_terms import SumOfTerms
from tests.refused import refused

RNG = np.random.default_rng(3)
Q, P = RNG.normal(0.0, 2.0, (5, 2)), RNG.normal(0.0, 1.0, (5, 2))


@dataclass(frozen=True)
class Near(fl.RationalWeight):
    """The same weight, which ends at a distance."""

    range: float = 2.5


@dataclass(frozen=True)
class Aligned(SumOfTerms):
    """Nothing but the term."""

    term_: fl.AlignmentTerm

    @property
    def terms(self):
        return (self.term_,)


LAWS = {
    "all": fl.CuckerSmale(fl.RationalWeight(2.0, 0.7, 1.5)),
    "mean": fl.CuckerSmale(fl.RationalWeight(2.0, 0.7, 1.5), mean=True),
    "near": Aligned(fl.AlignmentTerm(Near(2.0, 0.7, 1.5), 1.3)),
}


@pytest.mark.parametrize("name", LAWS)
def test_the_force_is_the_sum_and_the_power_its_rate(name):
    law, u, lost = LAWS[name], np.zeros_like(Q), 0.0
    term = law.terms[0]
    for i in range(5):
        for j in range(5):
            s2 = float(np.sum((Q[j] - Q[i]) ** 2))
            if i != j and s2 < getattr(term.weight, "range", inf) ** 2:
                a = term.gain * 2.0 / (1.0 + s2 / 1.5**2) ** 0.7 / (5.0 if term.mean else 1.0)
                u[i] += a * (P[j] - P[i])
                lost += 0.5 * a * float(np.sum((P[j] - P[i]) ** 2))
    np.testing.assert_allclose(law.acceleration(0.0, Q, P), u, rtol=1e-13, atol=1e-14)
    assert law.energy_rate(0.0, Q, P) == pytest.approx(-lost, rel=1e-13)
    assert float(np.sum((P - P.mean(axis=0)) * u)) == pytest.approx(-lost, rel=1e-12)


@pytest.mark.parametrize("name", LAWS)
def test_compiled_and_stepped_runs_agree(name):
    ends = [
        fl.simulate(LAWS[name], Q, P, (0.0, 2.0), t_eval=[2.0], rtol=1e-11, method=method).q[-1]
        for method in ("DOP853", "scipy-DOP853")
    ]
    np.testing.assert_allclose(*ends, atol=1e-9)


test_bad_parameters_are_named = refused(
    (lambda: fl.RationalWeight(0.0), "strength = 0: expected a number > 0"),
    (lambda: fl.RationalWeight(decay=-1.0), "decay = -1: expected a number >= 0"),
    (lambda: fl.RationalWeight(length=float("nan")), "length = nan: expected a finite number"),
    (lambda: fl.CuckerSmale(3), "weight = 3: expected RationalWeight"),
    (lambda: fl.CuckerSmale(mean=1), "mean = 1: expected True or False"),
)
