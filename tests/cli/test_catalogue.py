"""The two listing commands leave the process as they found it."""

from __future__ import annotations

import gc
import os

import pytest

from flockana.cli.catalogue import scenarios_command, theorems_command


@pytest.mark.parametrize("command", [scenarios_command, theorems_command])
@pytest.mark.parametrize(("collects", "threads"), [(True, None), (False, "2")])
def test_garbage_is_collected_and_threads_start_as_before(monkeypatch, capsys, command, collects, threads):
    if threads is None:
        monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    else:
        monkeypatch.setenv("OPENBLAS_NUM_THREADS", threads)
    before = gc.isenabled()
    (gc.enable if collects else gc.disable)()
    try:
        command()
        assert gc.isenabled() is collects
    finally:
        (gc.enable if before else gc.disable)()
    assert os.environ.get("OPENBLAS_NUM_THREADS") == threads
    assert len(capsys.readouterr().out.splitlines()) > 80
