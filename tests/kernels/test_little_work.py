"""Little work in the interpreter: the same bits as of compiled code, and compiled once there is enough of it."""

from math import exp, sqrt

import numpy as np
import pytest

from flockana import AlphaInteraction
from flockana.jit import njit, register_jitable
from flockana.kernels.bound_templates import bound
from flockana.kernels.cell_grid import sort_into_grid
from flockana.kernels.link_segments import crossing_signs, nearest_links
from flockana.kernels.little_work import ENOUGH, for_little, in_python
from flockana.kernels.neighbours import pair_list

LAW = AlphaInteraction()


def flock(n, m, seed=5):
    """Positions near each other, some far, and velocities."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(0.0, 3.0 * n ** (1.0 / m), (n, m))
    q[-1] += 1e4  # gaps are closed up
    return q, rng.normal(size=(n, m))


def same(kernel, *arguments):
    """Whether a kernel's text and its compiled code return and write the same bits."""
    copies = [[np.copy(x) if isinstance(x, np.ndarray) else x for x in arguments] for _ in range(2)]
    with np.errstate(all="ignore"):
        results = in_python(kernel)(*copies[0]), kernel(*copies[1])
    pairs = zip([results[0], *copies[0]], [results[1], *copies[1]], strict=True)
    return all(np.asarray(one).tobytes() == np.asarray(other).tobytes() for one, other in pairs if one is not None)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_sums_over_pairs_have_the_same_bits(m):
    q, p = flock(30, m)
    i, j = (each.astype(np.int32) for each in pair_list(q, LAW.range))
    forces = LAW.kernels.sums(m, LAW.par.size).forces
    assert i.size > 20
    assert same(forces, q, p, LAW.range, LAW.par, 1.5, 0.75, np.zeros_like(q), np.empty((3, *q.shape)))
    assert same(LAW.kernels.potential, q, i, j, LAW.par, LAW.panels)
    assert same(LAW.kernels.terms, q, i, j, LAW.par)


def test_a_grid_has_the_same_bits():
    q, _ = flock(40, 2)
    for one, other in zip(in_python(sort_into_grid)(q, 3.0), sort_into_grid(q, 3.0), strict=True):
        np.testing.assert_array_equal(one, other)


def test_links_that_cross_are_the_same():
    for m, planes in ((2, 1), (3, 3)):
        q, _ = flock(12, m)
        x = np.pad(q, ((0, 0), (0, 3 - m)))
        links = np.column_stack(np.triu_indices(12, 1)).astype(np.int32)
        a, b = np.triu_indices(len(links), 1)
        assert same(crossing_signs, x, links, a[:500], b[:500], planes)
        assert same(nearest_links, x, links, a[:500], b[:500], m == 2, 100.0)


@register_jitable
def _quotient(z):
    return 1.0 / sqrt(z)


@register_jitable
def _power(z):
    return z**2


@register_jitable
def _exponential(z):
    return exp(z)


def test_text_whose_bits_may_be_others_is_compiled():
    for function in (_power, _exponential):
        kernel = bound("flockana.kernels.over_array", function=function).over_array
        assert in_python(kernel) is None
        assert for_little(kernel, 1) is kernel


def test_what_the_interpreter_refuses_compiled_code_decides():
    kernel = bound("flockana.kernels.over_array", function=_quotient).over_array
    assert not kernel.is_compiled
    assert for_little(kernel, 1)(np.array([4.0]), ()).tolist() == [0.5]
    assert not kernel.is_compiled
    assert for_little(kernel, 1)(np.array([0.0]), ()).tolist() == [np.inf]
    assert kernel.is_compiled


def test_enough_work_is_compiled():
    @njit()
    def total(x):
        count = 0.0
        for k in range(x.size):
            count += x[k]
        return count

    x = np.ones(ENOUGH // 2)
    for _ in range(2):
        assert type(for_little(total, x.size)(x)) is float
        assert not total.is_compiled
    assert for_little(total, 1)(x) == x.size
    assert total.is_compiled
