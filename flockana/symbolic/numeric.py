"""Reference values of the symbolic expressions, by mpmath with thirty digits, as numpy arrays.

Slow and exact, for tests that hold a fast kernel against the formula itself. psi_alpha comes from its
derived pieces, the rate of the energy from the chain rule, not from the closed form.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np
import numpy.typing as npt
import sympy as sp

from flockana.base.checks import ensure_state, ensure_vector
from flockana.base.errors import ArgumentError
from flockana.symbolic.concrete import ConcreteFlock
from flockana.symbolic.functions import adjacency, phi_alpha
from flockana.symbolic.norms import EPS
from flockana.symbolic.parameters import AlphaSymbols, GainSymbols
from flockana.symbolic.potentials import ALPHA_NAMED, Z, psi_alpha

DIGITS = 30
FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class NumericLaw:
    """Law with numeric parameters, evaluated from its symbolic expressions.

    Parameters
    ----------
    flock : ConcreteFlock
        The expressions.
    functions : tuple of callables
        Acceleration, energy and energy rate of the flat state.

    Examples
    --------
    >>> paper = AlphaSymbols(eps=0.1, h=0.2, a=5, b=5, d=7, r=8.4)
    >>> law = numeric_law("algorithm1", 2, 1, alpha=paper, gains=GainSymbols(1, 1))
    >>> law.energy([[0.0], [0.0]], [[0.0], [0.0]])
    52.38381178664486
    """

    flock: ConcreteFlock
    functions: tuple[Callable[..., Any], Callable[..., Any], Callable[..., Any]]

    def _evaluate(self, which: int, q: Any, p: Any) -> Any:
        """Return one of the functions at a state, in high precision."""
        q, p = ensure_state(q, p)
        if q.shape != (self.flock.n, self.flock.m):
            raise ArgumentError(f"q has shape {q.shape}: expected {(self.flock.n, self.flock.m)}, as derived")
        with mpmath.workdps(DIGITS):
            return self.functions[which](*(mpmath.mpf(x) for x in (*q.ravel().tolist(), *p.ravel().tolist())))

    def acceleration(self, q: npt.ArrayLike, p: npt.ArrayLike) -> FloatArray:
        """Return u, shape (n, m)."""
        flat = [float(u) for u in self._evaluate(0, q, p)]
        return np.array(flat).reshape(self.flock.n, self.flock.m)

    def energy(self, q: npt.ArrayLike, p: npt.ArrayLike) -> float:
        """Return H(q, p) of Algorithm 1, H_lambda(x, v) of Algorithm 2."""
        return float(self._evaluate(1, q, p))

    def energy_rate(self, q: npt.ArrayLike, p: npt.ArrayLike) -> float:
        """Return the energy's time derivative along the flow, by the chain rule."""
        return float(self._evaluate(2, q, p))


def _compile(scalar: Callable[..., sp.Expr], numbers: list[sp.Expr]) -> Callable[[Any], Any]:
    """Return a function of z with fixed parameters."""
    named = ALPHA_NAMED
    parameters = [named.h, named.a, named.b, named.c, named.d_alpha, named.r_alpha]
    function = sp.lambdify([Z, *parameters], scalar(Z, alpha=named), "mpmath")
    with mpmath.workdps(DIGITS):
        values = [mpmath.mpmathify(number.evalf(DIGITS)) for number in numbers]
    return lambda z: function(z, *values)


def numeric_law(
    law: str,
    n: int,
    m: int,
    *,
    alpha: AlphaSymbols,
    gains: GainSymbols,
    q_r: npt.ArrayLike | None = None,
    p_r: npt.ArrayLike | None = None,
) -> NumericLaw:
    """Return acceleration, energy and energy rate of a small flock as functions of numpy arrays.

    Parameters
    ----------
    law : str
        ``"algorithm1"`` or ``"algorithm2"``.
    n, m : int
        Number of agents (small: the expressions grow as n^2), dimension.
    gains : GainSymbols
        Gains, all numbers that the law uses.
    q_r, p_r : array_like, shape (m,), optional
        State of the gamma-agent; the origin at rest if not given.

    Examples
    --------
    >>> paper = AlphaSymbols(eps=0.1, h=0.2, a=5, b=5, d=7, r=8.4)
    >>> law = numeric_law("algorithm2", 1, 1, alpha=paper, gains=GainSymbols(1, 1, 1, 2), q_r=[3.0])
    >>> law.acceleration([[1.0]], [[0.5]]).tolist()
    [[1.0]]
    """
    flock = ConcreteFlock(law, n, m, gains)
    values: dict[sp.Expr, sp.Expr] = {EPS: alpha.eps}
    for name, symbols, given in zip(("q_r", "p_r"), flock.target, (q_r, p_r), strict=True):
        components = ensure_vector(name, np.zeros(m) if given is None else given, m)
        values |= {symbol: sp.Rational(float(x)) for symbol, x in zip(symbols, components, strict=True)}
    state = [symbol for part in (flock.q, flock.p) for row in part for symbol in row]
    numbers = [alpha.h, alpha.a, alpha.b, alpha.c, alpha.d_alpha, alpha.r_alpha]
    expressions = [
        [u.xreplace(values) for row in flock.acceleration for u in row],
        flock.energy.xreplace(values),
        flock.rate.xreplace(values),
    ]
    missing = sp.Tuple(*numbers, *expressions[0], *expressions[1:]).free_symbols - set(state)
    if missing:
        raise ArgumentError(f"parameters {sorted(map(str, missing))} are symbols: expected a number for each")
    scalars = {"phi_alpha": phi_alpha, "psi_alpha": psi_alpha, "a": adjacency}
    modules = [{name: _compile(scalar, numbers) for name, scalar in scalars.items()}, "mpmath"]
    compiled = tuple(sp.lambdify(state, expression, modules, cse=True) for expression in expressions)
    return NumericLaw(flock, (compiled[0], compiled[1], compiled[2]))
