"""Split of Algorithm 2 into structural dynamics in the moving frame and linear translational dynamics."""

from itertools import chain

import sympy as sp

from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.energy import GenericPair, relative_feedback
from flockana.symbolic.norms import sigma_norm
from flockana.symbolic.pair import ADJACENCY, pair_potential, vector
from flockana.symbolic.parameters import GAINS, GainSymbols
from flockana.symbolic.sums import V, X


def _gradient_residual(pair: GenericPair, gains: GainSymbols) -> list[sp.Expr]:
    """Return the pair's force on i less -grad_i of its potential less its share -c2 (L v)_i."""
    (x_i, x_j), (v_i, v_j) = pair.q, pair.p
    gradient = pair_potential(x_i, x_j, gains=gains).diff(x_i)
    consensus = gains.c2_alpha * ADJACENCY(sigma_norm(x_j - x_i)) * (v_j - v_i)
    return [pair.tidy(term) for term in pair.forces(gains)[0] + gradient - consensus]


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
    on_i, on_j = pair.forces(gains)
    ends, centres = sp.Matrix.vstack(x_i, x_j, v_i, v_j), sp.Matrix.vstack(q_c, q_c, p_c, p_c)
    shift = {s: s + c for s, c in zip(ends, centres, strict=True)}
    own, translational = relative_feedback(x_i, v_i, gains)
    stated = -gains.c1_gamma * x_i - gains.c2_gamma * v_i
    residuals = chain(
        (pair.tidy(term) for term in on_i + on_j),
        (pair.tidy(term) for term in on_i.xreplace(shift) - on_i),
        (own - stated).expand(),
        _gradient_residual(pair, gains),
    )
    f_ij, f_ji = sp.symbols("f_ij f_ji")
    relative = sp.Eq(f_ij, sp.Function("f")(*(x_j - x_i), *(v_j - v_i)))
    steps = (
        Step("Forces between agents obey action = reaction, and so drop out of the mean:", sp.Eq(f_ij + f_ji, 0)),
        Step(r"The centre $q_c' = p_c$ moves as one agent without neighbours, linearly: $p_c' =$", translational),
        Step(r"Forces between agents depend on differences only: $f_{ij}(q, p) = f_{ij}(x, v)$.", relative),
        Step(
            r"The feedback on agent $i$ minus that on the centre contains none of $q_c, p_c, q_r, p_r$. It is linear, "
            r"and $\sum_i x_i = \sum_i v_i = 0$, so its mean over the agents is 0:",
            own,
        ),
        Step(
            r"So the structural dynamics is autonomous: $x' = v$, "
            r"$v' = -\nabla U_\lambda(x) - (c_2^\gamma I + c_2^\alpha \hat L(x)) v$ with",
            sp.Eq(sp.Symbol("lambda"), gains.c1_gamma),
        ),
    )
    name = "Algorithm 2: structural and translational dynamics"
    return Derivation(name, steps, sp.Tuple(own, translational), tuple(residuals))
