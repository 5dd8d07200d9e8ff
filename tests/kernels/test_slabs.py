"""Slabs of a list: they cover it, those summed at once share no agent, and threads change no bit."""

from __future__ import annotations

import os
import subprocess
import sys
from itertools import pairwise

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError
from flockana.kernels import verlet
from flockana.kernels.verlet import list_pairs
from flockana.laws.semi_implicit import SemiImplicitEuler

NUMBERS = pytest.importorskip("numba").config.NUMBA_NUM_THREADS
R = 8.4


def listed(q):
    few = np.empty(1, np.uint32)
    first, second, count, slabs = list_pairs(q, R, few, few)
    return first[:count], second[:count], slabs


def gas(n, m, stretch=1.0, seed=0):
    side = 7.0 * n ** (1.0 / m)
    q = np.random.default_rng(seed).uniform(0.0, side, (n, m))
    q[:, 0] *= stretch
    return q


@pytest.mark.parametrize(
    ("q", "most"),
    [
        (gas(5000, 2), 2),
        (gas(40_000, 2), 16),
        (gas(30_000, 1), 14),
        (gas(60_000, 3), 16),
        (gas(9000, 2, stretch=3.0), 4),
        (gas(9000, 2, stretch=0.02), 4),
        (gas(9000, 2, stretch=0.02)[:, ::-1].copy(), 3),  # a row of cells has more agents than a slab needs
        (gas(2000, 2), 1),
        (np.concatenate([gas(5000, 2), [[1e7, 1e7]]]), 1),  # no grid
    ],
)
def test_slabs_cover_the_list_and_every_other_one_shares_no_agent(q, most):
    first, second, slabs = listed(q)
    assert (slabs[0], slabs[-1]) == (0, len(first))
    assert np.all(np.diff(slabs) >= 0)
    assert len(slabs) - 1 <= most
    touched = [np.union1d(first[a:b], second[a:b]) for a, b in pairwise(slabs)]
    for parity in (touched[::2], touched[1::2]):
        assert sum(map(len, parity)) == (len(np.unique(np.concatenate(parity))) if parity else 0)


def test_there_are_several():
    assert len(listed(gas(40_000, 2))[2]) - 1 == 16


@pytest.mark.skipif(NUMBERS < 2, reason="there is one core")
@pytest.mark.parametrize(("m", "options"), [(2, {"method": "RK4", "dt": 0.02}), (3, {"rtol": 1e-4})])
def test_threads_change_no_bit(m, options):
    n, rng = 9000, np.random.default_rng(m)
    q, p = gas(n, m), rng.normal(size=(n, m))
    law = fl.Algorithm2(target=fl.LinearTarget((0.0,) * m, (1.0,) * m))
    one, two = (
        fl.simulate(law, q, p, (0.0, 0.04), t_eval=[0.0, 0.04], threads=threads, **options) for threads in (1, 2)
    )
    for name in "qpu":
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name))
    np.testing.assert_array_equal(one.extra["work"], two.extra["work"])
    # and the sum is that of all pairs, whatever its order
    exact = law.flow(0.04, one.q[-1], one.p[-1])[0]
    np.testing.assert_allclose(one.u[-1], exact, rtol=0.0, atol=1e-10 * np.abs(exact).max())


def test_a_small_flock_is_one_slab_and_a_large_one_is_summed_as_listed():
    assert verlet._SHARE > 1000  # else small runs pay for slabs
    assert len(listed(gas(1000, 2))[2]) == 2


@pytest.mark.parametrize(
    ("threads", "message"),
    [
        (0, "threads = 0: expected a whole number >= 1"),
        (True, "threads = True: expected a whole number"),
        (10**6, f"threads = 1000000: expected 1 to {NUMBERS}, the number of cores"),
    ],
)
def test_a_number_of_threads_that_there_is_not(threads, message):
    with pytest.raises(ArgumentError, match=message):
        fl.simulate(fl.Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0), threads=threads)


@pytest.mark.skipif(NUMBERS < 2, reason="there is one core")
@pytest.mark.parametrize("how", [{"method": "LSODA"}, {"method": "scipy-DOP853"}])
def test_a_run_that_is_not_compiled_takes_one(how):
    with pytest.raises(ArgumentError, match="threads = 2: this run of Algorithm1 is not compiled; expected 1"):
        fl.simulate(fl.Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0), threads=2, **how)
    law = SemiImplicitEuler(fl.DeadZoneFlocking(), dt=0.02)
    with pytest.raises(ArgumentError, match="threads = 2: the steps of a discrete law take one"):
        fl.simulate(law, [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0), threads=2)


FORKED = """
import os
import flockana as fl
from flockana.base.errors import ArgumentError

def run():
    return fl.simulate(fl.Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0), threads=2).status

assert run() == "complete"
child = os.fork()
if not child:
    try:
        run()
    except ArgumentError as error:
        os._exit(7 if "processes that are spawned" in str(error) else 1)
    os._exit(2)
assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
"""

AT_ONCE = """
from threading import Thread
import flockana as fl
ended = []
def run():
    ended.append(fl.simulate(fl.Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 9.0), threads=2).status)
both = [Thread(target=run), Thread(target=run)]
[each.start() for each in both]
[each.join() for each in both]
assert ended == ["complete", "complete"]
"""


@pytest.mark.skipif(NUMBERS < 2 or not hasattr(os, "fork"), reason="there is one core, or no fork")
def test_a_forked_process_is_refused_threads_before_openmp_ends_it():
    subprocess.run([sys.executable, "-c", FORKED], check=True, timeout=300)


@pytest.mark.skipif(NUMBERS < 2, reason="there is one core")
def test_two_threads_of_a_program_may_both_ask_for_threads():
    environment = os.environ | {"NUMBA_THREADING_LAYER": "workqueue"}
    subprocess.run([sys.executable, "-c", AT_ONCE], check=True, timeout=300, env=environment)
