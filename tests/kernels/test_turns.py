"""Of several processes that want a function one compiles it; no turn is waited for that nobody will give."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import numba
import pytest

from flockana.kernels import turns
from flockana.kernels.compiling import njit
from flockana.kernels.turns import Turn

ROOT = Path(__file__).parents[2]
MODULE = """
import numpy as np
from flockana.kernels.compiling import njit

@njit(cache=True)
def slow(x):
    for k in range(3):
        x = np.dot(x, x) + np.sort(x.ravel()).reshape(x.shape) + np.linalg.inv(x + np.eye(x.shape[0]))
    return x.sum()
"""
PROGRAM = """
import sys, time
from pathlib import Path
import numpy as np
import slow
Path(f"ready{sys.argv[1]}").touch()
while not Path("go").exists():
    time.sleep(0.001)
slow.slow(np.eye(2))
print(sum(slow.slow.stats.cache_misses.values()))
"""
HOLDER = """
import sys, time
from flockana.kernels.turns import Turn
assert Turn(sys.argv[1], "kernel").take()
print("taken", flush=True)
time.sleep(300)
"""
LOOK = """
import sys
from flockana.kernels import turns
turns._PATIENCE = 0.1
print(turns.Turn(sys.argv[1], "kernel").take())
"""
pytestmark = pytest.mark.skipif(turns.fcntl is None, reason="no locks on bytes of a file")


@pytest.fixture
def holder(tmp_path):
    """A process that has the turn."""
    command = [sys.executable, "-c", HOLDER, str(tmp_path)]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "taken\n"
        yield process
        process.kill()


def test_of_three_processes_one_compiles_and_the_others_load(tmp_path):
    (tmp_path / "slow.py").write_text(MODULE)
    worker_pool = [
        subprocess.Popen([sys.executable, "-c", PROGRAM, str(k)], cwd=tmp_path, stdout=subprocess.PIPE, text=True)
        for k in range(3)
    ]
    while not all((tmp_path / f"ready{k}").exists() for k in range(3)):
        assert all(process.poll() is None for process in worker_pool)
        time.sleep(0.01)
    (tmp_path / "go").touch()
    assert sorted(process.communicate(timeout=300)[0].strip() for process in worker_pool) == ["0", "0", "1"]


def test_one_that_ends_in_its_turn_gives_it(tmp_path, holder):
    turn = Turn(str(tmp_path), "kernel")
    assert Turn(str(tmp_path), "another").take()
    holder.kill()
    assert turn.take()
    turn.give()


def test_a_turn_is_not_waited_for_for_ever(tmp_path, holder, monkeypatch):
    monkeypatch.setattr(turns, "_PATIENCE", 0.1)
    turn = Turn(str(tmp_path), "kernel")
    assert not turn.take()
    turn.give()  # what it has not is not given
    assert not turn.take()


def test_who_gives_one_turn_keeps_the_others(tmp_path):
    first, second = Turn(str(tmp_path), "kernel"), Turn(str(tmp_path), "other")
    assert first.take()
    assert second.take()
    second.give()
    look = [sys.executable, "-c", LOOK, str(tmp_path)]
    assert subprocess.check_output(look, cwd=ROOT, text=True) == "False\n"
    first.give()
    assert subprocess.check_output(look, cwd=ROOT, text=True) == "True\n"


def test_one_that_fails_to_compile_gives_its_turn(tmp_path, monkeypatch):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))

    @njit(cache=True)
    def wrong(x):
        return x.no_such_thing

    with pytest.raises(numba.TypingError):
        wrong(1.0)
    assert not wrong._cache.turn._taken


@pytest.mark.parametrize("lacking", ["locks", "folder"])
def test_where_there_are_no_locks_everyone_compiles_at_once(tmp_path, monkeypatch, lacking):
    if lacking == "locks":
        monkeypatch.setattr(turns, "fcntl", None)
    turn = Turn(str(tmp_path if lacking == "locks" else tmp_path / "none"), "kernel")
    monkeypatch.setattr(turns.time, "sleep", lambda seconds: pytest.fail("it waits"))
    assert not turn.take()
    turn.give()
