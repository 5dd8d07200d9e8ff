"""Laws that `enclose` supports, as right-hand sides in balls."""

from math import sqrt
from typing import Any, cast

from flint import arb

from flockana.base.errors import ArgumentError
from flockana.certified.agent_terms import AgentTerm, Pull
from flockana.certified.balls import exact
from flockana.certified.flow import Flow
from flockana.certified.obstacle_terms import SphereTerm
from flockana.certified.series import PairNumbers
from flockana.environment.obstacles import Sphere
from flockana.environment.targets import LinearTarget, StaticTarget
from flockana.interactions import AlphaInteraction
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm1, Algorithm2, ensure_one_gain

_LED = (Algorithm2, Algorithm3)


def ensure_enclosable(law: Any) -> None:
    """Raise unless `enclose` supports a law."""
    if type(law) not in (Algorithm1, *_LED) or type(law.alpha) is not AlphaInteraction:
        raise ArgumentError(f"law = {law!r}: expected Algorithm1, 2 or 3 with AlphaInteraction, unwrapped")
    if isinstance(law, _LED):
        ensure_one_gain(law.gains)
        if type(law.target) not in (StaticTarget, LinearTarget):
            raise ArgumentError(
                f"target = {law.target!r}: expected StaticTarget or LinearTarget, whose path is exact; under "
                "Algorithm 2 the shape moves alike with every target"
            )
    if isinstance(law, Algorithm3):
        for k, obstacle in enumerate(law.obstacles):
            if type(obstacle) is not Sphere:
                raise ArgumentError(f"obstacles[{k}] = {obstacle!r}: expected a Sphere, the one kind known in balls")


def flow_of(law: Any, n: int, m: int) -> Flow:
    """Return a law for n agents in m dimensions in balls, each number as its exact decimal."""
    gains: Any = law.gains
    terms: tuple[AgentTerm, ...] = ()
    rates = [gains.c2_alpha * min(n, 6), sqrt(gains.c1_alpha * n)]
    if isinstance(law, _LED):
        path = cast(Any, law).target.harmonic.terms
        unit = arb(exact(cast(Any, law).alpha.unit)) if isinstance(law, Algorithm3) else None
        start, velocity, offset = (tuple(arb(exact(x)) for x in path[k].tolist()) for k in (0, 1, 4))
        declared = tuple(a + b for a, b in zip(velocity, offset, strict=True))  # p_r = dq_r/dt + offset
        terms = (Pull(start, velocity, declared, arb(exact(gains.c1_gamma)), arb(exact(gains.c2_gamma)), unit),)
        rates += [gains.c2_gamma, sqrt(gains.c1_gamma)]
    if isinstance(law, Algorithm3) and law.obstacles:
        terms = (*terms, *sphere_terms(law))
        rates += [gains.c2_beta, sqrt(gains.c1_beta)]
    stiffness, damping = arb(exact(gains.c1_alpha)), arb(exact(gains.c2_alpha))
    return Flow(n, m, PairNumbers.of_alpha(law.alpha), stiffness, damping, max(rates) or 1.0, terms)


def sphere_terms(law: Algorithm3) -> tuple[SphereTerm, ...]:
    """Return the terms of a law's obstacles at the present precision."""
    gains: Any = law.gains
    beta, pull, drag = PairNumbers.of_beta(law.beta), arb(exact(gains.c1_beta)), arb(exact(gains.c2_beta))
    spheres = [cast(Sphere, obstacle) for obstacle in law.obstacles]
    places = [(tuple(arb(exact(y)) for y in sphere.centre), arb(exact(sphere.radius))) for sphere in spheres]
    return tuple(SphereTerm(beta, centre, radius, pull, drag) for centre, radius in places)
