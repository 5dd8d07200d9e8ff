"""Compiled code on disk: whoever else compiles at the same time, what is loaded is what was asked for."""

import os
import pickle
import re
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor, wait
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np
import pytest

from flockana import AlphaInteraction, jit
from flockana.jit import njit, register_jitable, thawed
from flockana.kernels import connected_components
from flockana.kernels.bound_templates import bound, made
from flockana.kernels.scalars import sigma_1
from tests.programs import out_of_a_kernel

ROOT = Path(__file__).parents[1]
MANY = "".join(
    f"""
@register_jitable
def offset_{k}(x):
    return x + {k}.0
"""
    for k in range(6)
)
PROGRAM = """
import sys
import numpy as np
import many
from flockana.kernels.pair_kernels import lift_scalar
order = range(6) if sys.argv[1] == "up" else range(5, -1, -1)
z = np.full(1, 100.0)
assert {k: lift_scalar(getattr(many, f"offset_{k}"))(z)[0] for k in order} == {k: 100.0 + k for k in range(6)}
"""


def environment(folder: Path) -> dict[str, str]:
    return os.environ | {"NUMBA_CACHE_DIR": str(folder), "PYTHONPATH": str(ROOT)}


def test_only_what_numba_publishes_is_used():
    """No module of its core or of LLVM's, and no name that begins with an underscore."""
    private = re.compile(r"numba\.(core|np|cpython|typed\.\w+\._|_)|llvmlite|\b_nrt\b|_numba_type_|numba\.\w+\._\w")
    files = [path for room in ("flockana", "benchmarks") for path in (ROOT / room).rglob("*.py")]
    found = [f"{path}: {hit[0]}" for path in files if (hit := private.search(path.read_text("utf-8")))]
    assert len(files) > 500
    assert not found


class Pair(NamedTuple):
    """Of two numbers."""

    one: float
    other: float


@pytest.mark.parametrize("function", [lambda x: Pair(x, x), lambda x: (1, (2.0, Pair(x, x)))])
def test_no_kernel_gives_named_tuples_to_python(function):
    """An alarm that raises while numba makes one kills the process."""
    with pytest.raises(TypeError, match=r"returns .*Pair.*: expected numbers, as kernels that Python calls write"):
        njit()(function)(1.0)


@pytest.mark.parametrize(
    ("error", "raised"), [(out_of_a_kernel(), KeyboardInterrupt), (SystemError("own"), SystemError)]
)
def test_what_interrupts_numba_while_it_makes_arrays_is_raised_itself(error, raised):
    def interrupted(x):
        raise error

    kernel = njit()(lambda x: x)
    kernel._compiled = interrupted
    with pytest.raises(raised):
        kernel(1.0)


def test_processes_that_compile_at_once_compute_what_they_should(tmp_path):
    """Functions of one shape, compiled by three processes in two orders, then loaded by three others."""
    (tmp_path / "many.py").write_text(f"from flockana.jit import register_jitable\n{MANY}")
    for _ in range(2):
        several = [
            subprocess.Popen(
                [sys.executable, "-c", PROGRAM, way],
                cwd=tmp_path,
                stderr=subprocess.PIPE,
                text=True,
                env=environment(tmp_path / "kept"),
            )
            for way in ("up", "down", "up")
        ]
        for process in several:
            _, message = process.communicate(timeout=300)
            assert process.returncode == 0, message
    compiled = list((tmp_path / "kept" / "flockana").rglob("*.nbc"))
    assert len(compiled) == len(set(compiled)) == 6  # one process compiles a function, the others load it


@register_jitable
def doubled(x):
    """Twice x."""
    return 2.0 * x


@njit()
def raised(x):
    """Twice x, and one."""
    return doubled(x) + 1.0


def test_kernels_call_kernels_and_scalar_functions_by_name():
    @njit()
    def both(x):
        return raised(x) - doubled(x)

    assert (raised(3.0), doubled(3.0), both(3.0)) == (7.0, 6.0, 1.0)
    assert (raised.__name__, raised.__doc__, doubled.__doc__) == ("raised", "Twice x, and one.", "Twice x.")
    assert raised.py_func(1.0) == 3.0


def test_frozen_arrays_and_whole_numbers_need_no_second_signature():
    @njit()
    def total(x, factor):
        whole = 0.0
        for k in range(x.size):
            whole += factor * x[k]
        return whole

    x = np.arange(5.0)
    assert total(x, 1.0) == 10.0
    x.flags.writeable = False
    assert (total(x, 2), total(x + 1.0, 1.0), total(x, 1.0)) == (20.0, 15.0, 10.0)
    assert len(total.dispatcher.signatures) == 1
    assert not x.flags.writeable


@pytest.mark.timeout(60)
def test_a_thread_that_compiles_waits_for_none_that_is_about_to():
    """In Python 3.11 a `cached_property` has a lock, for which four threads at their first runs waited without end."""
    waiting, compiling = (
        jit.kernel(each.function) for each in (connected_components.unite, connected_components.labelled)
    )
    with ThreadPoolExecutor(1) as pool, jit._ONE:
        other = pool.submit(lambda: waiting.dispatcher)
        assert wait([other], timeout=0.2).not_done
        assert compiling.dispatcher.py_func is connected_components.labelled.function
    assert other.result().py_func is connected_components.unite.function


def test_other_types_are_compiled_for():
    @njit()
    def first(x):
        return x[0]

    assert (first(np.arange(3.0)), first(np.arange(3, 5))) == (0.0, 3)
    assert len(first.dispatcher.signatures) == 2


def test_a_thawed_view_keeps_the_memory_alive():
    def view():
        x = np.arange(1000.0)
        x.flags.writeable = False
        return thawed(x)

    found = view()
    np.testing.assert_array_equal(found, np.arange(1000.0))
    assert found.flags.writeable


def test_no_kernel_writes_to_frozen_accelerations():
    q, u = np.array([[0.0, 0.0], [8.0, 0.0]]), np.zeros((2, 2))
    u.flags.writeable = False
    with pytest.raises(numba.TypingError, match="readonly array"):
        AlphaInteraction().forces(q, 0.0 * q, stiffness=1.0, damping=1.0, out=u)
    assert not u.any()


def test_what_is_known_by_name_is_pickled_by_name():
    for known in (raised, doubled):
        assert pickle.loads(pickle.dumps(known)) is known


SOURCES = "li_dead_zone.kernels.steps", "li_dead_zone.kernels.pair", "jond_2025.kernels.zones", "isola_2024.kernels"


def test_kernels_load_numba_when_they_compute():
    code = "import sys, flockana.{0}; print('numba' in sys.modules, end=' ')"
    names = "kernels.pair_sums", "kernels.obstacles", "kernels.quintic_paths", *(f"sources.{name}" for name in SOURCES)
    rooms = "".join(code.format(name) + "\n" for name in names)
    run = subprocess.run([sys.executable, "-c", rooms], capture_output=True, text=True, check=True, cwd=ROOT)
    assert set(run.stdout.split()) == {"False"}


CALLER = """
from flockana.jit import njit
from flockana.between import inner

@njit(cache=True)
def outer(x):
    return inner(x) + 1
"""


def test_an_edit_in_what_a_kernel_imports_compiles_it_again(tmp_path):
    """A copy of the package, so that a kernel of it can be edited."""
    package = tmp_path / "flockana"
    package.mkdir()
    (package / "__init__.py").write_text("")
    shutil.copytree(ROOT / "flockana/base", package / "base", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "flockana/jit.py", package)
    (package / "between.py").write_text("from flockana.innermost import inner\n")
    (tmp_path / "caller.py").write_text(CALLER)
    for factor, expected in ((2, 7), (5, 16)):
        text = f"from flockana.jit import njit\n\n@njit(cache=True)\ndef inner(x):\n    return {factor} * x\n"
        (package / "innermost.py").write_text(text)
        code = "import caller; print(caller.outer(3), len(caller.outer.dispatcher.stats.cache_hits))"
        for hits in (0, 1):
            found = subprocess.run(
                [sys.executable, "-B", "-c", code],
                cwd=tmp_path,
                check=True,
                capture_output=True,
                text=True,
                timeout=300,
                env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "kept"), "PYTHONPATH": str(tmp_path)},
            )
            assert found.stdout.split() == [str(expected), str(hits)]


def test_a_bound_module_is_a_file_of_this_user_alone_and_written_again_if_it_was_edited():
    module = bound("flockana.kernels.over_array", function=sigma_1)
    path = Path(module.__file__)
    assert path.parents[1] == jit.kernels_folder()
    assert path.parents[1].stat().st_mode & 0o777 == path.parent.stat().st_mode & 0o777 == 0o700
    assert module.over_array(np.array([0.0, 1e200]), ()).tolist() == [0.0, 1.0]
    right = path.read_text()
    path.write_text(right + "\nraise ValueError\n")
    code = "from flockana.kernels.bound_templates import bound; from flockana.kernels.scalars import sigma_1\n"
    code += "bound('flockana.kernels.over_array', function=sigma_1)"
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT)
    assert path.read_text() == right


def test_a_closure_is_bound_in_memory_and_nothing_is_kept_of_it():
    offset = 3.0

    @register_jitable
    def raise_by_offset(x):
        return x + offset

    module = bound("flockana.kernels.over_array", function=raise_by_offset)
    assert not hasattr(module, "__file__")
    assert module.over_array(np.zeros(2), ()).tolist() == [3.0, 3.0]


def test_a_name_that_a_template_does_not_bind_is_an_error():
    with pytest.raises(TypeError, match="over_array has no line that binds functions"):
        bound("flockana.kernels.over_array", functions=sigma_1)


@pytest.fixture
def afresh():
    """Folders as they are looked for anew, before and after."""
    for each in (jit.kernels_folder, jit.sources_folder):
        each.cache_clear()
    yield
    for each in (jit.kernels_folder, jit.sources_folder):
        each.cache_clear()


def test_where_nothing_can_be_written_all_is_compiled_in_memory_with_one_warning(monkeypatch, caplog, afresh):
    def refused(_):
        raise PermissionError

    monkeypatch.setattr(jit, "_private", refused)
    assert made("x = 4.0\n", "number").x == 4.0
    assert jit.kernels_folder() is jit.kernels_folder() is None
    assert [record.message[:30] for record in caplog.records] == ["no folder can be written to fo"]


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="users are not told apart")
def test_without_a_home_the_temporary_folder_is_used_if_nobody_else_may_enter_it(monkeypatch, tmp_path, afresh):
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    monkeypatch.setenv("XDG_CACHE_HOME", "/proc/none")
    monkeypatch.setattr(jit.tempfile, "gettempdir", lambda: str(tmp_path))
    folder = jit.kernels_folder()
    assert folder.parent == tmp_path / f"flockana-kernels-{os.getuid()}"
    folder.parent.chmod(0o755)
    jit.kernels_folder.cache_clear()
    assert jit.kernels_folder() is None


def test_two_installations_keep_nothing_in_common(monkeypatch, afresh):
    """numba sets the constants of a function by its name: those of the copy that was loaded first."""
    here = jit.kernels_folder()
    jit.kernels_folder.cache_clear()
    monkeypatch.setattr(jit, "__file__", "/another/flockana/jit.py")
    there = jit.kernels_folder()
    assert here.parent == there.parent
    assert here.name != there.name


def test_folders_that_were_not_used_for_long_are_removed(tmp_path, afresh):
    for name, days in (("old", 100), ("young", 1)):
        (tmp_path / name).mkdir()
        os.utime(tmp_path / name, (0, time.time() - 86400.0 * days))
    assert jit.sources_folder(tmp_path, "new").is_dir()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["new", "young"]


HOLDER = """
import time
from flockana.jit import compiling
with compiling():
    print("alone", flush=True)
    time.sleep(300)
"""


@pytest.mark.skipif(jit.fcntl is None, reason="no locks on files")
def test_one_process_compiles_at_a_time_and_none_waits_for_one_that_was_killed(monkeypatch, tmp_path, afresh):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(jit, "_PATIENCE", 0.3)
    command = [sys.executable, "-c", HOLDER]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, env=environment(tmp_path)) as holder:
        assert holder.stdout.readline() == "alone\n"
        started = time.monotonic()
        with jit.compiling():
            assert time.monotonic() - started >= 0.3
        holder.kill()
    monkeypatch.setattr(jit, "_PATIENCE", 60.0)
    started = time.monotonic()
    with jit.compiling():
        assert time.monotonic() - started < 30.0


@pytest.mark.parametrize("terminal", [True, False])
def test_long_compiling_is_announced_once_on_a_terminal(terminal, monkeypatch, caplog):
    monkeypatch.setattr(jit, "_SILENT", 0.01)
    monkeypatch.setattr("sys.stderr.isatty", lambda: terminal)
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)  # another test may have loaded it
    monkeypatch.setattr(jit, "_ANNOUNCED", [])
    for _ in range(2):
        with jit.compiling(name="step"):
            until = time.monotonic() + (10.0 if terminal else 0.05)
            while not caplog.messages and time.monotonic() < until:  # however busy the machine is
                time.sleep(0.02)
    assert caplog.messages == [jit.COMPILES.format("step")] * terminal
