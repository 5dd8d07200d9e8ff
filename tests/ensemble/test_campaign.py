import json
import os
import time
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from itertools import count

import numpy as np
import pytest
import xarray

from flockana import Tolerances, scenario, verify
from flockana.base.errors import ArgumentError, SolverError, UnknownNameError
from flockana.base.integrity_seals import digest
from flockana.ensemble import PHASES, STATUSES, Store, batches, ensemble, phases, shares
from flockana.ensemble import digest as digests
from flockana.ensemble.digest import digest_of_sources, numerics_version
from flockana.ensemble.executors import Serial, WorkerPool, worker_pool
from flockana.ensemble.one_run import Job, Request, run_batch
from flockana.ensemble.runs import make_runs
from flockana.ensemble.worker_processes import ProcessPool
from flockana.measures.measure import measures
from tests.ensemble import tiny_flocks

SEEDS = range(6)
REQUEST = Request("tests.ensemble.tiny_flocks:trio", ("source",), ())


def same(first, second):
    """To the bit, wall time aside."""
    return first.drop_vars("seconds").identical(second.drop_vars("seconds"))


@pytest.fixture(scope="module")
def alone():
    return ensemble(tiny_flocks.trio, SEEDS, parameters={"speed": [0.1, 2.0], "n": [2, 3, 5]}, jobs=1)


@pytest.fixture(scope="module")
def pool():
    with ProcessPool(2) as executor:
        yield executor


@pytest.mark.slow
def test_the_numbers_do_not_depend_on_who_computes_them(alone, pool):
    grid = {"speed": [0.1, 2.0], "n": [2, 3, 5]}
    assert same(alone, ensemble(tiny_flocks.trio, SEEDS, parameters=grid, executor=pool))
    with ThreadPoolExecutor(3) as executor:
        assert same(alone, ensemble(tiny_flocks.trio, SEEDS, parameters=grid, executor=executor))
        assert executor.submit(int).result() == 0  # it is left running
    backwards = ensemble(tiny_flocks.trio, SEEDS[::-1], parameters={"n": [5, 3, 2], "speed": [2.0, 0.1]}, jobs=1)
    assert same(alone, backwards.sel(seed=list(SEEDS), n=[2, 3, 5]).sel(speed=[0.1, 2.0]).transpose(*alone.dims))


@pytest.mark.slow
def test_theorems_with_linear_algebra_agree_to_the_bit_between_processes(pool):
    """The Hessian's spectrum: threads of linear algebra could round differently."""
    given = {"theorems": ["os-1", "os-5-terminal"], "metrics": tuple(measures())}
    assert same(ensemble("hexagon", [0, 1], **given, jobs=1), ensemble("hexagon", [0, 1], **given, executor=pool))


def test_every_entry_is_that_of_a_run_made_by_hand(alone):
    item = tiny_flocks.trio(3, n=5, speed=2.0)
    run = item.run()
    flocking, source = item.verify(run)
    found = alone.sel(seed=3, n=5, speed=2.0)
    assert found.theorem.values.tolist() == ["alpha-flocking", "source"]
    assert found.claim.values.tolist()[-1] == "source:odd"
    for verdict in (flocking, source):
        assert STATUSES[int(found.verdict.sel(theorem=verdict.theorem))] == verdict.status
        for claim in verdict.claims:
            entry = found.sel(claim=f"{verdict.theorem}:{claim.name}")
            assert STATUSES[int(entry.status)] == claim.status
            assert (float(entry.margin), float(entry.error)) == (claim.margin, claim.error)
    metrics = run.metrics().isel(time=-1)
    for name in (
        "giant_share",
        "normalised_deviation_energy",
        "normalised_velocity_mismatch",
        "cohesion_radius",
        "order",
    ):
        assert float(found[name]) == float(metrics[name]), name
    assert float(found.min_distance) == run.min_distance() < float(metrics.min_distance) == 7.0 * found.end_distance
    assert float(found.components) == 1 + round((1.0 - float(metrics.connectivity)) * 4)
    residual = np.abs(run.energy_residual).max() / np.abs(run.energy()).max()
    assert float(found.energy_residual) == residual < 0.1
    assert (int(found.steps), int(found.evaluations)) == (run.stats["steps"], run.stats["evaluations"])
    assert (int(found.run), str(found.message.item())) == (0, "")


def test_the_seconds_of_runs_are_part_of_the_whole_time():
    started = time.perf_counter()
    found = ensemble(tiny_flocks.trio, SEEDS, jobs=1)
    assert found.seconds.values.min() > 0.0
    assert found.seconds.values.sum() <= time.perf_counter() - started


def test_dimensions_follow_the_parameters_in_their_order(alone):
    assert alone.status.dims == ("speed", "n", "seed", "claim")
    assert alone.n.values.tolist() == [2, 3, 5]
    fixed = ensemble(tiny_flocks.trio, [1], parameters={"n": 4, "fast": True}, theorems=[], jobs=1)
    assert (fixed.steps.dims, int(fixed.steps[0])) == (("seed",), 2)
    assert (int(fixed.n), bool(fixed.fast), fixed.sizes["claim"]) == (4, True, 0)


def test_it_survives_a_netcdf_file(alone, tmp_path):
    alone.to_netcdf(tmp_path / "all.nc", engine="h5netcdf")
    again = xarray.load_dataset(tmp_path / "all.nc", engine="h5netcdf")
    assert same(alone, again)
    assert json.loads(again.tolerances)["quasi"] == Tolerances().quasi
    assert again.mathematics == numerics_version()
    assert again.status.attrs["flag_meanings"].split() == list(STATUSES)


def test_theorems_and_tolerances_are_those_asked_for():
    asked = {"theorems": ["source", "energy"], "metrics": [], "jobs": 1}
    found = ensemble(tiny_flocks.trio, [1], tolerances=Tolerances(quasi=0.5), **asked).squeeze()
    assert found.theorem.values.tolist() == ["energy", "source"]
    assert float(found.margin.sel(claim="source:odd")) == 1.5
    run = tiny_flocks.trio(1).run()
    assert STATUSES[int(found.verdict.sel(theorem="energy"))] == verify("energy", run).status
    assert not {*measures()} & {*found}


def test_shares_count_what_was_decided():
    """Of seeds 0 to 9: 1, 3, 7, 9 verified, 2, 4, 6, 8 refuted, 0 and 5 vacuous."""
    found = ensemble(tiny_flocks.trio, range(10), theorems=["source"], metrics=[], jobs=1)
    table = shares(found, level=0.9).sel(claim="source:odd")
    assert [int(table[name]) for name in (*STATUSES, "runs", "incomplete")] == [4, 4, 2, 0, 10, 0]
    assert table.share.values.tolist() == [0.4, 0.4]
    # scipy.stats.binomtest(4, 10).proportion_ci(0.9, "exact")
    assert float(table.low[0]) == pytest.approx(0.1500282, abs=1e-7)
    assert float(table.high[0]) == pytest.approx(0.6964, abs=1e-4)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_run_that_fails_is_recorded_and_ends_nothing():
    found = ensemble(tiny_flocks.faulty, SEEDS, theorems=["source"], metrics=["order"], jobs=1)
    assert found.run.values.tolist() == [0, 0, 0, 2, 1, 0]
    assert found.message.values[3] == "ValueError: a bad seed"
    assert "4." in found.message.values[4]
    assert found.status.sel(claim="source:odd").values.tolist() == [2, 0, 1, -1, -1, 2]
    assert np.isnan(found.order.values).tolist() == [False, False, False, True, True, False]
    table = shares(found)
    assert (int(table.incomplete), table.runs.values.tolist(), table.verified.values.tolist()) == (2, [4], [1])


@pytest.mark.slow
def test_a_run_that_ends_its_worker_is_found_and_the_others_are_made():
    found = ensemble(tiny_flocks.deadly, range(8), theorems=["source"], metrics=[], jobs=2)
    assert found.run.values.tolist() == [0, 0, 3, 0, 0, 0, 0, 0]
    assert "worker process" in found.message.values[2]


@pytest.mark.slow
def test_workers_that_all_die_end_the_ensemble_with_the_remedy(monkeypatch):
    monkeypatch.setattr(batches, "HOPELESS", 2)
    with pytest.raises(SolverError, match=r"2 worker processes died .*__main__.*jobs=1"):
        ensemble(tiny_flocks.lethal, range(9), theorems=[], jobs=2)


class Brittle(ThreadPoolExecutor):
    """Breaks before its fourth batch, which it refuses, as a process pool does whose worker died since one looked."""

    def __init__(self):
        super().__init__(2)
        self.sent = 0

    def submit(self, function, /, *arguments, **options):
        self.sent += 1
        if self.sent == 4:
            raise BrokenProcessPool("a child process terminated abruptly")
        return super().submit(function, *arguments, **options)


def test_a_pool_that_is_found_broken_by_sending_to_it_loses_nothing_and_blames_nobody():
    with Brittle() as broken, ThreadPoolExecutor(2) as fresh:
        hands = WorkerPool(broken, lambda: 2, renew=lambda: fresh)
        records = [one for batch in make_runs(REQUEST, [Job(seed) for seed in range(8)], hands) for one in batch]
    assert hands.executor is fresh
    assert {one.job.seed: one.status for one in records} == dict.fromkeys(range(8), "complete")


def test_an_executor_that_refuses_work_is_told():
    executor = ThreadPoolExecutor(2)
    executor.shutdown()
    with pytest.raises(SolverError, match="the executor failed: RuntimeError: cannot schedule new futures"):
        ensemble(tiny_flocks.trio, range(4), theorems=[], executor=executor)


@pytest.mark.slow
def test_an_executor_of_dask_gives_the_same_numbers():
    distributed = pytest.importorskip("distributed")
    given = {"theorems": ["os-1"]}
    with distributed.Client(processes=False, n_workers=1, dashboard_address=None, set_as_default=False) as client:
        runs = ensemble("hexagon", [0, 1], **given, executor=client.get_executor(pure=False), jobs=2)
    assert same(runs, ensemble("hexagon", [0, 1], **given, jobs=1))


def test_finished_runs_of_a_failed_executor_are_kept_and_a_new_one_goes_on(tmp_path):
    class OneBatch(Serial):
        left = 1

        def submit(self, function, /, *arguments, **options):
            if not self.left:
                raise RuntimeError("the machine is gone")
            self.left -= 1
            return super().submit(function, *arguments, **options)

    store = tmp_path / "runs.sqlite"
    with pytest.raises(
        SolverError, match=r"the machine is gone; runs in a store are kept: make the same call with a new"
    ):
        ensemble(tiny_flocks.trio, range(4), theorems=[], executor=OneBatch(), store=store)
    with Store(store) as kept:
        assert 0 < len(kept) < 4
    whole = ensemble(tiny_flocks.trio, range(4), theorems=[], executor=Serial(), store=store)
    assert same(whole, ensemble(tiny_flocks.trio, range(4), theorems=[], jobs=1))


def test_a_broken_executor_of_the_users_is_told_from_a_bad_run():
    with ProcessPool(1) as executor, pytest.raises(SolverError, match="the executor failed: BrokenProcessPool"):
        ensemble(tiny_flocks.lethal, range(4), theorems=[], executor=executor)


@pytest.mark.slow
def test_workers_load_kernels_and_keep_to_one_thread(monkeypatch):
    """What an earlier run compiled comes from numba's cache; the parent's own setting stays."""
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "7")
    ensemble(tiny_flocks.trio, [0], jobs=1)
    asked = [tiny_flocks.compilations, tiny_flocks.threads]
    for _ in range(3):  # other processes that compile at the same moment may spoil the cache's index, but not for ever
        with ProcessPool(1) as pool:
            found = ensemble(tiny_flocks.trio, range(4), metrics=asked, executor=pool)
        assert found.threads.values.tolist() == [1.0] * 4
        if not found.compilations.values.any():
            break
    assert found.compilations.values.tolist() == [0.0] * 4
    assert os.environ["OPENBLAS_NUM_THREADS"] == "7"


@pytest.mark.parametrize("metric", [tiny_flocks.interrupts, tiny_flocks.interrupts_a_kernel])
def test_ctrl_c_ends_it_and_keeps_what_was_done(metric, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        ensemble(tiny_flocks.trio, SEEDS, theorems=[], metrics=[metric], jobs=1, store=tmp_path / "s.sqlite")
    with Store(tmp_path / "s.sqlite") as store:
        assert len(store) in (1, 2, 3)  # the seeds before 3, those of its batch apart


def test_a_worker_with_other_mathematics_is_refused():
    request = Request("hexagon", (), (), mathematics="0" * 16)
    with pytest.raises(SolverError, match=f"version {numerics_version()} of the mathematics, expected 0{{16}}"):
        run_batch(request, (Job(0),))


def test_the_mathematics_change_with_what_computes_and_with_nothing_else(monkeypatch):
    root = digests.Path(digests.__file__).resolve().parent.parent
    names = {path.relative_to(root).as_posix() for path in digests.source_files(root)}
    assert {
        "kernels/alpha.py",
        "dynamics/driver.py",
        "sources/olfati_saber_2006/theorems/theorem_1_free_flock.py",
        "base/errors.py",
    } <= names
    assert {
        "sources/isola_2024/scenarios/cases.py",
        "measures/standard_measures.py",
        "equilibria/strained13.json",
    } <= names
    silent = ("plots/", "plots.py", "figures", "report/", "player/", "explore/", "course/", "cli/", "falsify/")
    assert not any(part in name for part in silent for name in names)
    assert not {"ensemble/store.py", "base/bibtex_entries.py", "_version.py", "__init__.py"} & names
    source = b'def f(x):\n    """Doc."""\n    return x + 1\n'
    base = digest_of_sources({"a.py": source})
    assert digest_of_sources({"a.py": source.replace(b"Doc.", b"Other.") + b"# more\n"}) == base
    assert digest_of_sources({"a.py": source.replace(b"1", b"2")}) != base
    assert digest_of_sources({"b.py": source}) != base
    monkeypatch.setattr(digests, "version", lambda name: "0")
    assert digest_of_sources({"a.py": source}) != base


def test_keys_differ_wherever_a_number_could():
    base = Request("hexagon").to_dict() | {"seed": 1, "options": {"n": 3}}
    others = (
        {"seed": 2},
        {"options": {"n": 4}},
        Request("hexagon", ("os-1",)).to_dict(),
        Request("hexagon", tolerances=Tolerances(quasi=0.2)).to_dict(),
        Request("hexagon", metrics=("order",)).to_dict(),
        Request("hexagon", mathematics="other").to_dict(),
    )
    assert len({digest(base), *(digest(base | other) for other in others)}) == 7


def test_phases_in_their_order():
    """Collapse before fragmentation, fragmentation before motion; strained or moving flocks are neither."""
    cases = [
        ("flocking", 0.9, 1.0, 1e-5, 0.01),
        ("fragmentation", 0.9, 2.0, 9.0, 0.01),
        ("collapse", 0.049, 2.0, 0.0, 0.0),
        ("other", 0.9, 1.0, 2e-4, 0.01),
        ("other", 0.9, 1.0, 1e-5, 0.06),
    ]
    names = ("end_distance", "components", "slip", "normalised_deviation_energy")
    runs = xarray.Dataset({name: ("seed", [case[k + 1] for case in cases] + [np.nan]) for k, name in enumerate(names)})
    assert phases(runs).values.tolist() == [*(PHASES.index(case[0]) for case in cases), -1]
    assert PHASES[phases(runs, contact=0.04).values[2]] == "fragmentation"
    assert PHASES[phases(runs, tolerances=Tolerances(mismatch=1e-3)).values[3]] == "flocking"
    with pytest.raises(ArgumentError, match="lacks components"):
        phases(runs.drop_vars("components"))
    saved_once = runs.rename(normalised_deviation_energy="deviation_energy")
    np.testing.assert_array_equal(phases(saved_once), phases(runs))


def test_the_family_of_phases_holds_what_it_says():
    found = ensemble("phase", [0], theorems=[], parameters={"ratio": [0.0, 0.02, 2.0], "n": 12}, jobs=1)
    assert [PHASES[code] for code in phases(found).values.ravel()] == ["fragmentation", "flocking", "collapse"]
    item = scenario("phase", 3, density=0.5, n=8)
    side = 7.0 * np.sqrt(8 / 0.5)
    assert 0.3 * side < np.abs(item.q0).max() < 0.5 * side
    assert item.law.gains.c1_gamma == 0.01 * item.law.gains.c1_alpha


BAD = [
    ({"scenario": "hexagn"}, UnknownNameError, "did you mean 'hexagon'"),
    ({"scenario": 3}, ArgumentError, "scenario = 3: expected a name"),
    ({"scenario": lambda seed: None}, ArgumentError, "top of a module"),
    ({"seeds": []}, ArgumentError, "empty; expected"),
    ({"seeds": 200}, ArgumentError, r"seeds = 200: expected several .*range\(200\)"),
    ({"seeds": [1, 2, 1]}, ArgumentError, "seed 1 comes twice"),
    ({"seeds": range(10**11)}, ArgumentError, "seeds: there are more than 1000000; expected at most so many, split"),
    ({"seeds": count()}, ArgumentError, "seeds: there are more than 1000000"),
    ({"parameters": {"ratio": count()}}, ArgumentError, "ratio: there are more than 1000000 values"),
    (
        {"seeds": range(1001), "parameters": {"ratio": range(1000)}},
        ArgumentError,
        "1001000 runs: expected at most 1000000, seeds times values of options; split",
    ),
    ({"seeds": [1, -2]}, ArgumentError, "seed -2"),
    ({"seeds": [True]}, ArgumentError, "seed True"),
    ({"theorems": ["os-9"]}, UnknownNameError, "unknown theorem 'os-9'"),
    ({"theorems": ["E8"]}, ArgumentError, "E8 is not about a run"),
    ({"theorems": "os-1"}, ArgumentError, "expected several, such as"),
    ({"parameters": {"m": 2}}, ArgumentError, "hexagon has no option m"),
    ({"scenario": "phase", "parameters": {"density": [1.0, 0.0]}}, ArgumentError, "density = 0"),
    ({"scenario": "phase", "parameters": {"density": []}}, ArgumentError, "at least one value"),
    ({"scenario": "phase", "parameters": {"n": [20, 20]}}, ArgumentError, "all different"),
    ({"scenario": "phase", "parameters": {"n": [(1, 2)]}}, ArgumentError, r"n = \(1, 2\)"),
    ({"scenario": tiny_flocks.trio, "parameters": {"colour": 1}}, ArgumentError, "colour"),
    ({"scenario": tiny_flocks.trio, "parameters": {"order": [1, 2]}}, ArgumentError, "another variable of that name"),
    ({"metrics": ["speed"]}, UnknownNameError, "unknown metric 'speed'"),
    ({"tolerances": 0.1}, ArgumentError, "tolerances = 0.1"),
    ({"executor": "pool"}, ArgumentError, "executor = 'pool'"),
    ({"jobs": 0}, ArgumentError, "jobs = 0"),
]


@pytest.mark.parametrize(("changes", "kind", "message"), BAD)
def test_bad_input_is_refused_before_any_work(changes, kind, message, tmp_path):
    given = {"scenario": "hexagon", "seeds": [0], "store": tmp_path / "s.sqlite"} | changes
    with pytest.raises(kind, match=message):
        ensemble(given.pop("scenario"), given.pop("seeds"), **given)
    assert not (tmp_path / "s.sqlite").exists()


def test_what_no_scenario_is_becomes_an_error_of_its_run():
    found = ensemble(tiny_flocks.not_a_scenario, [5], jobs=1)
    assert "returned int: expected a Scenario" in found.message.values[0]


def test_shares_want_an_ensemble(alone):
    with pytest.raises(ArgumentError, match=r"expected what flockana\.ensemble returned"):
        shares(xarray.Dataset())
    with pytest.raises(ArgumentError, match="level = 95"):
        shares(alone, level=95)


def test_a_users_executor_is_kept_as_busy_as_it_is_wide():
    with ThreadPoolExecutor(5) as executor, worker_pool(executor) as hands:
        assert hands.width() == 5


def test_batches_grow_with_short_runs_and_shrink_towards_the_end():
    """1000 runs of a millisecond for 2 workers: batches of 250, then ever fewer, four of them out at once."""
    waiting = deque(range(1000))
    sent = [len(batch) for batch in batches.next_batches(waiting, deque(), 0, 2, 500)]
    assert sent == [250, 187, 140, 105]
    assert [len(batch) for batch in batches.next_batches(waiting, deque(), 3, 2, 10)] == [10]
    assert list(batches.next_batches(waiting, deque([7]), 1, 2, 10)) == []
    assert list(batches.next_batches(waiting, deque([7]), 0, 2, 10)) == [(7,)]
