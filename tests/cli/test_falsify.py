import json

import numpy as np
import pytest
from PIL import Image

from flockana.base.errors import ArgumentError
from flockana.base.integrity_seals import with_digest
from flockana.cli.falsify import known_false, read_ranges
from flockana.falsify import point_evaluation
from flockana.theorems import Claim, theorems
from tests.programs import Starts

COMMAND = ("falsify",)


TWICE = ["collision-energy", "--on", "head-on", "--claim", "twice", "--budget", 60]


def test_a_false_claim_is_found_written_drawn_and_replayed(call, tmp_path):
    code, out, err = call(*TWICE, "-o", "c.json", "--plot", "c.png")
    assert (code, err) == (0, "")
    rows = {line.split()[0]: line.split()[1:] for line in out.splitlines() if line.split()[:1]}
    assert (rows["twice"][0], *rows["twice"][2:4]) == ("4.839", "✗", "refuted")
    assert float(rows["twice"][1]) < 0.0
    assert rows["below"][2:4] == ["✓", "verified"]
    assert "found: twice is broken, and it is known to be false" in out
    assert "counterexample: c.json" in out
    assert np.ptp(np.asarray(Image.open(tmp_path / "c.png").convert("L"))) > 200
    code, out, err = call("--replay", "c.json")
    assert (code, err) == (0, "")
    assert "it breaks again" in out
    assert "✗ refuted" in out


def test_a_replay_on_which_the_claim_holds_is_3(call, tmp_path):
    call(*TWICE, "-o", "c.json")
    data = json.loads((tmp_path / "c.json").read_text()) | {"p0": [[0.0], [0.0]]}
    (tmp_path / "c.json").write_text(json.dumps(data))
    code, _, err = call("--replay", "c.json")
    assert (code, "its digest is not that of its contents" in err) == (2, True)
    del data["digest"]
    (tmp_path / "c.json").write_text(json.dumps(with_digest(data)))
    code, out, _ = call("--replay", "c.json")
    assert code == 3
    assert "it does not break here" in out


def test_a_true_claim_is_not_found_and_no_file_is_written(call, tmp_path):
    code, out, _ = call("collision-energy", "--on", "head-on", "--claim", "below", "--budget", 10, "-o", "c.json")
    assert code == 0
    assert "nothing found, which proves nothing: below came nearest; 10 of 10 runs" in out
    assert not (tmp_path / "c.json").exists()


def test_a_true_claim_that_breaks_is_3(call, monkeypatch):
    verify = point_evaluation.verify

    def wrong(theorem, run, **options):
        verdict = verify(theorem, run, **options)
        broken = Claim("below", "refuted", margin=-1.0, error=0.0, detail="it broke")
        return type(verdict)(verdict.theorem, verdict.hypotheses, (broken,), verdict.tolerances)

    monkeypatch.setattr(point_evaluation, "verify", wrong)
    code, out, _ = call("collision-energy", "--on", "head-on", "--claim", "below", "--budget", 10)
    assert code == 3
    assert "NOT known to be false" in out


def test_ctrl_c_is_130_with_the_best_so_far(call, monkeypatch):
    verify, starts = point_evaluation.verify, Starts()

    def interrupted(theorem, run, **options):
        if starts.number(run) == 4:
            raise KeyboardInterrupt
        return verify(theorem, run, **options)

    monkeypatch.setattr(point_evaluation, "verify", interrupted)
    code, out, err = call("collision-energy", "--on", "head-on", "--claim", "below", "--budget", 30)
    assert code == 130
    assert "4 of 30 runs; interrupted" in " ".join(out.split())
    assert err == "flockana: interrupted\n"


def test_parameters_and_the_state_are_chosen(call):
    code, out, _ = call(*TWICE, "--vary", "none", "--set", "gains.c1_alpha=1,2", "--deepen", "--budget", 5)
    assert code == 0
    assert "gains.c1_alpha = " in out
    assert "5 of 5 runs" in out
    assert read_ranges(["a.b=1,2", "c=-1e-3,4"]) == {"a.b": (1.0, 2.0), "c": (-1e-3, 4.0)}
    with pytest.raises(ArgumentError, match="expected NAME=LOW,HIGH once for each name"):
        read_ranges(["a=1,2", "a=1,3"])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "expected THEOREM --on CASE"),
        (["os-1", "--on", "head-on", "--claim", "x"], "unknown claim 'x'"),
        (["os-1", "--on", "head-on", "--vary", "x"], "expected 'q', 'p', both"),
        (["os-1", "--on", "head-on", "--set", "gains.c1_alpha=1"], "expected NAME=LOW,HIGH"),
        (["os-1", "--replay", "c.json"], "brings its own theorem"),
    ],
)
def test_bad_input_is_2_and_one_line(refused, arguments, message):
    refused(message, *arguments)


def test_what_is_known_to_be_false():
    false = {("os-3", "iv-printed"), ("zone-1-printed", "edges"), ("collision-energy", "twice"), ("E13", "printed")}
    true = {("os-3", "i"), ("os-1", "iii"), ("energy", "rate"), ("collision-energy", "below"), ("E13", "corrected")}
    true |= {("zone-1-corrected", "lengths"), ("dead-zone-1-corrected", "rate")}
    assert {name for name, _ in false | true} <= set(theorems())
    assert all(known_false(*one) for one in false)
    assert not any(known_false(*one) for one in true)
