import os

import numpy as np
import pytest

import flockana as fl
from tests.bad_input.values import INF, LAW, NAN, NUMBERS, PATHS, POINTS, POSITIVE, RUN, P, Q, refused, rows, without

T, A = np.array([0.0, 1.0]), np.zeros((2, 3, 2))
SPANS = {
    "none": None,
    "one": (0,),
    "three": (0, 1, 2),
    "a text": "01",
    "texts": ("0", "1"),
    "backwards": (1, 0),
    "empty": (1, 1),
    "nan": (0, NAN),
    "infinite": (0, INF),
    "a number": 3.0,
    "truth values": (False, True),
    "complex": (0, 1j),
    "dates": (np.datetime64("2020-01-01"), np.datetime64("2020-01-02")),
}
TIMES = {
    "a text": "x",
    "texts": ["0.1"],
    "nan": [NAN],
    "falling": [0.2, 0.1],
    "equal": [0.1, 0.1],
    "outside": [5.0],
    "two axes": [[0.1]],
    "none of them": [],
    "truth values": [False, True],
    "complex": [0.1j],
    "dates": [np.datetime64("2020-01-01")],
    "masked": np.ma.masked_array([0.1, 0.2], mask=[0, 1]),
}
SERIES = POINTS | {
    "nan, in shape": np.full((2, 3, 2), NAN),
    "complex, in shape": A * 1j,
    "truth values, in shape": A > 0,
    "texts, in shape": A.astype(str),
    "masked, in shape": np.ma.masked_array(A, mask=A == 0),
    "dates, in shape": A.astype("datetime64[s]"),
    "m = 4": np.zeros((2, 3, 4)),
    "n = 0": np.zeros((2, 0, 2)),
}
OTHERS = {"none": None, "a text": "x", "a class": fl.Algorithm1, "a number": 3}


def made(**change):
    return fl.Trajectory(**({"t": T, "q": A, "p": A, "u": A, "law": LAW} | change))


def simulated(span=(0.0, 0.1), **options):
    return fl.simulate(LAW, Q, P, span, **options)


def cases():
    yield "simulate law", OTHERS | {"a function": len}, lambda v: fl.simulate(v, Q, P, (0, 1))
    yield "simulate q0", POINTS, lambda v: fl.simulate(LAW, v, v, (0, 0.1))
    yield "simulate p0", POINTS, lambda v: fl.simulate(LAW, Q, v, (0, 0.1))
    yield "simulate t_span", SPANS, simulated
    methods = {"none": None, "unknown": "x", "a number": 3, "another case": "rk4", "a list": ["RK4"], "no dt": "RK4"}
    yield "simulate method", methods, lambda v: simulated(method=v)
    yield "simulate rtol", POSITIVE, lambda v: simulated(rtol=v)
    yield "simulate atol", without(POSITIVE, "none", "two numbers"), lambda v: simulated(atol=v)
    steps = POSITIVE | {"beyond memory": 1e-13, "beyond all": 1e-300}
    yield "simulate dt", steps, lambda v: simulated((0.0, 1.0), method="RK4", dt=v)
    yield "simulate t_eval", TIMES, lambda v: simulated((0.0, 1.0), t_eval=v)
    for name in "qpu":
        yield f"Trajectory {name}", SERIES, lambda v, k=name: made(**{k: v})
    times = {"none": None, "falling": [1.0, 0.0], "equal": [0.0, 0.0], "nan": [0.0, NAN], "infinite": [0.0, INF]}
    times |= {"texts": ["a", "b"], "one": [0.0], "dates": T.astype("datetime64[s]"), "truth values": [False, True]}
    yield "Trajectory t", times | {"complex": [0, 1j]}, lambda v: made(t=v)
    yield "Trajectory law", OTHERS, lambda v: made(law=v)
    yield "Trajectory status", {"none": None, "unknown": "fine", "a number": 3}, lambda v: made(status=v)
    series = {"none": None, "one sample": {"work": [0.0]}, "texts": {"work": ["a", "b"]}, "a list": [1]}
    yield "Trajectory extra", series | {"nan": {"work": [NAN, 0.0]}}, lambda v: made(extra=v)
    yield "Trajectory stats", {"none": None, "a list": [1], "a text": "x"}, lambda v: made(stats=v)
    yield "Trajectory between", {"a text": "x", "a mapping": {}}, lambda v: made(between=v)
    windows = {"texts": ("a", "b"), "none": (None, 1.0), "nan": (NAN, 1.0), "outside": (5.0, 6.0), "empty": (1.0, 0.0)}
    yield "window", windows, lambda v: RUN.window(*v)
    yield "metric", {"none": None, "unknown": "x", "a number": 3}, RUN.metric
    yield "measure", {"none": None, "unknown": "x"}, RUN.measure
    shares = NUMBERS | {"negative": -0.1, "one": 1.0, "two": 2.0}
    yield "is_quasi_flock share", shares, lambda v: fl.predicates.is_quasi_flock(RUN, share=v)
    yield "is_cohesive radius", POSITIVE, lambda v: fl.predicates.is_cohesive(RUN, v)
    for name in ("is_flock", "is_dynamic_flock", "is_quasi_flock"):
        yield name, {"none": None, "a number": 3, "a text": "x"}, getattr(fl.predicates, name)
    yield "Delayed", NUMBERS | {"negative": -0.1}, lambda v: fl.Delayed(LAW, v)
    yield "Sampled", POSITIVE, lambda v: fl.Sampled(LAW, v)
    yield "Saturated", POSITIVE, lambda v: fl.Saturated(LAW, v)
    yield "Disturbed intensity", NUMBERS | {"negative": -0.1}, lambda v: fl.Disturbed(LAW, intensity=v)
    yield "Measured position", NUMBERS | {"negative": -0.1}, lambda v: fl.Measured(LAW, v)
    yield "Lossy", NUMBERS | {"negative": -0.1, "above one": 1.1}, lambda v: fl.Lossy(LAW, v)
    late = fl.Delayed(LAW, 0.1)
    yield "dt of a delayed law", POSITIVE | {"no divisor": 0.03}, lambda v: fl.simulate(late, Q, P, (0.0, 1.0), dt=v)
    yield "q0 of a delayed law", POINTS, lambda v: fl.simulate(late, v, P, (0.0, 1.0), dt=0.1)


def paths():
    yield "load", PATHS, fl.Trajectory.load
    yield "save", PATHS, RUN.save
    yield "replay", PATHS, fl.replay
    yield "read_lammps", PATHS, lambda v: fl.read_lammps(v, LAW)
    yield "animate", PATHS | {"a picture": "x.png"}, lambda v: fl.animate(RUN, v, seconds=0.1, fps=10)
    yield "animate seconds", POSITIVE, lambda v: fl.animate(RUN, "x.gif", seconds=v)
    yield "animate fps", POSITIVE | {"too many": 1e9}, lambda v: fl.animate(RUN, "x.gif", fps=v)
    folders = {"none": None, "a number": 3, "null byte": "a\0b", "empty": "", "a file": __file__}
    yield "export_lammps", folders, lambda v: fl.export_lammps(LAW, Q, P, (0, 1), v)


@pytest.mark.parametrize(("table", "call"), rows(cases()))
def test_what_is_none_is_refused(table, call):
    refused(table, call)


@pytest.mark.parametrize(("table", "call"), rows(paths()))
def test_what_is_no_path_is_refused_and_nothing_is_left(table, call, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    refused(table, call)
    assert os.listdir(tmp_path) == []


def test_sizes_are_told_with_the_memory_that_they_would_need():
    with pytest.raises(fl.errors.ArgumentError, match=r"would take .* bytes, more than half .* take longer steps"):
        simulated((0.0, 1.0), method="RK4", dt=1e-13)
    with pytest.raises(fl.errors.ArgumentError, match=r"would take .* bytes, more than half .* a shorter delay"):
        fl.simulate(fl.Delayed(LAW, 1e12), Q, P, (0.0, 1.0), dt=0.1)
    sampled = fl.simulate(LAW, Q, P, (0.0, 1e-10), method="RK4", dt=1e-11, t_eval=[1e-10])
    assert sampled.status == "complete"
