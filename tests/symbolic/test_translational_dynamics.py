"""Transfer functions of the centre of mass, against the state-space form and erratum E12."""

import pytest
import sympy as sp

from flockana.base.errors import ArgumentError
from flockana.symbolic import GAINS, GainSymbols, frequency_gain, transfer_function
from flockana.symbolic.translational_dynamics import OMEGA, S

K = sp.Symbol("k", real=True)
MSN = GainSymbols(c1_gamma=70, c2_gamma=2 * sp.sqrt(70))


def test_transfer_functions_of_the_spec() -> None:
    c1, c2 = GAINS.c1_gamma, GAINS.c2_gamma
    denominator = S**2 + c2 * S + c1
    for scale, numerator in ((1, c2 * S + c1), (0, c1), (K, K * c2 * S + c1)):
        assert sp.simplify(transfer_function(scale) - numerator / denominator) == 0


def test_frequency_gain_is_the_modulus() -> None:
    for scale in (0, 1, K):
        response = transfer_function(scale, gains=MSN).subs(S, sp.I * OMEGA)
        assert sp.simplify(frequency_gain(scale, gains=MSN) ** 2 - response * sp.conjugate(response)) == 0
    assert frequency_gain(K, omega=0).subs(GAINS.c1_gamma, 2) == 1


@pytest.mark.parametrize(("scale", "stated"), [(0.009, 0.852), (1, 1.109)])
def test_e12_radii(scale: float, stated: float) -> None:
    """Case 4: radius ratio with the printed p_r (per iteration of 0.009 s) and with the true one, to three digits."""
    gain = frequency_gain(scale, gains=MSN, omega=2 * sp.pi * sp.Rational(25, 1000) / sp.Rational(45, 1000))
    assert float(gain) == pytest.approx(stated, abs=5e-4)


def test_bad_scale_is_named() -> None:
    with pytest.raises(ArgumentError, match="scale = nan: expected a finite number"):
        transfer_function(float("nan"))
