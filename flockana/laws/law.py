"""Base classes of laws of motion; the continuous ones are feedbacks u(t, q, p) for q' = p, p' = u."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.finite_differences import differences
from flockana.base.natural_scales import Scales
from flockana.base.override_checks import overrides_consistently
from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import (
    FloatArray,
    ensure_finite_scalar,
    ensure_fits,
    ensure_points,
    ensure_returned_array,
    ensure_state,
)
from flockana.interactions.distance_functions import LawFunction, PairCorner, UnknownEdges
from flockana.interactions.pair_interaction import PairInteraction
from flockana.laws.law_features import Feature, Unknown, function_feature

if TYPE_CHECKING:
    from control import StateSpace
    from scipy.sparse import csr_array, sparray

    from flockana.environment.beta_agents import ObstacleField
    from flockana.environment.obstacles import Obstacle
    from flockana.environment.target import Target
    from flockana.laws.terms.term import Compiled, Term


Arrays = Mapping[str, FloatArray]  # by name
Block = Callable[..., tuple[FloatArray, FloatArray, FloatArray] | None]  # of steps, as `Law.block` returns it
_SMOOTH = 1e-6  # relative: how far slopes by differences of several widths may be apart
_Term = TypeVar("_Term", bound="Term")
_LACKING: Mapping[str, Any] = {"target": None, "obstacles": (), "obstacle_field": None}


def _pair_among(parameters: Iterable[Any]) -> PairInteraction | None:
    """Return the first pair interaction among parameters or inner laws; None if its range is infinite."""
    for value in parameters:
        pair = value.pair if isinstance(value, LawOfMotion) else value
        if isinstance(pair, PairInteraction):
            return pair if np.isfinite(pair.range) else None
    return None


class LawOfMotion(ShortRepr, ABC):  # each of its two kinds has an abstract method of its own
    """Common interface of continuous laws and maps.

    A law has what its parameters are named for; what it lacks is None or empty, so that nobody need ask for its class.

    Attributes
    ----------
    pair : PairInteraction or None
        The pair interaction of finite range among its parameters, whatever their names.
    target : Target or None
        The γ-agent.
    obstacles : tuple of Obstacle
        What agents keep off.
    obstacle_field : ObstacleField or None
        How they do.
    """

    references: ClassVar[tuple[str, ...]] = ()
    is_map: ClassVar[bool] = False  # whether it leads from step to step, and has no state in between
    derived_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {}  # public methods by the one that integrators ask for

    if TYPE_CHECKING:
        pair: PairInteraction | None
        target: Target | None
        obstacles: tuple[Obstacle, ...]

        @property
        def obstacle_field(self) -> ObstacleField | None: ...  # noqa: D102

    else:  # a class attribute would be the default of a field of that name

        def __getattr__(self, name: str) -> Any:
            if name == "pair":
                return _pair_among(vars(self).values())
            if name in _LACKING:
                inner = vars(self).get("law")  # that it wraps or steps
                return getattr(inner, name) if isinstance(inner, Law) else _LACKING[name]
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)

    @property
    def title(self) -> str:
        """Name of the law in messages and tables: that of its class."""
        return type(self).__name__

    @property
    def continuous(self) -> Law | None:
        """Continuous law: the law itself, or the one discretised by a map; None without one."""
        return None

    @property
    def terms(self) -> tuple[Term, ...]:
        """Terms of a law that is a sum of terms; empty for other laws."""
        return ()

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Functions of the distance of two agents that the law reads: pair laws, nets, weights, link potentials.

        Whoever needs facts about a law's functions asks all of them here, through wrappers and schemes too. A law or a
        term that does not say what it reads has an entry without a function.
        """
        return tuple(function for subterm in self._parts() for function in subterm.functions)

    def features(self) -> tuple[Feature, ...]:
        """Return the narrowest features of all parts: functions of the distance, obstacles, γ-agents."""
        kind = type(self)
        says = getattr(kind, "functions", None) is not LawOfMotion.functions  # a law that names them by itself
        if says and overrides_consistently(kind, "functions", ("flow", "step", "velocity")):
            return tuple(map(function_feature, self.functions))
        return tuple(feature for subterm in self._parts() for feature in subterm.features())

    def _parts(self) -> Iterator[Any]:
        """Yield the parts of a law (terms or inner law) that declare its functions."""
        inner = vars(self).get("law")
        wraps = isinstance(inner, LawOfMotion)
        parts = (inner,) if wraps else self.terms
        for subterm in parts:
            says = wraps or overrides_consistently(type(subterm), "functions", ("act",))
            yield subterm if says else Unknown(type(subterm).__name__)
        is_ours = type(self).__module__.startswith("flockana.")
        is_told = is_ours if wraps else bool(parts) and overrides_consistently(type(self), "terms", ("flow", "step"))
        if not is_told:
            yield Unknown(type(self).__name__)

    def corners_at(self, q: Any, tolerance: float = 1e-9) -> tuple[PairCorner, ...]:
        """Return the pairs at a jump or bend of a function of the law.

        Parameters
        ----------
        q : array_like, shape (n, m)
            Positions.
        tolerance : float
            Relative: how near a distance must be.

        Returns
        -------
        tuple of PairCorner
            Pair, distance, name of the function and the corner: a jump or a kink of its force or its adjacency, with
            values or slopes on both sides. A law that does not say what it reads has corners at its `surfaces`.

        Examples
        --------
        >>> from flockana.interactions import pair_law
        >>> from flockana.laws.olfati_saber import Algorithm1
        >>> spring = pair_law("s*Abs(s - d)", adjacency=0, range=3.0, length=2.0)
        >>> [(corner.i, corner.j, str(corner.corner)) for corner in Algorithm1(spring).corners_at([[0.0], [2.0]])]
        [(0, 1, 'the force jumps at s = 2, from 2 to -2')]
        """
        q = ensure_points("q", q)
        functions = self.functions
        pairs = [pair for function in functions for pair in function.pairs_at_corners(q, tolerance)]
        if not functions or any(function.function is None for function in functions):
            radii = {float(item) for surface in self.surfaces for item in np.ravel(surface)}
            surfaces = LawFunction(f"the force of {type(self).__name__}", UnknownEdges(tuple(sorted(radii))), 1.0)
            pairs += surfaces.pairs_at_corners(q, tolerance)
        return tuple(dict.fromkeys(pairs))

    def term(self, kind: type[_Term]) -> _Term | None:
        """Return the law's first term of a given class; None without one.

        Parameters
        ----------
        kind : type
            Such as `Navigation`.
        """
        return next((term for term in self.terms if isinstance(term, kind)), None)

    @property
    def conservative(self) -> bool:
        """Whether the force at rest is known to be minus the gradient of the energy."""
        return False

    def centre_system(self) -> StateSpace | None:
        """Return a map's linear system of the centre of mass, from the target's (q_r, p_r) to q_c; None by default."""
        return None

    @property
    def centre_decouples(self) -> bool:
        """Whether shape and centre of mass are known to decouple: forces cancel, but for one linear pull on all."""
        return False

    @property
    def located(self) -> bool:
        """Whether the force jumps, so that every switch must be located."""
        return False

    @property
    def lattice(self) -> tuple[float, float] | None:
        """(d, r) if the pair interaction holds every neighbour within r at d, so that α-lattices may be asked for."""
        return None if self.pair is None else self.pair.lattice

    @property
    def scales(self) -> Scales | None:
        """Natural length and time of the law, the units of thresholds; None without its own."""
        return None

    @property
    def surfaces(self) -> tuple[float | tuple[float, ...], ...]:
        """Distances between agents at which a force begins, ends or jumps, each one number or one for every agent.

        Those of the law's pair interaction of finite range, if it has one. An integrator must not step over the region
        within one unseen (`flockana.dynamics.encounters`).
        """
        return () if self.pair is None else self.pair.surfaces

    @property
    def poles(self) -> tuple[float, ...]:
        """Distances between agents with infinite potential or undefined force; no run crosses them.

        Those of the law's pair interaction, if it has one, and 0 of a weight with a pole. A run that meets one ends as
        failed.
        """
        pair = () if self.pair is None else self.pair.poles
        return pair or ((0.0,) if any(entry.has_pole for entry in self.functions) else ())

    @property
    def pole_pairs(self) -> tuple[tuple[int, int], ...] | None:
        """Pairs to which the poles apply; None for all pairs."""
        return None

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:
        """Return the energy whose rate `Law.flow` returns, unchecked; NaN without an energy."""
        return float("nan")

    def switches(self, start: float, stop: float) -> FloatArray:
        """Return the times of law switches in [start, stop), rising.

        Parameters
        ----------
        start, stop : float
            Ends of the span; laws in turn alone have such times.
        """
        return np.empty(0)

    def check_dimension(self, m: int) -> None:  # nothing to check unless a subclass says so
        """Raise if the law is not defined in m dimensions; overridden by laws with vector parameters."""

    def check_agents(self, n: int) -> None:  # as `check_dimension`
        """Raise if the law is not for n agents; overridden by laws with per-agent parameters."""

    def check_start(self, q: FloatArray, p: FloatArray) -> None:
        """Raise if the law must not start from this state; called by `simulate` before integration."""
        self.check_agents(len(q))

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Arrays) -> Mapping[str, Any]:
        """Return the law's own measures of a run, shown by `Trajectory.metrics`.

        Parameters
        ----------
        extra : mapping of str to ndarray
            Further series of the run.

        Returns
        -------
        mapping of str to (str, ndarray of shape (T,)) or to `flockana.measures.measure.Series`
            By name, what it is in words and its values; a function of nothing that gives them, where that costs much.
        """
        return {}


class Law(LawOfMotion):
    """A continuous law; a subclass is a frozen dataclass with `flow` and, if it has an energy, `hamiltonian`.

    `flow` and `hamiltonian` are the unchecked inner loop of the integrators; `acceleration`, `energy` and
    `energy_rate` are the validated public face of the same functions.
    """

    derived_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "flow": ("acceleration", "energy_rate"),
        "hamiltonian": ("energy",),
    }

    @property
    def continuous(self) -> Law:
        """The law itself, as it is continuous."""
        return self

    @abstractmethod
    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """Return acceleration u of shape (n, m) and dH/dt in closed form (NaN without energy), unchecked."""

    def _checked(self, t: Any, q: Any, p: Any) -> tuple[float, FloatArray, FloatArray]:
        q, p = ensure_state(q, p)
        self.check_dimension(q.shape[1])
        self.check_agents(q.shape[0])
        return ensure_finite_scalar("t", t), q, p

    def checked_flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """Return `flow`, (u, dH/dt); raise unless u is a real (n, m) array and dH/dt a real number."""
        flow: Any = self.flow(t, q, p)
        name, at = type(self).__name__, f"at t = {t:g}"
        if not isinstance(flow, tuple) or len(flow) != 2:
            raise ArgumentError(f"{name} gives {format_value(flow)} {at}: expected (u, dH/dt)")
        ensure_returned_array(f"{name} gives u", flow[0], q.shape, at)
        if np.ndim(flow[1]) != 0 or np.asarray(flow[1]).dtype.kind not in "fiu":
            raise ArgumentError(f"{name} gives dH/dt = {format_value(flow[1])} {at}: expected a real number, or NaN")
        return flow

    def acceleration(self, t: float, q: Any, p: Any) -> FloatArray:
        """Control input u(t, q, p).

        Returns
        -------
        ndarray, shape (n, m)

        Raises
        ------
        ArgumentError
            On wrong shapes, values that are not finite, or agents at one place where their force has no limit.
        """
        t, q, p = self._checked(t, q, p)
        u = self.checked_flow(t, q, p)[0]
        if not np.isfinite(u).all():
            self.check_start(q, p)  # names the agents at which the law has no input
        return u

    def energy(self, t: float, q: Any, p: Any) -> float:
        """The law's energy H (arguments and errors as `acceleration`)."""
        return self.hamiltonian(*self._checked(t, q, p))

    def energy_rate(self, t: float, q: Any, p: Any) -> float:
        """Time derivative of `energy` along the law's flow, in closed form (arguments and errors as `acceleration`)."""
        return self.checked_flow(*self._checked(t, q, p))[1]

    def compiled(self, m: int) -> Compiled | None:
        """Return the law for compiled integrators (`flockana.dynamics.compiled_steps`); None if it has no such form."""
        return None

    def compiled_push(self, m: int) -> Compiled | None:
        """Return the law's compiled form without velocity noise; None if the law has no such form."""
        return self.compiled(m)

    def block(self, solver: Any) -> Block | None:
        """Return the law's own compiled block of solver steps, ``(times, q, p, wanted) -> (q, p, u)``.

        None unless a law has one; a block may give None where it does not serve. Arguments and results are those of
        `DiscreteLaw.visit`.

        Parameters
        ----------
        solver : FixedStep
            Method and step.
        """
        return None

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> tuple[sparray, sparray]:
        """(∂u/∂q, ∂u/∂p), sparse, in the order of ``q.ravel()``, unchecked; by differences unless overridden."""
        from scipy.sparse import csr_array

        scales = self.scales
        length = scales.length if scales else float(np.abs(q - q[0]).max()) or 1.0
        by_position = differences(lambda x: self.flow(t, x, p)[0], q, length)
        pace = float(np.sqrt(np.abs(by_position.matrix).max(initial=0.0))) or float(np.abs(p).max()) / length or 1.0
        by_velocity = differences(lambda v: self.flow(t, q, v)[0], p, scales.speed if scales else length * pace)
        spread = max(by_position.spread, by_velocity.spread)
        if spread > _SMOOTH:
            raise ArgumentError(
                f"{type(self).__name__} has a kink or a jump at this state (slopes differ by {spread:.2g} of the "
                "largest): expected a state around which its input is smooth, or a law that implements `derivatives`"
            )
        return csr_array(by_position.matrix), csr_array(by_velocity.matrix)

    def jacobian(self, t: float, q: Any, p: Any, *, sparse: bool = False) -> FloatArray | csr_array:
        """Derivative of (p, u) in the state, ordered ``(q.ravel(), p.ravel())``: [[0, I], [∂u/∂q, ∂u/∂p]].

        Parameters
        ----------
        sparse : bool
            Return a scipy.sparse.csr_array.

        Returns
        -------
        ndarray or csr_array, shape (2nm, 2nm)

        Raises
        ------
        ArgumentError
            On bad arrays, a kink or a jump of the law at this state, or a dense matrix that would not fit in memory.

        Examples
        --------
        >>> from flockana.laws.olfati_saber import Algorithm1
        >>> A = Algorithm1().jacobian(0.0, [[0.0], [7.0]], [[0.0], [0.0]])
        >>> A[:2, 2:].tolist(), bool(A[2, 0] == -A[2, 1])
        ([[1.0, 0.0], [0.0, 1.0]], True)
        """
        from scipy.sparse import block_array, csr_array, eye_array

        t, q, p = self._checked(t, q, p)
        if not sparse:
            ensure_fits("the Jacobian", (2 * q.size, 2 * q.size), "ask for sparse=True")
        by_position, by_velocity = self.derivatives(t, q, p)
        full_matrix: Any = csr_array(block_array([[None, eye_array(q.size)], [by_position, by_velocity]], format="csr"))
        return full_matrix if sparse else full_matrix.toarray()
