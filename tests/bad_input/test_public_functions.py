import inspect
from contextlib import suppress

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import FlockanaError, format_value

STRANGE = {
    "matrix": np.zeros((2, 5)),
    "masked": np.ma.masked_array([1.0, 2.0], [0, 1]),
    "list": [[1]],
    "NaN": [np.nan, 1.0],
    "object": object(),
    "text": "\0",
    "huge": 10**30,
}
ELSEWHERE = {"falsify", "verify", "shares", "explore"}  # long searches, a server, and what stands in tables of its own
MUCH = {("runs", "huge"), ("t_end", "huge")}  # one may ask for it


@pytest.fixture(scope="module")
def usual(tmp_path_factory):
    """What the arguments are otherwise."""
    law, q, p = fl.Algorithm1(), np.array([[0.0, 0.0], [7.0, 0.0]]), np.zeros((2, 2))
    folder = tmp_path_factory.mktemp("out")
    run = fl.simulate(law, q, p, (0.0, 0.1))
    shared = {"law": law, "t_span": (0.0, 0.1), "path": folder / "it", "folder": folder / "them", "name": "hexagon"}
    shared |= {"directory": folder / "page"}
    rest = fl.find_equilibrium(law, q)
    shared |= {"d": 7.0, "r": 8.4, "n": 2, "pairs": [[0, 1]], "nets": [[[0, 1]]], "x": q, "successes": 1, "trials": 2}
    shared |= {"item": law, "equilibrium": rest, "linearisation": fl.linearise(law, rest)}
    shared |= {"basin": fl.certify([[0.0], [7.0]], law=law), "distances": [0.1]}
    shared |= {"tube": fl.enclose(law, q, p, (0.0, 0.0009765625)), "adjacency": lambda s2, par: 1.0}
    shared |= {"margin": 1.0, "disturbance": 0.1, "spread": 0.05}
    shared |= {"range": 8.4, "length": 7.0, "scenario": "hexagon", "seeds": []}
    places = dict.fromkeys(("q", "q0", "positions", "configuration"), q) | dict.fromkeys(("p", "p0"), p)
    shared |= {"rec": fl.Recording(run.t, run.q, run.p, bound=0.0), "source": {"t": run.t, "q": run.q}}
    return shared | places | {"run": run, "trajectory": run, "subject": run, "theorem": "os-3", "target": "os-3"}


def required(function):
    parameters = inspect.signature(function).parameters.values()
    return [
        p.name
        for p in parameters
        if p.default is inspect.Parameter.empty and p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)
    ]


FUNCTIONS = [name for name in fl.__all__ if inspect.isfunction(getattr(fl, name)) and name not in ELSEWHERE]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_what_is_strange_is_refused_in_words(name, usual):
    function = getattr(fl, name)
    assert set(required(function)) <= set(usual), "a new argument: say above what it usually is"
    for parameter in inspect.signature(function).parameters.values():
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            continue
        for kind, value in STRANGE.items():
            if (parameter.name, kind) in MUCH:
                continue
            given = {key: usual[key] for key in required(function)} | {parameter.name: value}
            try:
                with suppress(FlockanaError):
                    function(**given)
            except Exception as other:  # whatever it is, it is not ours
                pytest.fail(f"{name}({parameter.name}: {kind}) raises {type(other).__name__}: {other}")


def of_rooms():
    """Functions of the package and of its rooms that have arguments without defaults."""
    rooms = {"": fl} | {
        f"{room}.": getattr(fl, room) for room in ("plots", "stability", "lattice", "reynolds", "metrics", "symbolic")
    }
    for prefix, room in rooms.items():
        for name in getattr(room, "__all__", None) or [name for name in vars(room) if not name.startswith("_")]:
            function = getattr(room, name)
            own = hasattr(room, "__all__") or getattr(function, "__module__", "") == room.__name__
            if inspect.isfunction(function) and own and name not in {"explore", "falsify"} and required(function):
                yield pytest.param(function, id=prefix + name)


@pytest.mark.parametrize("value", [None, object()], ids=["none", "a thing"])
@pytest.mark.parametrize("function", list(of_rooms()))
def test_none_and_foreign_objects_are_refused_by_name(function, value):
    names = required(function)
    with pytest.raises(FlockanaError) as refused:
        function(**dict.fromkeys(names, value))
    assert any(word in str(refused.value) for word in (*inspect.signature(function).parameters, format_value(value)))
