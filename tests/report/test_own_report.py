"""Pages of flocks and runs of the user's own, with own claims."""

import json

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError

FLOCK = fl.Flock(fl.Algorithm1(), [[0.0, 0.0], [8.0, 0.0]], t_span=(0.0, 1.0), name="a pair")


def test_a_page_has_the_verdicts_claims_and_figures_of_a_flock(tmp_path):
    slow = fl.claim("slow", lambda run: 100.0 - np.linalg.norm(run.p, axis=2).max(axis=1), statement="nobody is fast")
    page = fl.write_report(FLOCK, tmp_path / "mine", theorems=["energy", slow])
    text = page.read_text(encoding="utf-8")
    for wanted in ("a pair", "nobody is fast", "energy-identities", "<svg"):
        assert wanted in text
    said = json.loads((tmp_path / "mine" / "verdicts.json").read_text(encoding="utf-8"))
    statuses = {verdict["theorem"]: verdict["status"] for verdict in said["verdicts"]}
    assert statuses == {"energy": "verified", "slow": "verified"}


def test_a_run_is_judged_as_it_is(tmp_path):
    run = FLOCK.run()
    fl.write_report(run, tmp_path)
    said = json.loads((tmp_path / "verdicts.json").read_text(encoding="utf-8"))
    assert {v["theorem"]: v["status"] for v in said["verdicts"]} == {v.theorem: v.status for v in fl.verify(None, run)}


def test_a_recording_is_held_against_a_law(tmp_path):
    run = FLOCK.run()
    rec = fl.Recording(run.t, run.q, run.p, bound=1e-6, source="two birds")
    with pytest.raises(ArgumentError, match="a recording without a law: expected law="):
        fl.write_report(rec, tmp_path)
    text = fl.write_report(rec, tmp_path, law=FLOCK.law).read_text(encoding="utf-8")
    assert "recorded: two birds" in text
    assert "integrated by" not in text
    said = json.loads((tmp_path / "verdicts.json").read_text(encoding="utf-8"))
    expected = {v.theorem: v.status for v in fl.verify(None, rec, law=FLOCK.law)}
    assert {v["theorem"]: v["status"] for v in said["verdicts"]} == expected


def test_verdicts_stand_by_their_subjects_each_once(tmp_path):
    slow = fl.claim("slow", lambda run: 1.0, statement="nobody is fast")
    once = fl.verify(slow, FLOCK.run())
    text = fl.write_report([once, once, fl.verify("E8")], tmp_path).read_text(encoding="utf-8")
    for anchor in ("scenario-verdicts--slow", "scenario-verdicts-(2)--slow", "scenario-verdicts--E8"):
        assert text.count(f'id="{anchor}"') == 1
    assert "nobody is fast" in text
    with pytest.raises(ArgumentError, match=r"theorems = .*: verdicts have their own; leave theorems out"):
        fl.write_report(once, tmp_path, theorems=["os-1"])


def test_an_ensemble_gives_its_shares_by_parameters(tmp_path):
    axes = {"gains.c1_gamma": [0.1, 0.4]}
    drawn = fl.Flock(FLOCK.law, lambda seed: [[0.0, 0.0], [4.0 + seed, 0.0]], t_span=(0.0, 1.0))
    runs = fl.ensemble(drawn, [3, 5], theorems=["energy"], parameters=axes, metrics=[], jobs=1)
    text = fl.write_report(runs, tmp_path).read_text(encoding="utf-8")
    assert text.count("100.0 % [15.8, 100.0]") == 2 * int(runs.sizes["claim"])
    assert "gains.c1_gamma = 0.4" in text
    assert 'href="#scenario-' not in text


def test_what_is_no_flock_is_refused(tmp_path):
    with pytest.raises(ArgumentError, match="subject = 'flock': expected a Flock, a Scenario, a run, a recording with"):
        fl.write_report("flock", tmp_path)
    with pytest.raises(ArgumentError, match="theorems = 3: expected a list of names or own claims"):
        fl.write_report(FLOCK, tmp_path, theorems=3)
