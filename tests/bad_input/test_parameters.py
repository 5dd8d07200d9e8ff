from dataclasses import fields

import numpy as np
import pytest

import flockana as fl
from flockana import AlphaInteraction, BetaInteraction, DeadZoneInteraction, Gains, ZoneRadii
from tests.bad_input.values import LAW, NOT_NEGATIVE, NUMBERS, POINTS, POSITIVE, VECTORS, refused, rows, without

ORIGIN = (0.0, 0.0)
OTHERS = {"none": None, "a text": "x", "a number": 3}


def cases():
    for name in ("d", "r", "eps", "a", "b"):
        yield f"AlphaInteraction {name}", POSITIVE, lambda v, k=name: AlphaInteraction(**{k: v})
    yield "AlphaInteraction h", NOT_NEGATIVE, lambda v: AlphaInteraction(h=v)
    for name in ("d", "r", "eps"):
        yield f"BetaInteraction {name}", POSITIVE, lambda v, k=name: BetaInteraction(**{k: v})
    for field in fields(DeadZoneInteraction):
        yield f"DeadZone {field.name}", without(NUMBERS, "none"), lambda v, k=field.name: DeadZoneInteraction(**{k: v})
    for name in ("c1_alpha", "c2_alpha", "c1_beta", "c2_beta", "c1_gamma", "c2_gamma"):
        table = without(NOT_NEGATIVE, *["two numbers"] * name.endswith("gamma"))  # one for each agent
        yield f"Gains {name}", table, lambda v, k=name: Gains(**{k: v})
    yield "ZoneRadii r", POSITIVE, lambda v: ZoneRadii(r=v, a=1.0)
    for field in fields(fl.Tolerances):
        table = without(POSITIVE, "zero") if field.name == "settle" else POSITIVE
        yield f"Tolerances {field.name}", table, lambda v, k=field.name: fl.Tolerances(**{k: v})
    yield "StaticTarget", VECTORS, fl.StaticTarget
    yield "LinearTarget p", VECTORS, lambda v: fl.LinearTarget(ORIGIN, v)
    yield "CircleTarget centre", VECTORS, lambda v: fl.CircleTarget(v, 1.0, 1.0)
    yield "CircleTarget radius", NOT_NEGATIVE, lambda v: fl.CircleTarget(ORIGIN, v, 0.1)
    yield "CircleTarget frequency", NUMBERS, lambda v: fl.CircleTarget(ORIGIN, 1.0, v)
    yield "SineTarget amplitude", NUMBERS, lambda v: fl.SineTarget(ORIGIN, (1.0, 0.0), v, 0.1)
    axes = OTHERS | {"negative": -1, "beyond": 2, "a fraction": 0.5, "a truth value": True}
    yield "SineTarget axis", axes, lambda v: fl.SineTarget(ORIGIN, (1.0, 0.0), 1.0, 0.1, axis=v)
    yield "CallableTarget", OTHERS, fl.CallableTarget
    yield "Sphere centre", VECTORS, lambda v: fl.Sphere(v, 1.0)
    yield "Sphere radius", POSITIVE, lambda v: fl.Sphere(ORIGIN, v)
    yield "Wall point", VECTORS, lambda v: fl.Wall(v, (0.0, 1.0))
    yield "Wall normal", VECTORS | {"zero": ORIGIN}, lambda v: fl.Wall(ORIGIN, v)
    yield "Capsule start", VECTORS, lambda v: fl.Capsule(v, (0.0, 1.0), 1.0)
    yield "Capsule radius", POSITIVE, lambda v: fl.Capsule(ORIGIN, (0.0, 1.0), v)
    yield "Polygon", POINTS, fl.Polygon
    yield "SimplePolygon", POINTS, fl.SimplePolygon
    yield "Box", VECTORS, lambda v: fl.Box(v, (1.0, 1.0))
    yield "Algorithm1 alpha", OTHERS, fl.Algorithm1
    yield "Algorithm1 gains", OTHERS, lambda v: fl.Algorithm1(gains=v)
    yield "Algorithm2 target", OTHERS | {"a tuple": ORIGIN}, lambda v: fl.Algorithm2(target=v)
    still = fl.StaticTarget(ORIGIN)
    yield "Algorithm3 obstacles", OTHERS | {"a list": [3]}, lambda v: fl.Algorithm3(target=still, obstacles=v)
    yield "rescale length", POSITIVE, lambda v: fl.rescale(LAW, length=v)
    things = OTHERS | {"a class": fl.Algorithm1, "an array": np.zeros(2), "a list": [LAW]}
    yield "rescale item", things, lambda v: fl.rescale(v, length=2.0)
    yield "rescale time", POSITIVE, lambda v: fl.rescale(LAW, time=v)


@pytest.mark.parametrize(("table", "call"), rows(cases()))
def test_what_is_none_is_refused(table, call):
    refused(table, call)
