"""Ctrl-C in a long run: the run ends with what it has, and the process goes on."""

import signal
import subprocess
import sys
import textwrap
from pathlib import Path
from types import SimpleNamespace

import pytest

import flockana as fl
from flockana.theorems import second_runs


@pytest.mark.slow
def test_ctrl_c_within_a_kernel_ends_the_run_and_not_the_process():
    """Where the interrupt was raised in numba's own code that makes a kernel's result, the process crashed."""
    code = """
        import os, signal, threading
        import flockana as fl

        signal.signal(signal.SIGINT, signal.default_int_handler)
        law, q = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0))), fl.lattice.triangular(150, 8.0)
        fl.simulate(law, q, 0.0 * q, (0.0, 0.1))  # compiled
        for after in (0.3, 0.5, 0.7, 0.9):
            timer = threading.Timer(after, os.kill, (os.getpid(), signal.SIGINT))
            def watch(sample):  # from when the run is under way, however busy the machine is
                if timer.ident is None:
                    timer.start()
            print(fl.simulate(law, q, 0.0 * q, (0.0, 1e5), watch=watch).status, flush=True)
    """
    command, root = [sys.executable, "-c", textwrap.dedent(code)], Path(fl.__file__).resolve().parents[1]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, (signal.Signals(-done.returncode) if done.returncode < 0 else "", done.stderr)
    assert done.stdout.split() == 4 * ["interrupted"]


def test_ctrl_c_within_the_second_run_of_a_verdict_is_no_doubt_about_the_first(monkeypatch):
    run = fl.simulate(fl.Algorithm1(), [[0.0, 0.0], [8.0, 0.0]], [[0.0, 0.0]] * 2, (0.0, 1.0))
    monkeypatch.setattr(second_runs, "simulate", lambda *given, **options: SimpleNamespace(status="interrupted"))
    with pytest.raises(KeyboardInterrupt):
        fl.verify("os-1", run)
