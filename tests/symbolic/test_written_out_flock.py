"""Flocks written out, and the reference values computed from them, against the kernels."""

import subprocess
import sys
from functools import cache

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, AlphaInteraction, Gains, StaticTarget
from flockana.base.errors import UnknownNameError
from flockana.symbolic import AlphaSymbols, ConcreteFlock, GainSymbols, NumericLaw, numeric_law
from tests.refused import refused

PAPER = AlphaSymbols(eps=0.1, h=0.2, a=5, b=5, d=7, r=8.4)
UNEVEN = AlphaSymbols(eps=0.1, h=0.4, a=7, b=9, d=1.9, r=2.8)
GAINS = GainSymbols(c1_alpha=3, c2_alpha=2, c1_gamma=1.1, c2_gamma=0.5)
LAWS = ["algorithm1", "algorithm2"]
SIZES = [(1, 1), (1, 3), (2, 1), (2, 2), (2, 3), (3, 1), (3, 2), (3, 3), (4, 2)]


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("n", "m"), SIZES)
def test_the_chain_rule_gives_the_closed_form(law: str, n: int, m: int) -> None:
    assert ConcreteFlock(law, n, m).residual == 0


@cache
def reference(law: str, n: int, m: int, alpha: AlphaSymbols) -> NumericLaw:
    """Build a reference once per size."""
    return numeric_law(law, n, m, alpha=alpha, gains=GAINS, q_r=[2.0] * m, p_r=[0.25] * m)


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("n", "m", "alpha"), [(2, 1, PAPER), (3, 2, PAPER), (3, 3, UNEVEN), (4, 2, UNEVEN)])
def test_reference_values_are_those_of_the_kernels(law, n, m, alpha):
    """1e-12 relative to the largest term: the kernels cancel in floats, the reference does not."""
    pair = AlphaInteraction(**{name: float(getattr(alpha, name)) for name in ("d", "r", "eps", "h", "a", "b")})
    gains = Gains(c1_alpha=3.0, c2_alpha=2.0, c1_gamma=1.1, c2_gamma=0.5)
    target = StaticTarget((2.0,) * m, (0.25,) * m)
    own = Algorithm1(pair, gains) if law == "algorithm1" else Algorithm2(pair, gains, target)
    q, p = np.random.default_rng(n * m).normal(size=(2, n, m))
    for spread in (0.3, 1.0):
        u = own.acceleration(0.0, spread * pair.r * q, p)
        found = reference(law, n, m, alpha).acceleration(spread * pair.r * q, p)
        np.testing.assert_allclose(found, u, rtol=1e-12, atol=1e-12 * np.abs(u).max())


@pytest.mark.parametrize("law", LAWS)
def test_the_rate_is_the_derivative_of_the_energy(law: str) -> None:
    """Central difference along q + p t + u t^2/2, p + u t: error 340 t^2 here (measured), rounding 1e-14/t."""
    numeric, t = reference(law, 3, 2, PAPER), 1e-5
    q, p = np.array([[0.0, 0.0], [6.0, 1.0], [2.0, 7.5]]), np.array([[0.5, -0.2], [-1.0, 0.3], [0.1, 0.8]])
    u = numeric.acceleration(q, p)
    ahead, behind = (numeric.energy(q + s * p + s * s / 2 * u, p + s * u) for s in (t, -t))
    assert (ahead - behind) / (2 * t) == pytest.approx(numeric.energy_rate(q, p), rel=1e-6)


test_bad_input_is_named = refused(
    (lambda: ConcreteFlock("algoritm1", 2, 1), "unknown law 'algoritm1'; did you mean 'algorithm1'", UnknownNameError),
    (lambda: ConcreteFlock("algorithm1", 0, 1), "n = 0: expected a whole number >= 1"),
    (lambda: ConcreteFlock("algorithm1", 2, 4), "m = 4: expected a dimension"),
    (
        lambda: numeric_law("algorithm2", 2, 1, alpha=PAPER, gains=GainSymbols(1, 1)),
        r"parameters \['c_1\^gamma', 'c_2\^gamma'\] are symbols",
    ),
    (lambda: numeric_law("algorithm2", 2, 2, alpha=PAPER, gains=GAINS, q_r=[1.0]), "q_r has 1 components: expected 2"),
    (
        lambda: reference("algorithm1", 2, 1, PAPER).energy(np.zeros((3, 1)), np.zeros((3, 1))),
        r"q has shape \(3, 1\): expected \(2, 1\)",
    ),
)


def test_importing_it_loads_sympy_but_no_kernel() -> None:
    code = "import sys, flockana.symbolic; print([n for n in sys.modules if n.split('.')[0] in {0} or 'kernels' in n])"
    heavy = {"numba", "scipy", "matplotlib", "xarray", "networkx", "jinja2", "casadi", "control"}
    run = subprocess.run([sys.executable, "-c", code.replace("{0}", repr(heavy))], capture_output=True, text=True)
    assert (run.stdout.strip(), run.returncode) == ("[]", 0), run.stderr
