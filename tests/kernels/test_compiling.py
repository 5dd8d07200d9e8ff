"""Kernels on disk: whoever else compiles at the same time, what is loaded is what was asked for."""

from __future__ import annotations

import os
import pickle
import shutil
import subprocess
import sys
from itertools import pairwise
from multiprocessing import get_context
from pathlib import Path

import numba
import numpy as np
import pytest
from numba.core.caching import IndexDataCacheFile
from numba.core.codegen import JITCodeLibrary
from numba.core.serialize import dumps, loads

from flockana.interactions import AlphaInteraction
from flockana.kernels import caching
from flockana.kernels.caching import NamedByContent
from flockana.kernels.compiling import njit, register_jitable

ROOT = Path(__file__).parents[2]
MODULE = """
from flockana.kernels.compiling import Inlined, njit, register_jitable

def lifted(offset):
    @njit(cache=True)
    def over(x):
        return x + offset
    return over

MADE = [lifted(k) for k in range(12)]
"""
ARRAYS = """
import numpy as np
import pytest
from flockana.kernels.compiling import Inlined, njit, register_jitable

def lifted(offset):
    @njit()
    def raised(x):
        out = np.empty(x.size)
        for k in range(x.size):
            out[k] = x[k] + offset
        return out

    @njit(cache=True)
    def over(x):
        return raised(x)
    return over

ONE, TEN = lifted(1.0), lifted(10.0)
"""
PROGRAM = """
import sys
import many
order = range(12) if sys.argv[1] == "up" else range(11, -1, -1)
assert {k: many.MADE[k](100) for k in order} == {k: 100 + k for k in range(12)}
"""


def saved_at_once(kind, folder):
    """What is loaded after "b" was saved by one while another, at the same index, was writing the code of "a"."""
    one, two = (kind(str(folder), "kernel", "stamp") for _ in range(2))
    two._load_index = dict  # it looked before the other saved
    write = one._save_data

    def interrupted(name, data):
        two.save("b", "code of b")
        write(name, data)

    one._save_data = interrupted
    one.save("a", "code of a")
    return {key: kind(str(folder), "kernel", "stamp").load(key) for key in "ab"}


def test_two_that_save_at_once_lose_an_entry_at_most(tmp_path):
    """In numba's own files the code of the one stands under the name of the other."""
    found = saved_at_once(NamedByContent, tmp_path)
    assert all(code in (None, f"code of {key}") for key, code in found.items())
    assert any(found.values())
    (tmp_path / "numba").mkdir()
    assert saved_at_once(IndexDataCacheFile, tmp_path / "numba")["b"] == "code of a"


def test_another_version_of_the_source_is_another_file(tmp_path):
    old, new = (NamedByContent(str(tmp_path), "kernel", stamp) for stamp in ("old", "new"))
    old.save("a", 1)
    assert new.load("a") is None
    new.save("a", 2)
    assert (new.load("a"), old.load("a")) == (2, None)
    assert len(list(tmp_path.glob("*.nbc"))) == 2


def test_on_a_full_disk_what_is_compiled_is_used_and_not_kept(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    kept = NamedByContent(str(tmp_path), "kernel", "stamp")
    monkeypatch.setattr(NamedByContent, "_save_data", full)
    kept.save("a", "code")
    assert kept.load("a") is None
    assert not list(tmp_path.iterdir())


def test_processes_that_compile_at_once_compute_what_they_should(tmp_path):
    """Twelve functions of one name and one index, compiled by three processes in two orders, then loaded."""
    (tmp_path / "many.py").write_text(MODULE)
    for _ in range(2):
        worker_pool = [
            subprocess.Popen([sys.executable, "-c", PROGRAM, way], cwd=tmp_path, stderr=subprocess.PIPE, text=True)
            for way in ("up", "down", "up")
        ]
        for process in worker_pool:
            _, told = process.communicate(timeout=300)
            assert process.returncode == 0, told


def test_what_processes_compiled_one_by_one_another_may_load_together(tmp_path):
    """Each compiles one closure as its first: numba alone would name both alike, and fail in the third."""
    (tmp_path / "arrays.py").write_text(ARRAYS)
    for program in ("ONE(z)", "ONE(z), TEN(z)", "assert (ONE(z)[0], TEN(z)[0]) == (1.0, 10.0)"):
        command = [sys.executable, "-c", f"from arrays import *; z = np.zeros(1); {program}"]
        subprocess.run(command, cwd=tmp_path, check=True, timeout=300)


def number_of_one_more(_: object = None) -> int:
    """What numba counts a function as that is compiled now."""
    made = numba.njit(lambda x: x + 1)
    made(1)
    return next(iter(made.overloads.values())).type_annotation.func_id.unique_id


def test_what_a_process_compiles_is_numbered_as_in_no_other():
    """A child that is forked off would go on counting where its parent was, as another child does."""
    code = "from tests.kernels.test_compiling import number_of_one_more; print(number_of_one_more())"
    fresh = [int(subprocess.check_output([sys.executable, "-c", code], cwd=ROOT)) for _ in range(2)]
    with get_context("fork").Pool(1, maxtasksperchild=1) as pool:
        forked = pool.map(number_of_one_more, range(2), chunksize=1)
    own = number_of_one_more()
    assert number_of_one_more() == own + 1
    numbers = sorted([own, *forked, *fresh])
    assert min(b - a for a, b in pairwise(numbers)) > 2**32


def test_without_a_cache_it_is_numbas():
    @njit()
    def twice(x):
        return 2.0 * x

    np.testing.assert_array_equal(twice(np.arange(3.0)), [0.0, 2.0, 4.0])
    assert twice.py_func(4.0) == 8.0


@register_jitable
def doubled(x):
    """Twice x."""
    return 2.0 * x


@njit()
def raised(x):
    """Twice x, and one."""
    return doubled(x) + 1.0


def test_kernels_call_kernels_and_scalar_functions_by_name_and_so_do_functions_of_numba():
    @numba.njit
    def of_numba(x):
        return raised(x) - doubled(x)

    @numba.njit
    def of_a_function(f, x):
        return f(x)

    assert (raised(3.0), doubled(3.0), of_numba(3.0), of_a_function(raised, 3.0)) == (7.0, 6.0, 1.0, 7.0)
    assert raised.signatures
    assert (raised.__name__, raised.__doc__, doubled.__doc__) == ("raised", "Twice x, and one.", "Twice x.")


def test_of_a_kernel_of_the_package_frozen_arrays_need_no_second_one():
    def total(x):
        whole = 0.0
        for k in range(x.size):
            whole += x[k]
        return whole

    total.__module__ = "flockana.kernels.sums"
    kernel, x = njit()(total), np.arange(5.0)
    x.flags.writeable = False
    assert kernel(x) == 10.0
    assert kernel(x + 1.0) == 15.0
    assert kernel(x) == 10.0
    assert len(kernel.overloads) == 1


def test_no_kernel_of_the_package_writes_to_frozen_accelerations():
    q, u = np.array([[0.0, 0.0], [8.0, 0.0]]), np.zeros((2, 2))
    u.flags.writeable = False
    with pytest.raises(numba.TypingError, match="readonly array"):
        AlphaInteraction().forces(q, 0.0 * q, stiffness=1.0, damping=1.0, out=u)
    assert not u.any()


def test_a_kernel_of_others_cannot_write_to_what_is_frozen():
    @njit()
    def spoil(x):
        x[0] = 7.0

    x = np.zeros(3)
    x.flags.writeable = False
    with pytest.raises(numba.TypingError, match="readonly"):
        spoil(x)
    assert x[0] == 0.0


def test_a_kernel_called_by_kernels_has_nothing_that_python_would_need():
    @njit()
    def inner(x):
        return x + 1.0

    @njit()
    def outer(x):
        return 2.0 * inner(x)

    assert outer(1.0) == 4.0
    assert [len(kernel.overloads) for kernel in (inner.inner, inner.dispatcher)] == [1, 0]
    assert inner(2.0) == 3.0


def test_what_is_known_by_name_is_pickled_by_name():
    """What a closure over it is called then depends on no address and no process."""
    for known in (raised, doubled):
        assert pickle.loads(pickle.dumps(known)) is known
    local = loads(dumps(njit()(lambda x: doubled(x) - 1.0)))
    assert local(3.0) == 5.0


def test_kernels_load_numba_when_they_compute():
    code = "import sys, flockana.kernels.{0}; print('numba' in sys.modules, end=' ')"
    rooms = "".join(code.format(name) + "\n" for name in ("sweep", "dead_zone", "obstacles", "zones", "paths"))
    run = subprocess.run([sys.executable, "-c", rooms], capture_output=True, text=True, check=True)
    assert set(run.stdout.split()) == {"False"}


CALLER = """
from flockana.kernels.compiling import njit
from flockana.{name} import inner

@njit(cache=True)
def outer(x):
    return inner(x) + 1
"""


def test_an_edit_in_what_a_kernel_imports_compiles_it_again(tmp_path):
    """A copy of the package, so that a kernel of it can be edited."""
    package = tmp_path / "flockana"
    shutil.copytree(Path(caching.__file__).parents[1], package, ignore=shutil.ignore_patterns("__pycache__", "report"))
    (package / "between.py").write_text("from flockana.innermost import inner\n")
    (tmp_path / "caller.py").write_text(CALLER.format(name="between"))
    for factor, told in ((2, 7), (5, 16)):
        (package / "innermost.py").write_text(
            "from flockana.kernels.compiling import njit\n\n@njit(cache=True)\ndef inner(x):\n"
            f"    return {factor} * x\n"
        )
        command = [
            sys.executable,
            "-B",
            "-c",
            "import caller; print(caller.outer(3), len(caller.outer.stats.cache_hits))",
        ]
        for hits in (0, 1):
            found = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True, timeout=300)
            assert found.stdout.split() == [str(told), str(hits)]


def test_where_nothing_can_be_written_kernels_are_compiled_all_the_same(monkeypatch):
    monkeypatch.setattr(caching.FunctionCache, "__init__", lambda *_: (_ for _ in ()).throw(RuntimeError("no locator")))

    @njit(cache=True)
    def twice(x):
        return 2.0 * x

    assert twice(2.0) == 4.0


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="users are not told apart")
def test_where_nothing_can_be_written_kernels_are_kept_in_a_private_temporary_folder(monkeypatch, tmp_path, caplog):
    """A container with a read-only install and no home."""
    real = caching.FunctionCache.__init__

    def only_where_told(self, function):
        if not numba.config.CACHE_DIR:
            raise RuntimeError("no locator")
        real(self, function)

    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    monkeypatch.setattr(caching.FunctionCache, "__init__", only_where_told)
    monkeypatch.setattr(caching.tempfile, "gettempdir", lambda: str(tmp_path))
    caching.temporary_folder.cache_clear()
    try:

        @njit(cache=True)
        def plus(x):
            return x + 1.0

        @njit(cache=True)
        def twice(x):
            return 2.0 * x

        assert (plus(2.0), twice(2.0)) == (3.0, 4.0)
        (folder,) = tmp_path.iterdir()
        assert len(list(folder.rglob("*.nbc"))) == 2
        assert folder.stat().st_mode & 0o777 == 0o700
        assert len(caplog.records) == 1
        assert str(folder) in caplog.text
        assert numba.config.CACHE_DIR == ""
        folder.chmod(0o777)  # whoever may write there could have us run what they like
        caching.temporary_folder.cache_clear()

        @njit(cache=True)
        def minus(x):
            return x - 1.0

        assert minus(2.0) == 1.0
        assert len(list(folder.rglob("*.nbc"))) == 2
    finally:
        caching.temporary_folder.cache_clear()


def test_where_a_function_is_that_is_handed_on_is_asked_once(monkeypatch):
    asked, address = [], JITCodeLibrary.get_pointer_to_function
    monkeypatch.setattr(
        JITCodeLibrary, "get_pointer_to_function", lambda library, name: asked.append(name) or address(library, name)
    )
    twice, thrice = njit()(lambda x: 2.0 * x), njit()(lambda x: 3.0 * x)
    apply = njit()(lambda function, x: function(x))
    for one in (twice, thrice):
        one.compile(numba.float64(numba.float64))
        one.disable_compile()
    apply.compile((numba.types.FunctionType(numba.float64(numba.float64)), numba.float64))
    apply.disable_compile()
    asked.clear()
    assert [apply(one.dispatcher, x) for x in (1.0, 2.0) for one in (twice, thrice, twice)] == [2, 3, 2, 4, 6, 4]
    assert len(asked) == len(set(asked)) == 4  # of each, for compiled code and for C
