"""The portability matrix: machine code that a machine can give, what counts as changed, and children that die."""

import sys

import numpy as np
import pytest

from flockana import Tolerances, scenario
from tools import portability
from tools.portability import Row, changes, choose, differences, environments, outcome, table, unfit

AVX512 = {
    "machine": "x86_64",
    "libc": "glibc",
    "libm": "new",
    "openblas": {"numpy's": "SkylakeX"},
    "numba": "znver5",
    "numpy": ["X86_V3", "X86_V4", "AVX512_ICL"],
    "processor": ["sse4_2", "avx", "avx2", "fma", "avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"],
}


def test_a_machine_gives_the_environments_that_it_can_run():
    given = environments(AVX512)
    cores = [one["OPENBLAS_CORETYPE"] for name, one in given.items() if name.startswith("blas-")]
    assert cores == ["Prescott", "Nehalem", "Sandybridge", "Haswell", "SkylakeX"]
    # a Haswell has AVX2, so X86_V3 stays; and numba adds the features of the processor at hand unless told not to
    assert given["haswell"] == {
        "OPENBLAS_CORETYPE": "Haswell",
        "NUMBA_CPU_NAME": "haswell",
        "NUMBA_CPU_FEATURES": "",
        "NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL",
    }
    assert given["generic"]["NPY_DISABLE_CPU_FEATURES"] == "X86_V3 X86_V4 AVX512_ICL"
    assert given["generic"]["GLIBC_TUNABLES"] == given["libm"]["GLIBC_TUNABLES"]
    small = environments(AVX512 | {"libc": "musl", "processor": ["sse4_2", "avx"], "numpy": ["AVX"]})
    blas = ["blas-prescott", "blas-nehalem", "blas-sandybridge"]
    assert list(small) == [*blas, "numba-generic", "numpy-generic", "generic"]
    assert environments(AVX512 | {"machine": "arm64"}) == {}


@pytest.mark.parametrize(
    ("settings", "here", "reason"),
    [
        ({"OPENBLAS_CORETYPE": "Prescott"}, {"openblas": {"numpy's": "Katmai"}}, ""),
        ({"OPENBLAS_CORETYPE": "Nehalem"}, {}, "asked for the core Nehalem, got {\"numpy's\": 'SkylakeX'}"),
        ({"OPENBLAS_CORETYPE": "Nehalem"}, {"openblas": {}}, "asked for the core Nehalem, got {}"),
        ({"GLIBC_TUNABLES": "x"}, {}, "libm computes the same"),
        ({"GLIBC_TUNABLES": "x"}, {"libm": "old"}, ""),
        ({"NUMBA_CPU_NAME": "generic"}, {"numba": "generic"}, ""),
        ({"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4"}, {"numpy": ["X86_V3"]}, "numpy still uses X86_V3"),
        ({"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4"}, {"numpy": ["AVX512_ICL"]}, ""),
        ({"OPENBLAS_CORETYPE": "SkylakeX"}, {}, "this is the machine as it is"),
    ],
)
def test_an_environment_without_its_effect_is_left_out(settings, here, reason):
    found = unfit(settings, AVX512, AVX512 | here)
    assert reason in found
    assert bool(found) is bool(reason)


def test_a_start_is_moved_by_so_much_of_each_value():
    item = scenario("collapse")
    first, again, other = (portability.changed_entry(item, draw, 1.0, 1.0, 1.0) for draw in (1, 1, 2))
    np.testing.assert_array_equal(first.q0, again.q0)
    assert not np.array_equal(first.q0, other.q0)
    assert 0.9e-13 < np.abs(first.q0 / item.q0 - 1.0).max() < 1.1e-13  # of 300 uniform draws, and 2e-16 of rounding


@pytest.mark.parametrize(
    ("name", "options", "factor", "found"),
    [
        ("hexagon", {}, 0.5, {"rtol": 5e-9}),
        ("paper-split-rejoin", {}, 2.0, {"rtol": 2e-7, "atol": 2e-9}),
        ("notebook-algorithm1", {"push": True}, 0.5, {"method": "RK4", "dt": 0.0025}),
    ],
)
def test_the_solver_is_changed_where_it_has_a_tolerance(name, options, factor, found):
    given = portability.changed_entry(scenario(name, **options), 0, factor, 1.0, 1.0).options
    assert {key: value for key, value in given.items() if key != "t_eval"} == found


def test_thresholds_for_zero_and_thresholds_that_define_are_told_apart():
    given, twice, defined = Tolerances(), portability.scaled(2.0, 1.0), portability.scaled(1.0, 0.5)
    assert twice.energy == 2.0 * given.energy
    assert (twice.quasi, twice.cohesion, twice.giant) == (given.quasi, given.cohesion, given.giant)
    assert (defined.energy, defined.quasi, defined.cohesion) == (given.energy, 0.5 * given.quasi, given.cohesion)
    assert {*portability.DEFINITIONS, *portability.FIXED} <= set(Tolerances.__dataclass_fields__)


def test_an_outcome_has_statuses_as_an_entry_expects_them():
    found = outcome("three-agents-1d")
    assert found["run"] == "complete"
    assert set(found["expected"]) <= set(found["statuses"])
    assert found["statuses"]["E13:printed"] == "refuted"
    assert outcome("E8")["statuses"]["E8:printed"] == "refuted"
    assert outcome("E8", draw=1) is outcome("msn-case2-printed", solver=0.5) is None


def verdicts(statuses=(), *, run="complete", expected=(), residual=None):
    return {"run": run, "statuses": dict(statuses), "expected": dict(expected), "residual": residual}


ONE, NONE = {"E": "verified", "E:i": "verified"}, {"E": "verified"}
DEAD = verdicts(run="the child ended with status -4")


@pytest.mark.parametrize(
    ("there", "here", "found"),
    [
        (verdicts(ONE, expected=ONE), verdicts(ONE, expected=ONE), []),
        (verdicts({"E": "x", "E:i": "x"}), verdicts(ONE), [("E", "i", "x", "verified", "")]),
        (verdicts({"E": "x"}, expected=NONE), verdicts(NONE), [("E", "", "x", "verified", "verified")]),
        (verdicts(ONE, expected={"E:i": "refuted"}), verdicts(ONE), [("E", "i", "verified", "verified", "refuted")]),
        (verdicts(NONE), verdicts(ONE), [("E", "i", "missing", "verified", "")]),
        (verdicts(ONE), verdicts(NONE), [("E", "i", "verified", "missing", "")]),
        (DEAD, verdicts(ONE), [("", "run", "the child ended with status -4", "complete", "complete")]),
        (verdicts(run="failed"), verdicts(run="failed"), [("", "run", "failed", "failed", "complete")]),
    ],
)
def test_what_counts_as_changed(there, here, found):
    rows = list(differences("flock", "generic", there, here))
    assert [(row.theorem, row.claim, row.there, row.here, row.expected) for row in rows] == found
    if rows:
        head, line = table(rows).splitlines()
        assert head.split() == list(Row._fields)
        assert head.index("variant") == line.index("generic")


@pytest.mark.parametrize(("residual", "count"), [(0.19, 0), (0.21, 1), (float("nan"), 1), (None, 0)])
def test_the_balance_of_energy_may_use_a_share_of_its_tolerance(residual, count):
    pair = verdicts(residual=residual), verdicts(residual=None)
    assert len(list(differences("flock", "generic", *pair, share=0.2))) == count
    assert list(differences("flock", "generic", *pair)) == []


def test_a_child_that_dies_costs_its_entry_alone(monkeypatch, tmp_path):
    """Three entries, the second of which ends the child."""

    def asked(settings, caches, requests):
        names = [name for name, _ in requests]
        done = names[: names.index("deadly")] if "deadly" in names else names
        return [AVX512, *({"native": {"run": name}} for name in done)], "killed" if "deadly" in names else ""

    monkeypatch.setattr(portability, "ask", asked)
    here, found = portability.work({}, tmp_path, ["b", "deadly", "c"], {"native": {}})
    assert here is AVX512
    assert {name: one["native"]["run"] for name, one in found.items()} == {"b": "b", "deadly": "killed", "c": "c"}


def test_a_child_that_never_answers_ends_by_itself(monkeypatch, tmp_path):
    code = "import time\nfrom tools import portability\nportability.LIMIT = 0.5\nportability.machine = dict\n"
    code += "portability.outcome = lambda name: time.sleep(600)\nportability.child()\n"
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    (tmp_path / "python").write_text(f"#!/bin/sh\nexec {sys.orig_argv[0]} -c '{code}'\n")
    (tmp_path / "python").chmod(0o755)
    answers, ended = portability.ask({}, tmp_path, [("E8", {"native": {}})])
    assert answers == [{}]
    assert ended.startswith("the child ended with status 1: ")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (["E99"], "no entry is called E99; there are hexagon, E8"),
        (["--variants", "blas"], "no variant is called blas; there are native, "),
        (["--jobs", "0"], "--jobs 0 --draws 5: expected at least 1 and 0"),
    ],
)
def test_bad_input_is_2_and_says_what_there_is(monkeypatch, capsys, given, message):
    known = AVX512 | {"scenarios": ["hexagon"], "fixed": ["E8"]}
    monkeypatch.setattr(portability, "ask", lambda settings, caches, requests: ([known], ""))
    assert portability.main(given) == 2
    assert message in capsys.readouterr().err


def test_what_is_claimed_is_changed_only_on_demand():
    names = list(changes(1))
    assert "definitions-halved" in names
    assert not any(name.startswith("definitions") for name in choose(names, ()))
    assert choose(names, ("definitions-*", "moved-1")) == ["definitions-halved", "definitions-doubled", "moved-1"]


def test_a_moved_start_of_a_small_flock_changes_nothing(capsys):
    """From end to end: two agents that stay far from every threshold, and an erratum that needs no run."""
    assert portability.main(["head-on", "E8", "--variants", "moved-1", "--jobs", "1"]) == 0
    assert "no rows differ: 2 variants of" in capsys.readouterr().out
