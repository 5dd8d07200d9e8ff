"""Slowest modes of a large flock: sparse shift-invert about zero, with zero modes separated."""

from math import inf
from typing import Any, NamedTuple

import numpy as np

from flockana.base.errors import ArgumentError, SolverError
from flockana.base.value_checks import FloatArray, ensure_count
from flockana.lattice.elimination import Elimination
from flockana.stability.eigenvalue_errors import mode_errors
from flockana.stability.linearisation import Linearisation
from flockana.stability.modes import Mode, SecondOrder

_SHIFT = 1e-3  # of the fastest rate: beside zero, where A itself is singular
_ROUNDS = 3
_TRIES = (1.4, 2.0, 1.0, 2.8, 4.0, 0.7, 0.5, 0.25)  # of the ratio of the scales of K and D: the best ones first
_DENSE = 1500  # coordinates of a strongly connected component whose whole spectrum is found
_FIRST = 8  # eigenvalues asked for at first, for each mode that is wanted


class SlowModes(NamedTuple):
    """Slowest modes, with the rate up to which the list is complete.

    Attributes
    ----------
    modes : tuple of Mode
        Slowest first.
    complete_to : float
        No mode that decays more slowly than this is missing; NaN where K or D is not symmetric and nothing is known.
    """

    modes: tuple[Mode, ...]
    complete_to: float


def slowest_modes(linearisation: Linearisation, count: int = 12) -> SlowModes:
    """Find the slowest modes without a dense matrix: n = 2000 in seconds.

    Shift-invert finds the eigenvalues of least modulus, and a slow mode may yet swing fast. For symmetric K and D
    Rayleigh quotients rule this out: a mode that swings has Re λ = −vᴴDv/2 and |λ|² = vᴴKv, so with K ≤ a + b D it
    has |λ|² ≤ a + 2 b |Re λ|. More eigenvalues are asked for until as many modes as wanted are known to be the slowest,
    or a few rounds have passed. Soft modes (hinges, loose parts) are not set apart here; they show as tiny eigenvalues.

    Parameters
    ----------
    linearisation : Linearisation
        From `linearise`.
    count : int
        How many modes.

    Raises
    ------
    ArgumentError
        If the flock has no more than count modes, or count is no whole number >= 1.
    SolverError
        If ARPACK does not converge.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> from flockana.lattice import hexagonal_patch
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.stability.linearise import linearise
    >>> patch = linearise(Algorithm1(), hexagonal_patch(2, 7.0))
    >>> slow = slowest_modes(patch, 3)
    >>> bool(abs(slow.modes[0].decay_rate - patch.decay_rate) < 1e-9 * patch.decay_rate), slow.complete_to > 1.0
    (True, True)
    """
    if not isinstance(linearisation, Linearisation):
        raise ArgumentError(f"linearisation = {linearisation!r}: expected what linearise(law, equilibrium) gives")
    count = ensure_count("count", count)
    problem = linearisation.second_order
    if problem.net and max(component.q.size for component in problem.parts) <= _DENSE:
        return SlowModes(_of_components(problem, count), inf)
    free_count = 2 * problem.q.size - problem.rigid_invariant.left.shape[1]
    if 2 * count >= free_count - 2:
        raise ArgumentError(
            f"count = {count}: expected fewer modes, 2 count < {free_count - 2} eigenvalues off the zero modes; "
            "a flock this small has its whole spectrum in `modes`"
        )
    count_wanted = min(_FIRST * count, free_count - 2)
    for _ in range(_ROUNDS):
        values, vectors, radius = _nearest_zero(problem, count_wanted)
        is_upper = values.imag >= 0.0
        errors = mode_errors(problem.stiffness, problem.damping, values[is_upper], vectors[:, is_upper])
        modes = problem.named(values[is_upper], vectors[:, is_upper], errors, problem.rigid_invariant.translational)
        rising_rates = np.maximum.accumulate([mode.decay_rate for mode in modes])  # but for the rounding of equal ones
        slow_modes = _complete_to(problem, rising_rates.tolist(), radius, count)
        if not modes[count - 1].decay_rate > slow_modes or count_wanted == free_count - 2:
            break
        count_wanted = min(2 * count_wanted, free_count - 2)
    return SlowModes(modes[:count], slow_modes)


def _of_components(problem: SecondOrder, count: int) -> tuple[Mode, ...]:
    """Return the slowest modes from the whole spectra of the strongly connected components."""
    local_modes = problem.local_modes()
    if count >= len(local_modes):
        raise ArgumentError(f"count = {count}: expected fewer modes than {len(local_modes)}; `modes` has them all")
    shapes = np.array([problem.spread(k, mode) for _, k, mode in local_modes[:count]]).T
    values, errors = (np.array([getattr(mode, x) for *_, mode in local_modes[:count]]) for x in ("eigenvalue", "error"))
    return problem.named(values, shapes, errors, ())


def _complete_to(problem: SecondOrder, rates: list[float], radius: float, count: int) -> float:
    """Return the largest decay rate up to which every mode has |λ| <= radius: 0 if none, NaN if unknown."""
    # Of the bounds K < a + b D one is looked for that serves the rate that matters, number `count`, or else the
    # smallest; how far it goes beyond is found by bisection.
    if not problem.symmetric:
        return float("nan")
    if abs(problem.damping).max() == 0.0:
        return 0.0
    ratio = problem.scale / problem.damping_scale

    def complete(rate: float, factor: float) -> bool:
        b = factor * ratio
        return rate <= radius and _dominates(problem, radius**2 - 2.0 * b * rate, b)

    for first in (count, 1):
        for factor in _TRIES:
            if complete(rates[first - 1], factor):
                low, high = first, len(rates)  # rates rise: bisect
                while low < high:
                    middle = (low + high) // 2
                    low, high = (middle + 1, high) if complete(rates[middle], factor) else (low, middle)
                return rates[low - 1]
    return 0.0


def _dominates(problem: SecondOrder, a: float, b: float) -> bool:
    """Return whether the stiffness K < a + b D as a matrix inequality, by symmetric elimination."""
    from scipy.sparse import eye_array

    gap = a * eye_array(problem.q.size) + b * problem.damping - problem.stiffness
    try:
        Elimination(gap, problem.q, keep=False, definite=True)
    except SolverError:
        return False
    return True


def _nearest_zero(problem: SecondOrder, count: int) -> tuple[Any, Any, float]:
    """Return eigenvalues nearest to 0 off the invariant subspace, displacements, and the radius they fill."""
    from scipy.sparse import csc_array, eye_array
    from scipy.sparse.linalg import ArpackError, LinearOperator, eigs, splu

    size, shift = problem.q.size, _SHIFT * problem.pace
    damping = problem.damping + shift * eye_array(size)
    near = problem.stiffness + shift * damping
    solve = Elimination(near, problem.q).solve if problem.symmetric else splu(csc_array(near)).solve
    right, left = problem.rigid_invariant.right, problem.rigid_invariant.left
    gram = left.T @ right

    def off(z: FloatArray) -> FloatArray:
        return z - right @ np.linalg.solve(gram, left.T @ z) if right.shape[1] else z

    def inverse(z: FloatArray) -> FloatArray:
        """Return (A − shift)⁻¹ z of the flock's state matrix A by one solve of half its size."""
        z = off(z.ravel())
        q, p = z[:size], z[size:]
        dq = solve(-p - damping @ q)
        return off(np.concatenate([dq, q + shift * dq]))

    operator, vector_limit = LinearOperator((2 * size, 2 * size), matvec=inverse, dtype=np.float64), 5 * count // 2
    start = off(np.random.default_rng(0).standard_normal(2 * size))  # fixed, so that results are reproducible
    try:
        inverse_eigenvalues, vectors = eigs(operator, k=count, which="LM", v0=start, ncv=min(2 * size, vector_limit))
    except ArpackError as error:
        raise SolverError(f"ARPACK found no {count} eigenvalues nearest to zero ({error}); ask for fewer") from error
    values = shift + 1.0 / inverse_eigenvalues
    # a disc about the shift, cut down to one about zero
    return values, vectors[:size], float(np.max(np.abs(values - shift))) - shift
