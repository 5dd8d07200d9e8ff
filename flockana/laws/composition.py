"""Laws composed of chosen terms: gradient, consensus, γ-feedback, β-agents, drag and speed control."""

import inspect
from collections.abc import Iterable, Mapping
from dataclasses import KW_ONLY, dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base import value_checks
from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import normalise
from flockana.environment.beta_agents import ObstacleField
from flockana.environment.obstacles import Obstacle
from flockana.environment.target import Target
from flockana.interactions import BetaInteraction, Gains, PairInteraction
from flockana.interactions.gains import GainsField
from flockana.interactions.weights import Weight
from flockana.laws.algorithm3 import Algorithm3, ensure_obstacles
from flockana.laws.gain_laws import PAIR, TARGET, GainedLaw, alpha_scales, ensure_gains
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.laws.terms.alignment import AlignmentTerm
from flockana.laws.terms.along_velocity import AlongVelocity
from flockana.laws.terms.consensus import Consensus
from flockana.laws.terms.feedforward import TargetFeedforward
from flockana.laws.terms.navigation import Navigation
from flockana.laws.terms.obstacles import ObstacleTerm, ensure_one_dimension
from flockana.laws.terms.pairs import PairTerm
from flockana.laws.terms.term import Term
from flockana.measures.centre_frame import moving_frame

_PARTS = ("pair", "consensus", "navigation", "obstacles", "drag", "speed")
_NO_GAIN = Gains(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Composition(GainedLaw):
    """Law built by `compose`; an absent term is None, empty or has gain 0.

    u_i = c1α Σ_j φ n_ij + c2α Σ_j a_ij (p_j − p_i) + β-agents + γ-feedback + feedforward d²q_r/dt² + (α − β‖p_i‖²) p_i.

    Parameters
    ----------
    alpha : PairInteraction, optional
        Whose gradient acts between agents.
    gains : Gains or mapping of str to float
        Gains of all terms but the last.
    net : PairInteraction or Weight, optional
        Range and adjacency of the consensus, if they are not those of `alpha`, or any weight of the distance.
    unit : float, optional
        ℓ of a bounded pull −c1γ ℓ σ₁((q_i − q_r)/ℓ); None for the linear one.
    feedforward : bool
        Whether every agent is told the γ-agent's acceleration.
    obstacles : sequence of Obstacle
        What agents keep off.
    beta : BetaInteraction
        How they do.
    thrust, brake : float
        α, negative for a drag, and β >= 0.

    Raises
    ------
    ArgumentError
        On a part of another kind, parts of different dimensions, or a number out of range.

    Examples
    --------
    >>> law = Composition(target=None, thrust=-0.5)
    >>> law.acceleration(0.0, [[0.0]], [[2.0]]).tolist(), law.energy_rate(0.0, [[0.0]], [[2.0]])
    ([[-1.0]], -2.0)
    """

    alpha: PairInteraction | None = None
    gains: GainsField = _NO_GAIN  # type: ignore[assignment]
    _: KW_ONLY
    net: PairInteraction | Weight | None = None
    target: Target | None = None
    unit: float | None = None
    feedforward: bool = False
    obstacles: tuple[Obstacle, ...] = ()
    beta: BetaInteraction = field(default_factory=BetaInteraction)
    thrust: float = 0.0
    brake: float = 0.0

    units: ClassVar[Mapping[str, Powers]] = {"unit": (1, 0), "thrust": (0, -1), "brake": (-2, 1)}

    def __post_init__(self) -> None:
        none_type = type(None)
        value_checks.ensure_kind("alpha", self.alpha, (PairInteraction, none_type), PAIR)
        value_checks.ensure_kind("net", self.net, (PairInteraction, Weight, none_type), PAIR)
        value_checks.ensure_kind("target", self.target, (Target, none_type), TARGET)
        ensure_gains(self)
        value_checks.ensure_kind("beta", self.beta, BetaInteraction, "BetaInteraction(...)")
        object.__setattr__(self, "obstacles", ensure_obstacles(self.obstacles))
        if self.unit is not None:
            normalise(self, value_checks.ensure_positive, "unit")
        normalise(self, value_checks.ensure_finite_scalar, "thrust")
        normalise(self, value_checks.ensure_nonnegative, "brake")
        if self.target is not None:
            ensure_one_dimension(self.obstacles, self.target.dimension, "the target has")
        elif self.obstacles:
            ensure_one_dimension(self.obstacles, self.obstacles[0].dimension, "obstacles[0] has")
        normalise(self, value_checks.ensure_flag, "feedforward")
        if self.feedforward and (self.target is None or self.target.closed_path is None):
            raise ArgumentError(
                f"feedforward = True, target = {self.target!r}: expected a γ-agent of known acceleration, such as "
                "SineTarget(...) or CircleTarget(...)"
            )
        if not self.terms:
            raise ArgumentError(f"the law has no term: expected at least one of {', '.join(_PARTS)}")

    @property
    def scales(self) -> Scales | None:  # type: ignore[override]
        """Length and time scales of the pair law or consensus net; the time of drag or thrust if no gain gives one."""
        law = self.alpha or self.net
        if law is None or isinstance(law, Weight):
            return None
        law_scales = alpha_scales(
            law, self.gains if self.alpha else Gains(0.0, self.gains.c2_alpha, 0.0, 0.0, *self._pull)
        )
        is_used = any(np.max(gain) > 0.0 for gain in (self.gains.c1_alpha, self.gains.c2_alpha, *self._pull))
        return Scales(law_scales.length, 1.0 / abs(self.thrust)) if not is_used and self.thrust else law_scales

    @property
    def _pull(self) -> tuple[Any, Any]:
        return self.gains.c1_gamma, self.gains.c2_gamma

    @property
    def lattice(self) -> tuple[float, float] | None:  # noqa: D102
        return None if self.alpha is None or self.pair is None else self.pair.lattice

    @property
    def surfaces(self) -> tuple[float | tuple[float, ...], ...]:  # noqa: D102
        edges = {x for pair in (self.alpha, self.net) if isinstance(pair, PairInteraction) for x in pair.surfaces}
        edges |= {self.net.range} if isinstance(self.net, Weight) else set()
        return tuple(sorted(x for x in edges if np.isfinite(x)))

    @cached_property
    def obstacle_field(self) -> ObstacleField | None:
        """The obstacles with their interaction, None without obstacles."""
        return ObstacleField(self.obstacles, self.beta) if self.obstacles else None

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """Terms with the energy c1α V + c1β ΣΣ ψ_β + the γ-agent's and the kinetic energy."""
        # The energy is that of the shape, in the moving frame, where a γ-agent pulls all agents alike and linearly, and
        # nothing else ties the shape to a place (obstacles) or to a speed (β of speed control); else that in the given
        # frame.
        gains, net, is_tied = self.gains, self.net, bool(self.obstacles) or self.brake != 0.0
        pull = None if self.target is None else Navigation(self.target, gains, self.unit, given=is_tied)
        moving = pull is not None and pull.moving
        terms: list[Term] = []
        if self.alpha is not None:
            terms.append(PairTerm(self.alpha, gains.c1_alpha, gains.c2_alpha if net is None else 0.0))
        if net is not None:
            term = AlignmentTerm(net, gains.c2_alpha) if isinstance(net, Weight) else Consensus(net, gains.c2_alpha)
            terms.append(term)
        if self.obstacle_field is not None:
            terms.append(ObstacleTerm(self.obstacle_field, gains.c1_beta, gains.c2_beta))
        if pull is not None:
            terms.append(pull)
        if pull is not None and self.feedforward:
            terms.append(TargetFeedforward(pull.target, moving))
        if self.thrust or self.brake:
            terms.append(AlongVelocity(self.thrust, self.brake, moving))
        return tuple(terms)

    def structural_energy(self, q: Any, p: Any) -> float:
        """Return the energy that never rises without energy sources; in the moving frame unless the position is fixed.

        Parameters
        ----------
        q, p : array_like, shape (n, m)
            Positions and velocities in any frame; a γ-agent that holds the flock in the given frame is at rest.
        """
        q, p = value_checks.ensure_state(q, p)
        is_free = self.target is None and not self.obstacles and self.brake == 0.0
        return self.hamiltonian(0.0, q, moving_frame(p) if is_free else p)


def compose(
    *,
    pair: PairInteraction | None = None,
    gradient: float | None = None,
    consensus: float | Weight | None = None,
    net: PairInteraction | Weight | None = None,
    navigation: Target | None = None,
    pull: Any = None,
    match: Any = None,
    informed: Iterable[int] | None = None,
    agents: int | None = None,
    bounded: bool | float = False,
    feedforward: bool = False,
    obstacles: Iterable[Obstacle] = (),
    repulsion: float | None = None,
    braking: float | None = None,
    beta: BetaInteraction | None = None,
    drag: float | None = None,
    speed: tuple[float, float] | None = None,
    **unknown: Any,
) -> Algorithm1 | Algorithm2 | Algorithm3 | Composition:
    """Build a law from its terms, given by parts and gains; missing gains are the defaults of `Gains`.

    Parameters
    ----------
    pair : PairInteraction, optional
        A gradient c1 Σ_j φ n_ij between agents.
    gradient : float, optional
        c1 of the pair, 1/time².
    consensus : float or Weight, optional
        c2 of the velocity consensus c2 Σ_j a_ij (p_j − p_i), 1/time; none by default. Or a weight a(s) of the distance,
        near or far, such as `flockana.RationalWeight`, which is the net too, with c2 = 1.
    net : PairInteraction or Weight, optional
        Whose range and adjacency the consensus has, those of the pair by default; or a weight of the distance.
    navigation : Target, optional
        A γ-agent.
    pull, match : float or array_like, shape (n,), optional
        c1 (1/time²) and c2 (1/time) of the feedback −c1 (q_i − q_r) − c2 (p_i − p_r), one each or per agent.
    informed : sequence of int, optional
        The agents that feel the γ-agent; all by default.
    agents : int, optional
        How many there are, needed with `informed`.
    bounded : bool or float
        A pull −c1 ℓ σ₁((q_i − q_r)/ℓ) instead, as under Algorithm 3: ℓ, or True for that of the pair.
    feedforward : bool
        Whether all agents are told the γ-agent's acceleration.
    obstacles : sequence of Obstacle
        What agents keep off by β-agents.
    repulsion, braking : float, optional
        c1 and c2 of the obstacles.
    beta : BetaInteraction, optional
        The law between an agent and its β-agents.
    drag : float, optional
        c of −c p_i, 1/time.
    speed : (float, float), optional
        α and β of (α − β‖p_i‖²) p_i, which holds agents at the speed √(α/β).
    **unknown
        Any other name is an error.

    Returns
    -------
    Algorithm1, Algorithm2, Algorithm3 or Composition
        Algorithm 1, 2 or 3 itself where the terms are its own: then every theorem about it applies too.

    Raises
    ------
    ArgumentError
        On an unknown part, a gain without its part, dimensions that differ, or informed agents that there are not.

    Examples
    --------
    >>> from flockana.environment.targets import LinearTarget
    >>> from flockana.interactions import AlphaInteraction
    >>> compose(pair=AlphaInteraction(), consensus=2.0 * 30.0**0.5) == Algorithm1()
    True
    >>> leader = LinearTarget((0.0, 0.0), (1.0, 0.0))
    >>> law = compose(pair=AlphaInteraction(), consensus=2.0, navigation=leader, informed=(0, 2), agents=3, drag=0.1)
    >>> law.gains.c1_gamma, law.thrust
    ((1.1, 0.0, 1.1), -0.1)
    """
    for name in unknown:
        raise UnknownNameError("part of a law", name, {*inspect.signature(compose).parameters} - {"unknown"})
    if isinstance(consensus, Weight):
        if net is not None:
            raise ArgumentError(f"net = {net!r} beside consensus = {consensus!r}: expected one of the two weights")
        net, consensus = consensus, 1.0
    obstacles, feedforward = ensure_obstacles(obstacles), value_checks.ensure_flag("feedforward", feedforward)
    _ensure_parts("pair", pair, gradient=gradient)
    _ensure_parts("consensus", consensus, net=net)
    _ensure_parts(
        "navigation", navigation, pull=pull, match=match, informed=informed, bounded=bounded, feedforward=feedforward
    )
    _ensure_parts("informed", informed, agents=agents)
    _ensure_parts("obstacles", obstacles or None, repulsion=repulsion, braking=braking, beta=beta)
    if consensus is not None and pair is None and net is None:
        raise ArgumentError(f"consensus = {consensus!r} without a net: give net=AlphaInteraction(...), or a pair")
    parts = {
        "c1_alpha": (pair, gradient),
        "c2_alpha": (net if pair is None else pair, consensus if consensus is not None else 0.0),
        "c1_beta": (obstacles or None, repulsion),
        "c2_beta": (obstacles or None, braking),
        "c1_gamma": (navigation, pull),
        "c2_gamma": (navigation, match),
    }
    powers = {
        name: _of_informed(gain, name, informed, agents) for name, (part, gain) in parts.items() if part is not None
    }
    unit = _bounding_length(bounded, pair)
    thrust, brake = _along(drag, speed)
    plain = net is None and pair is not None and not (feedforward or thrust or brake)
    if plain and navigation is None and not obstacles:
        return Algorithm1(pair, Gains(**powers))  # type: ignore[arg-type]  # validated there
    if plain and navigation is not None and not obstacles and unit is None:
        return Algorithm2(pair, Gains(**powers), navigation)  # type: ignore[arg-type]
    beta = BetaInteraction() if beta is None else beta
    if plain and navigation is not None and pair is not None and unit == pair.bend_length:
        return Algorithm3(pair, Gains(**powers), navigation, beta, obstacles)
    gains = Gains(**(dict.fromkeys(parts, 0.0) | powers))
    rest = {"feedforward": feedforward, "obstacles": obstacles, "beta": beta, "thrust": thrust, "brake": brake}
    return Composition(pair, gains, net=net, target=navigation, unit=unit, **rest)  # type: ignore[arg-type]


def _ensure_parts(part: str, value: Any, **belonging: Any) -> None:
    """Raise if a gain or option is given without the part of the law to which it belongs."""
    for name, gain in belonging.items():
        if value is None and gain is not None and gain is not False:
            raise ArgumentError(f"{name} = {gain!r} without its part: give {part}=..., or leave {name} out")


def _of_informed(gain: Any, name: str, informed: Iterable[int] | None, agents: int | None) -> Any:
    """Return the gain agent by agent: `gain` for informed agents, 0 for the others."""
    gain = getattr(Gains(), name) if gain is None else gain
    if informed is None or not name.endswith("gamma"):
        return gain
    if agents is None:
        raise ArgumentError(f"informed = {informed!r} without agents: give agents=..., their total number")
    n = value_checks.ensure_count("agents", agents)
    members = {value_checks.ensure_index("informed has", i, n) for i in informed}
    checked_gain = value_checks.ensure_nonnegative("pull" if name.startswith("c1") else "match", gain)
    return tuple(checked_gain if i in members else 0.0 for i in range(n))


def _bounding_length(bounded: bool | float, pair: PairInteraction | None) -> float | None:
    """Return the length ℓ of a bounded pull; None for the linear one."""
    if bounded is False:
        return None
    if bounded is True:
        if pair is None:
            raise ArgumentError("bounded = True without a pair: give the length at which the pull saturates")
        return pair.bend_length
    return value_checks.ensure_positive("bounded", bounded)


def _along(drag: float | None, speed: tuple[float, float] | None) -> tuple[float, float]:
    """Return the coefficients (α − c, β) of drag and speed control along the velocity."""
    thrust_gain, brake_gain = 0.0, 0.0
    if speed is not None:
        if not isinstance(speed, tuple | list) or len(speed) != 2:
            raise ArgumentError(f"speed = {speed!r}: expected (α, β), as in (1.0, 0.25) for a speed of 2")
        thrust_gain, brake_gain = (value_checks.ensure_positive(f"speed[{k}]", value) for k, value in enumerate(speed))
    return thrust_gain - (0.0 if drag is None else value_checks.ensure_nonnegative("drag", drag)), brake_gain
