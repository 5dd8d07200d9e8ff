"""Parameters to plain data and back."""

import json
import re
from dataclasses import dataclass, is_dataclass
from importlib import import_module
from pkgutil import walk_packages

import numpy as np
import pytest

from flockana import CallableTarget, CircleTarget, LinearTarget, RescaledVelocity, SineTarget, StaticTarget, Tolerances
from flockana.base.errors import ArgumentError, FileError
from flockana.base.module_discovery import source_modules
from flockana.base.serialize import from_data, parameter_classes, to_data, to_data_mapping
from flockana.interactions import AlphaInteraction, BetaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm1, Algorithm2

THIRD = 1.0 / 3.0


@dataclass(frozen=True)
class OurOwn:
    """A parameter class outside flockana."""

    x: float


@pytest.mark.parametrize(
    "value",
    [
        AlphaInteraction(d=THIRD, r=np.float64(0.7), h=0.1 + 0.2),
        BetaInteraction(),
        Gains(c1_alpha=1e-300),
        Algorithm1(),
        Algorithm2(target=StaticTarget((THIRD, 5.0), (1.0, -0.0))),
        Algorithm2(target=SineTarget((1.0, 2.0), (0.0, 0.0), 3.0, THIRD, phase=0.1, axis=np.int64(0))),
        Algorithm2(target=RescaledVelocity(CircleTarget((0.0, 0.0, 1.0), 2.0, 0.5), 1.0 / 111.0)),
        LinearTarget([1], [2]),
        OurOwn(2.0),
        (1, 2.5, "text", None, True, (3.0, ())),
    ],
)
def test_round_trip_through_json_is_exact(value):
    assert from_data(json.loads(json.dumps(to_data(value)))) == value


def test_arrays_and_numpy_scalars_become_numbers():
    assert type(to_data_mapping({"steps": np.int64(3)})["steps"]) is int
    assert to_data([np.float32(0.5), np.arange(2), np.bool_(True)]) == [0.5, [0, 1], True]


def test_the_type_is_named():
    assert to_data(Gains())["type"] == "flockana:Gains"
    assert to_data(OurOwn(2.0))["type"] == f"{__name__}:OurOwn"


def test_files_that_name_a_module_are_read_wherever_the_class_lives_now():
    for module in ("flockana.interactions.gains", "flockana.where.it.once.was"):
        assert from_data({"type": f"{module}:Gains", "c1_alpha": 2.0}) == Gains(c1_alpha=2.0)


def test_no_two_parameter_classes_share_a_name():
    rooms = "interactions", "environment", "laws", "solvers"
    parts = [(import_module(f"flockana.{room}"), tuple(source_modules(room))) for room in rooms]
    modules = [import_module(x.name) for r, _ in parts for x in walk_packages(r.__path__, f"{r.__name__}.")]
    modules += [module for _, own in parts for module in own]
    classes = {x for m in modules for x in vars(m).values() if isinstance(x, type) and x.__module__ == m.__name__}
    names = [x.__name__ for x in classes if is_dataclass(x)]
    assert sorted(names) == sorted(parameter_classes())


def test_functions_cannot_be_written():
    law = Algorithm2(target=CallableTarget(lambda t: ((0.0,), (0.0,))))
    with pytest.raises(ArgumentError, match="a user's function has no such form, so describe it by a class"):
        to_data(law)
    with pytest.raises(ArgumentError, match="expected parameters made of numbers"):
        to_data({1, 2})
    with pytest.raises(ArgumentError, match="expected laws and their parts"):
        to_data(Tolerances())  # it would be written, and never read


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"type": "elsewhere.laws:Swarm"}, "needs elsewhere.laws:Swarm, which is not part of flockana: import"),
        ({"d": 7.0}, "the file needs None, which is not part of flockana"),
        ({"type": "flockana.nowhere:Law"}, "cannot rebuild flockana.nowhere:Law from the file"),
        ({"type": "flockana.interactions:Delta"}, "cannot rebuild flockana.interactions:Delta"),
        ({"type": "flockana.interactions.alpha:sqrt"}, "is no parameter class"),
        ({"type": "os:system", "command": "true"}, "is no parameter class"),
        ({"type": "flockana.interactions.gains:Gains", "c3": 1.0}, "unexpected keyword argument 'c3'"),
        ({"type": "flockana.interactions.alpha:AlphaInteraction", "d": 9.0}, "expected r > d"),
    ],
)
def test_strange_data(data, message):
    with pytest.raises(FileError, match=re.escape(message)):
        from_data(data)
