"""A small flock written out: u_i, H(q, p), and dH/dt by the chain rule over all agents.

Here nothing is lifted from a generic pair: the sums are formed, differentiated and compared as they stand,
with the graph Laplacian as a matrix. So it tests the lifting of `flockana.symbolic.energy`, and reference
values come from it, by mpmath with thirty digits: slow and exact, for tests that hold a fast kernel against the formula
itself. psi_alpha comes from its derived pieces, the rate of the energy from the chain rule, not from the closed form.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np
import numpy.typing as npt
import sympy as sp

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import (
    FloatArray,
    ensure_count,
    ensure_dimension,
    ensure_known,
    ensure_state,
    ensure_vector,
)
from flockana.symbolic import sums_over_pairs
from flockana.symbolic.derivation import Printed, Step, latex_steps
from flockana.symbolic.generic_pair import ADJACENCY, along_flow, own_force, pair_force, pair_potential, vector
from flockana.symbolic.parameter_symbols import GAINS, AlphaSymbols, GainSymbols
from flockana.symbolic.potentials import ALPHA_NAMED, Z, psi_alpha
from flockana.symbolic.scalar_functions import HALF, adjacency, phi_alpha
from flockana.symbolic.sigma_norms import EPS, sigma_norm

LAWS = ("algorithm1", "algorithm2")
DIGITS = 30


@dataclass(frozen=True)
class ConcreteFlock(Printed):
    """Small flock under a law, every expression explicit in the symbols q and p.

    Parameters
    ----------
    law : str
        ``"algorithm1"`` or ``"algorithm2"``.
    kinetic_factor : sympy.Expr
        Of sum |p_i|^2 (sum |v_i|^2) in the energy: 1/2; the printed H of erratum E1 has 1.

    Examples
    --------
    >>> ConcreteFlock("algorithm2", 2, 1).residual
    0
    """

    law: str
    n: int
    m: int
    gains: GainSymbols = GAINS
    kinetic_factor: sp.Expr = HALF

    def __post_init__(self) -> None:
        ensure_known("law", self.law, LAWS)
        ensure_count("n", self.n)
        ensure_dimension(self.m)

    @cached_property
    def q(self) -> tuple[sp.Matrix, ...]:
        """Positions, one column per agent."""
        return tuple(vector(f"q_{i}", self.m) for i in range(1, self.n + 1))

    @cached_property
    def p(self) -> tuple[sp.Matrix, ...]:
        """Velocities, one column per agent."""
        return tuple(vector(f"p_{i}", self.m) for i in range(1, self.n + 1))

    @cached_property
    def target(self) -> tuple[sp.Matrix, sp.Matrix]:
        """Position and velocity of the gamma-agent."""
        return vector("q_r", self.m), vector("p_r", self.m)

    @cached_property
    def moving(self) -> tuple[tuple[sp.Matrix, ...], tuple[sp.Matrix, ...]]:
        """State (x, v) relative to the centre of mass."""
        x, v = (tuple(row - sum(rows[1:], rows[0]) / self.n for row in rows) for rows in (self.q, self.p))
        return x, v

    @cached_property
    def acceleration(self) -> tuple[sp.Matrix, ...]:
        """Input u_i of every agent."""
        total = []
        for i, own_p in enumerate(agents := list(zip(self.q, self.p, strict=True))):
            u_i = sp.zeros(self.m, 1)
            if self.law == "algorithm2":
                u_i += own_force(*own_p, *self.target, gains=self.gains)
            for other in agents[:i] + agents[i + 1 :]:
                u_i += pair_force(*own_p, *other, gains=self.gains)
            total.append(sp.ImmutableMatrix(u_i))
        return tuple(total)

    @cached_property
    def energy(self) -> sp.Expr:
        """H(q, p) of Algorithm 1, H_lambda(x, v) of Algorithm 2 as a function of q and p."""
        x, v = self.moving if self.law == "algorithm2" else (self.q, self.p)
        potential = sp.Add(*(pair_potential(x_i, x_j, gains=self.gains) for x_i, x_j in combinations(x, 2)))
        inertia, kinetic = (sp.Add(*(row.dot(row) for row in rows)) for rows in (x, v))
        pull = self.gains.c1_gamma * HALF * inertia if self.law == "algorithm2" else sp.S.Zero
        return potential + pull + self.kinetic_factor * kinetic

    @cached_property
    def rate(self) -> sp.Expr:
        """Time derivative of the energy along the flow, by the chain rule over all agents."""
        q, p, u = ([s for rows in part for s in rows] for part in (self.q, self.p, self.acceleration))
        return along_flow(self.energy, q, p, u)

    @cached_property
    def laplacian(self) -> sp.Matrix:
        """Graph Laplacian L = Delta(A) - A of the weights a_ij."""

        def weight(i: int, j: int) -> sp.Expr:
            return sp.S.Zero if i == j else ADJACENCY(sigma_norm(self.q[j] - self.q[i]))

        adjacency = sp.Matrix(self.n, self.n, weight)
        return sp.ImmutableMatrix(sp.diag(*(adjacency * sp.ones(self.n, 1))) - adjacency)

    @cached_property
    def claimed(self) -> sp.Expr:
        """Closed form of the energy rate: -c2_alpha p^T L p; in Algorithm 2 with v, less c2_gamma |v|^2."""
        v = self.moving[1] if self.law == "algorithm2" else self.p
        stacked = sp.Matrix.vstack(*v)
        quadratic = (stacked.T * sp.kronecker_product(self.laplacian, sp.eye(self.m)) * stacked)[0]
        drag = self.gains.c2_gamma * stacked.dot(stacked) if self.law == "algorithm2" else 0
        return -self.gains.c2_alpha * quadratic - drag

    @cached_property
    def residual(self) -> sp.Expr:
        """Return the energy rate less its claimed closed form: 0 for a theorem."""
        roots = {}
        for i, j in combinations(range(self.n), 2):
            squared_value = (1 + EPS * sigma_norm(self.q[j] - self.q[i])) ** 2
            roots[squared_value] = sp.Symbol(f"w_{i + 1}{j + 1}", positive=True) ** 2
        return sp.expand((self.rate - self.claimed).xreplace(roots))

    def expand(self, generic: sp.Expr) -> sp.Expr:
        """Return an expression in sums over n agents written out for this flock.

        Parameters
        ----------
        generic : sympy.Expr
            An expression of `flockana.symbolic.sums_over_pairs`, such as an `EnergyIdentity` has.

        Examples
        --------
        >>> ConcreteFlock("algorithm1", 2, 1).expand(sums_over_pairs.half_square(sums_over_pairs.P))
        p_11**2/2 + p_21**2/2
        """
        x, v = self.moving
        rows = {sums_over_pairs.Q: self.q, sums_over_pairs.P: self.p, sums_over_pairs.X: x, sums_over_pairs.V: v}

        def entry(indexed: sp.Indexed) -> sp.Expr:
            i, k = (int(index) - 1 for index in indexed.indices)
            return sigma_norm(self.q[k] - self.q[i]) if indexed.base == sums_over_pairs.Z else rows[indexed.base][i][k]

        written_sum = sums_over_pairs.write_out(generic, self.n, self.m)
        return written_sum.xreplace({indexed: entry(indexed) for indexed in written_sum.atoms(sp.Indexed)})

    def latex(self) -> str:
        """Return acceleration, energy, rate and closed form as LaTeX."""
        steps = (
            *(Step(rf"$u_{{{i}}} =$", u_i) for i, u_i in enumerate(self.acceleration, start=1)),
            Step("Energy:", self.energy),
            Step("Its rate, by the chain rule:", self.rate),
            Step("The closed form:", self.claimed),
            Step("What is left between the two:", self.residual),
        )
        return latex_steps(f"{self.law.capitalize()}, n = {self.n}, m = {self.m}", steps)


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
    functions: tuple[Callable[..., Any], ...]

    def _evaluate(self, which: int, q: Any, p: Any) -> Any:
        """Return acceleration, energy or energy rate at a state, in high precision."""
        q, p = ensure_state(q, p)
        if q.shape != (self.flock.n, self.flock.m):
            raise ArgumentError(f"q has shape {q.shape}: expected {(self.flock.n, self.flock.m)}, as derived")
        with mpmath.workdps(DIGITS):
            return self.functions[which](*(mpmath.mpf(x) for x in (*q.ravel().tolist(), *p.ravel().tolist())))

    def acceleration(self, q: npt.ArrayLike, p: npt.ArrayLike) -> FloatArray:
        """Return the inputs u of all agents at a state, shape (n, m)."""
        input_values = [float(u) for u in self._evaluate(0, q, p)]
        return np.array(input_values).reshape(self.flock.n, self.flock.m)

    def energy(self, q: npt.ArrayLike, p: npt.ArrayLike) -> float:
        """Return H(q, p) of Algorithm 1, H_lambda(x, v) of Algorithm 2."""
        return float(self._evaluate(1, q, p))

    def energy_rate(self, q: npt.ArrayLike, p: npt.ArrayLike) -> float:
        """Return the energy's time derivative along the flow, by the chain rule."""
        return float(self._evaluate(2, q, p))


def _numbers(alpha: AlphaSymbols) -> list[sp.Expr]:
    return [alpha.h, alpha.a, alpha.b, alpha.c, alpha.d_alpha, alpha.r_alpha]


def _compile(scalar: Callable[..., sp.Expr], numbers: list[sp.Expr]) -> Callable[[Any], Any]:
    """Return a scalar function of the sigma-distance z, compiled with fixed parameters."""
    function = sp.lambdify([Z, *_numbers(ALPHA_NAMED)], scalar(Z, alpha=ALPHA_NAMED), "mpmath")
    with mpmath.workdps(DIGITS):
        values = [mpmath.mpmathify(number.evalf(DIGITS)) for number in numbers]
    return lambda z: function(z, *values)


def numeric_law(
    law: str, n: int, m: int, *, alpha: AlphaSymbols, gains: GainSymbols, q_r: Any = None, p_r: Any = None
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
    for name, symbols, given_value in zip(("q_r", "p_r"), flock.target, (q_r, p_r), strict=True):
        components = ensure_vector(name, np.zeros(m) if given_value is None else given_value, m)
        values |= {symbol: sp.Rational(float(x)) for symbol, x in zip(symbols, components, strict=True)}
    state = [symbol for part in (flock.q, flock.p) for row in part for symbol in row]
    parameter_values = _numbers(alpha)
    accelerations = [u.xreplace(values) for row in flock.acceleration for u in row]
    expressions = [accelerations, flock.energy.xreplace(values), flock.rate.xreplace(values)]
    missing = sp.Tuple(*parameter_values, *sp.flatten(expressions)).free_symbols - set(state)
    if missing:
        raise ArgumentError(f"parameters {sorted(map(str, missing))} are symbols: expected a number for each")
    scalars = {"phi_alpha": phi_alpha, "psi_alpha": psi_alpha, "a": adjacency}
    modules = [{name: _compile(scalar, parameter_values) for name, scalar in scalars.items()}, "mpmath"]
    return NumericLaw(flock, tuple(sp.lambdify(state, expression, modules, cse=True) for expression in expressions))
