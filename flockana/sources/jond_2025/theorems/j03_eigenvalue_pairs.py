"""Erratum J3: the eigenvalues of the two edge matrices pair off index by index on rooted trees only."""

from itertools import permutations

import numpy as np

from flockana.measures.perception import both_ways
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.theorems.theorem_toolkit import Claim, FloatArray, Tolerances, erratum, exact, spectral

_EIGENVALUES = 1e-6  # of matrices of 6 rows and entries up to 4000, well apart: 1e-12 of these entries times 100
_TREE_SHAPES = (((0, 1), (1, 2), (2, 3)), ((0, 1), (0, 2), (0, 3)), ((0, 1), (1, 2), (1, 3), (0, 4)))
_PATH_LENGTHS, _PATH_SPACING = (2.05, 2.7, 2.05), (1.0, 2.0, 2.0, 1.0)  # α_i r_i = |N_i| on a path of four


def path_matrices(mu: float) -> tuple[FloatArray, FloatArray]:
    """Return (A^s, A^a) of x'' = −A^a x' − A^s x on an undirected path of four with edges 2.05, 2.7, 2.05."""
    links = ((0, 1), (1, 2), (2, 3))
    law = MinimalFlocking(edges=both_ways(links), spacing=_PATH_SPACING, mu=mu)
    head, tail, weight, rho, align_weights = law.edge_data(np.empty((4, 1)))
    w = weight * (1.0 - rho / np.repeat(_PATH_LENGTHS, 2))
    T = np.zeros((3, 4))  # x = T p
    for e, (j, i) in enumerate(links):
        T[e, j], T[e, i] = 1.0, -1.0
    matrices = []
    for coefficients in (w, align_weights):
        u = np.zeros((4, 4))
        np.add.at(u, (head, tail), coefficients)
        np.add.at(u, (head, head), -coefficients)
        matrices.append(-T @ u @ np.linalg.pinv(T))
    return matrices[0], matrices[1]


def _pairing(mu: float) -> tuple[float, float]:
    """Return (error of the best index-by-index eigenvalue pairing, largest real part) on the path."""
    from scipy.optimize import linear_sum_assignment

    stiffness, damping = path_matrices(mu)
    eigenvalues = np.linalg.eigvals(np.block([[np.zeros((3, 3)), np.eye(3)], [-stiffness, -damping]]))
    least_error = np.inf
    for gammas in permutations(np.linalg.eigvals(stiffness)):
        pairs = zip(np.linalg.eigvals(damping), gammas, strict=True)
        gap = np.abs(np.concatenate([np.roots([1.0, m, g]) for m, g in pairs])[:, None] - eigenvalues)
        least_error = min(least_error, float(gap[linear_sum_assignment(gap)].max()))
    return least_error, float(eigenvalues.real.max())


@erratum("J3", expected={"refuted": "printed hurwitz", "verified": "trees"})
def theorem(tolerances: Tolerances) -> list[Claim]:
    """After (39) the proof pairs the eigenvalues of two matrices that do not commute. On directed rooted trees both are
    triangular in one order, and it is right; on an undirected path it is not, and A_cl can be unstable though every
    edge is longer than desired.
    """
    from flockana.sources.jond_2025.symbolic.spanning_trees import tree_characteristic

    residuals = {str(edges): tree_characteristic(edges).residuals[0] for edges in _TREE_SHAPES}
    error, abscissa = _pairing(400.0)
    _, stiffer = _pairing(4000.0)
    return [
        spectral("printed", -error, _EIGENVALUES, about="all", disproof="bearing-distance-printed").described(
            computed=error,
            stated="λ² + λ μ_i + γ_i = 0, index by index, for any graph",
            witness={"graph": "undirected path of four", "|x|": _PATH_LENGTHS, "α_i r_i": _PATH_SPACING, "μ": 400.0},
            detail=f"on an undirected path the best pairing misses an eigenvalue by {error:.3f}: the matrices do not "
            "commute",
        ),
        spectral("hurwitz", -stiffer, _EIGENVALUES, about="all", disproof="bearing-distance-printed").described(
            computed=stiffer,
            stated="negative real parts of all eigenvalues, since μ_i and γ_i have positive ones",
            witness={"graph": "the same path, every |x_e| > α_i r_i", "μ": 4000.0, "at μ = 400": abscissa},
            detail=f"with μ = 4000 an eigenvalue has real part {stiffer:.4f}, though every edge is longer than α_i r_i",
        ),
        exact("trees", not any(residuals.values()), proof="bearing-distance").described(
            computed="residual 0" if not any(residuals.values()) else str(residuals),
            stated="on rooted trees det(s² I + s A^a + A^s) = Π (s² + s + w_e)",
            witness=list(residuals),
            detail="on a chain, a star and a mixed tree the determinant factors edge by edge: both matrices are "
            "triangular in one order",
        ),
    ]
