"""Threads: the same bits for any number of them, in new and forked processes, under each of numba's layers."""

import shutil
import subprocess
import sys

import numpy as np
import pytest

from flockana.jit import launch_threads
from flockana.kernels.cell_grid import LARGE, cut_into_slabs, empty_cuts, sort_into_grid
from flockana.kernels.large_flocks import fill
from flockana.kernels.slab_steps import covered_by_threads
from flockana.kernels.thread_counts import ensure_threads
from flockana.kernels.verlet_list import COUNT, covers, list_pairs, no_pairs
from tests.refused import refused

SCRIPT = """
import hashlib, os, sys
from concurrent.futures import ThreadPoolExecutor
import numpy as np
import flockana as fl
from flockana.kernels.large_flocks import fill
from flockana.kernels.runge_kutta import energy_of, rate_of
from flockana.kernels.thread_counts import limited_threads, several_threads
from flockana.kernels.verlet_list import no_pairs

LAWS = {"alpha": fl.Algorithm1(), "dead zone": fl.DeadZoneFlocking()}

def flock(n, m):
    rng, side = np.random.default_rng(n + m), n ** (1.0 / m)
    return rng.uniform(0.0, 1.0, (n, m)) * [9.0 * side, *[5.0 * side] * (m - 1)], rng.normal(size=(n, m))

def told(*arrays):
    return hashlib.sha256(b"".join(np.ascontiguousarray(each).tobytes() for each in arrays)).hexdigest()[:12]

def run(threads, n=10_001, m=2, speed=1.0):
    q, p = flock(n, m)
    made = fl.simulate(LAWS["alpha"], q, speed * p, (0.0, 0.02), method="RK4", dt=0.01, threads=threads)
    assert (made.stats["redone"] > 0) == (speed > 1.0)
    return told(made.q, made.p, made.u, made.extra["work"])

def fast(threads):
    return run(threads, m=3, speed=150.0)

def forces(threads, n=10_001):
    law, flocks = LAWS["alpha"], [flock(n, m) for m in (1, 2, 3)]
    with limited_threads(threads):
        return told(*(x for each in flocks for x in (*law.flow(0.0, *each), law.energy(0.0, *each))))

def rate(name, threads, n=10_001, m=2):
    q, p = flock(n, m)
    form = LAWS[name].compiled(m)
    y, f = np.concatenate([q.ravel(), p.ravel(), [0.0]]), np.empty(2 * n * m + 1)
    system = form.system((0.0, np.zeros(m), np.zeros(m)), n, m)
    with several_threads(threads) as several:
        assert several == (threads > 1)
        system = form.in_threads(system) if several else system
        pairs = fill(no_pairs(n, m), q, sum(system.reach), several)
        rate_of(0.0, y, f, system, pairs)
        return told(f, energy_of(0.0, y, system, pairs), pairs.cuts[: pairs.cuts[0] + 2])
"""
RATES = """
for name in sys.argv[1:]:
    print(*(rate(name, k) for k in ({0})))
"""
FORKS = """
first = run(2)
reader, writer = os.pipe()
if os.fork() == 0:
    os.write(writer, run(2).encode())
    os._exit(0)
assert os.waitstatus_to_exitcode(os.wait()[1]) == 0
print(first, os.read(reader, 99).decode(), run(2))
"""
AT_ONCE = """
with ThreadPoolExecutor(4) as pool:
    print(*pool.map(run, [2] * 4), run(1))
"""
MANY = """
for told_by in (run, fast, forces, lambda k: rate("alpha", k, m=3)):
    print(*(told_by(k) for k in (1, 2, 3, 8)))
"""

SMALL = """
from flockana.jit import Kernel

made = fl.simulate(LAWS["alpha"], *flock(12, 2), (0.0, 0.02), method="RK4", dt=0.01)
for name, module in [each for each in sys.modules.items() if each[0].startswith("flockana")]:
    for key, value in vars(module).items():
        if isinstance(value, Kernel) and any(part in key for part in ("parallel", "threads", "parts", "slab")):
            assert "dispatcher" not in vars(value), (name, key)
print("none", "none")
"""


def same(body, *arguments, layer="default", before=(), **environment):
    """Run a script in a new process; each of its lines must be of equal words. Return the first of each."""
    variables = {"NUMBA_NUM_THREADS": "8", "NUMBA_THREADING_LAYER": layer, **environment}
    variables = [f"{key}={value}" for key, value in variables.items()]
    call = [*before, "env", "-u", "OMP_NUM_THREADS", *variables, sys.executable, "-c", SCRIPT + body, *arguments]
    told = subprocess.run(call, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    lines = [line.split() for line in told.stdout.splitlines()]
    assert [(len(line) > 1, len(set(line))) for line in lines] == [(True, 1)] * len(lines), lines
    return [line[0] for line in lines]


@pytest.mark.slow
def test_any_number_of_threads_gives_the_same_bits_under_each_layer():
    assert same(MANY) == same(MANY, layer="workqueue")


@pytest.mark.slow
@pytest.mark.parametrize("layer", ["default", "workqueue"])
@pytest.mark.parametrize("body", [FORKS, AT_ONCE], ids=["forks", "at once"])
def test_forked_children_and_four_threads_at_once_compute_the_same(body, layer):
    same(body, layer=layer)


@pytest.mark.slow
def test_laws_compiled_by_two_processes_are_loaded_by_a_third(tmp_path):
    """Without random addresses: numba names the loops of several threads by the address of an object."""
    cold = {"NUMBA_CACHE_DIR": str(tmp_path), "before": ["setarch", "-R"] if shutil.which("setarch") else []}
    apart = [same(RATES.format("2, 2"), name, **cold)[0] for name in ("alpha", "dead zone")]
    assert len(set(apart)) == 2
    assert same(RATES.format("2, 1, 8"), "dead zone", "alpha", **cold) == apart[::-1]
    assert same(RATES.format("2, 1, 8"), "alpha", "dead zone", layer="workqueue", **cold) == apart


def test_a_small_flock_compiles_nothing_for_threads_or_slabs():
    same(SMALL)


@pytest.mark.slow
@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("longest", [0, -1])
def test_slabs_hold_every_pair_and_even_ones_share_no_agent(m, longest):
    rng = np.random.default_rng(m)
    q = rng.uniform(0.0, 1.0, (LARGE, m)) * (3.0 * LARGE ** (1.0 / m))
    q[:, longest] *= 5.0
    pairs, (first, second) = fill(no_pairs(LARGE, m), q, 4.0), np.empty((2, 40 * LARGE), np.uint32)
    count, slabs = int(pairs.counts[COUNT]), int(pairs.cuts[0])
    assert slabs > 40
    assert list_pairs(q, 4.0, first, second) == count == pairs.cuts[slabs + 1]
    np.testing.assert_array_equal(pairs.first[:count], first[:count])
    np.testing.assert_array_equal(pairs.second[:count], second[:count])
    for parity in range(2):
        agents = []
        for s in range(parity, slabs, 2):
            part = slice(pairs.cuts[s + 1], pairs.cuts[s + 2])
            agents.append(np.union1d(pairs.first[part], pairs.second[part]))
        assert sum(each.size for each in agents) == np.unique(np.concatenate(agents)).size
    sizes = np.diff(pairs.cuts[1 : slabs + 2])
    assert sizes.max() < 4 * sizes.mean()


def test_a_small_flock_is_one_slab_and_one_place_is_too():
    q = np.random.default_rng(0).uniform(0.0, 300.0, (LARGE - 1, 2))
    pairs = fill(no_pairs(*q.shape), q, 4.0)
    assert pairs.cuts.tolist() == [1, 0, pairs.counts[COUNT]]
    _, start, rows = sort_into_grid(np.zeros((LARGE, 2)), 1.0)
    assert cut_into_slabs(start, rows, empty_cuts(LARGE)) == 1


def test_a_list_by_threads_holds_as_long_as_by_one():
    rng = np.random.default_rng(3)
    launch_threads()
    for m in (1, 2, 3):
        q = rng.uniform(-300.0, 300.0, (LARGE, m))
        pairs = no_pairs(*q.shape)._replace(places=q, reach=np.array([11.0]))
        for later in (q + 5.0, 0.95 * q, 0.9 * q, 1.2 * q, q + rng.normal(0.0, 0.1, q.shape), -q, np.nan * q):
            for within in (9.0, 10.0, 10.6):
                assert covered_by_threads(pairs, later, within) == covers(pairs, later, within)


test_numbers_of_threads_that_numba_lacks_are_refused = refused(
    *((k, f"threads = {k}: expected a number from 1 to") for k in (0, 10**6, 1.5, True)), make=ensure_threads
)
