"""Maps linearised about an equilibrium: multipliers, modes, a discrete python-control system.

A map q' = q + h p + f h² u, p' = p + h u with u at the start of the step has the multipliers z = 1 + h w, where
(w² + w (D + f h K) + K) v = 0: those of a flow whose damping is D + f h K. So all that is known of the modes of a flow
serves (`flockana.stability.modes`): zero modes come out as multipliers that are exactly 1. Agent by agent in place,
K_L and D_L the entries that act on agents moved before, the equation is
(w² (1 + h D_L + f h² K_L) + w (D + f h K + h K_L) + K) v = 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from numpy.polynomial import Polynomial

from flockana.base.errors import ArgumentError
from flockana.base.finite_differences import ORDER_2, central_differences
from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import ComplexArray, FloatArray, ensure_fits
from flockana.equilibria.curvature import EPS
from flockana.laws import DiscreteLaw
from flockana.stability.eigenvalue_errors import eigen
from flockana.stability.mode_names import translations
from flockana.stability.modes import Mode, SecondOrder
from flockana.stability.signal_names import axes_of, labels

if TYPE_CHECKING:
    import control

    from flockana.stability.damp_table import DampTable
    from flockana.stability.linear_flock import LinearFlock

_PARALLEL = 1e-9  # radians, or units of the law: headings that differ by no more are one, states that move less rest
_WIDTH, _KINK = 1e-6, 1e-4  # of a difference, in units of the law; of two slopes, of the size of A


@dataclass(frozen=True)
class MapMode:
    """Mode of a map near its fixed motion: after k steps Re(shape · multiplier^k).

    Parameters
    ----------
    multiplier : complex
        z; of a conjugate pair the one with Im z >= 0.
    shape : ndarray, shape (n, m) or (n,)
        Displacements of the agents (of a map of headings: turns), of unit length together.
    name : str
        As of a `Mode`; numbers count from the slowest.
    error : float
        Largest rounding error of the multiplier.

    Examples
    --------
    >>> flip = MapMode(-0.5, np.ones((1, 1)), "1", 0.1)
    >>> flip.decay_per_step, round(flip.frequency * 0.1, 6), flip.decays
    (0.5, 3.141593, True)
    """

    multiplier: complex
    shape: npt.NDArray[Any] = field(repr=False)
    name: str
    dt: float
    error: float = field(default=0.0, repr=False)

    @property
    def decay_per_step(self) -> float:
        """Decay per step, 1 − |z|; negative for a growing mode."""
        return 1.0 - abs(self.multiplier)

    @property
    def decay_rate(self) -> float:
        """Decay rate −ln|z|/dt, per time unit; infinite if one step ends the mode."""
        return -float(np.log(abs(self.multiplier))) / self.dt if self.multiplier else float("inf")

    @property
    def frequency(self) -> float:
        """Frequency arg z/dt, in radians per time unit; π/dt if the sign changes at each step."""
        return abs(float(np.angle(self.multiplier))) / self.dt

    @property
    def decays(self) -> bool:
        """Return whether the mode decays, beyond rounding."""
        return self.decay_per_step > self.error


@dataclass(frozen=True, eq=False)
class MapLinearisation(ShortRepr):
    """δx(k+1) = A δx(k) near the steady motion of a map, in its moving frame.

    Parameters
    ----------
    law : DiscreteLaw or Law
        The map, or the law that is sampled.
    q, p : ndarray, shape (n, m)
        Positions and velocities, all agents with the velocity of the frame.
    residual : float
        Distance from a fixed motion, relative to the law's forces (of headings: in radians).
    A, B : ndarray, shapes (N, N) and (N, F)
        Step of the state, and effect of a force on each agent that lasts the step (of a turn of each heading).
    states, inputs : tuple of str
        Their names: q0_x, …, p0_x, …, or heading0, …; what the map remembers beside by its own names.
    second_order : SecondOrder or None
        The equation of w, of which `growth` makes multipliers; None of a map of headings, and of one whose steps are
        differentiated.
    off : float
        Share of its size by which A may be off: of one whose steps are differentiated.
    growth : tuple of float
        Coefficients r of z = Σ r_k (dt w)^k: w = (z − 1)/dt of a map with one stage; of others w is an eigenvalue of
        the flow, and R(dt w) the stability function of the solver.
    step : float, optional
        Period, of a law with a clock, which has no `dt` of its own.

    Examples
    --------
    The R² notebook's step of a pair at its distance: what rotates or translates it stays.

    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.solvers.taylor_step import TaylorStep
    >>> from flockana.stability import linearise
    >>> pair = linearise(TaylorStep(Algorithm1(), 0.01), [[0.0, 0.0], [7.0, 0.0]])
    >>> [(mode.name, round(mode.decay_per_step, 4)) for mode in pair.modes], pair.stable
    ([('breathing', 0.0085), ('rotation', 0.0393)], True)
    """

    law: Any
    q: FloatArray = field(repr=False)
    p: FloatArray = field(repr=False)
    t: float
    residual: float
    A: FloatArray = field(repr=False)
    B: FloatArray = field(repr=False)
    states: tuple[str, ...] = field(repr=False)
    inputs: tuple[str, ...] = field(repr=False)
    second_order: SecondOrder | None = field(repr=False, default=None)
    off: float = 0.0
    growth: tuple[float, ...] = (1.0, 1.0)
    step: float | None = None

    @property
    def dt(self) -> float:
        """Time step of the map, in time units."""
        return self.law.dt if self.step is None else self.step

    @cached_property
    def _dense(self) -> tuple[ComplexArray, ComplexArray, FloatArray]:
        """Multipliers, vectors and errors of A; multipliers within their error of 1 are set to 1."""
        values, vectors, errors = eigen(self.A, self.off)
        return np.where(np.abs(values - 1.0) <= errors, 1.0, values), vectors, errors

    @property
    def multipliers(self) -> ComplexArray:
        """All eigenvalues of A, the largest first; neutral ones are exactly 1."""
        values = self._dense[0] if self.second_order is None else self._grown(self.second_order.eigenvalues)
        return values[np.lexsort((values.imag, -np.abs(values)))]

    def _grown(self, w: Any, derivative: int = 0) -> Any:
        """Return the growth polynomial R(dt w) of one step, or a derivative of R at dt w."""
        return Polynomial(self.growth).deriv(derivative)(self.dt * w)

    @property
    def zero_modes(self) -> tuple[Mode, ...]:
        """Motions with multiplier 1: translations, rotations, soft modes; none without a `second_order`."""
        return () if self.second_order is None else self.second_order.invariant.zero

    @cached_property
    def modes(self) -> tuple[MapMode, ...]:
        """Modes other than the neutral motions, slowest first; one for each real multiplier or conjugate pair."""
        all_modes: list[tuple[complex, Any, str, float]] = []
        if self.second_order is None:
            values, vectors, errors = self._dense
            mode_indices = np.flatnonzero((values != 1.0) & (values.imag >= 0.0))
            all_modes = [(complex(values[k]), vectors[:, k], "", float(errors[k])) for k in mode_indices]
        else:
            h, modes = self.dt, self.second_order.modes
            names = ("" if mode.name.isdigit() else mode.name for mode in modes)
            rows = zip(modes, names, strict=True)
            for mode, name in rows:
                z, error = complex(self._grown(mode.eigenvalue)), h * mode.error * abs(self._grown(mode.eigenvalue, 1))
                all_modes.append(
                    (z, mode.shape, name, error) if z.imag >= 0.0 else (z.conjugate(), mode.shape.conj(), name, error)
                )
        all_modes.sort(key=lambda one: 1.0 - abs(one[0]))
        numbered_modes = enumerate(all_modes, start=1)
        return tuple(MapMode(z, shape, name or str(k), self.dt, error) for k, (z, shape, name, error) in numbered_modes)

    @property
    def spectral_radius(self) -> float:
        """Largest modulus of the multipliers off the neutral motions; NaN without other modes."""
        return 1.0 - self.modes[0].decay_per_step if self.modes else float("nan")

    @property
    def stable(self) -> bool:
        """Return whether every mode off the neutral motions decays, beyond rounding; True without such modes."""
        return all(mode.decays for mode in self.modes)

    def damp(self, *, settled: float = 0.02) -> DampTable:
        """Return a table of all multipliers by rising natural frequency: see `Linearisation.damp`; s = ln z/dt.

        Parameters
        ----------
        settled : float
            Share of a deviation at which it counts as settled.
        """
        from flockana.stability.damp_table import damp_table

        poles = [(mode.name, complex(mode.multiplier)) for mode in self.modes]
        pairs = [(name, z.conjugate()) for name, z in poles if z.imag]
        zeros = [mode.name for mode in self.zero_modes]
        zeros += ["neutral"] * (len(self.multipliers) - len(poles) - len(pairs) - len(zeros))
        return damp_table([*((name, 1.0 + 0j) for name in zeros), *poles, *pairs], settled=settled, dt=self.dt)

    @cached_property
    def state_space(self) -> control.StateSpace:
        """Python-control system with this dt: a force on each agent to the centre and the deviations from it.

        Of a map of headings: a turn of each to the headings.
        """
        import control

        if self.second_order is None:
            readings, outputs = np.eye(len(self.A)), list(self.states)
        else:
            n, m = self.q.shape
            unit = translations(n, m)
            own_rows = np.vstack([unit.T / np.sqrt(n), np.eye(n * m) - unit @ unit.T])
            readings = np.hstack([own_rows, np.zeros_like(own_rows)])
            outputs = axes_of("qc", m) + labels("x", n, m)
        names = {"states": list(self.states), "inputs": list(self.inputs), "outputs": outputs, "name": "map"}
        return control.ss(self.A, self.B, readings, np.zeros((len(readings), self.B.shape[1])), self.dt, **names)


def stepped_equation(
    stiffness: Any, damping: Any, dt: float, factor: float, m: int, *, in_place: bool = False
) -> tuple[Any, Any]:
    """Return (K, D) of the equation in w = (z − 1)/dt of a map that steps δq'' = −K δq − D δq', sparse."""
    k, d = stiffness.tocsr(), damping + factor * dt * stiffness
    if not in_place:
        return k, d
    from scipy.sparse import csr_array, eye_array
    from scipy.sparse.linalg import spsolve

    moved_matrices = moved_before(k, m), moved_before(damping, m)
    mass = eye_array(k.shape[0]) + dt * moved_matrices[1] + factor * dt * dt * moved_matrices[0]
    solved_matrices: Any = (spsolve(mass.tocsc(), matrix.tocsc()) for matrix in (k, d + dt * moved_matrices[0]))
    return tuple(csr_array(matrix) for matrix in solved_matrices)  # type: ignore[return-value]


def moved_before(matrix: Any, m: int) -> Any:
    """Return the entries of a matrix by which agents depend on agents of smaller index."""
    entries = matrix.tocoo(copy=True)
    entries.data = np.where(entries.coords[1] // m < entries.coords[0] // m, entries.data, 0.0)
    return entries.tocsr()


def linearise_map(law: DiscreteLaw, flow: LinearFlock) -> MapLinearisation:
    """Return the linearisation of a map from that of its law: by `position_factor` or `stability_function`."""
    q, (n, m), size = flow.q, flow.q.shape, flow.q.size
    ensure_fits("A", flow.A_sparse.shape, "linearise fewer agents")
    names = (*labels("q", n, m), *labels("p", n, m)), tuple(labels("f", n, m))
    rest = law, q, flow.p, flow.t, flow.residual
    if law.position_factor is None and law.stability_function is not None:
        step, push = law.dt * flow.A, law.dt * np.eye(2 * size)[:, size:]
        a, b = np.zeros_like(step), np.zeros_like(push)
        for k in range(len(law.stability_function) - 1, -1, -1):  # R(h A), and its part that acts on a force
            b = a @ push
            a = a @ step + law.stability_function[k] * np.eye(2 * size)
        return MapLinearisation(*rest, a, b, *names, flow.second_order, growth=law.stability_function)
    h, f = law.dt, float(law.position_factor or 0.0)
    stiffness, damping = flow.stiffness, flow.damping
    one, zero = np.eye(size), np.zeros((size, size))
    motion_matrix, push = np.block([[one, h * one], [zero, one]]), np.vstack([f * h * h * one, h * one])
    a, b = motion_matrix + push @ flow.A[size:], push
    if law.in_place:  # agents see those before them where these have moved to: both sides hold the next state
        shift = -np.hstack([moved_before(matrix, m).toarray() for matrix in (stiffness, damping)])
        a, b = (np.linalg.solve(np.eye(2 * size) - push @ shift, matrix) for matrix in (a - push @ shift, push))
    equation = SecondOrder(q, *stepped_equation(stiffness, damping, h, f, m, in_place=law.in_place), zero=flow.zero)
    return MapLinearisation(*rest, a, b, *names, equation)


def linearise_headings(law: Any, q: FloatArray, p: FloatArray, t: float) -> MapLinearisation:
    """Return the linearisation of a heading map about parallel motion, with a constant net."""
    heading = np.arctan2(p[:, 1], p[:, 0])
    off = float(np.abs(np.angle(np.exp(1j * (heading - heading[0])))).max())
    if off > _PARALLEL:
        raise ArgumentError(
            f"headings differ by up to {off:.3g} radians: expected equal velocities, with which the net does not change"
        )
    matrix: FloatArray = law.averaging_matrix(q, heading).toarray()
    n = len(q)
    names = tuple(f"heading{i}" for i in range(n)), tuple(f"turn{i}" for i in range(n))
    return MapLinearisation(law, q, p, t, off, matrix, np.eye(n), *names)


def linearise_steps(law: DiscreteLaw, q: FloatArray, p: FloatArray, t: float) -> MapLinearisation:
    """Return the linearisation of any map about a steady motion by differences of steps; raise at a kink."""
    (n, m), name, memory = q.shape, law.title, {k: np.array(v) for k, v in law.start(q, p).items()}
    shapes = {"q": q.shape, "p": p.shape} | {key: value.shape for key, value in memory.items()}
    scales, length = law.scales, float(np.abs(q - q[0]).max()) or 1.0
    unit, time = (length, law.dt) if scales is None else (scales.length, scales.time)
    powers = dict.fromkeys(shapes, (0, 0)) | {"q": (1, 0), "p": (1, -1)} | dict(law.extra_units)
    sizes = {key: unit ** powers[key][0] * time ** powers[key][1] for key in shapes}
    ends = np.cumsum([0, *(int(np.prod(shape)) for shape in shapes.values())])

    def packed(parts: Mapping[str, FloatArray]) -> FloatArray:
        return np.concatenate([np.ravel(parts[key]) / sizes[key] for key in shapes])

    def stepped(state: FloatArray, steps: int = 0) -> FloatArray:
        """Return the map's state one step later in the moving frame, the step being number `steps`."""
        parts = zip(shapes.items(), np.split(state, ends[1:-1]), strict=True)
        values = {key: (part * sizes[key]).reshape(shape) for (key, shape), part in parts}
        drift, inner = steps * law.dt * p, {key: values[key] for key in memory}
        after = law.step(t + steps * law.dt, values["q"] + drift, values["p"], inner)
        return packed({"q": after[0] - drift - law.dt * p, "p": after[1]} | dict(after[3]))

    start = packed({"q": q, "p": p} | memory)
    shift = np.abs(stepped(start) - start)
    worst = int(np.argmax(shift))
    if not shift[worst] <= _PARALLEL:
        where = list(shapes)[int(np.searchsorted(ends, worst, side="right")) - 1]
        raise ArgumentError(
            f"the state is no steady motion of {name}: {where} changes by {shift[worst]:.3g} of its unit in a step, "
            f"expected at most {_PARALLEL:g}; start from positions and velocities that the map keeps"
        )
    matrix, kink = central_differences(stepped, start, _WIDTH, ORDER_2)
    wide = central_differences(stepped, start, 2.0 * _WIDTH, ORDER_2)[0]
    later_matrix = central_differences(lambda x: stepped(x, 97), start, _WIDTH, ORDER_2)[0]
    size, kink = float(np.linalg.norm(matrix)), max(kink, float(np.abs(wide - matrix).max()))
    if kink > _KINK * size:
        raise ArgumentError(
            f"{name} has a kink or a jump at this state (slopes to either side differ by {kink:.2g}): expected a "
            "state within its zones and bounds, not at the edge of one"
        )
    if np.abs(later_matrix - matrix).max() > _KINK * size:
        raise ArgumentError(f"{name} changes further along this motion: expected one that meets no obstacle")
    units = np.repeat(list(sizes.values()), np.diff(ends))
    off = (float(np.linalg.norm(wide - matrix)) + len(start) * 4.0 * EPS / _WIDTH) / size
    memory_names = [f"{key}{k}" for key, shape in shapes.items() if key in memory for k in range(int(np.prod(shape)))]
    names = (*labels("q", n, m), *labels("p", n, m), *memory_names)
    a = matrix * units[:, None] / units
    return MapLinearisation(
        law, q, p, t, float(shift[worst]), a, np.eye(len(a)), names, tuple(f"d{name}" for name in names), None, off
    )
