"""Terms of Algorithms 1 to 3 and of compositions, and the frame of their energy."""

from flockana.environment.beta import ObstacleField
from flockana.environment.target import Target
from flockana.interactions import Gains, PairInteraction
from flockana.interactions.weights import Weight
from flockana.laws.terms.alignment import AlignmentTerm
from flockana.laws.terms.along import AlongVelocity
from flockana.laws.terms.consensus import Consensus
from flockana.laws.terms.feedforward import TargetFeedforward
from flockana.laws.terms.navigation import Navigation
from flockana.laws.terms.obstacles import ObstacleTerm
from flockana.laws.terms.pairs import PairTerm
from flockana.laws.terms.term import Term


def parts(
    pair: PairInteraction | None,
    gains: Gains,
    *,
    net: PairInteraction | Weight | None = None,
    field: ObstacleField | None = None,
    target: Target | None = None,
    unit: float | None = None,
    feedforward: bool = False,
    thrust: float = 0.0,
    brake: float = 0.0,
) -> tuple[Term, ...]:
    """Return the terms of a law, in the order of addition."""
    # The energy is that of the shape, in the moving frame, where a γ-agent pulls all agents alike and linearly, and
    # nothing else ties the shape to a place (obstacles) or to a speed (β of speed control); else that in the given
    # frame.
    terms: list[Term] = []
    if pair is not None:
        terms.append(PairTerm(pair, gains.c1_alpha, gains.c2_alpha if net is None else 0.0))
    if isinstance(net, Weight):
        terms.append(AlignmentTerm(net, gains.c2_alpha))
    elif net is not None:
        terms.append(Consensus(net, gains.c2_alpha))
    if field is not None:
        terms.append(ObstacleTerm(field, gains.c1_beta, gains.c2_beta))
    moving = False
    if target is not None:
        tied = brake != 0.0 or bool(field is not None and field.obstacles)
        pull = Navigation(target, gains, unit, given=tied)
        moving = pull.moving
        terms.append(pull)
    if target is not None and feedforward:
        terms.append(TargetFeedforward(target, moving))
    if thrust != 0.0 or brake != 0.0:
        terms.append(AlongVelocity(thrust, brake, moving))
    return tuple(terms)
