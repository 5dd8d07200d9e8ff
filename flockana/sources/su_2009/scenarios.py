"""Scenarios of Su, Wang and Lin (2009): few informed agents, and a leader of varying velocity."""

from dataclasses import replace
from functools import partial
from math import pi
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.environment import CircleTarget, LinearTarget
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice.builders import hexagonal_spiral
from flockana.laws import Algorithm2, compose
from flockana.scenarios.one_start import LawEntry, follower_of
from flockana.scenarios.report_claims import ROUNDING, Claim, Tolerances, Trajectory, finding, report
from flockana.scenarios.scenario_builders import (
    Builder,
    Scenario,
    Start,
    entry,
    inconclusive,
    refuted,
    vacuous,
    verified,
)
from flockana.sources.su_2009.measures import following

_C_STAR = 523838.11786644866  # ψ_α(0) for a = b = 5e4; to compute it would load the compiler

_REFERENCES = ("su-2009", "olfati-saber-2006")
_LEADER = LinearTarget((6.0, 0.0), (1.0, 0.5))
_CIRCLE = CircleTarget((0.0, 0.0), radius=20.0, frequency=0.05)
_CONSENSUS = Gains().c2_alpha
_APART = 60.0  # distance of a group that nobody joins
_BOX, _SPEED = 100.0, 1.0  # of the survey's start


def _near_lattice(seed: int, n: int, noise: float) -> Start:
    generator = np.random.default_rng(seed)
    q = hexagonal_spiral(n, AlphaInteraction().d) + generator.uniform(-noise, noise, (n, 2))
    return q, generator.uniform(-0.3, 0.3, (n, 2))


@report("others", "an agent that is never linked to an informed agent goes its own way")
def _others_drift(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that the four isolated agents keep their mean velocity."""
    mean = run.p[:, -4:].mean(axis=1)
    change = float(np.abs(mean[-1] - mean[0]).max()) / run.scales.speed
    text = f"the mean velocity of the four agents out of reach changes by {change:.2g} of the law's speed"
    return finding(1e-6 - change, text, computed=change, stated="no change", error=ROUNDING)


def _few(seed: int = 0) -> Scenario:
    q, p = _near_lattice(seed, 7, 0.2)
    other_positions = hexagonal_spiral(4, AlphaInteraction().d) + np.array([_APART, 0.0])
    law = compose(pair=AlphaInteraction(), consensus=_CONSENSUS, navigation=_LEADER, informed=(0, 2), agents=len(q) + 4)
    title = "Two of eleven agents know the leader: those linked to them follow, the others drift on"
    source_text = (
        "Ours, on Su, Wang and Lin 2009: Algorithm 2 with default gains, seven agents near a patch of the lattice of "
        "which two feel a leader of constant velocity (1, ½), and four more out of everybody's reach."
    )
    q, p = np.vstack([q, other_positions]), np.vstack([p, np.tile([0.1, -0.2], (4, 1))])
    expected = (
        verified("su-informed:energy", "su-informed:distance", "su-informed:informed")
        | inconclusive("su-informed:linked")  # a run does not show that links last
        | verified("su-informed:pairs", "su-informed:one-instant", "su-informed:no-collision", "energy:balance")
        | vacuous("energy:rate")
        | verified("source")
    )
    # so tightly that the decay is seen through many constants
    options = {"t_eval": np.linspace(0.0, 90.0, 241), "rtol": 1e-11}
    reports, span = (_others_drift,), (0.0, 90.0)
    return Scenario("informed-few", title, source_text, law, q, p, span, seed, expected, reports, options, _REFERENCES)


def _one_informed(seed: int = 0) -> Scenario:
    """Return the scenario of erratum E13 with one informed agent, its leader at the flock's mean velocity."""
    alpha = AlphaInteraction(a=5e4, b=5e4)
    speed = float(np.sqrt(5.6 * _C_STAR))
    gains = Gains(1.0, 1.0, 0.0, 0.0, (0.01, 0.0, 0.0), (0.01, 0.0, 0.0))
    title = "One agent runs through two others: two pairs collide, with the energy of one"
    source = (
        "Ours, on Su, Wang and Lin 2009 and erratum E13: the start of E13 on a line; of three agents the fast one is "
        "informed, and the leader moves at a third of its speed."
    )
    law = Algorithm2(alpha, gains, LinearTarget((0.0,), (speed / 3.0,)))
    q, p = np.array([[-12.0], [0.0], [30.0]]), np.array([[speed], [0.0], [0.0]])
    expected = refuted("su-informed", "su-informed:pairs") | vacuous("su-informed:no-collision")
    expected |= verified("su-informed:one-instant", "su-informed:energy", "su-informed:distance")
    return Scenario("informed-through", title, source, law, q, p, (0.0, 0.03), seed, expected, references=_REFERENCES)


@report("lag", "the centre of mass does not come to the leader")
def _lag(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Compare the centre's lag behind a circling leader with |a_r|/|c1 − ω² + iωc2|."""
    gains, path = run.law.gains, run.law.target
    omega = 2.0 * pi * path.frequency
    lag = path.radius * omega**2 / abs(gains.c1_gamma - omega**2 + 1j * omega * gains.c2_gamma)
    distance = float(np.linalg.norm(run.q[-1].mean(axis=0) - path.position(float(run.t[-1]))))
    deviation = abs(distance / lag - 1.0)
    detail = f"the centre of mass ends {distance:.6g} from the leader, where the transfer function says {lag:.6g}"
    return finding(1e-6 - deviation, detail, computed=distance, stated=lag, error=ROUNDING)


def _varying(name: str, title: str, *, feedforward: bool) -> Builder:
    expected = verified("energy", "cohesion")
    law: Any = Algorithm2(target=_CIRCLE)
    remark = "; its acceleration is not told."
    if feedforward:
        expected |= verified("su-varying", "su-varying:centre", "su-varying:velocities", "su-varying:distance")
        expected |= verified("collision-energy:below")
        law = compose(pair=AlphaInteraction(), consensus=_CONSENSUS, navigation=_CIRCLE, feedforward=True)
        remark = " and are told its acceleration."
    else:
        expected |= vacuous("su-varying") | verified("source")
    source_text = (
        "Ours, on Su, Wang and Lin 2009: twelve agents near a lattice, all of which feel a leader on a circle of "
        f"radius 20{remark}"
    )
    draw, reports = partial(_near_lattice, n=12, noise=0.2), () if feedforward else (_lag,)
    return entry(name, title, source_text, law, draw, 40.0, expected, reports, references=_REFERENCES)


@report("informed-follow", "all informed agents adopt the leader's velocity")
def _some_follow(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that all informed agents follow the leader's velocity at the end."""
    is_informed = np.asarray(run.law.gains.c1_gamma) > 0.0
    count, of = int(following(run)[is_informed].sum()), int(is_informed.sum())
    text = (
        f"{count} of {of} informed agents, and {int(following(run).sum())} of {run.n} in all, move as the leader does"
    )
    return finding(count - of + 0.5, text, computed=count, stated=of)


@report("most-follow", "more than half of all agents follow")
def _most_follow(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that more than half of all agents follow the leader's velocity at the end."""
    count = int(following(run).sum())
    text = f"{count} of {run.n} agents move as the leader does"
    return finding(count - run.n // 2 - 0.5, text, computed=count, stated=f"more than {run.n // 2}")


def informed_survey(seed: int = 0, *, informed: int = 12, n: int = 60) -> Scenario:
    """Return n agents in a square, the first few informed of a leader with constant velocity."""
    if not 1 <= informed <= n:
        raise ArgumentError(f"informed = {informed}: expected 1 to {n}, the number of agents")
    generator, informed_agents = np.random.default_rng(seed), range(informed)
    law = compose(pair=AlphaInteraction(), consensus=_CONSENSUS, navigation=_LEADER, informed=informed_agents, agents=n)
    title = f"{informed} of {n} agents, spread over a square, know the leader: how many follow?"
    source_text = (
        "Su, Wang and Lin 2009 say that few informed agents lead most of a flock, and that more of them lead a "
        f"larger share. Ours: n = {n}, q uniform in a square of side {_BOX:g}, p uniform in [-1, 1]², leader from (6, "
        "0) at (1, ½), 80 time units; an option of the scenario says how many are informed."
    )
    q, p = generator.uniform(-0.5 * _BOX, 0.5 * _BOX, (n, 2)), generator.uniform(-_SPEED, _SPEED, (n, 2))
    expected = verified("su-informed:energy", "su-informed:distance")
    more: dict[str, Any] = {"references": _REFERENCES, "shipped": verified("source")}
    more["options"] = {"t_eval": np.linspace(0.0, 80.0, 81)}
    reports = (_some_follow, _most_follow)
    return Scenario("informed-survey", title, source_text, law, q, p, (0.0, 80.0), seed, expected, reports, **more)


_KNOWN = "A circling leader whose acceleration all agents know: the centre of mass converges to it"
_UNKNOWN = "A circling leader whose acceleration nobody knows: Algorithm 2 lags behind"
SCENARIOS: dict[str, Builder] = {
    "informed-few": _few,
    "informed-survey": informed_survey,
    "informed-through": _one_informed,
    "leader-known": _varying("leader-known", _KNOWN, feedforward=True),
    "leader-unknown": _varying("leader-unknown", _UNKNOWN, feedforward=False),
}


def _informing(some: int, n: int) -> Gains:
    """Return the default gains, with c1γ and c2γ zero except for the first agents."""
    gains, is_informed = Gains(), np.arange(n) < some
    return replace(gains, c1_gamma=tuple(gains.c1_gamma * is_informed), c2_gamma=tuple(gains.c2_gamma * is_informed))


ONE_START = (
    LawEntry(
        "Few informed",
        lambda q, p: Algorithm2(gains=_informing(3, len(q)), target=follower_of(q, p)),
        "su-informed",
        "three of ten feel the γ-agent: they adopt its velocity, and so do agents that stay linked to them",
    ),
)
