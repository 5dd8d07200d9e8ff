"""dH/dt of Algorithms 1 and 2, derived for generic n from one generic pair and one generic agent.

V is a sum over pairs, K and J are sums over agents, and every u_i is a sum over the other agents plus one
own term. So dH/dt is a sum over pairs of one expression plus a sum over agents of another, and an identity
between those two expressions is one for every n.
"""

from dataclasses import dataclass

import sympy as sp

from flockana.base.value_checks import ensure_dimension
from flockana.symbolic import sums_over_pairs
from flockana.symbolic.derivation import Printed, Step, latex_steps
from flockana.symbolic.generic_pair import ADJACENCY, PHI, along_flow, own_force, pair_force, pair_potential, vector
from flockana.symbolic.parameter_symbols import GAINS, GainSymbols
from flockana.symbolic.scalar_functions import HALF
from flockana.symbolic.sigma_norms import EPS, sigma_norm
from flockana.symbolic.sums_over_pairs import I_, J_, P, Q, V, X, Z, indexed, over_agents, over_pairs


@dataclass(frozen=True)
class EnergyIdentity(Printed):
    """Energy, its derived rate along the flow, the claimed closed form of the rate, and their difference.

    Parameters
    ----------
    energy : sympy.Expr
        The energy, as sums over n agents.
    rate : sympy.Expr
        Its time derivative along the flow, by the chain rule.
    claimed : sympy.Expr
        The closed form.
    residual : sympy.Expr
        rate - claimed, computed: 0 for a theorem.
    steps : tuple of Step
        The derivation.

    Examples
    --------
    >>> algorithm1_identity(2).residual
    0
    """

    name: str
    energy: sp.Expr
    rate: sp.Expr
    claimed: sp.Expr
    residual: sp.Expr
    steps: tuple[Step, ...]

    @property
    def holds(self) -> bool:
        """Return whether the derived energy rate equals the claimed one identically."""
        return bool(self.residual == 0)

    def latex(self) -> str:  # noqa: D102
        return latex_steps(self.name, self.steps)


class GenericPair:
    """Two agents i and j among n, by components: the terms of dH/dt that involve both."""

    z = sp.Symbol("z_ij", nonnegative=True)

    def __init__(self, m: int, frame: tuple[sp.IndexedBase, sp.IndexedBase] = (Q, P)) -> None:
        self.m = ensure_dimension(m)
        self.frame = frame
        position, velocity = (str(base) for base in frame)
        self.q = vector(f"{position}_i", m), vector(f"{position}_j", m)
        self.p = vector(f"{velocity}_i", m), vector(f"{velocity}_j", m)

    def forces(self, gains: GainSymbols = GAINS) -> tuple[sp.Matrix, sp.Matrix]:
        """Return the pair forces of agent j on i and of i on j, from one formula."""
        (q_i, q_j), (p_i, p_j) = self.q, self.p
        return pair_force(q_i, p_i, q_j, p_j, gains=gains), pair_force(q_j, p_j, q_i, p_i, gains=gains)

    def along(self, energy: sp.Expr, gains: GainSymbols = GAINS) -> sp.Expr:
        """Return the rate of a pair's energy under the forces between its two agents, simplified."""
        components = [[*first, *second_symbols] for first, second_symbols in (self.q, self.p, self.forces(gains))]
        return self.tidy(along_flow(energy, *components))

    def energy_rates(
        self, gains: GainSymbols = GAINS, *, copies: sp.Expr = sp.S.One, factor: sp.Expr = HALF
    ) -> tuple[sp.Expr, sp.Expr]:
        """Return the rates of copies times a pair's potential and of factor times (|p_i|^2 + |p_j|^2)."""
        kinetic = factor * sp.Add(*(p.dot(p) for p in self.p))
        return self.along(copies * pair_potential(*self.q, gains=gains), gains), self.along(kinetic, gains)

    def laplacian_form(self) -> sp.Expr:
        """Return the term of one pair in p^T L p: a_ij |p_j - p_i|^2."""
        stacked_velocities = sp.Matrix.vstack(*self.p)
        block = sp.kronecker_product(sp.Matrix([[1, -1], [-1, 1]]), sp.eye(self.m))
        return self.tidy(ADJACENCY(self.z) * (stacked_velocities.T * block * stacked_velocities)[0])

    def tidy(self, expression: sp.Expr) -> sp.Expr:
        """Return an expression expanded in relative coordinates, with the pair's sigma-norm named z_ij."""
        root = sp.Symbol("w", positive=True)
        pair_symbols = [pair for vectors in (self.q, self.p) for pair in zip(*vectors, strict=True)]
        relative = {i: j + sp.Symbol(f"d{i}", real=True) for i, j in pair_symbols}
        sigma = sigma_norm(self.q[1] - self.q[0])
        expression = expression.xreplace({sigma: self.z}).subs(1 + EPS * sigma, root)
        expanded_form = sp.expand(expression.subs(relative))
        collected_form = sp.collect(expanded_form, [PHI(self.z), ADJACENCY(self.z)], func=sp.factor)
        symbol_map = {relative[i] - j: i - j for i, j in pair_symbols}
        return collected_form.xreplace(symbol_map).subs(root, 1 + EPS * self.z)

    def lift(self, expression: sp.Expr) -> sp.Expr:
        """Return the sum over all pairs of a one-pair expression."""
        names: dict[sp.Expr, sp.Expr] = {self.z: Z[I_, J_]}
        for base, pair_symbols in zip(self.frame, (self.q, self.p), strict=True):
            for index, end in zip((I_, J_), pair_symbols, strict=True):
                names |= {symbol: base[index, k] for k, symbol in enumerate(end, start=1)}
        return over_pairs(expression.xreplace(names))


def _pair_steps(pair: GenericPair, factor: sp.Expr, gains: GainSymbols) -> tuple[sp.Expr, sp.Expr, tuple[Step, ...]]:
    """Return the derived and the claimed contribution of a pair to dH/dt, and the steps between them."""
    potential, power = pair.energy_rates(gains, factor=factor)
    total = pair.tidy(potential + power)
    stated_rate = -gains.c2_alpha * pair.laplacian_form()
    first_text = r"One generic pair, $d\psi_\alpha/dz = \phi_\alpha$: its potential changes at "
    steps = (
        Step(first_text + r"$c_1^\alpha \nabla\psi_\alpha \cdot (p_j - p_i)$,", potential),
        Step("the forces between the two, entered in the kinetic energy, work at", power),
        Step("and together the pair contributes", total),
    )
    return total, stated_rate, steps


def algorithm1_identity(m: int = 2, *, gains: GainSymbols = GAINS, kinetic_factor: sp.Expr = HALF) -> EnergyIdentity:
    """Derive dH/dt = -c2_alpha p^T L p along Algorithm 1, in the given frame (Olfati-Saber, Theorem 1).

    Parameters
    ----------
    kinetic_factor : sympy.Expr
        H = V + factor * sum |p_i|^2. Anything but 1/2 leaves a residual (erratum E1).

    Examples
    --------
    >>> algorithm1_identity(3).holds
    True
    """
    pair = GenericPair(m)
    total, stated_rate, steps = _pair_steps(pair, kinetic_factor, gains)
    energy = sums_over_pairs.hamiltonian(m, gains=gains, factor=kinetic_factor)
    rate = pair.lift(total)
    stated_form = pair.lift(stated_rate)
    lift_steps = (
        Step("The energy, every pair once, with", energy),
        Step("the sigma-distance of a pair:", sums_over_pairs.sigma_distance(Q, m)),
        *steps,
        Step(
            r"Lifting: $\dot H = \sum_{i<j} \dot\psi_{ij} + \sum_i p_i \cdot u_i$ and "
            r"$u_i = \sum_{j \neq i} f_{ij}$ regroup by pairs "
            r"($\phi_\alpha = a_{ij} = 0$ beyond $r_\alpha$), so $\dot H$ is",
            rate,
        ),
        Step(r"and $-c_2^\alpha\, p^T \hat L p$ is, with $\hat L$ the sum of its pairs' blocks,", stated_form),
    )
    residual = pair.lift(pair.tidy(total - stated_rate))
    return EnergyIdentity("Algorithm 1: energy", energy, rate, stated_form, residual, lift_steps)


def relative_feedback(x_i: sp.Matrix, v_i: sp.Matrix, gains: GainSymbols) -> tuple[sp.Matrix, sp.Matrix]:
    """Return the relative navigational feedback on an agent at (x_i, v_i), and the feedback on the centre."""
    q_c, p_c, q_r, p_r = (vector(name, len(x_i)) for name in ("q_c", "p_c", "q_r", "p_r"))
    centre = own_force(q_c, p_c, q_r, p_r, gains=gains)
    return (own_force(q_c + x_i, p_c + v_i, q_r, p_r, gains=gains) - centre).expand(), centre


def structural_identity(m: int = 2, *, gains: GainSymbols = GAINS, lambda_: sp.Expr | None = None) -> EnergyIdentity:
    """Derive dH_lambda/dt = -c2_gamma |v|^2 - c2_alpha v^T L v in the moving frame (Olfati-Saber, Theorem 3).

    Parameters
    ----------
    gains : GainSymbols
        Gains; all symbolic if not given. With c1_gamma = c2_gamma = 0 this is Algorithm 1.
    lambda_ : sympy.Expr, optional
        Weight of the inertia; c1_gamma if not given. Anything else leaves a residual.

    Examples
    --------
    >>> structural_identity(2).holds
    True
    >>> structural_identity(1, lambda_=sp.Symbol("lambda")).holds
    False
    """
    lambda_ = gains.c1_gamma if lambda_ is None else lambda_
    pair = GenericPair(m, (X, V))
    total, stated_rate, steps = _pair_steps(pair, HALF, gains)
    (x_i, _), (v_i, _) = pair.q, pair.p
    own_part = relative_feedback(x_i, v_i, gains)[0]
    agent = sp.factor_terms(sp.expand(along_flow(HALF * (lambda_ * x_i.dot(x_i) + v_i.dot(v_i)), x_i, v_i, own_part)))
    agent_claimed = -gains.c2_gamma * v_i.dot(v_i)
    names = indexed((X, x_i), (V, v_i))
    energy = sums_over_pairs.structural_hamiltonian(m, gains=gains, lambda_=lambda_)
    rate = pair.lift(total) + over_agents(agent.xreplace(names))
    stated_form = pair.lift(stated_rate) + over_agents(agent_claimed.xreplace(names))
    lift_steps = (
        Step("The energy in the moving frame, with", energy),
        Step("the sigma-distance of a pair:", sums_over_pairs.sigma_distance(X, m)),
        *steps,
        Step(
            r"One generic agent: $q_i = q_c + x_i$, $p_i = p_c + v_i$; the feedback on it minus that on the centre is",
            own_part,
        ),
        Step(r"and with $\lambda J + K$ it contributes", agent),
        Step(
            r"Lifting: forces between agents cancel in the mean $\dot p_c$, and $\sum_i v_i = 0$; "
            r"summed over pairs and agents, $\dot H_\lambda$ is",
            rate,
        ),
        Step(r"and $-c_2^\gamma \|v\|^2 - c_2^\alpha\, v^T \hat L v$ is", stated_form),
    )
    agent_residual = over_agents(sp.expand(agent - agent_claimed).xreplace(names))
    residual = pair.lift(pair.tidy(total - stated_rate)) + agent_residual
    return EnergyIdentity("Structural energy in the moving frame", energy, rate, stated_form, residual, lift_steps)
