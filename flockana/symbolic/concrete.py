"""A small flock written out: u_i, H(q, p), and dH/dt by the chain rule over all agents.

Here nothing is lifted from a generic pair: the sums are formed, differentiated and compared as they stand,
with the graph Laplacian as a matrix. So it tests the lifting of `flockana.symbolic.energy`, and reference
values come from it.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import sympy as sp

from flockana.base.checks import ensure_dimension, ensure_known
from flockana.base.errors import ArgumentError
from flockana.symbolic import sums
from flockana.symbolic.derivation import Printed, Step, latex_steps
from flockana.symbolic.functions import HALF
from flockana.symbolic.norms import EPS, sigma_norm
from flockana.symbolic.pair import ADJACENCY, along_flow, own_force, pair_force, pair_potential, vector
from flockana.symbolic.parameters import GAINS, GainSymbols

LAWS = ("algorithm1", "algorithm2")


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
        if not isinstance(self.n, int) or self.n < 1:
            raise ArgumentError(f"n = {self.n!r}: expected a number of agents >= 1")
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
        """The state (x, v) relative to the centre of mass."""
        x, v = (tuple(each - sum(rows[1:], rows[0]) / self.n for each in rows) for rows in (self.q, self.p))
        return x, v

    @cached_property
    def acceleration(self) -> tuple[sp.Matrix, ...]:
        """Input u_i of every agent."""
        total = []
        for i, (q_i, p_i) in enumerate(zip(self.q, self.p, strict=True)):
            u_i = sp.zeros(self.m, 1)
            if self.law == "algorithm2":
                u_i += own_force(q_i, p_i, *self.target, gains=self.gains)
            for j, (q_j, p_j) in enumerate(zip(self.q, self.p, strict=True)):
                if j != i:
                    u_i += pair_force(q_i, p_i, q_j, p_j, gains=self.gains)
            total.append(sp.ImmutableMatrix(u_i))
        return tuple(total)

    @cached_property
    def energy(self) -> sp.Expr:
        """H(q, p) of Algorithm 1, H_lambda(x, v) of Algorithm 2 as a function of q and p."""
        x, v = self.moving if self.law == "algorithm2" else (self.q, self.p)
        potential = sp.Add(*(pair_potential(x_i, x_j, gains=self.gains) for x_i, x_j in combinations(x, 2)))
        kinetic = self.kinetic_factor * sp.Add(*(v_i.dot(v_i) for v_i in v))
        if self.law == "algorithm1":
            return potential + kinetic
        return potential + self.gains.c1_gamma * HALF * sp.Add(*(x_i.dot(x_i) for x_i in x)) + kinetic

    @cached_property
    def rate(self) -> sp.Expr:
        """The energy's time derivative along the flow, by the chain rule over all agents."""
        q, p, u = ([s for rows in part for s in rows] for part in (self.q, self.p, self.acceleration))
        return along_flow(self.energy, q, p, u)

    @cached_property
    def laplacian(self) -> sp.Matrix:
        """The graph Laplacian L = Delta(A) - A of the weights a_ij."""

        def weight(i: int, j: int) -> sp.Expr:
            return sp.S.Zero if i == j else ADJACENCY(sigma_norm(self.q[j] - self.q[i]))

        adjacency = sp.Matrix(self.n, self.n, weight)
        return sp.ImmutableMatrix(sp.diag(*(adjacency * sp.ones(self.n, 1))) - adjacency)

    @cached_property
    def claimed(self) -> sp.Expr:
        """The closed form: -c2_alpha p^T L p; for Algorithm 2, -c2_alpha v^T L v - c2_gamma |v|^2."""
        v = self.moving[1] if self.law == "algorithm2" else self.p
        stacked = sp.Matrix.vstack(*v)
        quadratic = (stacked.T * sp.kronecker_product(self.laplacian, sp.eye(self.m)) * stacked)[0]
        drag = self.gains.c2_gamma * stacked.dot(stacked) if self.law == "algorithm2" else 0
        return -self.gains.c2_alpha * quadratic - drag

    @cached_property
    def residual(self) -> sp.Expr:
        """Return rate - claimed, in roots sqrt(1 + eps |q_j - q_i|^2) of each pair: 0 for a theorem."""
        roots = {}
        for i, j in combinations(range(self.n), 2):
            square = (1 + EPS * sigma_norm(self.q[j] - self.q[i])) ** 2
            roots[square] = sp.Symbol(f"w_{i + 1}{j + 1}", positive=True) ** 2
        return sp.expand((self.rate - self.claimed).xreplace(roots))

    def expand(self, generic: sp.Expr) -> sp.Expr:
        """Return an expression in sums over n agents written out for this flock.

        Parameters
        ----------
        generic : sympy.Expr
            An expression of `flockana.symbolic.sums`, such as an `EnergyIdentity` has.

        Examples
        --------
        >>> ConcreteFlock("algorithm1", 2, 1).expand(sums.half_square(sums.P))
        p_11**2/2 + p_21**2/2
        """
        x, v = self.moving
        rows = {sums.Q: self.q, sums.P: self.p, sums.X: x, sums.V: v}

        def entry(indexed: sp.Indexed) -> sp.Expr:
            i, k = (int(index) - 1 for index in indexed.indices)
            return sigma_norm(self.q[k] - self.q[i]) if indexed.base == sums.Z else rows[indexed.base][i][k]

        written = sums.write_out(generic, self.n, self.m)
        return written.xreplace({indexed: entry(indexed) for indexed in written.atoms(sp.Indexed)})

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
