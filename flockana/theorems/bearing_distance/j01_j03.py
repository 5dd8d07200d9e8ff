"""Errata J1 to J3: what Theorem 1 of the bearing-distance paper makes of its edges and their eigenvalues."""

from __future__ import annotations

from itertools import permutations

import numpy as np

from flockana.base.binomial import clopper_pearson
from flockana.base.checks import FloatArray
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.minimal import MinimalFlocking
from flockana.measures.nets import components
from flockana.measures.perception import Edges, both_ways, edge_vectors, random_out_tree
from flockana.theorems.bearing_distance.tree_case import TreeCase, tree_case
from flockana.theorems.bearing_distance.tree_limits import longest_floor, settles
from flockana.theorems.limits import limit_claim
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge

_TREES, _MOST, _SEED, _END = 200, 8, 1, 80.0
_CONFIDENCE = 0.95
_INTERVAL = 1e-9  # to which the ends of an exact interval are computed
_EIGENVALUES = 1e-6  # of matrices of 6 rows and entries up to 4000, well apart: 1e-12 of these entries times 100
_SOURCE = "Jond, bearing-distance flocking, Theorem 1"
_REFERENCES = ("jond-2025",)
_TREE_SHAPES = (((0, 1), (1, 2), (2, 3)), ((0, 1), (0, 2), (0, 3)), ((0, 1), (1, 2), (1, 3), (0, 4)))
_PATH_LENGTHS, _PATH_SPACING = (2.05, 2.7, 2.05), (1.0, 2.0, 2.0, 1.0)  # α_i r_i = |N_i| on a path of four


def random_forest(count: int, seed: int, *, rho: float = 1.0) -> tuple[MinimalFlocking, FloatArray, FloatArray]:
    """(law, q, p) of many random out-trees of 2 to 8 agents side by side: one run moves them all, none sees another.

    Parameters
    ----------
    count : int
        Number of trees.
    seed : int
        Of the trees and their states: positions in a box of 4 ρ, velocities up to ρ in each component.
    rho : float
        Desired spacing.

    Examples
    --------
    >>> law, q, p = random_forest(3, 0)
    >>> len(law.edges) == len(q) - 3
    True
    """
    rng = np.random.default_rng(seed)
    edges: list[tuple[int, int]] = []
    agents = 0
    for _ in range(count):
        n = int(rng.integers(2, _MOST + 1))
        edges += [(j + agents, i + agents) for j, i in random_out_tree(n, rng)]
        agents += n
    q, p = rng.uniform(0.0, 4.0 * rho, (agents, 2)), rng.uniform(-rho, rho, (agents, 2))
    return MinimalFlocking(edges=tuple(edges), spacing=rho), q, p


def _j1(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    law, q, p = random_forest(_TREES, _SEED)
    run = simulate(law, q, p, (0.0, _END), t_eval=(0.0, _END))
    lengths = np.linalg.norm(edge_vectors(run.q[-1], law.edges or ()), axis=1)
    trees = _apart(run)
    certain = [settles(*tree) for tree in trees]
    weakest = min(certain, key=lambda one: one.margin)
    right = sum(one.margin > one.error for one in certain)
    vanished = sum(not longest_floor(*tree)[0] > 0.0 for tree in trees)
    least, most = map(float, clopper_pearson(right, _TREES, level=_CONFIDENCE))
    none = tuple(map(float, clopper_pearson(vanished, _TREES, level=_CONFIDENCE)))
    case = {"trees": _TREES, "agents": f"2 to {_MOST}", "seed": _SEED, "t": _END}
    return [], [
        Claim(
            "printed",
            judge(none[1] - 1.0, _INTERVAL, []) if vanished < _TREES else "inconclusive",
            computed={"trees whose edges might all vanish": vanished, "interval": list(none)},
            stated="|x_e| -> 0 on every edge of every spanning tree (share 1)",
            margin=none[1] - 1.0,
            error=_INTERVAL,
            witness=case | {"shortest edge at the end": float(lengths.min())},
            detail=f"of {_TREES} random directed trees {_TREES - vanished} keep an edge at a length > 0 for ever; the "
            f"shortest of all is {lengths.min():.8g} αr at the end",
        ),
        limit_claim(
            "corrected",
            [],
            [weakest],
            computed={"trees": right, "interval": [least, most]},
            stated="what converges is | |x_e| - α_i r_i | and the velocity difference, on every edge",
            witness=case | {"largest length error": float(np.abs(lengths - 1.0).max())},
            detail=f"{right} of {_TREES} random directed trees go to every edge at αr and equal velocities; share "
            f"{least:.3f} or more ({_CONFIDENCE:.0%}, Clopper-Pearson)",
        ),
    ]


def _apart(run: Trajectory) -> list[tuple[TreeCase, FloatArray, FloatArray]]:
    """Each tree of a forest with its last state: they do not see each other."""
    edges: Edges = run.law.edges
    label = components(run.n, np.array(edges, dtype=np.int32))
    found = []
    for k in range(int(label.max()) + 1):
        agents = np.flatnonzero(label == k)
        own = {int(agent): number for number, agent in enumerate(agents)}
        law = MinimalFlocking(edges=tuple((own[j], own[i]) for j, i in edges if j in own), spacing=run.law.spacing)
        case = tree_case(law, len(agents))
        assert case is not None
        found.append((case, run.q[-1][agents], run.p[-1][agents]))
    return found


def _two_agents_abscissa(ratio: float) -> float:
    """Largest real part of the law's own Jacobian for two agents in the plane, less the root's neutral motion."""
    law = MinimalFlocking(edges=((0, 1),), spacing=1.0)
    A = law.jacobian(0.0, np.array([[0.0, 0.0], [ratio, 0.0]]), np.zeros((2, 2)))
    child = [2, 3, 6, 7]
    return float(np.linalg.eigvals(np.asarray(A)[np.ix_(child, child)]).real.max())


def _j2(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    import sympy as sp

    from flockana.symbolic.spanning_trees import frozen_eigenvalues, symmetric_part

    cases = {ratio: frozen_eigenvalues(sp.Rational(ratio)) for ratio in ("1/2", "1", "2")}
    abscissas = {ratio: sp.re(values[0]) for ratio, values in cases.items()}
    measured = _two_agents_abscissa(0.5)
    five = symmetric_part(5)
    return [], [
        Claim(
            "hurwitz",
            "refuted" if abscissas["1/2"].is_positive else "verified",
            "symbolic",
            computed={ratio: [str(value) for value in values] for ratio, values in cases.items()},
            stated="A_cl is Hurwitz, whatever the edges' lengths",
            margin=-float(abscissas["1/2"]),
            error=0.0,
            witness={"|x|/αr": 0.5, "largest real part of the law's Jacobian there": measured},
            proof="bearing-distance-printed",
            detail=f"two agents at half the spacing: eigenvalue {float(abscissas['1/2']):.3f}, unstable (the law's own "
            f"Jacobian: {measured:.3f}); at the spacing {abscissas['1']}, singular",
        ),
        Claim(
            "outside",
            "verified" if abscissas["2"].is_negative and abscissas["1"] == 0 else "refuted",
            "symbolic",
            computed=float(abscissas["2"]),
            stated="Hurwitz if and only if |x_e| > α_i r_i on every edge",
            margin=-float(abscissas["2"]),
            error=0.0,
            witness={"|x|/αr": [1, 2], "real parts": [0.0, float(abscissas["2"])]},
            proof="bearing-distance",
            detail=f"at twice the spacing the real parts are {float(abscissas['2']):g}: negative",
        ),
        Claim(
            "positive-definite",
            "refuted" if five.holds and five.result.is_negative else "inconclusive",
            "symbolic",
            computed=str(five.result),
            stated="the edge matrices of a spanning tree are positive definite",
            margin=float(five.result),
            error=0.0,
            witness="root -> a -> five children, unit weights",
            proof="bearing-distance-printed",
            detail=f"the symmetric part of DᵀD_in has least eigenvalue 1 - √k/2 for a node of k children: "
            f"{float(five.result):.4f} for five",
        ),
    ]


def path_matrices(mu: float) -> tuple[FloatArray, FloatArray]:
    """(A^s, A^a) of x'' = −A^a x' − A^s x on an undirected path of four, with edges of 2.05, 2.7, 2.05 and αr = |N_i|.

    Parameters
    ----------
    mu : float
        Weight of every spring.

    Examples
    --------
    >>> path_matrices(1.0)[1].diagonal().round(12).tolist()
    [1.5, 1.0, 1.5]
    """
    links = ((0, 1), (1, 2), (2, 3))
    law = MinimalFlocking(edges=both_ways(links), spacing=_PATH_SPACING, mu=mu)
    head, tail, weight, rho, align = law.edge_data(np.empty((4, 1)))
    w = weight * (1.0 - rho / np.repeat(_PATH_LENGTHS, 2))
    T = np.zeros((3, 4))  # x = T p
    for e, (j, i) in enumerate(links):
        T[e, j], T[e, i] = 1.0, -1.0
    loop = []
    for coefficients in (w, align):
        u = np.zeros((4, 4))
        np.add.at(u, (head, tail), coefficients)
        np.add.at(u, (head, head), -coefficients)
        loop.append(-T @ u @ np.linalg.pinv(T))
    return loop[0], loop[1]


def _pairing(mu: float) -> tuple[float, float]:
    """(error of the best index-by-index pairing of the eigenvalues, true largest real part) on the path."""
    from scipy.optimize import linear_sum_assignment

    stiffness, damping = path_matrices(mu)
    true = np.linalg.eigvals(np.block([[np.zeros((3, 3)), np.eye(3)], [-stiffness, -damping]]))
    best = np.inf
    for gammas in permutations(np.linalg.eigvals(stiffness)):
        roots = [
            root for m, g in zip(np.linalg.eigvals(damping), gammas, strict=True) for root in np.roots([1.0, m, g])
        ]
        gap = np.abs(np.array(roots)[:, None] - true)
        best = min(best, float(gap[linear_sum_assignment(gap)].max()))
    return best, float(true.real.max())


def _j3(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    from flockana.symbolic.spanning_trees import tree_characteristic

    found = {str(edges): tree_characteristic(edges).residuals[0] for edges in _TREE_SHAPES}
    error, abscissa = _pairing(400.0)
    _, stiffer = _pairing(4000.0)
    return [], [
        Claim(
            "printed",
            judge(-error, _EIGENVALUES, []),
            computed=error,
            stated="λ² + λ μ_i + γ_i = 0, index by index, for any graph",
            margin=-error,
            error=_EIGENVALUES,
            witness={"graph": "undirected path of four", "|x|": _PATH_LENGTHS, "α_i r_i": _PATH_SPACING, "μ": 400.0},
            proof="bearing-distance-printed",
            detail=f"on an undirected path the best pairing misses an eigenvalue by {error:.3f}: the matrices do not "
            "commute",
        ),
        Claim(
            "hurwitz",
            judge(-stiffer, _EIGENVALUES, []),
            computed=stiffer,
            stated="negative real parts of all eigenvalues, since μ_i and γ_i have positive ones",
            margin=-stiffer,
            error=_EIGENVALUES,
            witness={"graph": "the same path, every |x_e| > α_i r_i", "μ": 4000.0, "at μ = 400": abscissa},
            proof="bearing-distance-printed",
            detail=f"with μ = 4000 an eigenvalue has real part {stiffer:.4f}, though every edge is longer than α_i r_i",
        ),
        Claim(
            "trees",
            "verified" if all(residual == 0 for residual in found.values()) else "refuted",
            "symbolic",
            computed="residual 0" if not any(found.values()) else str(found),
            stated="on rooted trees det(s² I + s A^a + A^s) = Π (s² + s + w_e)",
            witness=list(found),
            proof="bearing-distance",
            detail="on a chain, a star and a mixed tree the determinant factors edge by edge: both matrices are "
            "triangular in one order",
        ),
    ]


THEOREM = (
    Theorem(
        id="J1",
        title="Edges converge to their desired lengths, not to zero",
        statement=(
            "Theorem 1 lets the edge vectors x and their rates converge to zero. x = 0 is collision and contradicts "
            "the goal (27); what converges is the length error | |x_e| - α_i r_i | and the velocity difference."
        ),
        source=f"{_SOURCE}, (36)",
        kind="fixed",
        check=_j1,
        references=_REFERENCES,
        expected={"J1": "refuted", "J1:printed": "refuted", "J1:corrected": "verified"},
    ),
    Theorem(
        id="J2",
        title="A_cl is Hurwitz only outside the desired spacing",
        statement=(
            "The proof takes the edge matrices for positive definite, A_cl for Hurwitz. W^s = diag(μ(1 - αr/|x|)) is "
            "negative inside the desired spacing and zero at it: A_cl is Hurwitz if and only if |x_e| > α_i r_i on "
            "every edge. DᵀD_in is not positive definite once a node has five children."
        ),
        source=f"{_SOURCE}, proof",
        kind="fixed",
        check=_j2,
        references=_REFERENCES,
        expected={
            "J2": "refuted",
            "J2:hurwitz": "refuted",
            "J2:outside": "verified",
            "J2:positive-definite": "refuted",
        },
    ),
    Theorem(
        id="J3",
        title="Eigenvalues do not pair off index by index",
        statement=(
            "After (39) the proof pairs the eigenvalues of two matrices that do not commute. On directed rooted trees "
            "both are triangular in one order, and it is right; on an undirected path it is not, and A_cl can be "
            "unstable though every edge is longer than desired."
        ),
        source=f"{_SOURCE}, proof, after (39)",
        kind="fixed",
        check=_j3,
        references=_REFERENCES,
        expected={"J3": "refuted", "J3:printed": "refuted", "J3:hurwitz": "refuted", "J3:trees": "verified"},
    ),
)
