import sympy as sp

from flockana.symbolic.code_printing import Constants, function_text


def test_constants_become_parameters():
    x, k = sp.symbols("x k")
    constants = Constants([x], 2)
    assert str(constants.extract_constants(sp.sqrt(k) * x + 1)) == "c2*x + 1"
    assert constants.values == [sp.sqrt(k)]


def test_a_piecewise_function_shares_what_its_results_share():
    x = sp.Symbol("x")
    lines = function_text("f", "x", ["y, m0 = x, 1.0"], [[x**2, sp.sin(x) + x**2]], "v0").splitlines()
    assert [line.strip() for line in lines[:6]] == [
        "def f(x):",
        "y, m0 = x, 1.0",
        "x0 = (x*x)",
        "p0, p1 = x0, x0 + sine(x)",
        "v0 = p0 if y < m0 else p1",
        "return v0",
    ]
