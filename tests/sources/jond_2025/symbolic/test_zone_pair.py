"""The pair's symbolic behaviours against the compiled ones, the bound's series, the drag and the stand-off."""

from math import tanh

import numpy as np
import pytest
import sympy as sp

from flockana import ZoneFlocking, ZoneRadii, ZoneWeights
from flockana.sources.jond_2025.kernels.zones import saturation as compiled_saturation
from flockana.sources.jond_2025.symbolic import zone_pair as symbolic

PLAIN = ZoneWeights(separation=1.0, cohesion_gain=1.0, alignment_gain=1.0)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_the_two_forms_are_one(m):
    derivation = symbolic.derive_equivalence(m)
    assert derivation.residuals == (0,) * (3 * m)


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("form", ["position", "bearing"])
def test_kernel_and_derivation_agree(m, form):
    expressions = {"position": symbolic.position_form, "bearing": symbolic.bearing_form}[form](m)
    symbols = [x for part in symbolic.pair_symbols(m) for x in part]
    law, rng = ZoneFlocking(ZoneRadii(0.1, c=3.0, a=5.0), PLAIN, form=form), np.random.default_rng(m)
    for _ in range(5):
        gap = rng.normal(size=m)
        p_i, v_i, v_j = rng.normal(size=(3, m))
        p_j = p_i + 2.0 * gap / np.linalg.norm(gap)  # in the zone of conflict, where all three act
        values = dict(zip(symbols, [*p_i, *v_i, *p_j, *v_j], strict=True)) | {symbolic.C: 3}
        found = law.behaviours(np.stack([p_i, p_j]), np.stack([v_i, v_j]))
        for name, expression in expressions.items():
            wanted = [float(x) for x in expression.xreplace(values).evalf(25)]
            np.testing.assert_allclose(found[name][0], wanted, rtol=1e-12, atol=1e-14, err_msg=name)


def test_the_series_of_the_bound():
    x = sp.Symbol("x", nonnegative=True)
    assert sp.series(symbolic.saturation(x, bound=1) / x, x, 0, 6).removeO() == 1 - x**2 / 3 + 2 * x**4 / 15
    assert sp.limit(symbolic.saturation(x) / x, x, 0) == 1
    for value in (1e-12, 5e-5, 0.2, 3.0):
        exact = symbolic.saturation(sp.Rational(str(value)), bound=2).evalf(30) / sp.Rational(str(value))
        assert compiled_saturation(value, 2.0) == pytest.approx(float(exact), rel=4e-16)
    seam = 1e-4  # below it the kernel keeps the first two terms: the third is under half a unit of rounding
    assert float(2 * sp.Rational(str(seam)) ** 4 / 15) < 2.0**-54


@pytest.mark.parametrize(("step", "speed"), [(0.1, 2.0083), (0.05, 1.628), (0.01, 0.974), (0.001, 0.457)])
def test_the_drag_of_the_printed_bound(step, speed):
    """Reference: the errata's figures (A7), found there by iteration."""
    found = float(symbolic.fastest_under_drag(step, 2, 4))
    assert found == pytest.approx(speed, abs=6e-4)
    assert 4.0 * tanh((found + 2.0 * step) / 4.0) == pytest.approx(found, rel=1e-12)


def test_stand_off():
    general = symbolic.stand_off()
    assert sp.simplify(general - (symbolic.C - symbolic.SPEED * sp.Symbol("w^ga", positive=True) / symbolic.GAIN)) == 0


@pytest.mark.parametrize(("weight", "gain"), [(5.0, 1.0), (2.0, 1.5)])
def test_a_pair_rests_where_the_compiled_forces_vanish(weight, gain):
    distance = float(symbolic.rest_distance(separation=weight, cohesion=gain, repulsion=1).subs(symbolic.C, 3))
    law = ZoneFlocking(weights=ZoneWeights(separation=weight, cohesion_gain=gain))
    parts = law.behaviours([[0.0], [distance]], [[0.0], [0.0]])
    np.testing.assert_allclose(parts["separation"] + parts["cohesion"], 0.0, atol=1e-14)
    assert np.abs(parts["cohesion"]).min() > 1.0
    general = next(each for each in symbolic.rest_distance().args if each.has(symbolic.C))
    w, g = (next(s for s in general.free_symbols if s.name == name) for name in "wg")
    assert sp.simplify(general.subs({symbolic.C: 3, w: weight, g: gain}) - distance) < 1e-12
    assert sp.ask(sp.Q.positive(sp.simplify((symbolic.C - general) * (w + g))))  # below c for every cohesion


@pytest.mark.parametrize("speed", [0.0, 1.0, 3.0, 4.0, 7.0])
def test_the_altitude_is_the_compiled_laws(speed):
    numbers = {symbolic.BOUND: 4, sp.Symbol("r", positive=True): 1.5, sp.Symbol("a", positive=True): 5}
    law = ZoneFlocking(zone_length="speed")
    assert law.altitudes([[0.0, speed]])[0] == pytest.approx(float(symbolic.altitude(speed).subs(numbers)), rel=1e-14)


def test_speeds_of_a_pair_of_whom_one_is_informed():
    """The matrix is the Jacobian of the compiled law; its polynomial is Hurwitz, as all coefficients are positive."""
    matrix, polynomial = symbolic.informed_pair()
    g = next(s for s in polynomial.free_symbols if s.name == "g")
    numbers = np.array(matrix.subs({g: 2, symbolic.GAIN: 5}), dtype=float)
    law = ZoneFlocking(weights=ZoneWeights(speed=(5.0, 0.0), cohesion_gain=0.0, alignment_gain=2.0))
    x = np.array([0.3, -0.2])
    parts = law.behaviours([[0.0, 0.0], [0.0, 4.0]], np.column_stack([3.0 + x, [0.0, 0.0]]))
    np.testing.assert_allclose(sum(parts.values())[:, 0], numbers @ x, atol=1e-14)
    rate = next(s for s in polynomial.free_symbols if s.name == "lambda")
    assert all(c.is_positive for c in sp.Poly(polynomial, rate).all_coeffs())
    assert (np.linalg.eigvals(numbers).real < 0.0).all()
