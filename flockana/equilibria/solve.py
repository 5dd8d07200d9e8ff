"""Equilibria of laws with a potential, by IPOPT, damped motion with Newton steps, or a root-finder."""

from dataclasses import dataclass, field
from itertools import combinations
from math import sqrt
from typing import Any

import numpy as np

from flockana.base.errors import SolverError
from flockana.base.integrity_seals import ensure_sealed, sealed
from flockana.base.table_export import facts_html, facts_text
from flockana.base.value_checks import (
    FloatArray,
    ensure_count,
    ensure_finite_scalar,
    ensure_flag,
    ensure_known,
    ensure_points,
)
from flockana.equilibria.classify import MAX_SIZE, EquilibriumKind, classify_spectrum, ensure_small, falling, spectrum
from flockana.equilibria.descent import descend
from flockana.equilibria.potential import Potential, ensure_flock_law, inside_obstacle
from flockana.laws import Navigation
from flockana.measures.metrics import pairs_at_one_place
from flockana.measures.nets import LinkArray, link_lengths, links

METHODS = ("minimise", "ipopt", "descent", "root")
RESIDUAL = 1e-9  # of the force scale: what counts as an equilibrium
ALL_PAIRS = 48  # up to here every pair is listed, and the program is used again
_MARGIN = 1.0  # of d, beyond the range, for the listed pairs; agents move by half of it before the next list
_ROUNDS = 200
_INSIDE = 0.999  # of the box: what ends nearer to its faces goes on
_LARGEST = 6000  # n m up to which IPOPT and hybr end within minutes
_ESCAPES, _SMALL, _NUDGE = 3, 400, 1e-2  # from saddles: how often, up to which n m, by how much of d
_POLISH = 8
_REACH = 1e-3  # of d: a polish that goes farther than that has left the point it should refine


@dataclass(frozen=True)
class Equilibrium:
    """Configuration at which the force on every agent vanishes, with its kind of critical point.

    Parameters
    ----------
    q : ndarray, shape (n, m)
        Positions; under Algorithm 2 with one c1γ their centre is the γ-agent.
    energy : float
        Potential energy: c1α V, U_λ, or V_α + V_β + V_γ.
    residual : float
        Largest force on an agent over that of the law's `scales`.
    links : int array, shape (M, 2)
        Pairs closer than r.
    kind : {"minimum", "saddle", "maximum", "degenerate"}
        From the Hessian off the rigid motions: strict minimum; saddle or maximum by its negative eigenvalues;
        degenerate if none is negative and some are zero, so that the second order does not decide.
    hessian_eigenvalues : ndarray
        Off the rigid motions, rising; beyond n m = 6000 the smallest, with all that are not surely positive among
        them, and the largest.
    rigid_modes : int
        Rigid motions that leave the potential unchanged.
    zero_modes : int
        Zero eigenvalues beyond these: soft modes.
    index : int
        Number of negative eigenvalues.
    success : bool
        Whether the solver succeeded and the residual is small enough.
    message : str
        The solver's own status, and what was wrong if something was.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> pair = find_equilibrium(Algorithm1(), [[0.0, 0.0], [6.0, 1.0]])
    >>> pair.kind, pair.rigid_modes, pair.strain(), pair.message
    ('minimum', 3, 0.0, 'Solve_Succeeded')
    """

    law: Any = field(repr=False)
    q: FloatArray = field(repr=False)
    energy: float
    residual: float
    links: LinkArray = field(repr=False)
    kind: EquilibriumKind
    hessian_eigenvalues: FloatArray = field(repr=False)
    rigid_modes: int
    zero_modes: int
    index: int
    success: bool
    message: str

    def facts(self) -> dict[str, str]:
        """Return the equilibrium's properties in words, as the rows of the table that a notebook shows."""
        eigenvalue_text = f"{self.hessian_eigenvalues[0]:.4g}" if self.hessian_eigenvalues.size else "none"
        return {
            "law": self.law.title,
            "agents": f"{self.q.shape[0]}, m = {self.q.shape[1]}, {len(self.links)} links",
            "kind": self.kind + (f" of index {self.index}" if self.index else ""),
            "energy": f"{self.energy:.6g}",
            "residual": f"{self.residual:.2g} of the law's forces",
            "lowest curvature": eigenvalue_text,
            "rigid, soft modes": f"{self.rigid_modes}, {self.zero_modes}",
            "success": f"{'yes' if self.success else 'no'}: {self.message}",
        }

    def __str__(self) -> str:
        return facts_text("Equilibrium", self.facts())

    def _repr_html_(self) -> str:
        return facts_html("Equilibrium", self.facts())

    def strain(self) -> float:
        """Return the largest |link − d|/d to twelve digits; NaN without links.

        Under dead-zone flocking of contacts only, the pairs that repel, with d₁ for d; NaN if no pair does.
        """
        pair = Potential(self.law).pair
        distances, d = link_lengths(self.q, self.links), pair.length
        distances = distances[distances < pair.bond_range]
        return round(float(np.abs(distances - d).max() / d), 12) if distances.size else float("nan")

    @property
    def curvature(self) -> float:
        """Hessian's smallest eigenvalue off the rigid motions over the largest in modulus; NaN without one."""
        values = self.hessian_eigenvalues
        return float(values[0] / np.abs(values).max()) if values.size and values.any() else float("nan")


def find_equilibrium(
    law: Any, q0: Any, *, method: str = "minimise", t: float = 0.0, max_iter: int = 3000, strict: bool = True
) -> Equilibrium:
    """Find an equilibrium from q0: a minimum of the law's potential, or with ``method="root"`` any critical point.

    Not the end of the motion from q0: IPOPT goes downhill, but not along the flow, and may end in another basin. So may
    the descent, which takes the lower of several minima where the flock's net gives way.

    Parameters
    ----------
    law : Algorithm1, Algorithm2, Algorithm3 or DeadZoneFlocking
        The law, the last with a ramp.
    q0 : array_like, shape (n, m)
        Start, with no agent inside an obstacle.
    method : {"minimise", "ipopt", "descent", "root"}
        IPOPT on the potential, with its gradient and Hessian; the descent of `flockana.equilibria.descent`, for flocks
        up to n m = 60 000; or Levenberg-Marquardt on the gradient, which finds saddles too (n m up to hundreds).
        "minimise" is IPOPT up to n m = 400, where it leaves saddles by their steepest direction, and beyond that the
        descent, a hundred times as fast at n = 1000 and ending in lower minima.
    t : float
        When, for a γ-agent that moves.
    max_iter : int
        Most iterations of a solve.
    strict : bool
        Raise on failure; else return the last point with ``success=False`` and the reason.

    Raises
    ------
    SolverError
        If no equilibrium was found, with the solver's status.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> hexagon = find_equilibrium(Algorithm1(), [[0, 0], [7, 0], [4, 6], [-3, 6], [-7, 0], [-4, -6], [3, -6]])
    >>> hexagon.kind, len(hexagon.links), hexagon.zero_modes
    ('minimum', 12, 0)
    """
    q = ensure_points("q0", q0)
    law = ensure_flock_law(law, q.shape[1])
    ensure_known("method", method, METHODS)
    ensure_flag("strict", strict)
    if method == "minimise":
        method = "ipopt" if q.size <= _SMALL else "descent"
    ensure_small(*q.shape, most=MAX_SIZE if method == "descent" else _LARGEST)
    potential = Potential(law, ensure_finite_scalar("t", t))
    max_iter = ensure_count("max_iter", max_iter)
    law.check_start(q, np.zeros_like(q))
    solve_method = {"descent": descend, "ipopt": _minimise, "root": _root}[method]
    final_state, converged, message = solve_method(potential, q, max_iter)
    if coincident_count := pairs_at_one_place(q):  # no force parts them: where they end says little of other starts
        message += f"; {coincident_count} pair{'s' * (coincident_count > 1)} of agents began at one place"
    return finish(potential, final_state, converged, message, strict=strict)


def finish(potential: Potential, q: FloatArray, converged: bool, message: str, *, strict: bool = True) -> Equilibrium:
    """Return a solver's result as an `Equilibrium`, refined and classified; raise if it is none."""
    q = polish(potential, q) if converged and q.size <= _LARGEST else q  # the descent has polished what is larger
    pull = potential.law.term(Navigation)
    is_unpulled = pull is not None and pull.gains.c1_gamma == 0.0
    if potential.target is not None and not (potential.pinned or is_unpulled):  # as Algorithm 2 holds the centre
        q = q + (potential.target - q.mean(axis=0))
    residual = potential.residual(q)
    is_blocked = inside_obstacle(potential.law, q)
    success = converged and residual <= RESIDUAL and not is_blocked
    if is_blocked:
        message = f"{message}, but with an agent inside an obstacle"
    elif converged and not success:
        message = (
            f"{message}, yet the residual force is {residual:.2g} of the law's force scale, more than {RESIDUAL:g}"
        )
    if strict and not success:
        raise SolverError(
            f"no equilibrium of {type(potential.law).__name__} found: {message} (residual force {residual:.2g}); "
            "start nearer to one (gradient_flow goes downhill more carefully), or raise max_iter"
        )
    modes = spectrum(potential, q)
    q.setflags(write=False)
    equilibrium = Equilibrium(
        law=potential.law,
        q=q,
        energy=potential.energy(q),
        residual=residual,
        links=links(q, potential.pair.range),
        kind=classify_spectrum(modes),
        hessian_eigenvalues=modes.eigenvalues,
        rigid_modes=modes.rigid,
        zero_modes=modes.zero,
        index=modes.negative,
        success=success,
        message=message,
    )
    return sealed(equilibrium)


def ensure_unedited_equilibrium(name: str, equilibrium: Equilibrium) -> None:
    """Raise unless an equilibrium is unchanged since a solver returned it."""
    origin_text = "one as find_equilibrium returned it or read it from a file"
    ensure_sealed(name, equilibrium, origin_text, "find it anew, or give its positions alone")


def all_pairs(n: int) -> LinkArray:
    """Return all pairs of n agents."""
    return np.array(list(combinations(range(n), 2)), dtype=np.int32).reshape(-1, 2)


def _minimise(potential: Potential, q: FloatArray, max_iter: int) -> tuple[FloatArray, bool, str]:
    """Minimise a potential in boxes about successive solutions, until a solution lies inside its box."""
    # The box is so small that no pair outside the list can come within range, and IPOPT's long steps along soft
    # directions cannot scatter the flock. A point from which V falls is left along its most negative direction.
    from flockana.equilibria.ipopt_program import Program

    (n, m), escape_count, margin = q.shape, 0, _MARGIN * potential.pair.length
    program: Program | None = None
    for _ in range(_ROUNDS):
        basis = potential.symmetries(q)
        if basis.shape[1] == q.size:
            return q, True, "nothing to solve: every motion is a rigid one"
        if program is None or n > ALL_PAIRS or program.gauge != basis.shape[1]:
            pairs = all_pairs(n) if n <= ALL_PAIRS else links(q, potential.pair.range + margin)
            program = Program(potential, (n, m), pairs, basis.shape[1])
        reach, start = margin / (2.0 * sqrt(m)), q
        q, converged, status = program.solve(q, basis=basis, reach=reach, max_iter=max_iter)
        if not (converged and np.isfinite(q).all()):
            return q, False, status
        if np.abs(q - start).max() > _INSIDE * reach:
            continue
        if escape_count == _ESCAPES or q.size > _SMALL:
            return q, True, status
        if (direction := falling(potential, polished_state := polish(potential, q))) is None:
            return q, True, status
        escape_count, q = escape_count + 1, polished_state + _NUDGE * potential.pair.length * direction
    return q, False, f"still on the way after {_ROUNDS} boxes of {margin / sqrt(m):.3g}"


def _root(potential: Potential, q: FloatArray, max_iter: int) -> tuple[FloatArray, bool, str]:
    """Find a zero of a potential's gradient by Levenberg-Marquardt, with rigid motions fixed by equations."""
    from scipy.optimize import least_squares

    basis, scale, d = potential.symmetries(q), potential.force_scale, potential.pair.length
    start = q.ravel() / d

    def equations(x: FloatArray) -> FloatArray:
        return np.concatenate([-potential.force(d * x.reshape(q.shape)).ravel() / scale, basis.T @ (x - start)])

    def jacobian(x: FloatArray) -> FloatArray:
        return np.vstack([potential.stiffness(d * x.reshape(q.shape)).toarray() * (d / scale), basis.T])

    result = least_squares(equations, start, jacobian, xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=max_iter)
    converged = result.status > 0 and float(np.abs(result.fun).max()) < 1e-5
    reason = result.message if converged else f"{result.message} The gradient has a least square that is not zero."
    return d * result.x.reshape(q.shape), converged, reason


def polish(potential: Potential, q: FloatArray) -> FloatArray:
    """Refine an equilibrium by Newton's method with the Hessian; a small shift keeps soft modes finite."""
    from scipy.sparse import block_array, csc_array, eye_array
    from scipy.sparse.linalg import splu

    best_state, best_residual = q, potential.residual(q)
    iterate = q
    for _ in range(_POLISH):
        if best_residual <= 1e-14:
            break
        rigid, hessian = csc_array(potential.symmetries(iterate)), csc_array(potential.stiffness(iterate))
        shift = 1e-9 * float(abs(hessian).max() or 1.0)
        matrix = block_array([[hessian + shift * eye_array(q.size), rigid], [rigid.T, None]], format="csc")
        force = np.concatenate([potential.force(iterate).ravel(), np.zeros(rigid.shape[1])])
        step = splu(matrix).solve(force)[: q.size].reshape(q.shape)
        iterate = iterate + step
        if not np.isfinite(step).all() or np.abs(iterate - q).max() > _REACH * potential.pair.length:
            break
        residual = potential.residual(iterate)
        if residual >= best_residual:
            break
        best_state, best_residual = iterate, residual
    return np.array(best_state)
