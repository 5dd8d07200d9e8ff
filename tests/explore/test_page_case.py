import contextlib
import io

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError, FileError
from flockana.base.integrity_seals import sealed
from flockana.explore.page_case import Case, program
from flockana.falsify.counterexample import Counterexample

SHORT = [
    Case(
        "scenario", "hexagon", duration=0.5, changes={"gains.c1_alpha": 12.5, "alpha.r": 8.1}, moved={2: (9.0, -1 / 3)}
    ),
    Case("scenario", "beside-a-sphere", seed=3, changes={"obstacles.0.radius": 1.25}),
    Case("scenario", "zone-path", duration=2.0),
    Case("scenario", "tanner-fixed", duration=1.0),  # which gives t_eval and rtol
    Case("law", "Algorithm1", n=9, duration=0.3, moved={0: (0.1, 0.2), 8: (50.0, 0.0)}),
    Case("law", "Algorithm2", n=8, m=3, duration=0.2, changes={"target.q": (1.0, 0.0, 1e-3)}),
    Case("law", "Algorithm3", n=8, duration=0.3, changes={"obstacles.0.centre": (3.0, 0.1)}),
    Case("law", "DeadZoneFlocking", n=5, seed=2, duration=0.05),
]


def made(case):
    """What the lines of Python leave behind."""
    names = {}
    with contextlib.redirect_stdout(io.StringIO()) as said:
        exec(program(case.parts), names)
    return names, said.getvalue()


def same(case):
    parts, (names, said) = case.parts, made(case)
    run = fl.simulate(parts.law, parts.q0, parts.p0, parts.t_span, **parts.options)
    assert names["law"] == parts.law
    np.testing.assert_array_equal(names["run"].q, run.q)
    np.testing.assert_array_equal(names["run"].t, run.t)
    return run, said


@pytest.mark.parametrize("case", SHORT, ids=lambda case: f"{case.name}-{case.seed}")
def test_the_lines_of_python_make_the_same_run(case, monkeypatch):
    monkeypatch.setattr(fl, "verify", lambda name, run: name)  # verdicts take long; one case has them below
    _, said = same(case)
    assert said.split() == list(case.parts.theorems)


def test_they_print_the_verdicts():
    case = Case("scenario", "head-on", changes={"gains.c1_alpha": 20.0})
    run, said = same(case)
    assert [fl.verify(name, run).status for name in case.parts.theorems] == [
        line.split()[1] for line in said.splitlines() if not line.startswith(" ")
    ]


def test_a_saved_run_is_shown_as_it_is_until_something_changes(tmp_path):
    rng = np.random.default_rng(0)
    run = fl.simulate(fl.Algorithm1(), rng.normal(0, 6, (4, 2)), rng.normal(0, 1, (4, 2)), (1.0, 1.5), rtol=1e-6)
    path = str(run.save(tmp_path / "run.nc"))
    case = Case("file", path)
    np.testing.assert_array_equal(case.parts.recorded.q, run.q)
    assert made(case)[0]["run"].q.tolist() == run.q.tolist()
    touched = Case("file", path, moved={1: (0.0, 0.0)})
    assert touched.parts.recorded is None
    assert touched.parts.options["rtol"] == 1e-6
    same(touched)


def test_a_counterexample_brings_its_theorem_and_tolerances(tmp_path):
    item, loose = fl.scenario("head-on"), fl.Tolerances(energy=1e-5)
    found = sealed(
        Counterexample("energy", "rate", "head-on", item.law, item.q0, item.p0, (0.0, 0.5), tolerances=loose)
    )
    case = Case("file", str(found.save(tmp_path / "found.json")))
    assert (case.parts.theorems, case.parts.tolerances) == (("energy",), loose)
    assert "tolerances=found.tolerances" in program(case.parts)
    same(case)


@pytest.mark.parametrize(
    "asked",
    [
        {"kind": "scenario"},
        {"kind": "module", "name": "os"},
        {"kind": "scenario", "name": "hexagon", "law": {}},
        {"kind": "law", "name": "Algorithm1.__class__"},
        {"kind": "law", "name": "Algorithm1", "n": 2.5},
        {"kind": "scenario", "name": "hexagon", "seed": -1},
        {"kind": "scenario", "name": "hexagon", "duration": "5"},
        {"kind": "scenario", "name": "hexagon", "moved": {"7": [0, 0]}},
        {"kind": "scenario", "name": "hexagon", "moved": {"0": [0, 0, 0]}},
        {"kind": "scenario", "name": "hexagon", "moved": {"-1": [0, 0]}},
        {"kind": "scenario", "name": "hexagon", "changes": [1]},
        {"kind": "file", "name": "/etc/passwd"},
    ],
)
def test_what_is_no_case_is_an_error_of_ours(asked):
    with pytest.raises((ArgumentError, FileError)):
        _ = Case.of(asked).parts
