import json
import os
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from textwrap import indent

import numpy as np
import pytest
from PIL import Image
from rich.cells import cell_len

from flockana import Algorithm1, Trajectory
from flockana.base.errors import FlockanaError, SolverError
from flockana.cli import main as command_line
from flockana.report.seed_surveys import Survey
from flockana.report.stability import NO_FLOCKS
from flockana.report.verify_catalogue import Task, check_all, plan
from flockana.scenarios import Report, Scenario
from flockana.theorems import Claim
from tests.programs import ANSWERS_CTRL_C, CLI, IGNORES_CTRL_C, group, interrupt, out_of_a_kernel, posix, program, until

scenario_module = import_module("flockana.scenarios.scenario")  # where a function has the module's name


def tiny(name="tiny", status="refuted"):
    def build(seed=0):
        q = np.array([[0.0], [7.5 + seed]])
        span = (0.0, 0.5)
        expected = {"energy": status}
        return Scenario(name, "Two agents on a line", "ours", Algorithm1(), q, 0.0 * q, span, seed, expected)

    return build


def verdicts(folder):
    return json.loads(Path(folder, "verdicts.json").read_text(encoding="utf-8"))


@pytest.fixture
def catalogue(offer):
    """A catalogue of two small scenarios: one meets its expectation, the other does not."""
    offer(right=tiny("right", "verified"), wrong=tiny("wrong", "refuted"))


def test_as_expected_is_0_and_a_surprise_is_3(call, catalogue):
    code, out, err = call("verify", "right", "--no-report")
    assert (code, err) == (0, "")
    assert "all as expected" in out
    code, out, err = call("verify", "wrong", "--no-report")
    assert code == 3
    assert "wrong: energy is verified, expected refuted" in out


def test_a_theorem_runs_every_scenario_that_names_it(call, catalogue):
    code, out, _ = call("verify", "energy", "--jobs", 1)
    assert code == 3
    assert "2 verdicts" in out
    assert os.path.getsize("report/index.html") > 10_000
    assert [v["subject"] for v in verdicts("report")["verdicts"]] == ["right", "wrong"]


def test_a_fixed_theorem_runs_by_itself(call):
    code, out, err = call("verify", "E8", "--no-report")
    assert (code, err) == (0, "")
    assert "rank(A)/n" in out
    assert "1 verdict in" in out
    assert not os.path.exists("report")


def test_json_is_all_that_is_printed(call, catalogue):
    code, out, err = call("verify", "right", "--json", "--seed", 1, "--output", "there")
    data = json.loads(out)
    assert (code, err, data["seed"], data["verdicts"][0]["status"]) == (0, "", 1, "verified")
    assert verdicts("there")["verdicts"] == data["verdicts"]


def test_shares_over_seeds_are_told_when_asked_for(call):
    code, out, err = call("verify", "zone-gap", "--seeds", 3, "--jobs", 1)
    (told,) = verdicts("report")["statistics"]["scenarios"]
    assert (code, err, told["runs"], told["rows"][0]["verified"]["count"]) == (0, "", 3, 3)
    assert "zone-gap, 3 seeds" in out
    assert "Clopper" in Path("report", "index.html").read_text(encoding="utf-8")
    code, out, _ = call("verify", "zone-gap", "--jobs", 1, "--no-report", "--json")
    assert (code, json.loads(out)["statistics"]) == (0, None)


def test_the_whole_catalogue_tells_shares_of_who_asks_for_them(call, offer, monkeypatch):
    claim = Claim("apart", "verified")
    one = replace(tiny("right", "verified")(), reports=(Report("apart", "all apart", lambda *given: claim),), seeds=26)
    offer(right=lambda seed=0: replace(one, seed=seed), wrong=tiny("wrong", "verified"))
    monkeypatch.setattr("flockana.report.verify_catalogue.theorems", lambda: ("energy",))
    monkeypatch.setattr(
        "flockana.report.verify_catalogue._section", lambda task: NO_FLOCKS
    )  # tests/report makes sections
    code, out, _ = call("verify", "--jobs", 1)
    (told,) = verdicts("report")["statistics"]["scenarios"]
    assert (code, told["scenario"], told["rows"][0]["verified"]["count"]) == (0, "right", 26)
    assert "shares of runs over many seeds: in the report" in out
    _, out, _ = call("verify", "--jobs", 1, "--seeds", 0, "--no-report", "--json")
    assert json.loads(out)["statistics"] is None
    _, out, _ = call("verify", "--jobs", 1, "--no-report", "--seeds", 2)
    assert "right, 2 seeds" in out
    assert "seeds" not in call("verify", "--jobs", 1, "--no-report")[1]


def test_errata_are_all_and_only_the_errata():
    names = [task.name for task in plan("errata") if task.fixed]
    assert {"E1", "E3", "E7", "E8", "E9", "E10"} <= set(names)
    assert all(name[0] in "EJL" for name in names)
    runs = {task.name: task.only for task in plan("errata") if not task.fixed}
    assert runs["collapse"] == ("E11",)
    assert runs["three-agents-1d"] == ("E13",)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["verify", "colapse"], "unknown scenario or theorem 'colapse'; did you mean 'collapse'?"),
        (["verify", "os-1", "--seeds", "2"], "expected a scenario whose source reports an outcome, got os-1"),
        (["verify", "zone-51", "--seeds", "2", "--on", "x.nc"], "a case has one seed"),
        (["verify", "--jobs", "0"], "greater than or equal to 1; got '0'"),
        (["verify", "--on", "run.nc"], "--on CASE needs a NAME"),
        (["verify", "os-1", "--on", "none.nc"], "no file none.nc"),
        (["verify", "E8", "--on", "none.nc"], "E8 is not about a run"),
        (["verify", "errata", "--on", "none.nc"], "a case is checked by one scenario or theorem; name one"),
        (["verify", "hexagon", "--no-report", "--output", "x"], "--output x: --no-report writes none; leave out one"),
        (["ensemble", "hexagon", "--retry"], "--retry: without a store no failed runs are known; give --store FILE"),
        (["run", "hexagon", "-o", "."], ". is a folder"),
        (["animate", "hexagon", "-o", "x.png"], "expected a file name that ends in .gif or .mp4"),
        (["flock"], "unknown command 'flock'; known: animate, check, "),
        (["verfy"], "unknown command 'verfy'; did you mean 'verify'? Known: "),
        ([""], "unknown command ''"),
        (["verify", "--colour"], "--colour"),
    ],
)
def test_bad_input_is_2_and_one_line(refused, arguments, message):
    refused(message, *arguments)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("verify",), "cannot write to report: there is a file of that name"),
        (("run", "-o", "report/run.nc"), "cannot write to report"),
        (("animate", "-o", "report/x.gif"), "cannot write to report"),
        (("animate", "-o", "x.mp4"), "needs the program ffmpeg"),
    ],
)
def test_what_cannot_be_written_is_refused_before_anything_runs(refused, monkeypatch, tmp_path, arguments, message):
    (tmp_path / "report").write_text("a file")
    monkeypatch.setattr("flockana.report.verify_catalogue.check", lambda task: pytest.fail("it ran"))
    monkeypatch.setattr(Scenario, "run", lambda *a, **k: pytest.fail("it ran"))
    monkeypatch.setattr("matplotlib.animation.FFMpegWriter.isAvailable", classmethod(lambda cls: False))
    refused(message, arguments[0], "hexagon", *arguments[1:])


def test_animate_writes_a_film(call, catalogue, monkeypatch, tmp_path):
    film = ("animate", "right", "-o", "film.gif", "--seconds", 0.3, "--fps", 10)
    code, out, err = call(*film)
    assert (code, err) == (0, "")
    assert "written: film.gif" in out
    with Image.open(tmp_path / "film.gif") as image:
        assert image.n_frames == 3
    whole = Scenario.run
    for status, expected in (("failed", 3), ("interrupted", 130)):
        monkeypatch.setattr(Scenario, "run", lambda self, s=status, **k: replace(whole(self), status=s))
        assert call(*film)[0] == expected
        assert call("run", "right", "-o", "run.nc")[0] == expected
        assert Trajectory.load(tmp_path / "run.nc").status == status


def test_run_saves_and_verify_reads_it_back(call, catalogue, tmp_path):
    code, out, err = call("run", "right", "-o", "run.nc", "--seed", 1)
    assert (code, err) == (0, "")
    assert "saved: run.nc" in out
    assert "energy H" in out
    saved = Trajectory.load(tmp_path / "run.nc")
    assert saved.q[0, 1, 0] == 8.5
    assert call("verify", "energy", "--on", "run.nc")[0] == 0  # nothing is expected of a saved run by itself
    assert call("verify", "right", "--on", "run.nc", "--no-report")[0] == 0
    assert call("verify", "wrong", "--on", "run.nc", "--no-report")[0] == 3
    assert "run.nc" in Path("report/index.html").read_text(encoding="utf-8")


def test_a_run_of_another_scenario_is_refused(call, catalogue, tmp_path):
    call("run", "right", "-o", "run.nc")
    run = Trajectory.load(tmp_path / "run.nc")
    assert run.n == 2
    replace(run, q=run.q[:, :1], p=run.p[:, :1], u=run.u[:, :1], extra={}).save(tmp_path / "one.nc")
    code, _, err = call("verify", "right", "--on", "one.nc")
    assert code == 2
    assert "one.nc holds no run of right" in err


def broken(patch, error):
    """Let the second scenario raise where it is verified."""
    verify = scenario_module.verify

    def breaking(theorem, run, **options):
        if options["subject"] == "wrong":
            raise error
        return verify(theorem, run, **options)

    patch.setattr(scenario_module, "verify", breaking)


@pytest.mark.parametrize("error", [KeyboardInterrupt(), out_of_a_kernel()])
def test_what_was_done_before_an_interrupt_is_reported(error, call, catalogue, monkeypatch):
    broken(monkeypatch, error)
    for _ in range(2):  # another report that was broken off may be replaced
        code, out, err = call("verify", "energy", "--jobs", 1)
        assert code == 130
        assert err == "flockana: interrupted\n"
        assert "1 verdict in" in out
        data = verdicts("report")
        assert (data["complete"], len(data["verdicts"])) == (False, 1)


def test_a_complete_report_is_not_replaced_by_one_that_was_broken_off(call, catalogue, monkeypatch):
    assert call("verify", "energy", "--jobs", 1)[0] == 3  # as the catalogue expects of wrong
    whole = {path.name: path.read_bytes() for path in Path("report").iterdir()}
    written = Path("report/verdicts.json").stat().st_mtime_ns
    with monkeypatch.context() as patch:
        broken(patch, KeyboardInterrupt)
        code, out, _ = call("verify", "energy", "--jobs", 1)
    assert (code, "report: report/unfinished/index.html" in out) == (130, True)
    assert {path.name: path.read_bytes() for path in Path("report").iterdir() if path.is_file()} == whole
    assert [verdicts(folder)["complete"] for folder in ("report", "report/unfinished")] == [True, False]
    assert call("verify", "energy", "--jobs", 1)[0] == 3
    assert Path("report/verdicts.json").stat().st_mtime_ns > written  # a whole one replaces it


def test_what_was_done_before_an_error_is_reported(call, catalogue, monkeypatch):
    broken(monkeypatch, SolverError("it gave up"))
    code, _, err = call("verify", "energy", "--jobs", 1)
    assert (code, err) == (2, "flockana: wrong: it gave up\n")
    assert len(verdicts("report")["verdicts"]) == 1


@pytest.mark.parametrize("width", [60, 80])
def test_no_name_is_cut_and_what_was_expected_is_seen_at_any_width(call, offer, monkeypatch, width):
    run = replace(tiny("tiny", "verified")(), expected={"alpha-flocking-strict": "refuted"})
    offer(tiny=lambda seed=0: run)
    monkeypatch.setenv("COLUMNS", str(width))
    _, out, _ = call("verify", "tiny", "--no-report")
    table = out[out.rindex("theorem ") :]
    assert max(map(len, table.splitlines())) <= width
    assert "expected" in table.splitlines()[0]
    assert "alpha-flocking-strict " in table
    assert "…" not in table
    assert ("rigour" in table) == (width == 80)


@pytest.mark.slow
@pytest.mark.parametrize("width", [40, 60])
@pytest.mark.parametrize(
    ("arguments", "whole"),
    [
        (("ensemble", "three-agents-1d", "--seeds", 1, "--jobs", 1), ("iv-printed", "100.0 [2.5, 100.0]", "corrected")),
        (("falsify", "os-3", "--on", "three-agents-1d", "--budget", 1), ("iv-printed", "1.411e+04", "inconclusive")),
        (("stability", "hexagon", "--start", "start"), ("breathing", "1.9637", "0.09292", "translation", "-1.96375")),
        (("theorems", "--long"), ("alpha-flocking-strict", "Definition", "positions")),
        (("scenarios", "--long"), ("algorithm1-flocks", "fragments")),
        (("lattice", "line:4"), ("infinitesimally", "quantitative", "α-lattice")),
        (("run", "three-agents-1d", "-o", "run.nc"), ("normalised_velocity_mismatch:", "3.2594e+05", "969730")),
    ],
    ids=lambda value: str(value[0]),
)
def test_a_narrow_terminal_cuts_no_number_and_no_name(call, monkeypatch, width, arguments, whole):
    monkeypatch.setenv("COLUMNS", str(width))
    _, out, _ = call(*arguments)
    assert max(map(cell_len, out.splitlines())) <= width
    assert "…" not in out
    assert [text for text in whole if text not in out] == []


def test_errata_come_as_pairs_of_printed_and_right(call, monkeypatch):
    monkeypatch.setattr("flockana.report.verify_catalogue.theorems", lambda: ("E8",))
    _, out, _ = call("verify", "errata", "--no-report", "--jobs", 1)
    assert "✗ MSN project: rank(A)/n is 1 on a connected net" in out
    assert "✓ right: rank(L)/(n - 1) is 1, as the slides print it" in out


def test_version_and_help(call):
    assert call("--version")[1].startswith("flockana 0")
    assert call("--help") == call("-h")
    assert call("--help")[0] == 0
    assert "<bool>" not in call("verify", "--help")[1]
    assert "--install-completion" in call("--help")[1]
    code, out, _ = call()
    assert (code, "verify" in out) == (0, True)


def test_the_options_of_the_command_that_is_asked_for_are_read_and_no_others():
    assert [one.name for one in command_line._app("stability").registered_commands] == ["stability"]
    assert len(command_line._app("").registered_commands) == len(command_line._app("--help").registered_commands) > 10


@pytest.mark.slow
def test_an_error_in_a_worker_arrives_with_the_name_of_its_task():
    with pytest.raises(FlockanaError, match="nothing: unknown theorem 'nothing'"):
        list(check_all([Task("nothing", fixed=True), Task("E8", fixed=True)], jobs=2))


WORKING = """
import time
from pathlib import Path
from flockana.report import verify_catalogue

def endless(task):
    Path("begun").touch()
    time.sleep(3600.0)

verify_catalogue.check = endless
if __name__ == "__main__":
"""


@pytest.mark.slow
def test_a_task_that_ends_its_process_is_named_when_all_others_are_done():
    tasks = [Survey("os:_exit", (0, 1)), Task("E8", fixed=True), Task("E10", fixed=True)]
    results = check_all(tasks, jobs=2)
    assert sorted(next(results).name for _ in range(2)) == ["E10", "E8"]
    with pytest.raises(
        SolverError, match="os:_exit, seeds 0 to 1: the worker process ended; if memory is short, try --jobs 1"
    ):
        next(results)


def test_in_one_process_a_result_is_given_before_the_next_task_begins():
    begun = []
    results = check_all([Task("E8", fixed=True), Task("E10", fixed=True)], watch=begun.append)
    assert next(results).name == "E8"
    assert {task.name for tasks in begun for task in tasks} == {"E8"}


@pytest.mark.slow
@posix
@pytest.mark.parametrize("moment", ["starting", "working"])
def test_ctrl_c_ends_all_processes_cleanly(moment, tmp_path):
    """While the first worker is being started, and when one is at work for what would be an hour."""
    script = tmp_path / "script.py"
    script.write_text(WORKING + indent(ANSWERS_CTRL_C + CLI, "    "))
    signs = {"starting": lambda: len(group(command)) >= 3, "working": (tmp_path / "begun").exists}
    with program(script, "verify", "--jobs", "2", "--no-report", folder=tmp_path) as command:
        until(signs[moment], command)  # the third process is the first worker: multiprocessing's own helper is another
        interrupt(command)
        _, err = command.communicate()
        assert (command.returncode, err) == (130, "flockana: interrupted\n")
        until(lambda: not group(command))  # that helper outlives its parent by a moment


@pytest.mark.slow
@posix
def test_where_ctrl_c_is_ignored_it_stays_ignored(tmp_path):
    """So a shell starts its background jobs; theirs is not the Ctrl-C that the terminal sends."""
    store = tmp_path / "s.sqlite"
    given = ("ensemble", "hexagon", "--jobs", "1", "--seeds", "2", "--theorem", "alpha-flocking", "--store", store)
    with program("-c", IGNORES_CTRL_C + CLI, *given, folder=tmp_path) as command:
        until(store.exists, command)
        interrupt(command)
        _, err = command.communicate()
        assert (command.returncode, err) == (0, "")
