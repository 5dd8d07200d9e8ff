import gc
import os

import pytest

from flockana.base.garbage_collection import SELDOM
from flockana.cli import main as program
from flockana.cli.catalogue import scenarios_command, theorems_command
from flockana.cli.verify import verify_command
from flockana.report import verify_catalogue


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


@pytest.mark.usefixtures("garbage_often_sought")
def test_a_command_seldom_looks_for_garbage_and_the_process_does_as_before(monkeypatch):
    before, seen = gc.get_threshold(), []
    assert before[0] < SELDOM
    monkeypatch.setattr(program, "_app", lambda asked: lambda **given: seen.append(gc.get_threshold()))
    with pytest.raises(SystemExit):
        program.main([])
    assert [threshold[0] for threshold in seen] == [SELDOM]
    assert gc.get_threshold() == before


def test_verify_starts_one_thread_for_matrices_unless_told(monkeypatch):
    seen = []
    monkeypatch.setattr(
        verify_catalogue, "plan", lambda *given, **options: seen.append(os.environ.get("OPENBLAS_NUM_THREADS")) or ()
    )
    for name, threads, expected in (("", "", "1"), ("OPENBLAS_NUM_THREADS", "2", "2"), ("OMP_NUM_THREADS", "2", None)):
        for each in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
            monkeypatch.delenv(each, raising=False)
        if name:
            monkeypatch.setenv(name, threads)
        verify_command("hexagon", no_report=True, as_json=True)
        assert seen.pop() == expected
        assert os.environ.get("OPENBLAS_NUM_THREADS") == (threads if name.startswith("OPEN") else None)
