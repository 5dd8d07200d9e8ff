"""Erratum J2: the matrix A_cl of Theorem 1 is Hurwitz only while every edge is longer than desired."""

import numpy as np

from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, exact, undecided


def _two_agents_abscissa(ratio: float) -> float:
    """Return the child's spectral abscissa in a two-agent tree whose edge is `ratio` desired lengths long."""
    law = MinimalFlocking(edges=((0, 1),), spacing=1.0)
    A = law.jacobian(0.0, np.array([[0.0, 0.0], [ratio, 0.0]]), np.zeros((2, 2)))
    child = [2, 3, 6, 7]
    return float(np.linalg.eigvals(np.asarray(A)[np.ix_(child, child)]).real.max())


def _positive_definite() -> Claim:
    """Return the claim that edge matrices are positive definite, for a root, its child and five grandchildren."""
    from flockana.sources.jond_2025.symbolic.spanning_trees import symmetric_part

    name, five_children = "positive-definite", symmetric_part(5)
    if not five_children.holds:
        return undecided(name, "the least eigenvalue is not the stated one")
    return exact(
        name,
        not five_children.result.is_negative,
        computed=str(five_children.result),
        stated="the edge matrices of a spanning tree are positive definite",
        margin=float(five_children.result),
        error=0.0,
        witness="root -> a -> five children, unit weights",
        disproof="bearing-distance-printed",
        detail=f"the symmetric part of DᵀD_in has least eigenvalue 1 - √k/2 for a node of k children: "
        f"{float(five_children.result):.4f} for five",
    )


@erratum("J2", expected={"refuted": "hurwitz positive-definite", "verified": "outside"})
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The proof assumes that the edge matrices are positive definite and A_cl is Hurwitz. W^s = diag(μ(1 - αr/|x|)) is
    negative inside the desired spacing and zero at it: A_cl is Hurwitz if and only if |x_e| > α_i r_i on every edge.
    DᵀD_in is not positive definite once a node has five children.
    """
    import sympy as sp

    from flockana.sources.jond_2025.symbolic.spanning_trees import frozen_eigenvalues

    eigenvalues = {ratio: frozen_eigenvalues(sp.Rational(ratio)) for ratio in ("1/2", "1", "2")}
    abscissas = {ratio: sp.re(values[0]) for ratio, values in eigenvalues.items()}
    measured_abscissa = _two_agents_abscissa(0.5)
    return [
        exact(
            "hurwitz",
            not (abscissas["1/2"].is_positive),
            computed={ratio: [str(value) for value in values] for ratio, values in eigenvalues.items()},
            stated="A_cl is Hurwitz, whatever the edges' lengths",
            margin=-float(abscissas["1/2"]),
            error=0.0,
            witness={"|x|/αr": 0.5, "largest real part of the law's Jacobian there": measured_abscissa},
            disproof="bearing-distance-printed",
            detail=f"two agents at half the spacing: eigenvalue {float(abscissas['1/2']):.3f}, unstable (the law's own "
            f"Jacobian: {measured_abscissa:.3f}); at the spacing {abscissas['1']}, singular",
        ),
        exact(
            "outside",
            abscissas["2"].is_negative and abscissas["1"] == 0,
            computed=float(abscissas["2"]),
            stated="Hurwitz if and only if |x_e| > α_i r_i on every edge",
            margin=-float(abscissas["2"]),
            error=0.0,
            witness={"|x|/αr": [1, 2], "real parts": [0.0, float(abscissas["2"])]},
            proof="bearing-distance",
            detail=f"at twice the spacing the real parts are {float(abscissas['2']):g}: negative",
        ),
        _positive_definite(),
    ]
