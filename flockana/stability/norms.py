"""H₂ and H∞ norms from disturbing forces on the agents to the deviations of the flock."""

from __future__ import annotations

from collections.abc import Iterable
from math import atan, inf, sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError, SolverError
from flockana.base.value_checks import FloatArray, ensure_kind, ensure_nonnegative, ensure_positive
from flockana.equilibria.curvature import EPS
from flockana.stability.eigenvalue_errors import eigenvalues
from flockana.stability.second_order_blocks import Blocks
from flockana.stability.zero_modes import complement

if TYPE_CHECKING:
    from control import StateSpace

_ROUNDS = 30
_ROUNDINGS = 64.0  # of eps N cond(K): of the solves for K⁺ and for the Gramian
_IMAGINARY = 1e-9  # of the largest eigenvalue: real parts below that are zero


def disturbance_system(flock: Blocks) -> StateSpace:
    """Return a `control.StateSpace` from a force on each agent to the deviation of the flock's shape.

    That is the deviation from the nearest displaced and turned copy of the equilibrium, all rigid motions taken out.

    Parameters
    ----------
    flock : Blocks
        The linearised flock.

    Examples
    --------
    >>> from flockana import Algorithm1, stability
    >>> system = disturbance_system(stability.law_blocks(Algorithm1(), [[0.0, 0.0], [7.0, 0.0]]))
    >>> system.nstates, system.ninputs, system.noutputs
    (3, 4, 1)
    """
    ensure_kind("flock", flock, "Blocks", "what blocks(...) gives")
    import control

    a, b, positions, _ = flock.quotient()
    visible_space = complement(flock.rigid)
    c = np.hstack([visible_space.T @ positions, np.zeros((visible_space.shape[1], a.shape[0] - positions.shape[1]))])
    return control.StateSpace(a, b, c, np.zeros((c.shape[0], b.shape[1])), remove_useless_states=False)


def h2_norm(system: StateSpace) -> float:
    """Return the H₂ norm of a linear system, from white noise of unit intensity in every input to the output.

    The controllability Gramian of the balanced system by Bartels and Stewart's method (scipy); infinite unless the
    system is stable. White noise in continuous time that reaches an output directly, D != 0, has infinite variance
    there; in discrete time it adds its own.

    Parameters
    ----------
    system : control.StateSpace
        In continuous or discrete time.

    Raises
    ------
    SolverError
        If rounding leaves nothing of the norm, as where damping is below rounding of the stiffness.

    Examples
    --------
    x'' + d x' + k x = w has 1/√(2 d k), and x(k+1) = a x(k) + w has 1/√(1 − a²):

    >>> import control
    >>> round(h2_norm(control.ss([[0, 1], [-8, -1]], [[0], [1]], [[1, 0]], 0)), 12)
    0.25
    >>> h2_norm(control.ss([[0.6]], [[1]], [[1]], 0, True))
    1.25
    """
    balanced_system = _balanced(system)
    if not balanced_system.stable or (balanced_system.d.any() and not balanced_system.discrete):
        return inf
    power = float(np.trace(balanced_system.covariance()))
    if power < 0.0:
        raise SolverError(
            f"the power of the outputs comes out as {power:.3g}: a mode decays too slowly for the rounding of A; "
            "ask for more damping, or for the norm of a part"
        )
    return sqrt(power)


class Balanced(NamedTuple):
    """State-space system with states scaled by powers of 2 to similar magnitude."""

    a: FloatArray
    b: FloatArray
    c: FloatArray
    d: FloatArray
    discrete: bool

    @property
    def stable(self) -> bool:
        """Return whether every mode of the state-space system decays, beyond rounding."""
        values, errors = eigenvalues(self.a)
        return bool(np.all((np.abs(values) - 1.0 if self.discrete else values.real) < -errors))

    def covariance(self) -> FloatArray:
        """Return the output covariance of a stable system under unit white noise in every input."""
        from scipy.linalg import solve_continuous_lyapunov, solve_discrete_lyapunov

        if not self.discrete:
            return np.asarray(self.c @ solve_continuous_lyapunov(self.a, -self.b @ self.b.T) @ self.c.T)
        return np.asarray(self.c @ solve_discrete_lyapunov(self.a, self.b @ self.b.T) @ self.c.T + self.d @ self.d.T)

    def continuous(self) -> Balanced:
        """Return a discrete system as a continuous one over s = (z − 1)/(z + 1), with the same gains."""
        if not self.discrete:
            return self
        identity = np.eye(len(self.a))
        inverse = np.linalg.inv(self.a + identity)
        a, b, c = inverse @ (self.a - identity), sqrt(2.0) * inverse @ self.b, sqrt(2.0) * self.c @ inverse
        return Balanced(a, b, c, self.d - self.c @ inverse @ self.b, discrete=False)

    def gain(self, omega: float) -> float:
        """Return the largest gain (singular value) at a frequency, of a system in continuous time."""
        if omega == inf or not len(self.a):
            return float(np.linalg.norm(self.d, 2))
        answer = np.linalg.solve(1j * omega * np.eye(len(self.a)) - self.a, self.b)
        return float(np.linalg.norm(self.c @ answer + self.d, 2))

    def crossings(self, level: float) -> FloatArray:
        """Return the frequencies >= 0 at which a gain equals `level`, from eigenvalues of a Hamiltonian matrix."""
        a, b, c, d = self.a, self.b, self.c, self.d
        input_map = np.linalg.solve(level**2 * np.eye(d.shape[1]) - d.T @ d, np.hstack([d.T @ c, level * b.T]))
        output_map = level * c.T @ np.linalg.solve(level**2 * np.eye(d.shape[0]) - d @ d.T, c)
        inner = a + b @ input_map[:, : len(a)]
        values = np.linalg.eigvals(np.block([[inner, b @ input_map[:, len(a) :]], [-output_map, -inner.T]]))
        return np.sort(values.imag[(np.abs(values.real) <= _IMAGINARY * np.abs(values).max()) & (values.imag >= 0)])


def _balanced(system: StateSpace) -> Balanced:
    """Return the matrices of a system with balanced states."""
    from scipy.linalg.lapack import dgebal

    ensure_kind("system", system, "StateSpace", "a control.StateSpace, as disturbance_system(...) gives it")
    a, b, c, d = (np.asarray(x, dtype=np.float64) for x in (system.A, system.B, system.C, system.D))
    is_discrete = bool(system.isdtime(strict=True))
    if not a.size or not c.size or not b.size:
        zero = np.zeros((0, 0))
        return Balanced(zero, np.zeros((0, b.shape[1])), np.zeros((c.shape[0], 0)), d, is_discrete)
    a, _, _, units, _ = dgebal(a, scale=1)
    return Balanced(a, b / units[:, None], c * units, d, is_discrete)


@check_kinds
def stationary_covariance(system: StateSpace, intensity: float = 1.0) -> FloatArray:
    """Return the output covariance under white noise in every input, from the Lyapunov equation.

    Parameters
    ----------
    system : control.StateSpace
        Stable; in continuous time without direct feedthrough.
    intensity : float
        Of the noise, as `flockana.Disturbed` takes it; the trace is then (intensity · H₂ norm)².

    Returns
    -------
    ndarray, shape (outputs, outputs)

    Raises
    ------
    ArgumentError
        If the system is not stable, or noise reaches an output directly in continuous time: then there is no
        stationary covariance.

    Examples
    --------
    >>> import control
    >>> swing = control.ss([[0, 1], [-8, -1]], [[0], [1]], np.eye(2), 0)
    >>> (stationary_covariance(swing, 2.0).round(12) + 0.0).tolist()
    [[0.25, 0.0], [0.0, 2.0]]
    """
    intensity, balanced = ensure_nonnegative("intensity", intensity), _balanced(system)
    if not balanced.stable:
        raise ArgumentError("the system is not stable: expected one whose modes all decay, such as disturbance_system")
    if balanced.d.any() and not balanced.discrete:
        raise ArgumentError(
            f"D has an entry {float(np.abs(balanced.d).max()):.3g}: expected 0 in continuous time, for white noise "
            "that reaches an output directly has no variance there"
        )
    covariance: FloatArray = intensity**2 * balanced.covariance()
    return 0.5 * (covariance + covariance.T)


def h2_bounds(flock: Blocks) -> tuple[float, float]:
    """Return closed-form bounds √(tr K⁺/(2 d_max)) and √(tr K⁺/(2 d_min)) of the H₂ norm to the shape."""
    # With noise of intensity 2 D in place of 1 the stationary law is Gibbs's, with covariance K⁻¹; since d_min ≤ D ≤
    # d_max and covariance grows with the noise, that brackets it. They meet, but for rounding, where D is a multiple of
    # 1.
    ensure_kind("flock", flock, "Blocks", "what blocks(...) gives")
    positions, velocities, shapes = (complement(x) for x in (flock.neutral, flock.drifting, flock.rigid))
    rates = np.linalg.eigvalsh(velocities.T @ flock.damping @ velocities)
    visible_shapes = positions.T @ shapes
    trace = float(np.sum(visible_shapes * np.linalg.solve(positions.T @ flock.stiffness @ positions, visible_shapes)))
    # the bracket may be closed: it is opened by what rounding does to K⁺, and to the norm that is compared with it
    stiff = np.linalg.eigvalsh(positions.T @ flock.stiffness @ positions)
    spread = _ROUNDINGS * EPS * len(flock.stiffness) * float(stiff[-1] / stiff[0]) if stiff.size else 0.0
    threshold = EPS * len(flock.stiffness) * float(rates[-1])
    low, high = (sqrt(trace / (2.0 * float(rate))) if rate > threshold else inf for rate in (rates[-1], rates[0]))
    return low * (1.0 - spread), high * (1.0 + spread)


def hinf_norm(system: StateSpace, *, tol: float = 1e-9) -> tuple[float, float]:
    """Return the H∞ norm of a linear system, and the frequency of its peak.

    Bruinsma and Steinbuch (1990): a gain is exceeded exactly where the Hamiltonian matrix has imaginary eigenvalues,
    between which the next frequencies are tried. The norm is at least what is returned, and at most (1 + tol) times.

    Parameters
    ----------
    system : control.StateSpace
        In continuous or discrete time; infinite unless it is stable. A peak at infinity is that of D.
    tol : float
        Relative tolerance.

    Raises
    ------
    SolverError
        If it does not converge.

    Examples
    --------
    x'' + d x' + k x = w has 1/(d √(k − d²/4)) at √(k − d²/2):

    >>> import control
    >>> norm, peak = hinf_norm(control.ss([[0, 1], [-25, -6]], [[0], [1]], [[1, 0]], 0))
    >>> round(norm * 24, 9), round(peak**2, 5)
    (1.0, 7.0)
    """
    tol, balanced = ensure_positive("tol", tol), _balanced(system)
    if not balanced.stable:
        return inf, float("nan")
    continuous_system = balanced.continuous()
    gain, omega = largest_gain(continuous_system, tol)
    if gain == 0.0:
        return 0.0, 0.0
    return gain, 2.0 * atan(omega) / (1.0 if system.dt is True else float(system.dt)) if balanced.discrete else omega


def largest_gain(system: Balanced, tol: float, seen: Iterable[float] = ()) -> tuple[float, float]:
    """Return the H∞ norm and peak frequency of a stable continuous-time system; `seen` are first trials."""
    poles = np.linalg.eigvals(system.a)
    trials = np.unique(np.concatenate([[0.0], np.abs(poles), np.abs(poles.imag)]))
    best_gain = max((system.gain(w), w) for w in (*seen, *trials.tolist()[:: max(1, trials.size // 24)], inf))
    if not len(poles) or best_gain[0] == 0.0:
        return best_gain
    for _ in range(_ROUNDS):
        level = (1.0 + tol) * best_gain[0]
        crossing = system.crossings(level)
        middles = np.concatenate([crossing, 0.5 * (crossing[1:] + crossing[:-1])])
        peak = max(((system.gain(w), w) for w in middles.tolist()), default=(0.0, 0.0))
        if peak[0] <= level:
            return max(best_gain, peak)
        best_gain = peak
    raise SolverError(f"the H∞ norm did not settle in {_ROUNDS} rounds; the last lower bound is {best_gain[0]:.6g}")
