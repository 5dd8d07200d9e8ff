"""Kernels on disk: whoever else compiles at the same time, what is loaded is what was asked for."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from flockana.kernels.compiling import _NamedByContent, njit

MODULE = """
from flockana.kernels.compiling import njit

def lifted(offset):
    @njit(cache=True)
    def over(x):
        return x + offset
    return over

MADE = [lifted(k) for k in range(12)]
"""
PROGRAM = """
import sys
import many
order = range(12) if sys.argv[1] == "up" else range(11, -1, -1)
assert {k: many.MADE[k](100) for k in order} == {k: 100 + k for k in range(12)}
"""


@pytest.mark.parametrize("second_first", [False, True])
def test_two_that_save_at_once_lose_an_entry_at_most(tmp_path, monkeypatch, second_first):
    one, two = (_NamedByContent(str(tmp_path), "kernel", "stamp") for _ in range(2))
    monkeypatch.setattr(_NamedByContent, "_load_index", lambda self: {})  # each has looked before the other saved
    for cache, key in ((two, "b"), (one, "a")) if second_first else ((one, "a"), (two, "b")):
        cache.save(key, f"code of {key}")
    monkeypatch.undo()
    found = {key: one.load(key) for key in "ab"}
    assert found in ({"a": "code of a", "b": None}, {"a": None, "b": "code of b"})


def test_another_version_of_the_source_is_another_file(tmp_path):
    old, new = (_NamedByContent(str(tmp_path), "kernel", stamp) for stamp in ("old", "new"))
    old.save("a", 1)
    assert new.load("a") is None
    new.save("a", 2)
    assert (new.load("a"), old.load("a")) == (2, None)
    assert len(list(tmp_path.glob("*.nbc"))) == 2


def test_processes_that_compile_at_once_compute_what_they_should(tmp_path):
    """Twelve functions of one name and one index, compiled by three processes in two orders, then loaded."""
    (tmp_path / "many.py").write_text(MODULE)
    for _ in range(2):
        crew = [
            subprocess.Popen([sys.executable, "-c", PROGRAM, way], cwd=tmp_path, stderr=subprocess.PIPE, text=True)
            for way in ("up", "down", "up")
        ]
        for process in crew:
            _, told = process.communicate(timeout=300)
            assert process.returncode == 0, told


def test_without_a_cache_it_is_numbas():
    @njit()
    def twice(x):
        return 2.0 * x

    np.testing.assert_array_equal(twice(np.arange(3.0)), [0.0, 2.0, 4.0])
    assert twice.py_func(4.0) == 8.0
