from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
import tiny_flocks

from flockana.ensemble import Store, ensemble, executors
from flockana.errors import ArgumentError, SolverError

pytest.importorskip("distributed")
HERE = Path(__file__).parent
RUNS = 40


def started(arguments, environment):
    command = [sys.executable, "-m", "distributed.cli." + arguments[0], *arguments[1:]]
    return subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """A scheduler and two worker processes on loopback; gives address, file that logs every run begun, scheduler."""
    folder = tmp_path_factory.mktemp("cluster")
    file, log = folder / "scheduler.json", folder / "log"
    paths = [str(HERE), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, paths)), tiny_flocks.LOG: str(log)}
    local = ["--host", "127.0.0.1", "--scheduler-file", str(file)]
    running = [started(["dask_scheduler", *local, "--port", "0", "--no-dashboard"], environment)]
    try:
        for _ in range(2):
            worker = ["dask_worker", *local, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
            running.append(started([*worker, "--local-directory", str(folder)], environment))
        for _ in range(600):
            if file.exists() and file.stat().st_size:
                break
            time.sleep(0.05)
        yield json.loads(file.read_text())["address"], log, running[0]
    finally:
        for process in running:
            process.kill()
        for process in running:
            process.wait()


def begun(log):
    return [tuple(map(int, line.split())) for line in log.read_text().splitlines()] if log.exists() else []


def test_a_worker_killed_in_mid_run_loses_nothing(cluster, tmp_path, monkeypatch):
    """Batches of one run each, so that many are out when the worker dies."""
    address, log, _ = cluster
    monkeypatch.setattr(executors, "_BATCH_SECONDS", 0.0)
    killed = []

    def kill():
        for _ in range(2400):
            if len(begun(log)) >= 12 and len({process for process, _ in begun(log)}) == 2:
                killed.append(begun(log)[-1][0])
                os.kill(killed[0], signal.SIGKILL)
                return
            time.sleep(0.01)

    thread = threading.Thread(target=kill)
    thread.start()
    given = {"theorems": ["source"]}
    found = ensemble(tiny_flocks.slow, range(RUNS), **given, cluster=address, store=tmp_path / "s.sqlite")
    thread.join()
    assert len(killed) == 1
    assert {process for process, _ in begun(log)[-5:]} != set(killed)
    assert not found.run.values.any()
    pool = ensemble(tiny_flocks.trio, range(RUNS), **given, jobs=2).assign_attrs(scenario=found.attrs["scenario"])
    assert found.drop_vars("seconds").identical(pool.drop_vars("seconds"))
    with Store(tmp_path / "s.sqlite") as kept:
        assert len(kept) == RUNS


def test_the_same_runs_are_made_again_when_they_are_asked_for_again(cluster):
    """Dask would by default give the first call's results to the second."""
    address, log, _ = cluster
    before = len(begun(log))
    for _ in range(2):
        ensemble(tiny_flocks.trio, [3], theorems=[], metrics=[], cluster=address)
    assert len(begun(log)) == before + 2


def test_a_scheduler_lost_in_mid_run_ends_the_ensemble_and_what_was_done_is_kept(cluster, tmp_path, monkeypatch):
    """The last test that uses the cluster."""
    address, log, scheduler = cluster
    monkeypatch.setattr(executors, "_BATCH_SECONDS", 0.0)
    before = len(begun(log))

    def kill():
        while len(begun(log)) < before + 12:
            time.sleep(0.01)
        scheduler.kill()

    threading.Thread(target=kill, daemon=True).start()
    given = {"theorems": [], "metrics": [], "store": tmp_path / "s.sqlite"}
    with pytest.raises(SolverError, match=r"the executor failed: .*runs in a store are kept"):
        ensemble(tiny_flocks.slow, range(500), cluster=address, **given)
    with Store(tmp_path / "s.sqlite") as kept:
        assert 0 < len(kept) < 500


def test_no_scheduler_is_told_with_the_remedy(monkeypatch):
    monkeypatch.setattr(executors, "_CONNECT", 0.3)
    for address in ("tcp://127.0.0.1:1", "nowhere-at-all:x"):
        with pytest.raises(SolverError, match=r"no scheduler with a worker .*dask scheduler"):
            ensemble(tiny_flocks.trio, [0], cluster=address)


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ArgumentError, match=r"pip install 'flockana\[cluster\]'"):
        ensemble(tiny_flocks.trio, [0], cluster="local")


def test_a_cluster_of_ones_own_starts_and_ends():
    found = ensemble(tiny_flocks.trio, range(4), theorems=["source"], metrics=[], cluster="local", jobs=1)
    assert found.drop_vars("seconds").identical(
        ensemble(tiny_flocks.trio, range(4), theorems=["source"], metrics=[], jobs=1).drop_vars("seconds")
    )
