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


def test_what_is_no_flock_is_refused(tmp_path):
    with pytest.raises(ArgumentError, match="subject = 'flock': expected a Flock, a Scenario or a run"):
        fl.write_report("flock", tmp_path)
    with pytest.raises(ArgumentError, match="theorems = 3: expected a list of names or own claims"):
        fl.write_report(FLOCK, tmp_path, theorems=3)
