"""The same physics written down otherwise: other units, another place, another frame, other numbers for the agents."""

from dataclasses import replace

import numpy as np

from flockana import (
    Capsule,
    CyclicPursuit,
    DistanceFormation,
    LedDeadZoneFlocking,
    MinimalFlocking,
    Polygon,
    Sphere,
    Wall,
    rescale,
)
from flockana.environment import targets
from tests.adversarial.cases import Case

UNITS = {"micrometres and milliseconds": (1e6, 1e3), "kilometres and hours": (1e-3, 1.0 / 3600.0)}
UNITS["powers of two"] = (2.0**10, 2.0**-7)


class UnchangedError(Exception):
    """This law cannot be written down so."""


def in_units(case, length, time):
    """Lengths and times in other units, tolerances and steps too."""
    options = dict(case.options)
    for name, factor in (("t_eval", time), ("dt", time), ("atol", length)):
        if options.get(name) is not None:
            options[name] = np.asarray(options[name]) * factor if name == "t_eval" else options[name] * factor
    law = rescale(case.law, length=length, time=time)
    q, p = np.asarray(case.q0) * length, np.asarray(case.p0) * (length / time)
    return Case(law, q, p, case.until * time, options, case.since * time)


def rigid(case, turn, shift):
    """Turned (or reflected) and moved, with everything that stands in the plane."""
    if getattr(getattr(case.law, "world", None), "dimension", None) is not None:
        raise UnchangedError("obstacles, box and aliens stay where they are")
    law, (q, p) = _world(case.law, turn, shift), (np.asarray(state, float) @ turn for state in (case.q0, case.p0))
    if isinstance(law, CyclicPursuit) and np.linalg.det(turn) < 0.0:
        law = replace(law, angle=-law.angle)
    return replace(case, law=law, q0=q + shift, p0=p)


def boosted(case, velocity):
    """Seen from a frame that moves: with a γ-agent only if it moves on a line."""
    law, back = case.law, case.since * velocity
    if law.obstacles:
        raise UnchangedError("obstacles stand still")
    if law.target is not None:
        if not isinstance(law.target, targets.LinearTarget):
            raise UnchangedError("no straight line")
        law = replace(law, target=targets.LinearTarget(np.array(law.target.q), np.array(law.target.p) + velocity))
    return replace(case, law=law, q0=np.asarray(case.q0) + back, p0=np.asarray(case.p0) + velocity)


def renumbered(case, order):
    """Agent order[k] becomes agent k."""
    law = case.law
    if getattr(getattr(law, "gains", None), "per_agent", False):
        raise UnchangedError("gains by agent")
    weights = getattr(law, "weights", None)
    if weights is not None and any(isinstance(value, tuple) for value in vars(weights).values()):
        raise UnchangedError("weights by agent")
    if isinstance(law, CyclicPursuit | DistanceFormation):
        raise UnchangedError("neighbours by number")
    if isinstance(law, MinimalFlocking) and law.edges is not None:
        place = np.argsort(order)
        law = replace(law, edges=tuple((int(place[j]), int(place[i])) for j, i in law.edges))
    if _led(law):
        place, led = np.argsort(order), law.law
        group, pinned = np.asarray(led.group)[order], place[list(led.pinned)]
        law = replace(law, law=replace(led, group=group.tolist(), pinned=pinned.tolist()))
    return replace(case, law=law, q0=np.asarray(case.q0)[order], p0=np.asarray(case.p0)[order])


def delayed_start(case, by):
    """The clock started earlier: only where nothing in the law tells the time."""
    target = getattr(case.law, "target", None)
    if not isinstance(target, targets.StaticTarget | None) or _led(case.law):
        raise UnchangedError("the γ-agent tells the time")
    options = dict(case.options)
    if options.get("t_eval") is not None:
        options["t_eval"] = np.asarray(options["t_eval"]) + by
    return replace(case, since=case.since + by, options=options)


def _led(law):
    """Whether it is a map of a law with leaders."""
    return isinstance(getattr(law, "law", None), LedDeadZoneFlocking)


def _world(law, turn, shift):
    changes = {}
    if _led(law):
        changes["law"] = replace(law.law, leaders=[_target(leader, turn, shift) for leader in law.law.leaders])
    if law.target is not None:
        changes["target"] = _target(law.target, turn, shift)
    if getattr(law, "obstacles", ()):
        changes["obstacles"] = tuple(_obstacle(one, turn, shift) for one in law.obstacles)
    return replace(law, **changes) if changes else law


def _target(target, turn, shift):
    if isinstance(target, targets.RescaledVelocity):
        return targets.RescaledVelocity(_target(target.target, turn, shift), target.factor)
    if isinstance(target, targets.CallableTarget):
        return targets.CallableTarget(
            lambda t: (np.asarray(target.state(t)[0]) @ turn + shift, np.asarray(target.state(t)[1]) @ turn)
        )
    if isinstance(target, targets.StaticTarget | targets.LinearTarget):
        return type(target)(np.array(target.q) @ turn + shift, np.array(target.p) @ turn)
    name = {targets.SineTarget: "start", targets.CircleTarget: "centre"}[type(target)]
    if not np.array_equal(turn, np.eye(len(turn))):
        raise UnchangedError("its axis is one of the coordinates")
    return replace(target, **{name: np.array(getattr(target, name)) + shift})


def _obstacle(one, turn, shift):
    moved = {
        name: tuple(map(tuple, np.atleast_2d(np.asarray(getattr(one, name)) @ turn + shift)))
        for name in ("centre", "point", "a", "b", "vertices")
        if hasattr(one, name)
    }
    if not isinstance(one, Polygon):
        moved = {name: rows[0] for name, rows in moved.items()}
    if isinstance(one, Wall):
        moved["normal"] = tuple(np.asarray(one.normal) @ turn)
    if not isinstance(one, Sphere | Wall | Capsule | Polygon):
        raise UnchangedError(type(one).__name__)
    return replace(one, **moved)
