"""Averages over random nets in turn, with and without a root together, and a run whose agents leave their extent."""

from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import flockana as fl
from flockana import NetAveraging, Tolerances, theorem
from flockana.theorems.observed_run import Observed
from tests.adversarial.cases import VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import seeds

THEOREMS = ("rooted-averaging", "growing-windows")


@effort(0.4)
@given(st.integers(2, 6), st.integers(1, 4), st.booleans(), seeds)
def test_a_tree_whose_links_are_seen_in_turn_agrees_and_a_forest_does_not(n, turns, forest, seed):
    rng = np.random.default_rng(seed)
    order = rng.permutation(n + 1)
    nets = np.array([np.eye(n + 1)] * turns)
    for k in range(1, n + (not forest)):
        one, other, net = order[k], order[rng.integers(k)], rng.integers(turns)
        share = rng.uniform(0.1, 0.9)
        nets[net][one] = share * nets[net][one] + (1.0 - share) * np.eye(n + 1)[other]
    law = NetAveraging(nets, lengths=tuple(rng.integers(1, 4, turns).tolist()))
    q = rng.normal(size=(n + 1, 1))
    sides = (VACUOUS, VERIFIED, VERIFIED) if forest else (VERIFIED, VERIFIED, VACUOUS)
    hold(
        "rooted-averaging",
        Case(law, q, 0.0 * q, 6.0),
        dict(zip(("agreement", "hull", "some-start"), sides, strict=True)),
    )


@given(st.integers(2, 5), st.integers(1, 3), st.floats(0.0, 1.0))
@effort(0.2)
def test_rounds_that_grow_keep_agents_apart(first, growth, share):
    law = fl.scenario("averaging-ever-later").law
    law = replace(law, lengths=(first, 1, first, 1), growth=(growth, 0, growth, 0))
    q = np.array([[0.0], [share], [1.0]])
    hold("growing-windows", Case(law, q, 0.0 * q, 40.0), {"apart": VERIFIED})
    run = fl.simulate(law, q, 0.0 * q, (0.0, 40.0))
    closer = run.q.copy()
    closer[-1, 2] = closer[-1, 0] + 0.9 * (1.0 - 2.0 ** (1 - first))
    claim = theorem("growing-windows").examine(Observed.of(replace(run, q=closer)), Tolerances())[1][0]
    assert (claim.status, claim.contradicts) == ("inconclusive", "growing-windows")
