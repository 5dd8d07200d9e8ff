import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from flockana import Algorithm1, Scenario, Trajectory, animate, simulate
from tests.programs import full_disk, posix


def tiny(seed=0):
    q = np.array([[0.0], [7.5 + seed]])
    expected = {"energy": "verified"}
    return Scenario("tiny", "Two agents on a line", "ours", Algorithm1(), q, 0.0 * q, (0.0, 0.5), seed, expected)


@pytest.fixture
def catalogue(offer):
    offer(tiny=tiny, other=tiny)


OUTPUTS = [
    ("run", "tiny", "-o", "it.nc"),
    ("lattice", "square:2x2", "--plot", "it.png"),
    ("lattice", "square:2x2", "--plot", "it.pdf"),
    ("equilibrium", "line:2", "-o", "it.json"),
    ("equilibrium", "line:2", "--plot", "it.png"),
    ("stability", "line:2", "--plot", "it.png"),
    ("ensemble", "three-agents-1d", "--seeds", 1, "--theorem", "energy", "--jobs", 1, "-o", "it.nc"),
    ("animate", "tiny", "-o", "it.gif", "--seconds", "0.2"),
]
NO_FOLDER = ["/dev/null", "/proc/it", "a-file"]


@posix
@pytest.mark.parametrize("arguments", OUTPUTS, ids=lambda arguments: f"{arguments[0]}-{arguments[-1]}")
def test_a_full_disk_is_one_line_and_the_old_file_stays(call, request, tmp_path, arguments):
    if arguments[0] != "ensemble":  # which has names looked up by its workers
        request.getfixturevalue("catalogue")
    name = next(str(word) for word in arguments if str(word).startswith("it."))
    (tmp_path / name).write_text("good")
    with full_disk(100):
        code, out, err = call(*arguments)
    assert (code, err.count("\n"), out.count("Traceback")) == (2, 1, 0)
    assert "File too large; choose another file" in err or "choose a file name and folder" in err
    assert out or arguments[0] == "animate"  # what was computed is told
    assert (tmp_path / name).read_text() == "good"
    assert os.listdir(tmp_path) == [name]


@posix
@pytest.mark.parametrize("folder", NO_FOLDER)
@pytest.mark.parametrize("kind", [(), ("--slides",), ("--grader", "otter")], ids=" ".join)
def test_a_course_goes_to_a_folder(refused, tmp_path, folder, kind):
    (tmp_path / "a-file").write_text("good")
    refused("choose a folder you may write to", "course", folder, *kind)
    assert (tmp_path / "a-file").read_text() == "good"


def test_proofs_are_not_looked_for_in_a_course_s_folder(tmp_path):
    """It has a `proofs` too, for students' own, and `python -m` looks there first."""
    (tmp_path / "proofs").mkdir()
    (tmp_path / "proofs" / "__init__.py").touch()
    (tmp_path / "proofs" / "proof.py").touch()
    done = command("prove", "no-such", folder=tmp_path)
    assert (done.returncode, b"unknown proof 'no-such'" in done.stderr) == (2, True)


@posix
def test_pages_and_json_of_a_report_are_replaced_together(call, catalogue, tmp_path):
    assert call("verify", "tiny")[0] == 0
    before = {path.name: path.read_bytes() for path in (tmp_path / "report").iterdir()}
    assert set(before) == {"index.html", "verdicts.json"}
    with full_disk(len(before["verdicts.json"]) + 2000):  # room for one of them
        code, out, err = call("verify", "tiny", "--seed", 1)
    assert (code, err.count("\n"), "choose another folder" in err) == (2, 1, True)
    assert "energy on tiny" in out  # the verdicts are told all the same
    assert {path.name: path.read_bytes() for path in (tmp_path / "report").iterdir()} == before


@posix
def test_through_a_link_the_file_is_written_and_the_link_stays(call, catalogue, tmp_path):
    (tmp_path / "there.nc").write_text("before")
    (tmp_path / "link.nc").symlink_to("there.nc")
    assert call("run", "tiny", "-o", "link.nc")[0] == 0
    assert (tmp_path / "link.nc").is_symlink()
    assert Trajectory.load(tmp_path / "there.nc").n == 2


def test_a_report_on_a_part_leaves_the_one_on_all_alone(call, catalogue, monkeypatch):
    monkeypatch.setattr("flockana.report.verify_catalogue.theorems", lambda: ("energy",))
    assert call("verify", "--seeds", 0, "--jobs", 1)[0] == 0
    before = Path("report/verdicts.json").read_bytes()
    code, out, _ = call("verify", "tiny")
    assert (code, "report: report/tiny/index.html" in out) == (0, True)
    assert Path("report/verdicts.json").read_bytes() == before
    assert json.loads(Path("report/tiny/verdicts.json").read_text(encoding="utf-8"))["of"] == "tiny"
    out = call("verify", "tiny", "--output", "report")[1]  # whoever names the folder too
    assert "report: report/tiny/index.html" in out
    assert Path("report/verdicts.json").read_bytes() == before


@pytest.mark.parametrize("frame", [0, 1])
def test_ctrl_c_in_a_film_is_ctrl_c(tmp_path, monkeypatch, frame):
    """Before the first frame Pillow had nothing to end; and what is raised in a callback may be swallowed there."""
    import signal

    run = simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))

    def progress(done, total):
        assert done <= frame + 1  # the next frame is not drawn
        if done == frame + 1:
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(signal, "getsignal", lambda number: signal.default_int_handler)
    with pytest.raises(KeyboardInterrupt):
        animate(run, tmp_path / "it.gif", seconds=1.0, fps=5.0, progress=progress)
    assert list(tmp_path.iterdir()) == []


def command(*arguments, module="flockana", stdout=subprocess.PIPE, folder=None, **environment):
    known = os.pathsep.join(filter(None, [os.getcwd(), os.environ.get("PYTHONPATH", "")]))
    return subprocess.run(
        [sys.executable, "-m", module, *arguments],
        stdout=stdout,
        stderr=subprocess.PIPE,
        cwd=folder,
        env=os.environ | {"PYTHONPATH": known} | environment,
        timeout=120,
    )


@pytest.mark.parametrize("module", ["flockana", "flockana.cli"])
def test_it_runs_as_a_module(module):
    done = command("--version", module=module)
    assert (done.returncode, done.stdout[:10], done.stderr) == (0, b"flockana 0", b"")
    assert command("verify", "no-such", module=module).returncode == 2


@pytest.mark.parametrize("encoding", ["cp1252", "ascii"])
def test_an_encoding_without_greek_is_no_error(encoding):
    done = command("theorems", PYTHONIOENCODING=encoding)
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"\\u" in done.stdout
    done = command("verify", "E8", "--no-report", "--json", PYTHONIOENCODING=encoding)
    told = json.loads(done.stdout.decode(encoding))
    same = json.loads(command("verify", "E8", "--no-report", "--json", PYTHONIOENCODING="utf-8").stdout.decode("utf-8"))
    assert told["verdicts"] == same["verdicts"]


@pytest.mark.skipif(not Path("/dev/full").is_char_device(), reason="no full device")
def test_output_on_a_full_device_is_2_and_one_line():
    with open("/dev/full", "wb") as full:
        done = command("scenarios", stdout=full)
    assert done.returncode == 2
    assert done.stderr.decode() == (
        "flockana: cannot write the output: No space left on device; send it elsewhere, or make room\n"
    )


@posix
def test_a_reader_that_leaves_does_not_change_the_exit_status(tmp_path):
    read, write = os.pipe()
    os.close(read)
    with os.fdopen(write, "wb") as gone:
        done = command("theorems", stdout=gone)
        assert (done.returncode, done.stderr) == (0, b"")
        file = tmp_path / "square.png"
        done = command("lattice", "square:2x2", "--plot", str(file), stdout=gone)
    assert (done.returncode, done.stderr) == (0, b"")
    assert file.stat().st_size > 1000  # the work is done
