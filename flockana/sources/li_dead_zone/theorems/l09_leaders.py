"""Erratum L9: leaders and pinned agents, present in the text and missing in (9)."""

from functools import lru_cache
from typing import Any

import numpy as np

from flockana.environment.targets import CircleTarget, LinearTarget
from flockana.lattice import hexagonal_patch
from flockana.solvers.semi_implicit_euler import SemiImplicitEuler
from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.sources.li_dead_zone.laws.with_leaders import LedDeadZoneFlocking
from flockana.sources.li_dead_zone.theorems.net_components import components_of
from flockana.theorems.claims import by_count, equal, erratum, of_map
from flockana.theorems.theorem_toolkit import Claim, FloatArray, Observed, Tolerances, Trajectory, limit_claim, observed

_CLOSE = 0.02  # of a leader's speed: within it an agent's velocity is its leader's
_APART = 30.0  # between two groups
_ROUNDING = 1e-9  # of what steps of a fixed size come to, relative


def led_run(
    leaders: tuple[Any, ...], centres: tuple[tuple[float, float], ...], *, feedforward: bool = True
) -> Observed:
    """Return a run of seven agents around each centre, with the middle agent pinned to a leader, for 60 time units."""
    pair = DeadZoneInteraction()
    q = np.concatenate([hexagonal_patch(1, pair.d1) + np.array(centre) for centre in centres])
    middle = [k for k, centre in enumerate(np.repeat(np.array(centres), 7, axis=0)) if np.allclose(q[k], centre)]
    group = np.arange(len(q)) // 7
    tie_options: dict[str, Any] = {"leaders": leaders, "group": group, "pinned": middle, "feedforward": feedforward}
    law = LedDeadZoneFlocking(pair, c1=2.0, c2=3.0, **tie_options)
    return observed(SemiImplicitEuler(law, 0.01), q, 0.0 * q, (0.0, 60.0), t_eval=[0.0, 54.0, 60.0])


def _slip(run: Trajectory) -> FloatArray:
    """Return the largest velocity error to the leader at each late sample, relative to the leader's speed."""
    law = run.law.continuous
    rows = []
    for t, p in zip(run.t[1:], run.p[1:], strict=True):
        led_velocity = law.ties.led(float(t))[1]
        rows.append((np.linalg.norm(p - led_velocity, axis=1) / np.linalg.norm(led_velocity, axis=1)).max())
    return np.array(rows)


def _printed() -> Claim:
    """Return the printed claim that agents with different leaders do not match under (9), which has no leader."""
    law, q, p = DeadZoneFlocking(), np.array([[0.0, 0.0], [8.0, 0.0]]), np.array([[-0.2, 0.0], [0.2, 0.0]])
    bond = components_of(q, p, law).members[0].bond
    return limit_claim("printed", [], escape=bond).described(
        stated="under (9) agents with different leaders do not match",
        detail="(9) has no leader: two agents 8 m apart that should part at 0.4 m/s match in the limit",
    )


@lru_cache(maxsize=1)
def _runs() -> dict[str, Observed]:
    straight_target, circle = LinearTarget((3.0, 0.0), (0.5, 0.0)), CircleTarget((-4.0, 0.0), 4.0, frequency=0.05)
    leader_targets = LinearTarget((0.0, 0.0), (-1.0, 0.0)), LinearTarget((_APART, 0.0), (1.0, 0.0))
    return {
        "one": led_run((straight_target,), ((0.0, 0.0),)),
        "two": led_run(leader_targets, ((0.0, 0.0), (_APART, 0.0))),
        "known": led_run((circle,), ((0.0, 0.0),)),
        "unknown": led_run((circle,), ((0.0, 0.0),), feedforward=False),
    }


def _follow(name: str, seen: Observed, stated: str, what: str) -> Claim:
    """Return the claim that all velocities equal the leader's late in a run."""
    slip = float(_slip(seen.run).max())
    times = " and ".join(f"{t:g}" for t in seen.t[1:])
    detail = f"{what} each velocity differs from the leader's by at most {slip:.2g} of its speed"
    stated = f"at t = {times} {stated}, to {_CLOSE:g} of its speed"
    return of_map(name, _CLOSE - slip, _ROUNDING, computed=slip, stated=stated, detail=detail)


def _apart(seen: Observed) -> Claim:
    group = np.array(seen.law.continuous.group)
    first_velocity, second_velocity = (seen.end.p[group == leader].mean(axis=0) for leader in (0, 1))
    difference = float(np.linalg.norm(first_velocity - second_velocity))
    return of_map("different-leaders", difference / 2.0 - (1.0 - _CLOSE), _ROUNDING, computed=difference).described(
        stated=f"at t = {seen.t[-1]:g} agents with different leaders do not match, under the law with leaders",
        detail=f"two groups {_APART:g} m apart whose leaders separate at 2 m/s separate at {difference:.4g} m/s; in "
        "groups that start mixed, some unpinned agents follow the wrong leader (scenario dead-zone-leaders)",
    )


def _fraction() -> Claim:
    """Return the claim that pinning a fraction of agents makes all follow, refuted by an agent out of range."""
    law = LedDeadZoneFlocking(leaders=(LinearTarget((0.0, 0.0), (-1.0, 0.0)),), group=(0, 0), pinned=(0,))
    q, p = np.array([[0.0, 0.0], [20.0, 0.0]]), np.array([[-1.0, 0.0], [0.0, 0.0]])
    force = float(np.abs(law.flow(0.0, q, p)[0]).max())
    r = law.interaction.r
    return by_count("fraction", int(force == 0.0 and q[1, 0] >= r), about="all").described(
        stated="to pin a fraction of the agents makes all follow",
        witness={"force": force, "distance": float(q[1, 0])},
        detail=f"an agent at rest {q[1, 0]:g} m from the only pinned one, which leaves with its leader, never feels a "
        f"force, as r = {r:g}: each agent needs a path in the net to a pinned one",
    )


@erratum(
    "L9",
    corrected=(),
    expected={
        "refuted": "printed fraction",
        "verified": "energy one-leader different-leaders acceleration acceleration-needed",
    },
    ours=("energy",),
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Agents with different leaders are said not to match, and a pinned fraction of the agents to follow leaders whose
    acceleration is known. (9) has neither leader nor pin: under it all neighbours match. A law with these terms does so
    while each agent has a path in the net to a pinned one and groups stay out of each other's range; pinning a fraction
    of the agents does not suffice.
    """
    # Check (9), the energy of a law with leaders, and this law with one leader, two leaders, and a turning one.
    from flockana.symbolic.energy_balances import led_energy_identity

    runs, residuals = _runs(), [row for m in (1, 2, 3) for row in led_energy_identity(m).residuals]
    one, turning_text = "all follow one leader that one agent of seven is pinned to", "all follow a leader that turns"
    deaf, late = float(_slip(runs["unknown"].run).min()), runs["unknown"].t[1:]
    return [
        _printed(),
        equal("energy", residuals).described(
            stated="dH/dt = -k₂ pᵀL̂p within groups - c₂ Σ h_i ‖p_i - p_l‖² - Σ f_i·p_l, in the frames of the leaders",
            detail="it holds in 1, 2 and 3 dimensions; with one leader Σ f_i = 0 and H never rises; neighbours with "
            "different leaders add or remove energy",
        ),
        _follow("one-leader", runs["one"], one, "with 1 of 7 pinned"),
        _apart(runs["two"]),
        _fraction(),
        _follow("acceleration", runs["known"], f"{turning_text}, its acceleration known", "with feedforward"),
        of_map("acceleration-needed", deaf - _CLOSE, _ROUNDING, computed=deaf).described(
            stated="not all follow a leader that turns if its acceleration is not known",
            detail=f"without feedforward a velocity is off by {deaf:.2g} of the leader's speed at t = {late[0]:g} "
            f"and {late[1]:g}",
        ),
    ]
