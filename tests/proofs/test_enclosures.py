"""The compiled kernels lie within rounding of enclosures that hold, to 30 digits, for every scenario."""

import numpy as np
import pytest
from flint import arb, ctx

from flockana.certified import scalar_functions_in_balls
from flockana.certified.balls import AlphaParameters, BetaParameters, exact
from flockana.interactions import AlphaInteraction, BetaInteraction
from proofs import enclosures

EPS = np.finfo(float).eps
SETS = enclosures.parameter_sets()
ALPHA = [par for par in SETS if isinstance(par, AlphaParameters)]
BETA = [par for par in SETS if isinstance(par, BetaParameters)]
# plateau, taper and beyond; d_α on the taper for the first, on the plateau for the second
SHAPES = [AlphaParameters(), AlphaParameters(h="0.95"), AlphaParameters(a=1, b=40, eps="0.01")]


@pytest.fixture(autouse=True)
def _digits():
    with ctx.workdps(45):
        yield


def floats(par):
    kind = AlphaInteraction if isinstance(par, AlphaParameters) else BetaInteraction
    return kind(**{name: float(value.p) / float(value.q) for name, value in vars(par).items()})


def error(value, enclosure):
    """How far a float is from all of an enclosure."""
    return float((arb(value) - enclosure).abs_upper())


def test_every_scenario_with_an_interaction_is_enclosed():
    assert sum(len(users) for par, users in SETS.items() if isinstance(par, AlphaParameters)) >= 20
    assert len(ALPHA) >= 5
    assert len(BETA) >= 1
    for step in enclosures.PROOF.steps():
        assert step.holds is True, step.text


@pytest.mark.parametrize("par", [*ALPHA, *SHAPES], ids=str)
def test_alpha_constants_of_the_kernels_are_within_rounding(par):
    alpha, exact = floats(par), enclosures.alpha_constants(par)
    assert enclosures.to_digits(exact)
    for name in ("d_alpha", "r_alpha"):  # a square, a root and a division, of parameters that are rounded themselves
        assert error(getattr(alpha, name), exact[name]) <= 4 * EPS * float(exact[name])
    # documented: 1e-13 c* absolute
    assert error(alpha.c_star, exact["c_star"]) <= 1e-13 * alpha.c_star
    assert error(alpha.far_potential, exact["far_potential"]) <= 1e-13 * alpha.c_star


@pytest.mark.parametrize("par", [*BETA, BetaParameters(h="0.1"), BetaParameters(d="0.3", eps=2)], ids=str)
def test_beta_constants_of_the_kernels_are_within_rounding(par):
    beta, exact = floats(par), enclosures.beta_constants(par)
    assert error(beta.d_beta, exact["d_beta"]) <= 4 * EPS * beta.d_beta
    assert error(beta.psi_beta(0.0), exact["psi_beta_0"]) <= 1e-13 * beta.psi_beta(0.0)


@pytest.mark.parametrize("par", SHAPES, ids=str)
def test_alpha_functions_of_the_kernels_lie_on_the_enclosures(par):
    alpha = floats(par)
    scale = float(par.b.p) / float(par.b.q)
    for z in np.linspace(0.0, 1.1 * alpha.r_alpha, 23):
        assert error(alpha.phi_alpha(z), scalar_functions_in_balls.phi_alpha(arb(z), par)) <= 32 * EPS * scale
        assert (
            error(alpha.phi_alpha_slope(z), scalar_functions_in_balls.phi_alpha_slope(arb(z), par)) <= 64 * EPS * scale
        )
        assert error(alpha.psi_alpha(z), scalar_functions_in_balls.psi_alpha(arb(z), par)) <= 1e-13 * alpha.c_star
        assert error(alpha.adjacency(z), scalar_functions_in_balls.adjacency(arb(z), par)) <= 16 * EPS


def test_beta_functions_of_the_kernels_lie_on_the_enclosures():
    par = BetaParameters()
    beta = floats(par)
    for z in np.linspace(0.0, 1.1 * beta.d_beta, 23):
        assert error(beta.phi_beta(z), scalar_functions_in_balls.phi_beta(arb(z), par)) <= 32 * EPS
        assert error(beta.psi_beta(z), scalar_functions_in_balls.psi_beta(arb(z), par)) <= 1e-13 * beta.psi_beta(0.0)


def test_a_printed_value_with_one_wrong_digit_is_told():
    (par,) = (par for par in ALPHA if par == AlphaParameters())
    with ctx.workdps(45):
        c_star = scalar_functions_in_balls.c_star(par)
        assert enclosures.agree(c_star, "52.383811786644864")
        assert not enclosures.agree(c_star, "52.383811786644865")


def test_a_ball_encloses_the_function_on_all_of_it():
    par, rng = AlphaParameters(), np.random.default_rng(0)
    beta = BetaParameters()
    functions = [
        *(
            lambda z, f=f: f(z, par)
            for f in (
                scalar_functions_in_balls.phi_alpha,
                scalar_functions_in_balls.phi_alpha_slope,
                scalar_functions_in_balls.psi_alpha,
            )
        ),
        *(
            lambda z, f=f: f(z, beta)
            for f in (
                scalar_functions_in_balls.phi_beta,
                scalar_functions_in_balls.phi_beta_slope,
                scalar_functions_in_balls.psi_beta,
            )
        ),
        lambda x: scalar_functions_in_balls.sigma_norm(x, par.eps),
        lambda z: scalar_functions_in_balls.bump(z / 20, par.h),
        scalar_functions_in_balls.sigma_1,
        scalar_functions_in_balls.square,
    ]
    with ctx.workdps(20):
        for _ in range(40):
            middle, radius = rng.uniform(0.0, 25.0), 10.0 ** rng.uniform(-6.0, 0.5)
            for function in functions:
                wide = function(arb(middle, radius))
                for share in (-1.0, -0.4, 0.0, 0.7, 1.0):
                    assert wide.overlaps(function(arb(abs(middle + share * radius))))


def test_monotone_functions_are_not_overestimated():
    par = AlphaParameters()
    wide = scalar_functions_in_balls.psi_alpha(
        arb(4, 3), par
    )  # [1, 7], left of d_α: between ψ(7) and ψ(1), up to the balls' rounding
    ends = [scalar_functions_in_balls.psi_alpha(arb(z), par) for z in (7, 1)]
    assert float(wide.lower()) == pytest.approx(float(ends[0]), abs=1e-6)
    assert float(wide.upper()) == pytest.approx(float(ends[1]), abs=1e-6)
    around = scalar_functions_in_balls.psi_alpha(arb(scalar_functions_in_balls.d_alpha(par).mid(), 1), par)
    assert around.lower() <= 0
    assert float(around.lower()) > -1e-6


def test_parameters_are_the_decimals_that_are_printed():
    assert AlphaParameters.of(AlphaInteraction()) == AlphaParameters(7, "8.4", 0.1, "0.2", 5, 5)
    assert str(exact(0.1)) == "1/10"
    assert str(AlphaParameters()).startswith("d = 7, r = 42/5, eps = 1/10")
    with pytest.raises(ValueError, match=r"d = 7, r = 6, .*: expected 0 < d < r"):
        AlphaParameters(r=6)
    with pytest.raises(ValueError, match="h = 1: expected d > 0, eps > 0, 0 < h < 1"):
        BetaParameters(h=1)
