"""The frame around the proofs: what fails, hangs, dies or lacks a library is never called proved, nor false."""

import importlib
import json
import multiprocessing
import signal
import sys
from functools import partial
from pathlib import Path
from textwrap import indent

import pytest

from flockana.cli.main import main
from proofs import certificates, proof, run
from proofs.proof import Step, proofs
from proofs.run import Outcome, check
from tests.programs import ANSWERS_CTRL_C, CLI, group, interrupt, posix, program, until

HEAD = """
from proofs.proof import Proof, Step

def steps():
    yield Step("one is one", 1 == 1, "1 = 1", "counted")
    {body}

PROOF = Proof("{name}", "{name} is so.", "nothing", "symbolic", steps, title="Toy: {name}", time_limit={limit})
"""
BODIES = {
    "holds": "yield Step('two is two', True)",
    "broken": "yield Step('two is three', False, '2 = 3', 'it is not')",
    "puzzled": "yield Step('P is NP', None, evidence='unknown, timeout')",
    "hangs": "import os, time; os.environ.get('HANGS') and open(os.environ['HANGS'], 'w').close(); time.sleep(3600)",
    "crashes": "1 / 0",
    "dies": "import os; os._exit(7)",
    "lacks": "raise ModuleNotFoundError(\"No module named 'flint'\", name='flint.types')",
    "misses": "import no_such_module",
}


@pytest.fixture
def toys(tmp_path, monkeypatch):
    """A package of toy proofs, each going wrong in its own way."""
    folder = tmp_path / "toy_proofs"
    folder.mkdir()
    (folder / "__init__.py").touch()
    for name, body in BODIES.items():
        limit = 5.0 if name == "hangs" else 60.0
        (folder / f"{name}.py").write_text(HEAD.format(name=name, body=body, limit=limit))
    (folder / "by_another_name.py").write_text(HEAD.format(name="other", body="", limit=60.0))
    (folder / "helper.py").write_text("NOT_A_PROOF = 1  # PROOF\n")
    (folder / "_template.py").write_text("PROOF = 1\n")
    (folder / "unlucky.py").write_text("import z3_is_not_here as z3\nPROOF = 1\n")
    hollow = HEAD.format(name="hollow", body="", limit=60.0)
    (folder / "hollow.py").write_text(hollow.replace("yield", "return\n    yield"))
    monkeypatch.syspath_prepend(tmp_path)
    importlib.invalidate_caches()
    sys.modules.pop("toy_proofs", None)
    return "toy_proofs"


def checked(package, *names, **options):
    return {outcome.id: outcome for outcome in check(names, package=package, **options)}


def test_proofs_are_found_by_their_files_and_not_imported(toys):
    assert proof.names(toys) == tuple(sorted([*BODIES, "by-another-name", "hollow", "unlucky"]))
    assert not any(name.startswith("toy_proofs.") for name in sys.modules)


def test_each_way_of_going_wrong_reads_as_it_should(toys):
    found = checked(toys, *proof.names(toys), jobs=2)
    assert {name: outcome.status for name, outcome in found.items()} == {
        "holds": "proved",
        "broken": "failed",
        **dict.fromkeys(("puzzled", "hangs", "crashes", "dies", "lacks", "misses"), "unknown"),
        **dict.fromkeys(("by-another-name", "hollow", "unlucky"), "unknown"),
    }
    assert {name: list(outcome.objections()) for name, outcome in found.items()} == {
        "holds": [],
        "broken": ["does not hold: two is three (it is not)"],
        "puzzled": ["could not tell: P is NP (unknown, timeout)"],
        "hangs": ["stopped after 5 s, with 1 steps checked"],
        "crashes": ["stopped by ZeroDivisionError: division by zero"],
        "dies": ["its process ended before the proof did (exit code 7)"],
        "lacks": ["python-flint is not installed: pip install 'flockana[proofs]'"],
        "misses": ["stopped by ModuleNotFoundError: No module named 'no_such_module'"],
        "by-another-name": [
            "stopped by ValueError: toy_proofs.by_another_name calls its proof 'other': expected 'by-another-name', "
            "after the file"
        ],
        "hollow": ["it has no steps"],
        "unlucky": ["stopped by ModuleNotFoundError: No module named 'z3_is_not_here'"],
    }
    assert [len(found[name].steps) for name in ("holds", "broken", "puzzled", "hangs", "dies")] == [2, 2, 2, 1, 1]


def test_a_limit_given_replaces_the_proofs_own(toys):
    (outcome,) = check(["hangs"], package=toys, time_limit=1.5)
    assert outcome.reason == "stopped after 1.5 s, with 1 steps checked"
    assert outcome.seconds >= 1.5


TORN = """import gc, os
    from multiprocessing.connection import Connection
    pipe = next(one for one in gc.get_objects() if isinstance(one, Connection) and one.writable)
    os.write(pipe.fileno(), bytes([0, 0, 1, 0]) + b"half of what was announced")
    os._exit(7)"""
ODD = {  # what is written before and into it; an import that is slow on a busy machine says nothing of the proof
    "slow": ("import time; time.sleep(1.5)", "", 0.5, ("proved", 1, "")),
    "endless": ("import time; time.sleep(3600)", "", 60.0, ("unknown", 0, "stopped after 1.5 s, with 0 steps checked")),
    "torn": ("", TORN, 60.0, ("unknown", 1, "its process ended before the proof did (exit code 7)")),
}


@pytest.mark.parametrize("name", ODD)
def test_what_happens_before_a_proof_begins_or_while_it_tells_is_told(name, toys, tmp_path, monkeypatch):
    head, body, limit, expected = ODD[name]
    if name == "endless":
        monkeypatch.setattr(run, "START_LIMIT", 1.5)
    (tmp_path / toys / f"{name}.py").write_text(f"{head}\n{HEAD.format(name=name, body=body, limit=limit)}")
    (outcome,) = check([name], package=toys)
    assert (outcome.status, len(outcome.steps), outcome.reason) == expected


def test_leaving_early_leaves_no_process(toys):
    from multiprocessing import active_children

    results = check(["holds", "hangs"], package=toys, jobs=2, time_limit=3600.0)
    assert next(results).id == "holds"
    (hanging,) = active_children()
    results.close()
    assert hanging.exitcode == -signal.SIGKILL
    assert active_children() == []


def test_a_process_whose_parent_was_killed_ends_without_a_word(toys, capfd):
    ours, theirs = multiprocessing.Pipe(duplex=False)
    ours.close()
    orphan = multiprocessing.get_context("spawn").Process(target=run._work, args=("holds", toys, theirs))
    orphan.start()
    theirs.close()
    orphan.join()
    assert (orphan.exitcode, capfd.readouterr().err) == (0, "")


def test_a_false_step_outweighs_an_unknown_one():
    steps = [Step("a", True), Step("b", None), Step("c", False)]
    assert Outcome("x", steps=steps).status == "failed"
    assert Outcome("x", steps=steps[:2]).status == "unknown"
    assert Outcome("x", steps=steps[:1], reason="stopped").status == "unknown"
    assert Outcome("x", steps=steps[:1]).status == "proved"
    assert Outcome("x").status == "unknown"


def test_a_proof_with_other_than_its_steps_is_none():
    steps = [Step("a", True), Step("b", True)]
    assert Outcome("x", steps=steps, size=2).status == "proved"
    short = Outcome("x", steps=steps[:1], size=2)
    assert (short.status, list(short.objections())) == ("unknown", ["1 steps were checked: expected 2"])
    assert all(proof.size for proof in proofs())


def test_the_certificate_as_json(tmp_path):
    outcome = Outcome("toy", "Toy", "x = x.", "x real", "smt", ("os-1",), steps=[Step("one", True, "x = x", "said so")])
    certificates.write(outcome, tmp_path)
    data = json.loads((tmp_path / "toy.json").read_text(encoding="utf-8"))
    assert list(data) == [
        *("schema", "status", "id", "title", "statement", "hypotheses", "rigour", "theorems", "time_limit"),
        *("steps", "seconds", "reason", "values", "versions"),
    ]
    assert (data["schema"], data["status"], data["id"], data["rigour"]) == (1, "proved", "toy", "smt")
    assert data["steps"] == [{"text": "one", "holds": True, "latex": "x = x", "evidence": "said so", "found": {}}]
    assert set(data["versions"]) == {"python", "flockana", "sympy", "python-flint", "z3-solver"}


def test_the_certificate_to_read():
    steps = [Step("one", True, "x\n= x", "said so"), Step("two", None), Step("three", False)]
    text = certificates.as_markdown(Outcome("toy", "Toy", "x = x.", "x real", "smt", ("os-1",), steps=steps))
    assert text.startswith("# Toy\n\n**FAILED** · proof `toy` · smt · 3 steps · 0.0 s\n\n**Statement.** x = x.\n")
    for part in (
        *("**Given.** x real", "**Backs** os-1", "2. two: **unknown**.", "3. three: **does not hold**."),
        "1. one: holds. *said so*\n\n   $$\n   x\n   = x\n   $$\n",
        "- could not tell: two\n- does not hold: three\n",
    ):
        assert part in text
    signs = certificates.as_markdown(Outcome("toy", statement="|x| < c* and <b>", reason="`x`"))
    assert r"**Statement.** \|x\| \< c\* and \<b>" in signs
    assert r"- \`x\`" in signs
    assert "**Unknown**" in signs
    assert certificates.as_markdown(Outcome("toy", steps=steps[:1])).startswith("# toy\n\n**Proved**")


@pytest.fixture
def prove(toys, monkeypatch, capsys, tmp_path):
    """`flockana prove` on the toys."""
    monkeypatch.setattr(proof, "names", partial(proof.names, toys))
    monkeypatch.setattr(run, "check", partial(check, package=toys))
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        with pytest.raises(SystemExit) as end:
            main(["prove", *map(str, arguments)])
        out = capsys.readouterr()
        return end.value.code, out.out, out.err

    return call


def test_a_proof_that_holds_is_0(prove):
    code, out, err = prove("holds")
    assert (code, err) == (0, "")
    assert "1 of 1 proved, 2 steps" in out
    assert "holds is so." in " ".join(out.split())
    assert sorted(path.name for path in Path("certificates").iterdir()) == ["holds.json", "holds.md", "index.md"]
    row = "| [Toy: holds](holds.md) | holds is so. | symbolic | 2 | Proved |"
    assert row in Path("certificates/index.md").read_text()


@pytest.mark.parametrize(("name", "word"), [("broken", "FAILED"), ("puzzled", "unknown"), ("lacks", "unknown")])
def test_anything_else_is_3_and_says_why(prove, name, word):
    code, out, err = prove("holds", name, "--output", "deep/er", "--jobs", 2)
    assert (code, err) == (3, "")
    assert f" {word} " in out
    assert "1 of 2 proved" in out
    assert f"{name}: " in out
    assert json.loads(Path(f"deep/er/{name}.json").read_text())["status"] == word.lower()


def test_bad_input_is_2_before_any_work(prove, tmp_path):
    code, out, err = prove("hold")
    assert (code, out) == (2, "")
    assert "unknown proof 'hold'; did you mean 'holds'? Known: " in err
    (tmp_path / "file").touch()
    code, out, err = prove("holds", "--output", "file")
    assert (code, out) == (2, "")
    assert "cannot write to file: there is a file of that name; choose a folder you may write to" in err
    assert prove("holds", "--jobs", 0)[0] == 2


def test_outside_a_checkout_is_one_line_and_2(prove, monkeypatch):
    from flockana.cli import prove as command

    monkeypatch.setattr(command, "__file__", str(Path.cwd() / "site-packages" / "flockana" / "commands" / "prove.py"))
    code, out, err = prove("holds")
    assert (code, out) == (2, "")
    where = "clone its repository and run `flockana prove` in that folder"
    assert err == f"flockana: the proofs are not installed with flockana: {where}\n"


SCRIPT = """
from functools import partial
from proofs import proof, run
proof.names = partial(proof.names, "toy_proofs")
run.check = partial(run.check, package="toy_proofs")
if __name__ == "__main__":
"""


@posix
@pytest.mark.parametrize("moment", ["holds.md", "hangs"])
def test_ctrl_c_is_130_and_leaves_what_was_done(moment, toys, tmp_path):
    """While the process of the second proof starts, most likely, and when it hangs."""
    script, out = tmp_path / "script.py", tmp_path / "out"
    script.write_text(SCRIPT + indent(ANSWERS_CTRL_C + CLI, "    "))
    given = ("prove", "holds", "hangs", "-o", out, "--jobs", "1", "--time-limit", "3600")
    root = Path(proof.__file__).parents[1]
    environment = {"HANGS": str(out / "hangs")}
    with program(script, *given, paths=[root, tmp_path], environment=environment, folder=tmp_path) as process:
        until((out / moment).exists, process)
        interrupt(process)
        _, err = process.communicate()
        assert process.returncode == 130, err
        assert err == "flockana: interrupted\n"  # and no traceback of a child
        until(lambda: not group(process))
    assert json.loads((out / "holds.json").read_text())["status"] == "proved"
    assert {path.name for path in out.iterdir()} - {"hangs"} == {"holds.json", "holds.md"}
