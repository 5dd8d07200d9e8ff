"""What kernels alone call: written down for its callers, on disk too, and not made into machine code of its own."""

from __future__ import annotations

import os
import subprocess
import sys

import numba
import numpy as np
import pytest

from flockana.kernels.compiling import njit
from flockana.kernels.libraries import InnerLibrary, OuterLibrary

FILE = """
import numpy as np
from flockana.kernels.compiling import njit

@njit(cache=True)
def inner(x):
    if x.size > 2:
        raise ValueError("too many", x.size)
    made = np.empty(x.size)
    for k in range(x.size):
        made[k] = x[k] / 3.0
    return made

@njit(cache=True)
def middle(x):
    return inner(x).sum() + 1.0

@njit(cache=True)
def outer(x):
    return 2.0 * middle(x)

@njit(cache=True)
def other(x):
    return 2.0 - middle(x)
"""
PROGRAM = """
import sys
import numpy as np
from kept import {name} as kernel, inner, middle

expected = {{"outer": 4.0, "other": 0.0}}["{name}"]
assert kernel(np.array([1.0, 2.0])) == expected
try:
    kernel(np.zeros(3))
except ValueError as error:
    assert error.args == ("too many", 3), error.args
else:
    raise AssertionError("nothing was raised")
import numba
directly = kernel.dispatcher  # a kernel of numba takes it in itself
assert numba.njit(lambda x: directly(x) + 1.0)(np.array([1.0, 2.0])) == expected + 1.0
hits = (sum(each.stats.cache_hits.values()) for each in (inner.inner, middle.inner, kernel))
print(*hits)
"""


@njit()
def third(x):
    return x / 3.0


@njit()
def sum_of_thirds(x):
    total = 0.0
    for k in range(x.size):
        total += third(x[k])
    return total


def library(kernel):
    (made,) = kernel.overloads.values()
    return made.library


def test_it_has_no_machine_code_and_its_callers_have_all_of_it():
    x = np.random.default_rng(0).normal(size=100)
    plain = numba.njit(lambda x: x / 3.0)
    expected = 0.0
    for value in x:
        expected += plain(value)
    assert sum_of_thirds(x) == expected
    inner, outer = library(third.inner), library(sum_of_thirds.dispatcher)
    assert isinstance(inner, InnerLibrary)
    assert isinstance(outer, OuterLibrary)
    (name,) = (each.name for each in inner.get_defined_functions())
    assert inner.get_pointer_to_function(name) == 0
    assert not inner.codegen._engine.is_symbol_defined(name)


def test_called_from_python_it_is_a_kernel_like_others():
    assert sum_of_thirds(np.ones(3)) == 1.0
    assert third(6.0) == 2.0
    assert isinstance(library(third.dispatcher), OuterLibrary)


@pytest.mark.parametrize("compiler", [njit(), numba.njit], ids=["ours", "numba's"])
def test_what_it_raises_is_raised_with_its_numbers(compiler):
    """They are told by way of an environment, which numba sets where it makes machine code."""

    @njit()
    def refused(x):
        if x > 3.0:
            raise ValueError("too large", x)
        return x

    @compiler
    def doubled(x):
        return 2.0 * refused(x)

    assert doubled(2.0) == 4.0
    with pytest.raises(ValueError, match="too large") as told:
        doubled(5.0)
    assert told.value.args == ("too large", 5.0)


def test_kernels_of_the_package_are_loaded_without_what_numba_could_compile(tmp_path):
    code = """
import sys
import numpy as np
from flockana.kernels.instants import least_distances
print(least_distances(np.zeros((1, 2, 2)) + [[0.0], [4.0]])[0] ** 2, "numba.np.linalg" in sys.modules)
"""
    command, apart = [sys.executable, "-c", code], os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    for _ in range(2):  # the first compiles it, into a folder where nobody else writes
        told = subprocess.run(command, env=apart, capture_output=True, text=True, check=True, timeout=300)
    distance, loaded = told.stdout.split()
    assert float(distance) == pytest.approx(32.0, rel=1e-14)
    assert loaded == "False"


def test_another_process_reads_it_and_compiles_what_is_new(tmp_path):
    (tmp_path / "kept.py").write_text(FILE)

    def hits(name):
        command = [sys.executable, "-c", PROGRAM.format(name=name)]
        told = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True, timeout=300)
        return told.stdout.split()

    assert hits("outer") == ["0", "0", "0"]
    assert hits("other") == ["0", "1", "0"]  # what `middle` calls is in it
    assert hits("other") == ["0", "0", "1"]
