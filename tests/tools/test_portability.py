"""The portability matrix: which machine code a machine can give, what counts as changed, and children that die."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

from flockana import scenario
from flockana.theorems import Tolerances
from tools.portability import __main__ as command
from tools.portability import worker
from tools.portability.__main__ import NATIVE, Matrix, Row, changes, differences, environments, table

AVX512 = {
    "machine": "x86_64",
    "libc": "glibc",
    "libm": "new",
    "openblas": {"numpy's": ["SkylakeX", True], "casadi's": ["CORE2", False]},
    "numba": ["znver5", ["avx512f"]],
    "numpy": ["X86_V3", "X86_V4", "AVX512_ICL"],
    "processor": ["SSE42", "AVX", "AVX2", "FMA3", "AVX512F", "AVX512_SKX", "X86_V3", "X86_V4", "AVX512_ICL"],
}


def verdicts(statuses=(), *, run="complete", expected=(), residual=None):
    return {"run": run, "statuses": dict(statuses), "expected": dict(expected), "residual": residual}


# what a machine can give


def test_a_machine_with_everything_gives_every_environment():
    given, notices = environments(AVX512)
    cores = {name: one["OPENBLAS_CORETYPE"] for name, one in given.items() if name.startswith("blas-")}
    assert list(cores.values()) == ["Prescott", "Nehalem", "Sandybridge", "Haswell", "SkylakeX"]
    assert not notices
    # a Haswell has AVX2, so X86_V3 stays; and numba adds the features of the processor at hand unless told not to
    assert given["haswell"] == {
        "OPENBLAS_CORETYPE": "Haswell",
        "NUMBA_CPU_NAME": "haswell",
        "NUMBA_CPU_FEATURES": "",
        "NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL",
    }
    assert given["generic"]["OPENBLAS_CORETYPE"] == "Prescott"
    assert given["generic"]["NPY_DISABLE_CPU_FEATURES"] == "X86_V3 X86_V4 AVX512_ICL"
    assert given["generic"]["GLIBC_TUNABLES"] == given["libm"]["GLIBC_TUNABLES"]


def test_what_a_machine_lacks_is_left_out_and_said():
    found, notices = environments(AVX512 | {"libc": "musl", "processor": ["SSE42", "AVX"], "numpy": ["AVX"]})
    assert list(found) == [
        "blas-prescott",
        "blas-nehalem",
        "blas-sandybridge",
        "numba-generic",
        "numpy-generic",
        "generic",
    ]
    assert [notice.split(":")[0] for notice in notices] == [
        "blas-haswell is left out",
        "blas-skylakex is left out",
        "libm is left out",
    ]
    assert notices[0].endswith("the processor has no AVX2, FMA3")
    assert "GLIBC_TUNABLES" not in found["generic"]


def test_other_processors_vary_no_machine_code():
    assert environments(AVX512 | {"machine": "arm64"}) == ({}, ["machine code is not varied: arm64 is no x86-64"])


@pytest.mark.parametrize(
    ("settings", "here", "reason"),
    [
        (
            {"OPENBLAS_CORETYPE": "Prescott"},
            {"openblas": {"numpy's": ["Katmai", True], "casadi's": ["CORE2", False]}},
            "",
        ),
        ({"OPENBLAS_CORETYPE": "Nehalem"}, {}, "asked for the core Nehalem, got {\"numpy's\": 'SkylakeX'}"),
        ({"OPENBLAS_CORETYPE": "Nehalem"}, {"openblas": {}}, "no OpenBLAS whose core can be chosen"),
        ({"GLIBC_TUNABLES": "x"}, {}, "libm computes the same"),
        ({"GLIBC_TUNABLES": "x"}, {"libm": "old"}, ""),
        ({"NUMBA_CPU_NAME": "generic"}, {}, "asked numba for generic, got znver5"),
        ({"NUMBA_CPU_NAME": "generic"}, {"numba": ["generic", []]}, ""),
        ({"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4"}, {"numpy": ["X86_V3"]}, "numpy still uses X86_V3"),
        ({"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4"}, {"numpy": ["AVX512_ICL"]}, ""),
        ({"OPENBLAS_CORETYPE": "SkylakeX"}, {}, "this is the machine as it is"),
    ],
)
def test_an_environment_without_its_effect_is_told(settings, here, reason):
    told = worker.unfit(settings, AVX512, AVX512 | here)
    assert reason in told
    assert bool(told) is bool(reason)


# what is changed in an entry


def test_a_start_is_moved_by_so_much_of_each_value():
    item = scenario("collapse")
    first, again, other = (worker.moved(item, draw) for draw in (1, 1, 2))
    np.testing.assert_array_equal(first.q0, again.q0)
    assert not np.array_equal(first.q0, other.q0)
    share = np.abs(first.q0 / item.q0 - 1.0)
    assert 0.9e-13 < share.max() < 1.1e-13  # 300 uniform draws: the largest is near the bound, 2e-16 of rounding
    assert np.array_equal(first.p0 == 0.0, item.p0 == 0.0)


def test_the_solver_is_changed_where_it_has_a_tolerance():
    assert worker.resolved(scenario("hexagon"), 0.5).options == {"rtol": 5e-9}
    large = worker.resolved(scenario("paper-split-rejoin"), 2.0).options
    assert (large["rtol"], large["atol"]) == (2e-7, 2e-9)
    assert len(large["t_eval"]) > 100
    assert worker.resolved(scenario("notebook-algorithm1", push=True), 0.5).options == {"method": "RK4", "dt": 0.0025}
    assert worker.resolved(scenario("msn-case1-printed"), 0.5) is None


def test_thresholds_for_zero_and_thresholds_that_define_are_told_apart():
    given, twice, defined = Tolerances(), worker.scaled(2.0, 1.0), worker.scaled(1.0, 0.5)
    assert twice.energy == 2.0 * given.energy
    assert (twice.quasi, twice.cohesion, twice.giant) == (given.quasi, given.cohesion, given.giant)
    assert (defined.energy, defined.quasi, defined.cohesion) == (given.energy, 0.5 * given.quasi, given.cohesion)


def test_the_name_of_every_threshold_is_known():
    assert {*worker.DEFINITIONS, *worker.FIXED} <= set(Tolerances.__dataclass_fields__)


def test_a_worker_tells_statuses_as_an_entry_expects_them():
    found = worker.outcome("three-agents-1d")
    assert found["run"] == "complete"
    assert set(found["expected"]) <= set(found["statuses"])
    assert found["statuses"]["E13:printed"] == "refuted"
    alone = worker.outcome("E8")
    assert alone["expected"]["E8"] == alone["statuses"]["E8"] == "refuted"
    assert alone["statuses"]["E8:printed"] == "refuted"
    assert worker.outcome("E8", draw=1) is None
    assert worker.outcome("msn-case2-printed", solver=0.5) is None


def test_a_worker_tells_an_error_and_goes_on():
    told = worker.answer({"name": "nowhere", "changes": {"native": {}}})
    assert told["outcomes"]["native"]["run"].startswith("UnknownNameError: ")


# what counts as changed


def rows(there, here, **options):
    return list(differences("flock", "generic", there, here, **options))


def test_the_same_statuses_make_no_row():
    same = verdicts({"os-3": "refuted", "os-3:i": "refuted"}, expected={"os-3": "refuted"}, residual=0.1)
    assert rows(same, same, share=0.2) == []


def test_a_claim_that_differs_is_a_row_and_its_verdict_only_where_expected():
    here = verdicts({"os-3": "verified", "os-3:i": "verified", "os-3:ii": "vacuous"})
    there = verdicts({"os-3": "inconclusive", "os-3:i": "inconclusive", "os-3:ii": "vacuous"})
    assert rows(there, here) == [Row("flock", "os-3", "i", "generic", "inconclusive", "verified", "")]
    expected = {"expected": {"os-3": "verified"}}
    assert [(row.claim, row.expected) for row in rows(there | expected, here | expected)] == [
        ("", "verified"),
        ("i", ""),
    ]


def test_what_is_not_as_expected_is_a_row_even_if_it_is_so_everywhere():
    same = verdicts({"E": "verified", "E:i": "verified"}, expected={"E:i": "refuted", "E:ii": "verified"})
    assert rows(same, same) == [
        Row("flock", "E", "i", "generic", "verified", "verified", "refuted"),
        Row("flock", "E", "ii", "generic", "missing", "missing", "verified"),
    ]


def test_a_claim_that_is_missing_on_either_side_is_a_row():
    one, none = verdicts({"E": "verified", "E:i": "verified"}), verdicts({"E": "verified"})
    assert [(row.there, row.here) for row in rows(none, one)] == [("missing", "verified")]
    assert [(row.there, row.here) for row in rows(one, none)] == [("verified", "missing")]


def test_a_run_that_fails_is_one_row():
    here = verdicts({"E": "verified", "E:i": "verified"}, expected={"E": "verified"})
    (row,) = rows(verdicts(run="the worker ended by SIGILL"), here)
    assert (row.claim, row.there, row.here) == ("run", "the worker ended by SIGILL", "complete")
    assert len(rows(here, verdicts(run="the worker ended by SIGILL"))) == 1
    assert len(rows(verdicts(run="failed"), verdicts(run="failed"))) == 1  # nowhere is it a run


@pytest.mark.parametrize(("residual", "count"), [(0.19, 0), (0.21, 1), (float("nan"), 1), (None, 0)])
def test_the_balance_of_energy_may_use_a_share_of_its_tolerance(residual, count):
    found = rows(verdicts(residual=residual), verdicts(residual=None), share=0.2)
    assert len(found) == count
    assert rows(verdicts(residual=residual), verdicts(residual=None)) == []


def test_the_table_has_a_column_for_each_field():
    head, line = table([Row("flock", "os-3", "i", "generic", "verified", "refuted", "")]).splitlines()
    assert head.split() == ["scenario", "theorem", "claim", "variant", "there", "here", "expected"]
    assert line.split() == ["flock", "os-3", "i", "generic", "verified", "refuted"]
    assert head.index("variant") == line.index("generic")


# children

FAKE = f"""
import json, os, sys, time
told = json.loads(sys.stdin.readline())
with open(__file__ + ".starts", "a") as starts:
    print(os.environ.get("OPENBLAS_CORETYPE"), os.environ.get("NUMBA_CACHE_DIR"), file=starts)
unfit = "too old" if os.environ.get("OPENBLAS_CORETYPE") == "Nehalem" else ""
here = {AVX512!r} | {{"unfit": unfit, "scenarios": ["deadly", "endless", "a", "b", "c"], "fixed": ["E8"]}}
print(json.dumps(here), flush=True)
for line in sys.stdin if not unfit else ():
    request = json.loads(line)
    if request["name"] == "deadly" and "NUMBA_CPU_NAME" in os.environ:
        print("illegal", file=sys.stderr, flush=True)
        os.kill(os.getpid(), {int(signal.SIGILL)})
    if request["name"] == "endless":
        open(__file__ + ".endless", "w").close()
        time.sleep(600)
    status = "refuted" if request["name"] == "a" and "NUMBA_CPU_NAME" in os.environ else "verified"
    one = {{"run": "complete", "statuses": {{"E:i": status}}, "expected": {{}}}}
    print(json.dumps({{"outcomes": dict.fromkeys(request["changes"], one), "seconds": 1.0}}), flush=True)
"""
GENERIC = {"NUMBA_CPU_NAME": "generic"}


@pytest.fixture
def fake_worker(tmp_path, monkeypatch):
    """Children that run no flock; what chooses machine code outside must not reach them."""
    (tmp_path / "worker.py").write_text(FAKE)
    monkeypatch.setattr(command, "HERE", tmp_path)
    monkeypatch.setenv("OPENBLAS_CORETYPE", "outside")
    return tmp_path


def carried_out(folder, where, names, *, jobs=2, asked=None):
    matrix = Matrix(folder / "caches")
    matrix.carry_out(where, names, asked or {NATIVE: {}}, jobs)
    return matrix


@pytest.mark.parametrize("jobs", [1, 3])
def test_every_entry_is_run_once_in_every_environment(fake_worker, jobs):
    asked = {NATIVE: {}, "moved-1": {"draw": 1}}
    matrix = carried_out(fake_worker, {NATIVE: {}, "generic": GENERIC}, ["a", "b", "c"], jobs=jobs, asked=asked)
    assert set(matrix.outcomes) == {NATIVE, "moved-1", "generic"}
    assert all(sorted(found) == ["a", "b", "c"] for found in matrix.outcomes.values())
    assert matrix.seconds == {NATIVE: 1.5, "moved-1": 1.5, "generic": 3.0}
    assert matrix.rows(None) == [Row("a", "E", "i", "generic", "refuted", "verified", "")]
    starts = {tuple(line.split()) for line in (fake_worker / "worker.py.starts").read_text().splitlines()}
    assert starts == {("None", "None"), ("None", str(fake_worker / "caches/generic"))}


def test_a_child_that_dies_costs_its_entry_alone(fake_worker):
    matrix = carried_out(fake_worker, {NATIVE: {}, "generic": GENERIC}, ["b", "deadly", "c"], jobs=1)
    assert matrix.outcomes["generic"]["deadly"]["run"] == "the worker ended by SIGILL: illegal"
    assert matrix.outcomes["generic"]["b"]["run"] == matrix.outcomes["generic"]["c"]["run"] == "complete"


def test_an_environment_without_effect_is_left_out_and_said_once(fake_worker, capsys):
    matrix = carried_out(fake_worker, {NATIVE: {}, "old": {"OPENBLAS_CORETYPE": "Nehalem"}}, ["a", "b"], jobs=2)
    assert list(matrix.outcomes) == [NATIVE]
    assert matrix.left_out == {"old": "too old"}
    assert capsys.readouterr().err.count("old is left out: too old") == 1


def test_an_interrupt_ends_the_children_and_what_was_found_is_told(fake_worker, monkeypatch, capsys):
    class Interrupted(Matrix):
        def work(self, *given):
            super().work(*given)
            raise KeyboardInterrupt  # as the main thread has it from `result`

    def end():
        while not (fake_worker / "worker.py.endless").exists():
            time.sleep(0.01)
        for child in list(matrices[0].children):
            child.kill()

    matrices = []
    monkeypatch.setattr(command, "Matrix", lambda caches: matrices.append(Interrupted(caches)) or matrices[0])
    threading.Thread(target=end, daemon=True).start()
    assert command.main(["a", "endless", "--variants", "moved-1", "--jobs", "1"]) == 130
    assert "worker ended by SIGKILL" in capsys.readouterr().out
    assert list(matrices[0].outcomes["moved-1"]) == ["a", "endless"]
    assert not matrices[0].children


def test_a_child_that_never_answers_ends_by_itself():
    code = "import sys; sys.path.insert(0, sys.argv[1]); import worker, time; worker.LIMIT = 0.5; "
    code += "worker.machine = dict; worker.answer = lambda request: time.sleep(600); worker.main()"
    given = '{"settings": {}, "native": null}\n{"name": "E8", "changes": {}}\n'
    folder = str(command.HERE)
    done = subprocess.run(
        [sys.executable, "-c", code, folder], input=given, capture_output=True, text=True, env=os.environ
    )
    assert done.returncode == 1
    assert "Timeout" in done.stderr


def test_a_child_that_does_not_begin_is_bad_input(fake_worker, capsys):
    (fake_worker / "worker.py").write_text("raise SystemExit('no numba')")
    assert command.main(["E8"]) == 2
    assert "the worker ended by exit status 1: no numba" in capsys.readouterr().err


# the command


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (["E99"], "no entry is called E99; there are "),
        (["--variants", "blas"], "no variant is called blas; there are native, "),
        (["--jobs", "0"], "--jobs 0 --draws 5: expected at least 1 and 0"),
    ],
)
def test_bad_input_is_2_and_says_what_there_is(fake_worker, capsys, given, message):
    assert command.main(given) == 2
    assert message in capsys.readouterr().err


def test_what_is_claimed_is_changed_only_on_demand():
    names = list(changes(1))
    assert "definitions-halved" in names
    assert not any(name.startswith("definitions") for name in command.choose(names, ()))
    chosen = command.choose(names, ("definitions-*", "moved-1"))
    assert chosen == ["definitions-halved", "definitions-doubled", "moved-1"]


def test_a_moved_start_of_a_small_flock_changes_nothing(tmp_path, capsys):
    """From end to end: two agents that stay far from every threshold, and an erratum that needs no run."""
    told = tmp_path / "told.json"
    assert command.main(["head-on", "E8", "--variants", "moved-1", "--jobs", "1", "--json", str(told)]) == 0
    printed = capsys.readouterr().out
    assert "nothing changed: 2 variants of" in printed
    assert "numba " in printed
    outcomes = json.loads(told.read_text())["outcomes"]
    assert outcomes["moved-1"]["head-on"]["statuses"] == outcomes[NATIVE]["head-on"]["statuses"]
    assert outcomes["moved-1"]["E8"] is None
