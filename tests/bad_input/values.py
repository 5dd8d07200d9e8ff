"""Values that are wrong for every argument of a kind, by what is wrong with them, and what a refusal must say."""

import re

import numpy as np
import pytest

from flockana import Algorithm1, simulate
from flockana.base.errors import FlockanaError

NAN, INF = float("nan"), float("inf")
LAW = Algorithm1()
Q = [[0.0, 0.0], [7.0, 0.0], [3.5, 6.0]]
P = [[0.0, 0.0]] * 3
RUN = simulate(LAW, Q, P, (0.0, 1.0))

VECTORS = {
    "none": None,
    "a text": "abc",
    "numbers as texts": [["1", "2"]],
    "numbers as bytes": [[b"1", b"2"]],
    "truth values": [[True, False]],
    "nan": [[NAN, 0.0]],
    "infinity": [[INF, 0.0]],
    "three axes": np.zeros((2, 2, 2)),
    "nothing": [],
    "four columns": np.zeros((2, 4)),
    "ragged": [[0.0], [1.0, 2.0]],
    "complex": [[1j, 0.0]],
    "dates": np.array([["2020-01-01", "2020-01-02"]], dtype="datetime64[D]"),
    "durations": np.array([[1, 2]], dtype="timedelta64[s]"),
    "masked": np.ma.masked_array([[1.0, 2.0]], mask=[[True, False]]),
    "objects": np.array([[object(), 1.0]], dtype=object),
    "truth values among objects": np.array([[True, 1.0]], dtype=object),
    "a mapping": {"a": 1},
    "a set": {1.0},
    "a function": len,
}
POINTS = VECTORS | {"one axis": [0.0, 1.0], "no agents": np.zeros((0, 2))}
NUMBERS = {
    "none": None,
    "a text": "abc",
    "a number as text": "7",
    "a truth value": True,
    "numpy's truth value": np.True_,
    "nan": NAN,
    "infinity": INF,
    "two numbers": [1.0, 2.0],
    "complex": 1j,
    "a date": np.datetime64("2020-01-01"),
    "masked": np.ma.masked,
    "a mapping": {},
}
NOT_NEGATIVE = NUMBERS | {"negative": -1.0}
POSITIVE = NOT_NEGATIVE | {"zero": 0.0}
COUNTS = {
    "none": None,
    "a text": "3",
    "a truth value": True,
    "nan": NAN,
    "a fraction": 2.5,
    "negative": -1,
    "zero": 0,
    "a list": [3],
}
SIZES = COUNTS | {"beyond memory": 10**13, "beyond machine numbers": 10**30}
LINKS = {
    "none": None,
    "a text": "ab",
    "fractions": [[0.0, 1.0]],
    "beyond n": [[0, 9]],
    "negative": [[-1, 0]],
    "one axis": [0, 1],
    "three columns": [[0, 1, 2]],
    "truth values": [[True, False]],
    "nan": [[NAN, 0]],
}
NAMES = {"none": None, "unknown": "no-such-name", "a number": 3, "a list": ["energy"]}
PATHS = {
    "none": None,
    "a number": 3,
    "null byte": "a\0b",
    "bytes": b"x",
    "a list": ["x"],
    "missing": "/nowhere/at/all.nc",
    "a folder": "/",
    "nothing": "",
}
_REMEDY = re.compile(
    "expected|choose|did you mean|[Kk]nown:|nearest of|run the simulation again|search again|give |ask for|take |use "
    "|start|needs|is checked on|it has|the run spans"
)


def without(table, *names):
    """A table but for some of its rows: values that are right here."""
    assert set(names) <= set(table)
    return {name: value for name, value in table.items() if name not in names}


def refused(table, call):
    """Fail unless every value of a table is refused, in words that tell the remedy."""
    wrong = []
    for name, value in table.items():
        try:
            given = call(value)
        except FlockanaError as error:
            if not _REMEDY.search(str(error)) or len(str(error)) > 2000:
                wrong.append(f"{name}: no remedy in {str(error)!r}")
        except Exception as error:
            wrong.append(f"{name}: {type(error).__name__}: {error}")
        else:
            wrong.append(f"{name}: accepted, {given!r:.80}")
    if wrong:
        pytest.fail("\n".join(wrong))


def rows(cases):
    """Test ids and arguments of cases (name, table, call)."""
    return [pytest.param(table, call, id=name) for name, table, call in cases]
