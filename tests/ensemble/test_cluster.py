import gc
import json
import os
import signal
import socket
import subprocess
import sys
import threading
from contextlib import ExitStack, contextmanager, nullcontext
from multiprocessing import active_children, spawn
from pathlib import Path

import pytest

from flockana.base.errors import ArgumentError, SolverError
from flockana.ensemble import Store, cluster, ensemble, runs
from tests.ensemble import tiny_flocks
from tests.ensemble.tiny_flocks import begun
from tests.programs import ANSWERS_CTRL_C, group, interrupt, posix, program, until

distributed = pytest.importorskip("distributed")
pytestmark = posix
ROOT = Path(__file__).parents[2]
RUNS = 40


@pytest.fixture(autouse=True)
def patient(monkeypatch):
    """Who is there answers in the end, however busy the machine; the tests of who is not there set limits of theirs."""
    for limit in ("CONNECT", "START", "ALONE"):
        monkeypatch.setattr(cluster, limit, 500.0)


def dask(kind, file, environment, *options):
    """A scheduler or a worker on loopback, with its own folder for its files."""
    command = ["-m", f"distributed.cli.dask_{kind}", "--host", "127.0.0.1", "--scheduler-file", file, *options]
    own = environment | {"DASK_TEMPORARY_DIRECTORY": str(file.parent)}
    return program(*command, environment=own, paths=[ROOT], output=subprocess.DEVNULL)


def scheduler(file, environment):
    return dask("scheduler", file, environment, "--port", "0", "--no-dashboard")


def worker(file, environment):
    return dask("worker", file, environment, "--nthreads", "1", "--no-nanny", "--no-dashboard")


@pytest.fixture
def running(tmp_path):
    """A scheduler and two worker processes on loopback: its address, the runs begun, the gate of gated ones, itself."""
    file, log, gate = tmp_path / "scheduler.json", tmp_path / "log", tmp_path / "gate"
    environment = {tiny_flocks.LOG: str(log), tiny_flocks.GATE: str(gate)}
    with ExitStack() as stack:
        master = stack.enter_context(scheduler(file, environment))
        until(lambda: file.exists() and file.stat().st_size, master)
        workers = [stack.enter_context(worker(file, environment)) for _ in range(2)]
        address = json.loads(file.read_text())["address"]
        with distributed.Client(address, timeout=500.0, set_as_default=False) as client:
            until(lambda: len(client.nthreads()) == 2, master, *workers)
        yield address, log, gate, master


@contextmanager
def meanwhile(condition, act, *alive):
    """Do something in another thread as soon as a condition holds."""
    given_up, failures = threading.Event(), []

    def watch():
        try:
            until(lambda: given_up.is_set() or condition(), *alive)
            if not given_up.is_set():
                act()
        except BaseException as error:
            failures.append(error)

    thread = threading.Thread(target=watch)
    thread.start()
    try:
        yield
    finally:
        given_up.set()
        thread.join()
    assert failures == []


def test_runs_asked_for_again_are_made_again_and_a_worker_killed_in_mid_run_loses_nothing(
    running, tmp_path, monkeypatch
):
    """Dask would by default give the first call's results to the second.

    Then in batches of one run each, so that many are out when the worker dies; it is held in one of them.
    """
    address, log, gate, _ = running
    for _ in range(2):
        ensemble(tiny_flocks.trio, [3], theorems=[], metrics=[], cluster=address)
    assert len(begun(log)) == 2
    monkeypatch.setattr(runs, "BATCH_SECONDS", 0.0)
    killed = []

    def held():
        return [process for process, seed in begun(log) if seed >= 24]

    def kill():
        killed.append(held()[0])
        os.kill(killed[0], signal.SIGKILL)
        gate.touch()

    given = {"theorems": ["source"]}
    with meanwhile(held, kill):
        found = ensemble(tiny_flocks.gated, range(RUNS), **given, cluster=address, store=tmp_path / "s.sqlite")
    assert len(killed) == 1
    assert begun(log)[-1][0] != killed[0]
    assert not found.run.values.any()
    here = ensemble(tiny_flocks.trio, range(RUNS), **given, jobs=1).assign_attrs(scenario=found.attrs["scenario"])
    assert found.drop_vars("seconds").identical(here.drop_vars("seconds"))
    with Store(tmp_path / "s.sqlite") as kept:
        assert len(kept) == RUNS


def test_a_scheduler_lost_in_mid_run_ends_the_ensemble_and_what_was_done_is_kept(running, tmp_path, monkeypatch):
    address, _, _, master = running
    monkeypatch.setattr(runs, "BATCH_SECONDS", 0.0)
    monkeypatch.setattr(cluster, "CONNECT", 20.0)  # after which Dask gives up a scheduler that it has lost
    path = tmp_path / "s.sqlite"

    def some_are_kept():
        if not path.exists():
            return False
        with Store(path) as store:
            return len(store)

    given = {"theorems": [], "metrics": [], "store": path}
    with (
        meanwhile(some_are_kept, master.kill),
        pytest.raises(SolverError, match=r"the executor failed: .*runs in a store are kept"),
    ):
        ensemble(tiny_flocks.gated, range(RUNS), cluster=address, **given)
    with Store(path) as kept:
        assert 0 < len(kept) <= 24


def test_a_scheduler_that_falls_silent_ends_the_ensemble(running, monkeypatch):
    """Stopped, not ended: its connections stay open."""
    address, log, _, master = running
    monkeypatch.setattr(cluster, "ALONE", 5.0)
    with (
        meanwhile(lambda: any(seed >= 24 for _, seed in begun(log)), lambda: os.kill(master.pid, signal.SIGSTOP)),
        pytest.raises(SolverError, match=r"the executor failed: Dask's scheduler does not answer .*are kept"),
    ):
        ensemble(tiny_flocks.gated, range(RUNS), theorems=[], metrics=[], cluster=address)


def test_a_cluster_whose_workers_are_gone_for_good_is_given_up(running, monkeypatch):
    address, log, _, _ = running
    monkeypatch.setattr(cluster, "ALONE", 5.0)
    monkeypatch.setattr(runs, "BATCH_SECONDS", 0.0)

    def both_at_work():
        return len({process for process, _ in begun(log)}) == 2 and any(seed >= 24 for _, seed in begun(log))

    def kill():
        for process in {process for process, _ in begun(log)}:
            os.kill(process, signal.SIGKILL)

    with (
        meanwhile(both_at_work, kill),
        pytest.raises(SolverError, match=r"the cluster has had no worker for 5 s; runs in a store are kept"),
    ):
        ensemble(tiny_flocks.gated, range(RUNS), theorems=[], metrics=[], cluster=address)


@contextmanager
def server(answer):
    """An address on loopback; each connection is handed to `answer`. Gives the connections that came, too."""
    came = []

    def serve():
        while True:
            try:
                connection, _ = listening.accept()
            except OSError:
                return
            came.append(connection)
            answer(connection)

    listening = socket.create_server(("127.0.0.1", 0))
    thread = threading.Thread(target=serve)
    thread.start()
    try:
        yield f"tcp://127.0.0.1:{listening.getsockname()[1]}", came
    finally:
        listening.shutdown(socket.SHUT_RDWR)
        listening.close()
        thread.join()
        for connection in came:
            connection.close()


@contextmanager
def nothing_left():
    """No thread, no process, no open client: one of these would close itself by chance, at worst under Dask's lock."""

    def now():  # Dask keeps one thread for all that follows
        return {one for one in threading.enumerate() if "Offload" not in one.name}, {*active_children()}

    before = now()
    yield
    assert {one.status for one in gc.get_objects() if issubclass(type(one), distributed.Client)} <= {"closed"}
    until(lambda: now() == before)  # the thread in which Dask waits for a process outlives that by a moment


def silent(connection):
    pass


def closing(connection):
    connection.close()


def of_another_kind(connection):
    connection.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n" * 20)


ADDRESSES = ["tcp://127.0.0.1:1", "nowhere-at-all:x", "no such address", "odd://127.0.0.1:8"]


@pytest.mark.parametrize("there", [silent, closing, of_another_kind, *ADDRESSES])
def test_where_no_scheduler_is_is_told_with_the_remedy(there, monkeypatch):
    monkeypatch.setattr(cluster, "CONNECT", 0.5)
    message = r"no scheduler with a worker answers within 0\.5 s \(.+\); .*dask scheduler"
    serving = nullcontext((there, None)) if isinstance(there, str) else server(there)
    with serving as (address, _), nothing_left(), pytest.raises(SolverError, match=message):
        ensemble(tiny_flocks.trio, [0], cluster=address)


@pytest.fixture
def idle(tmp_path):
    """The address of a scheduler whose workers never come."""
    file = tmp_path / "scheduler.json"
    with scheduler(file, {}) as master:
        until(lambda: file.exists() and file.stat().st_size, master)
        yield json.loads(file.read_text())["address"]


def test_workers_that_never_come_are_told_with_the_remedy(idle, monkeypatch):
    monkeypatch.setattr(cluster, "CONNECT", 3.0)
    with nothing_left(), pytest.raises(SolverError, match=r"answers within 3 s \(.*it has no workers\).*dask worker"):
        ensemble(tiny_flocks.trio, [0], cluster=idle)


def test_ctrl_c_while_it_connects_leaves_nothing(answering):
    def interrupted(connection):
        signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

    with server(interrupted) as (address, came), nothing_left(), pytest.raises(KeyboardInterrupt):
        ensemble(tiny_flocks.trio, [0], cluster=address)
    assert len(came) == 1


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ArgumentError, match=r"pip install 'flockana\[cluster\]'"):
        ensemble(tiny_flocks.trio, [0], cluster="local")


def test_a_cluster_of_ones_own_starts_and_ends():
    with nothing_left():
        found = ensemble(tiny_flocks.trio, range(4), theorems=["source"], metrics=[], cluster="local", jobs=1)
    assert found.drop_vars("seconds").identical(
        ensemble(tiny_flocks.trio, range(4), theorems=["source"], metrics=[], jobs=1).drop_vars("seconds")
    )


@pytest.mark.parametrize("limit", [0.3, 3.0])  # given up while the process is made, and while it is waited for
@pytest.mark.parametrize("python", ["exit 1", "sleep 1000"], ids=["ends", "hangs"])
def test_worker_processes_that_do_not_start_are_told_with_the_remedy(python, limit, tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "START", limit)
    broken = tmp_path / "python"
    broken.write_text(f"#!/bin/sh\nexec {python}\n")
    broken.chmod(0o755)
    monkeypatch.setattr(spawn, "_python_exe", os.fsencode(broken))
    with nothing_left(), pytest.raises(SolverError, match=r"worker processes do not start .*__main__.*jobs=1"):
        ensemble(tiny_flocks.trio, [0], cluster="local", jobs=1)


def test_ctrl_c_ends_a_cluster_of_ones_own(tmp_path):
    """A program at work; its worker process never gets the signal."""
    log = tmp_path / "log"
    code = (
        "import sys\nfrom tests.ensemble import tiny_flocks\nfrom flockana.ensemble import ensemble\n"
        "if __name__ == '__main__':\n    ensemble(tiny_flocks.gated, range(40), cluster='local', jobs=1)\n"
    )
    environment = {tiny_flocks.LOG: str(log), tiny_flocks.GATE: str(tmp_path / "gate")}
    own = {"environment": environment | {"DASK_TEMPORARY_DIRECTORY": str(tmp_path)}, "paths": [ROOT]}
    with program("-c", ANSWERS_CTRL_C + code, **own) as process:
        until(lambda: any(seed >= 24 for _, seed in begun(log)), process)
        interrupt(process)
        _, err = process.communicate()
        assert err.strip().endswith("KeyboardInterrupt"), err
        assert process.returncode == -signal.SIGINT
        until(lambda: not group(process))


def test_ctrl_c_while_a_cluster_of_ones_own_starts_leaves_nothing(answering, monkeypatch):
    """It comes when the processes are there, and somebody to end them."""
    start = distributed.LocalCluster.__init__

    def interrupted(self, **options):
        start(self, **options)
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(distributed.LocalCluster, "__init__", interrupted)
    with nothing_left(), pytest.raises(KeyboardInterrupt):
        ensemble(tiny_flocks.trio, [0], cluster="local", jobs=1)
