from threading import get_ident

from flockana import jit
from flockana.cli import compiling
from flockana.cli.compiling import announce_compiling, in_compiler


def test_kernels_and_callbacks_are_compiled_and_nothing_else_is(monkeypatch):
    seen, load = [], jit.load_numba
    monkeypatch.setattr(jit, "load_numba", lambda: (seen.append(in_compiler(get_ident())), load())[1])
    kernel = jit.njit()(lambda x: x + 1.0)
    assert kernel(1.0) == 2.0
    assert any(seen)
    seen.clear()
    number = load().types.float64
    assert jit.callback(jit.njit()(lambda x: x + 2.0), number(number)).ctypes(1.0) == 3.0
    assert all(seen)
    assert not in_compiler(get_ident())


def test_it_is_said_once_and_on_a_terminal_only(monkeypatch, capsys):
    monkeypatch.setattr(compiling, "_EVERY", 0.01)
    monkeypatch.setattr(compiling, "in_compiler", lambda thread: True)
    with announce_compiling():
        pass
    assert capsys.readouterr().err == ""
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    over = compiling.threading.Event()
    compiling._watch(get_ident(), over)
    assert capsys.readouterr().err == f"{compiling._TEXT}\n"
