"""What is packed gives the same bits; the compiler that others use is left as it was."""

from __future__ import annotations

import platform
import re

import numba
import numpy as np
import pytest
from numba import config
from numba.core.typed_passes import NativeLowering

from flockana.kernels.compiling import njit
from flockana.kernels.packing import PackedLowering

VECTOR = r"\bv?(?:add|sub|mul)pd\b"


def pulled(first, second, weight, x, u):
    total = 0.0
    for k in range(first.size):
        i, j = first[k], second[k]
        gap = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1]
        total += gap[0] * gap[0] + gap[1] * gap[1]
        u[i, 0] += weight[k] * gap[0]
        u[i, 1] += weight[k] * gap[1]
        u[j, 0] -= weight[k] * gap[0]
        u[j, 1] -= weight[k] * gap[1]
    return total


def results(function):
    rng = np.random.default_rng(0)
    first, second = rng.integers(0, 40, (2, 999)).astype(np.uint64)
    u = np.zeros((40, 2))
    total = function(first, second, rng.normal(size=999), rng.normal(size=(40, 2)), u)
    return total, u


def test_packing_changes_no_bit_and_packs():
    packed, plain = njit(error_model="numpy")(pulled), numba.njit(error_model="numpy")(pulled)
    (total, u), (expected_total, expected) = results(packed), results(plain)
    assert total == expected_total
    np.testing.assert_array_equal(u, expected)
    if platform.machine() in ("x86_64", "AMD64"):
        here, there = (
            len(re.findall(VECTOR, next(iter(each.inspect_asm().values())))) for each in (packed.dispatcher, plain)
        )
        assert here > there


def test_numba_is_left_as_it_was(monkeypatch):
    before = config.SLP_VECTORIZE
    assert njit()(lambda x: x + 1.0)(1.0) == 2.0
    assert before == config.SLP_VECTORIZE

    def refused(self, state):
        assert config.SLP_VECTORIZE == 1
        raise MemoryError

    monkeypatch.setattr(NativeLowering, "run_pass", refused)
    with pytest.raises(MemoryError):
        PackedLowering().run_pass(None)
    assert before == config.SLP_VECTORIZE
