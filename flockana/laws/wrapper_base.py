"""Base classes of laws that wrap a law, and the step data for them."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator
from typing import Any, ClassVar, NamedTuple

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.value_checks import FloatArray, ensure_kind, ensure_seed, normalise
from flockana.laws.first_order_law import VelocityLaw, first_order
from flockana.laws.law import Law
from flockana.laws.terms.pairs import PairTerm

_BLOCK = 256  # steps whose random numbers are drawn at once
_CHANNELS = 8  # kinds of random numbers
Past = Callable[[float], tuple[FloatArray, FloatArray]]


class View(NamedTuple):
    """States that agents know when they compute their inputs."""

    t: float  # Time that they take it to be
    q: FloatArray  # q, p: Their own positions and velocities; under a law of first order p holds their positions
    p: FloatArray
    # Positions and velocities of the others, in the last two axes; shape (n, n, m), by listener and speaker, or (1, n,
    # m) if all hear the same. By default `q` and `p`.
    heard: tuple[FloatArray, FloatArray] | None = None
    linked: Any = None  # Whether a listener hears a speaker; all by default
    both: bool = False  # In the terms between agents their own state is that which is heard too


class Step:
    """Step in which a wrapped law is evaluated: number, length, past, random numbers, held inputs.

    Parameters
    ----------
    number : int
        Of the step, from 0 at the start of the run.
    h : float
        Length.
    past : callable
        (q, p) at an earlier time.
    held : dict
        Inputs held, by the wrapper that holds them.

    Attributes
    ----------
    begins : bool
        Whether it is at its beginning: then held inputs are renewed.
    interval : float
        Time from one reading of the sensors to the next.
    """

    __slots__ = ("_drawn", "begins", "h", "held", "interval", "number", "past")

    def __init__(self, number: int, h: float, past: Past, held: dict[int, FloatArray] | None = None) -> None:
        self.number, self.h, self.past = number, h, past
        self.held: dict[int, FloatArray] = {} if held is None else held
        self.begins, self.interval = True, h
        self._drawn: dict[tuple[int, int], tuple[int, FloatArray]] = {}

    def normal(self, seed: int, channel: int, shape: tuple[int, ...]) -> FloatArray:
        """Return independent standard normal numbers of this step, determined by seed, channel and step.

        Parameters
        ----------
        channel : int
            Kind of number.
        shape : tuple of int
            Of the array.
        """
        block, row = divmod(self.number, _BLOCK)
        draws = self._drawn.get((seed, channel))
        if draws is None or draws[0] != block:
            draws = self._drawn[(seed, channel)] = block, _normal_block(seed, channel, block, shape)
        return draws[1][row]


def _normal_block(seed: int, channel: int, block: int, shape: tuple[int, ...]) -> FloatArray:
    generator = np.random.Generator(np.random.Philox(key=seed * _CHANNELS + channel, counter=[0, 0, 0, block]))
    return generator.standard_normal((_BLOCK, *shape))


def normal_numbers(seed: int, channel: int, shape: tuple[int, ...], first: int, count: int) -> FloatArray:
    """Return the standard normal random numbers of `count` steps from step `first` on, stacked."""
    blocks = range(first // _BLOCK, (first + count - 1) // _BLOCK + 1)
    normal_samples = np.concatenate([_normal_block(seed, channel, block, shape) for block in blocks])
    return normal_samples[first % _BLOCK :][:count]


class HearingLaw(Law):
    """Law whose input uses only differences to neighbours' states as received by each agent."""

    @abstractmethod
    def heard_input(
        self, own: tuple[FloatArray, FloatArray], heard: tuple[FloatArray, FloatArray], linked: Any
    ) -> FloatArray:
        """Return accelerations from each agent's own and received positions and velocities, unchecked.

        Parameters
        ----------
        own : (ndarray, ndarray), shape (n, m)
            Positions and velocities.
        heard : (ndarray, ndarray), shape (n, n, m) or (1, n, m)
            Positions and velocities of others, by listener and speaker.
        linked : bool array, shape (n, n), or None
            Whether a listener hears a speaker; None where all are heard.
        """


class WrappingLaw(Law):
    """Law around another one, `law`, with the same target, obstacles, scales and energy."""

    law: Any  # Law; or VelocityLaw, where a wrapper takes it

    @property
    def references(self) -> tuple[str, ...]:  # type: ignore[override]  # those of the law
        """Keys of the wrapped law's bibliography."""
        return self.law.references

    @property
    def scales(self) -> Scales | None:  # noqa: D102
        return self.law.scales

    @property
    def surfaces(self) -> tuple[float | tuple[float, ...], ...]:  # noqa: D102
        return self.law.surfaces

    def switches(self, start: float, stop: float) -> FloatArray:
        """Return the switching times of the wrapped law within a time span.

        Parameters
        ----------
        start, stop : float
            Ends of the span.
        """
        return self.law.switches(start, stop)

    def check_dimension(self, m: int) -> None:  # noqa: D102
        self.law.check_dimension(m)

    def check_agents(self, n: int) -> None:  # noqa: D102
        self.law.check_agents(n)

    def check_start(self, q: FloatArray, p: FloatArray) -> None:  # noqa: D102
        super().check_start(q, p)
        self.law.check_start(q, p)


class Wrapper(WrappingLaw):
    """Law with one imperfection of the control loop added; wraps any law, including wrappers.

    A subclass is a frozen dataclass with the field `law` and `input`, which asks the law that it wraps. `stepped` says
    whether it can be integrated by fixed steps only, because it has a past, a clock or chance.
    """

    stepped: ClassVar[bool] = True
    takes_first_order: ClassVar[bool] = False  # whether the law may be a `VelocityLaw`, or wrap one

    def __post_init__(self) -> None:
        if not self.takes_first_order or not isinstance(self.law, VelocityLaw):
            known_kind = Law if self.takes_first_order or first_order(self.law) is None else ()
            wanted_text = "a continuous law of second order such as Algorithm1(), or one that wraps a law"
            ensure_kind("law", self.law, known_kind, wanted_text)
        if "seed" in vars(self):  # times the channels it is part of a key, and files hold 64 bits
            normalise(self, lambda _, seed: ensure_seed(seed, 62), "seed")

    @abstractmethod
    def input(self, step: Step, view: View) -> FloatArray:
        """Return accelerations from the agents' known states, shape (n, m), unchecked.

        Parameters
        ----------
        step : Step
            In which it is asked.
        view : View
            What agents know.
        """

    def kick(self, step: Step, shape: tuple[int, ...]) -> FloatArray | None:
        """Change of the velocities by white noise in this step; None without noise.

        Parameters
        ----------
        step : Step
            The step.
        shape : (int, int)
            (n, m).
        """
        return None

    @property
    def noisy(self) -> bool:
        """Whether the law draws random numbers at each step."""
        return hasattr(self, "seed") and self.stepped

    @property
    def moving(self) -> bool:
        """Whether the law's energy is measured in the frame of the centre of mass."""
        return bool(getattr(self.law, "moving", False))

    @property
    def memory(self) -> float:
        """Longest time into the past from which the law uses states, its greatest delay; 0 without delay."""
        return 0.0

    @property
    def clocks(self) -> tuple[float, ...]:
        """Periods of the law, such as a sampling period, that must be whole multiples of the time step."""
        return ()

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        raise ArgumentError(
            f"{type(self).__name__} has no input at an instant: expected a run in fixed steps, simulate(law, ..., "
            "dt=0.01), or the law that it wraps"
        )

    @property
    def wrappers(self) -> Iterator[Wrapper]:
        """Wrappers of the law, outermost first."""
        yield self
        if isinstance(self.law, Wrapper):
            yield from self.law.wrappers

    @property
    def core(self) -> Any:
        """Innermost law, without wrappers."""
        return self.law.core if isinstance(self.law, Wrapper) else self.law

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:  # noqa: D102
        return self.law.hamiltonian(t, q, p)  # of the law; its balance is not kept

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Any) -> Any:  # noqa: D102
        return self.law.measures(t, q, p, extra)


def needs_steps(law: Any) -> bool:
    """Return whether a law requires fixed steps."""
    return isinstance(law, Wrapper) and any(wrapper.stepped for wrapper in law.wrappers)


def wrappers_within(law: Any) -> tuple[Wrapper, ...]:
    """Return the wrappers of a law, the outermost first; empty without any."""
    return tuple(law.wrappers) if isinstance(law, Wrapper) else ()


def wrappers_of(law: Any) -> tuple[Wrapper, ...]:
    """Wrappers of a law, or of the law that a map steps; empty without any."""
    return wrappers_within(law.continuous)


def input_of(law: Law | VelocityLaw, step: Step, view: View) -> FloatArray:
    """Return the accelerations of a law, wrapped or not, in a step, from the agents' information.

    Of a law of first order these are velocities: x' = v(t, x) is stepped in the place of p' = u, with x in `view.p`.
    """
    if isinstance(law, VelocityLaw):
        return law.velocity(view.t, view.p)
    if isinstance(law, Wrapper):
        return law.input(step, view)
    if view.heard is None and view.linked is None:
        return law.flow(view.t, view.q, view.p)[0]
    return _heard_input(law, view)


def _heard_input(law: Law, view: View) -> FloatArray:
    """Return the input of a law that is a sum of terms, with pair terms evaluated on received states."""
    u, n = np.zeros_like(view.q), len(view.q)
    heard = (view.q[None], view.p[None]) if view.heard is None else view.heard
    if isinstance(law, HearingLaw):
        return law.heard_input(_own(view, heard), heard, view.linked)
    if not _has_pairs(law):
        return _input_of_each(law, view, heard)
    for term in law.terms:
        if not isinstance(term, PairTerm):
            term.act(view.t, view.q, view.p, u)
        elif view.both and view.linked is None and len(heard[0]) == 1:
            term.act(view.t, np.ascontiguousarray(heard[0][0]), np.ascontiguousarray(heard[1][0]), u)
        else:
            own_input = _own(view, heard)
            away = heard[0] - own_input[0][:, None]
            in_range = np.einsum("ijk,ijk->ij", away, away) < term.pair.range**2
            in_range &= ~np.eye(n, dtype=bool)
            i, j = np.nonzero(in_range if view.linked is None else in_range & view.linked)
            if not i.size:
                continue
            slip = np.broadcast_to(heard[1] - own_input[1][:, None], (n, n, u.shape[1]))[i, j]
            weight, adjacency = _pair_weights(term, own_input[0][i], away[i, j])
            force = term.stiffness * weight[:, None] * away[i, j] + term.damping * adjacency[:, None] * slip
            np.add.at(u, i, force)
    return u


def _has_pairs(law: Any) -> bool:
    return any(isinstance(term, PairTerm) for term in law.terms)


def _input_of_each(law: Law, view: View, heard: tuple[FloatArray, FloatArray]) -> FloatArray:
    """Return the input of any law, evaluated agent by agent from own states and others' states as received."""
    n, u = len(view.q), np.empty_like(view.q)
    q, p = (np.broadcast_to(part, (n, *view.q.shape)) for part in heard)
    for i in range(n):
        is_self = np.arange(n)[:, None] == i
        u[i] = law.flow(view.t, np.where(is_self, view.q, q[i]), np.where(is_self, view.p, p[i]))[0][i]
    return u


def _own(view: View, heard: tuple[FloatArray, FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return each agent's own position and velocity, as used in its differences to received states."""
    if not view.both:
        return view.q, view.p
    n = len(view.q)
    agents = np.arange(n)
    return tuple(np.broadcast_to(part, (n, *part.shape[1:]))[agents, agents] for part in heard)  # type: ignore[return-value]


def _pair_weights(term: PairTerm, here: FloatArray, away: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the factor of q_j − q_i in the pair force, and the weight a_ij, at given position differences."""
    index = np.arange(len(here))
    weight, adjacency, _ = term.pair.kernels.terms(
        np.vstack([here, here + away]), index, len(index) + index, term.pair.par
    )
    return weight, adjacency


def ensure_hears(law: Law | VelocityLaw) -> None:
    """Raise unless the law's pair terms are known, so that received states can be used in these terms alone."""
    core = law.core if isinstance(law, Wrapper) else law
    if not isinstance(core, HearingLaw) and not _has_pairs(core):
        raise ArgumentError(
            "expected a sum of terms with a pair term, such as Algorithm1(), or NetConsensus(...), in which the states "
            f"of others are apart from an agent's own: got {type(core).__name__}; "
            'late="all" or "neighbours" and of="all" take any law'
        )
