"""Algorithm 2 split into structural and linear translational dynamics, and the latter's transfer functions."""

import sympy as sp

from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.energy import GenericPair, relative_feedback
from flockana.symbolic.generic_pair import ADJACENCY, own_force, pair_potential, vector
from flockana.symbolic.parameter_symbols import GAINS, GainSymbols, exact
from flockana.symbolic.sigma_norms import sigma_norm
from flockana.symbolic.sums_over_pairs import V, X

S = sp.Symbol("s")
OMEGA = sp.Symbol("omega", positive=True)
SQUARE = sp.Symbol("w", nonnegative=True)  # ω²


def natural_frequency(gains: GainSymbols = GAINS) -> sp.Expr:
    """Return the natural frequency omega_n = sqrt(c1_gamma) of the centre of mass, in radians per time unit.

    Examples
    --------
    >>> natural_frequency(GainSymbols(c1_gamma=4))
    2
    """
    return sp.sqrt(gains.c1_gamma)


def damping_ratio(gains: GainSymbols = GAINS) -> sp.Expr:
    """Return the damping ratio zeta = c2_gamma/(2 sqrt(c1_gamma)) of the centre of mass.

    Examples
    --------
    >>> damping_ratio(GainSymbols(c1_gamma=4, c2_gamma=4))
    1
    """
    return gains.c2_gamma / (2 * sp.sqrt(gains.c1_gamma))


def transfer_function(scale: sp.Expr = sp.S.One, *, gains: GainSymbols = GAINS, s: sp.Symbol = S) -> sp.Expr:
    """Return the transfer function from q_r to q_c, for a gamma-agent that prints p_r = scale * dq_r/dt.

    It is solved from q_c'' = -c1_gamma (q_c - q_r) - c2_gamma (q_c' - p_r) in the Laplace domain.

    Parameters
    ----------
    scale : number or sympy.Expr
        1 for the true velocity, 0 for a p_r held at zero; erratum E12 has the step, a p_r per iteration.
    s : sympy.Symbol
        The Laplace variable.

    Examples
    --------
    >>> transfer_function(0, gains=GainSymbols(c1_gamma=4, c2_gamma=3))
    4/(s**2 + 3*s + 4)
    >>> transfer_function(gains=GainSymbols(c1_gamma=4, c2_gamma=3))
    (3*s + 4)/(s**2 + 3*s + 4)
    """
    q_c = sp.Symbol("Q_c")
    terms = (q_c, s * q_c, sp.S.One, exact("scale", scale) * s)
    force = own_force(*(sp.Matrix([term]) for term in terms), gains=gains)
    (response,) = sp.solve(sp.Eq(s**2 * q_c, force[0]), q_c)
    return response


def frequency_gain(scale: sp.Expr = sp.S.One, *, gains: GainSymbols = GAINS, omega: sp.Expr = OMEGA) -> sp.Expr:
    """Return |G(j omega)|, the ratio of the flock's amplitude to the gamma-agent's on a sine or circle.

    Parameters
    ----------
    scale : number or sympy.Expr
        As in `transfer_function`, real.
    omega : number or sympy.Expr
        Angular frequency, real.

    Examples
    --------
    >>> frequency_gain(0, gains=GainSymbols(c1_gamma=4, c2_gamma=3), omega=2)
    2/3
    """
    omega = exact("omega", omega)
    numerator, denominator = _squared_moduli(scale, gains, omega**2)
    return sp.sqrt(numerator / denominator)


def _squared_moduli(scale: sp.Expr, gains: GainSymbols, square: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return squared moduli of numerator and denominator of G(jω), polynomials in ω²."""

    def modulus(polynomial: sp.Expr) -> sp.Expr:
        even_part, odd_part = ((polynomial + sign * polynomial.subs(S, -S)) / 2 for sign in (1, -1))
        return sp.expand(sp.expand(even_part**2 - odd_part**2).subs(S, sp.I * sp.sqrt(square)))

    return tuple(modulus(part) for part in sp.fraction(transfer_function(scale, gains=gains)))


def gain_slope(scale: sp.Expr = sp.S.One, *, gains: GainSymbols = GAINS, square: sp.Expr = SQUARE) -> sp.Expr:
    """Return the numerator of d|G(j omega)|^2 / d(omega^2), which has the sign of the slope."""
    numerator, denominator = _squared_moduli(scale, gains, square)
    return sp.expand(sp.diff(numerator, square) * denominator - numerator * sp.diff(denominator, square))


def falling_condition(scale: sp.Expr = sp.S.One, *, gains: GainSymbols = GAINS) -> sp.Expr:
    """Return c2_gamma^2 (1 - scale^2) - 2 c1_gamma: |G(j omega)| falls with omega iff it is >= 0 (erratum E15)."""
    return gains.c2_gamma**2 * (1 - exact("scale", scale) ** 2) - 2 * gains.c1_gamma


def derive_split(m: int = 2, *, gains: GainSymbols = GAINS) -> Derivation:
    """Derive the split of Algorithm 2 into structural and translational dynamics, exact for generic n.

    The result is the pair (own part of v_i', p_c'); the residuals hold every equation of the steps.

    Parameters
    ----------
    gains : GainSymbols
        Gains; all symbolic if not given. With c1_gamma = c2_gamma = 0 this is Algorithm 1.

    Examples
    --------
    >>> derive_split(2).holds
    True
    """
    pair = GenericPair(m, (X, V))
    (x_i, x_j), (v_i, v_j) = pair.q, pair.p
    q_c, p_c = vector("q_c", m), vector("p_c", m)
    on_i, force_on_j = pair.forces(gains)
    pair_state, centres = sp.Matrix.vstack(x_i, x_j, v_i, v_j), sp.Matrix.vstack(q_c, q_c, p_c, p_c)
    shift = {s: s + c for s, c in zip(pair_state, centres, strict=True)}
    own_part, translational = relative_feedback(x_i, v_i, gains)
    stated_form = -gains.c1_gamma * x_i - gains.c2_gamma * v_i
    gradient = pair_potential(x_i, x_j, gains=gains).diff(x_i)
    consensus = gains.c2_alpha * ADJACENCY(sigma_norm(x_j - x_i)) * (v_j - v_i)
    differences = (*(on_i + force_on_j), *(on_i.xreplace(shift) - on_i), *(on_i + gradient - consensus))
    residuals = (*map(pair.tidy, differences), *(own_part - stated_form).expand())
    f_ij, f_ji = sp.symbols("f_ij f_ji")
    relative = sp.Eq(f_ij, sp.Function("f")(*(x_j - x_i), *(v_j - v_i)))
    steps = (
        Step("Forces between agents obey action = reaction, and so drop out of the mean:", sp.Eq(f_ij + f_ji, 0)),
        Step(r"The centre $q_c' = p_c$ moves as one agent without neighbours, linearly: $p_c' =$", translational),
        Step(r"Forces between agents depend on differences only: $f_{ij}(q, p) = f_{ij}(x, v)$.", relative),
        Step(
            r"The feedback on agent $i$ minus that on the centre contains none of $q_c, p_c, q_r, p_r$. It is linear, "
            r"and $\sum_i x_i = \sum_i v_i = 0$, so its mean over the agents is 0:",
            own_part,
        ),
        Step(
            r"So the structural dynamics is autonomous: $x' = v$, "
            r"$v' = -\nabla U_\lambda(x) - (c_2^\gamma I + c_2^\alpha \hat L(x)) v$ with",
            sp.Eq(sp.Symbol("lambda"), gains.c1_gamma),
        ),
    )
    name = "Algorithm 2: structural and translational dynamics"
    return Derivation(name, steps, sp.Tuple(own_part, translational), residuals)
