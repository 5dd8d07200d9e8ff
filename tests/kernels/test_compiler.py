"""The compiler is numba's: its flags are the same flags, and garbage is sought afterwards as it was before."""

import gc

import pytest
from numba.core import compiler
from numba.core.errors import TypingError
from numba.core.targetconfig import ConfigStack, TargetConfig

from flockana.base.garbage import SELDOM
from flockana.kernels.compiler import Flags
from flockana.kernels.compiling import njit, register_jitable


def numbas(**options):
    flags = compiler.Flags()
    for name, value in options.items():
        setattr(flags, name, value)
    return flags


@pytest.mark.parametrize(
    "options", [{}, {"nrt": True}, {"nrt": True, "error_model": "numpy", "forceinline": True}, {"release_gil": False}]
)
def test_they_are_numbas_flags(options):
    theirs = numbas(**options)
    ours = Flags(theirs)
    assert ours.values() == theirs.values()
    assert ours == theirs
    assert theirs == ours
    assert hash(ours) == hash(theirs)
    assert ours.get_mangle_string() == theirs.get_mangle_string()
    ours.no_compile = True
    assert ours != theirs
    assert ours.values() == numbas(**options, no_compile=True).values()
    assert type(ours.copy()) is Flags
    assert ours.copy() == ours


def test_numba_lists_none_by_name_for_a_kernel_and_what_is_inlined_into_it(monkeypatch):
    listed, numbas_own = [], TargetConfig.values
    monkeypatch.setattr(TargetConfig, "values", lambda flags: listed.append(type(flags)) or numbas_own(flags))

    @register_jitable
    def square(x):
        return x * x + 1.0

    assert njit()(lambda x: square(x) - square(x + 1.0))(2.0) == -5.0
    assert not listed


@pytest.mark.usefixtures("garbage_often_sought")
def test_garbage_is_seldom_sought_while_a_function_is_compiled(monkeypatch):
    seen, compiled = [], compiler.CompilerBase.compile_extra

    def watched(self, function):
        seen.append((gc.get_threshold()[0], gc.isenabled()))
        return compiled(self, function)

    monkeypatch.setattr(compiler.CompilerBase, "compile_extra", watched)
    before = gc.get_threshold()
    assert before[0] < SELDOM
    assert njit()(lambda x: 2 * x)(21) == 42
    with pytest.raises(TypingError):
        njit()(lambda x: x.nothing)(1.0)
    assert seen == [(SELDOM, True)] * 2
    assert gc.get_threshold() == before


def test_what_was_switched_off_stays_off():
    gc.disable()
    try:
        njit()(lambda x: 3 * x)(1)
        assert not gc.isenabled()
    finally:
        gc.enable()


def test_no_flags_are_left_behind():
    njit()(lambda x: 4 * x)(1)
    assert ConfigStack.top_or_none() is None
