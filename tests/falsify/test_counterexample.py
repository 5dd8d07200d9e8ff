"""Counterexamples as files: written, read, simulated and checked again."""

import json
from dataclasses import replace

import numpy as np
import pytest

from flockana.base.errors import ArgumentError, FileError
from flockana.falsify import Counterexample, falsify, replay
from flockana.theorems import Tolerances
from tests.falsify.conftest import HEAD_ON, OWN


class TestTheFile:
    def test_it_breaks_again_to_the_bit(self, collision, tmp_path):
        path = collision.save(tmp_path / "c.json")
        again = Counterexample.load(path)
        np.testing.assert_array_equal(again.q0, collision.q0)
        np.testing.assert_array_equal(again.p0, collision.p0)
        assert again.law == collision.case.law
        assert (again.theorem, again.claim, again.margin) == ("collision-energy", "twice", collision.margin)
        verdict = replay(path)
        assert verdict.claim("twice").status == "refuted"
        assert verdict.claim("twice").witness == collision.verdict.claim("twice").witness
        assert [p.name for p in tmp_path.iterdir()] == ["c.json"]

    def test_options_of_the_run_and_tolerances_are_kept(self, tmp_path):
        case = replace(HEAD_ON, options={"rtol": 1e-6, "t_eval": np.linspace(0.0, 3.0, 200)})
        tolerances = Tolerances(contact=1e-3)
        found = falsify("collision-energy", case, claim="twice", budget=40, tolerances=tolerances)
        again = Counterexample.load(found.save(tmp_path / "c.json"))
        assert again.tolerances == tolerances
        assert len(again.run().t) == 200
        assert again.run().stats["rtol"] == 1e-6

    def test_a_theorem_of_one_s_own_is_brought_along(self, tmp_path):
        path = falsify(OWN, HEAD_ON, budget=40, vary="p", speed=40.0).save(tmp_path / "c.json")
        with pytest.raises(ArgumentError, match=r"a counterexample to 'slow', .*: give that claim"):
            replay(path)
        assert replay(path, theorem=OWN).claim("slow").status == "refuted"

    def test_there_is_none_where_nothing_broke(self, tmp_path):
        found = falsify("collision-energy", HEAD_ON, claim="below", budget=2)
        with pytest.raises(ArgumentError, match="collision-energy:below did not break"):
            found.save(tmp_path / "c.json")

    def test_a_folder_that_does_not_exist(self, collision, tmp_path):
        with pytest.raises(FileError, match=r"cannot write .*choose another file"):
            collision.save(tmp_path / "no" / "c.json")

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            ({"format": "flockana-trajectory"}, "holds no counterexample .*'flockana-trajectory'"),
            ({"format_version": 2}, "is of format 2, expected 1: use the flockana that wrote it"),
            ({"q0": [[0.0], ["x"]]}, "is damaged: q"),
            ({"q0": [[0.0]]}, "is damaged: q has shape"),
            ({"law": {"type": "flockana.laws.olfati_saber:Algorithm9"}}, "is damaged: cannot rebuild"),
            ({"law": [1.0]}, "is damaged: law"),
            ({"t_span": [3.0, 0.0]}, "is damaged: t_span"),
            ({"options": [1]}, "is damaged"),
            ({"tolerances": {"energie": 1.0}}, "is damaged: .*energie"),
            ({"theorem": 3}, "is damaged: 3 is no text"),
            ({"margin": "x"}, "is damaged"),
        ],
    )
    def test_damage_is_named(self, collision, tmp_path, change, message):
        path = collision.save(tmp_path / "c.json")
        path.write_text(json.dumps(json.loads(path.read_text()) | change))
        with pytest.raises(FileError, match=message):
            replay(path)

    @pytest.mark.parametrize(
        ("text", "message"), [("{", "is no JSON"), ("[1]", "format 'list'"), ("{}", "format None")]
    )
    def test_what_is_no_file_of_ours(self, tmp_path, text, message):
        path = tmp_path / "c.json"
        path.write_text(text)
        with pytest.raises(FileError, match=message):
            replay(path)
        with pytest.raises(FileError, match=r"cannot read .*No such file"):
            replay(tmp_path / "none.json")
        path.write_bytes(bytes(range(128, 200)))
        with pytest.raises(FileError, match="is no JSON"):
            replay(path)

    def test_a_missing_entry(self, collision, tmp_path):
        path = collision.save(tmp_path / "c.json")
        data = json.loads(path.read_text())
        del data["p0"]
        path.write_text(json.dumps(data))
        with pytest.raises(FileError, match="is damaged: 'p0'"):
            replay(path)
