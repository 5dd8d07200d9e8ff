"""A law and a start of the user's own, wherever a scenario of the catalogue does."""

import os
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError, FlockanaError, UnknownNameError
from tests.refused import refused

LAW = fl.Algorithm1(gains={"c1_alpha": 4.0, "c2_alpha": 2.0})
PAIR = [[0.0, 0.0], [8.0, 0.0]]


def start(seed):
    return 7.0 * np.random.default_rng(seed).random((3, 2))


def test_flock_draws_its_start_from_the_seed_and_runs():
    flock = fl.Flock(LAW, start, t_span=(0, 1), name="three")
    assert np.array_equal(flock.scenario(4).q0, start(4))
    assert not flock.scenario(4).p0.any()
    assert flock.run(4).status == "complete"
    both = fl.Flock(LAW, lambda seed: (start(seed), np.ones((3, 2))))
    assert both.start(1)[1].all()


def test_verify_without_a_theorem_gives_one_table_of_those_about_the_law():
    found = fl.verify(law=LAW, q0=PAIR, t_span=(0, 2))
    by_id = {verdict.theorem: verdict for verdict in found}
    assert "os-1" in by_id
    assert "os-3" not in by_id
    assert "cucker-smale" not in by_id
    assert by_id["os-1"].status == fl.verify("os-1", law=LAW, q0=PAIR, t_span=(0, 2)).status
    assert str(found).splitlines()[0].split() == ["theorem", "status", "rigour", "decided", "by", "title"]
    assert len(str(found).splitlines()) == 1 + len(found)
    assert found._repr_html_().count("<tr>") == 1 + len(found)
    assert r"\toprule" in found.to_latex()
    for call, message in (
        (lambda: fl.verify(law=LAW), r"expected a Trajectory, or law=..., q0=..."),
        (lambda: fl.verify(law=LAW, q0=start), r"a function of a seed: expected Flock\(law, q0, p0, t_span\).verify"),
        (lambda: fl.verify(None, fl.Flock(LAW, start)), r"is a Flock: expected flock.run\(seed\), or flock.verify"),
    ):
        with pytest.raises(ArgumentError, match=message):
            call()


def test_ensemble_of_an_own_flock_over_seeds_and_numbers_of_its_law():
    runs = fl.ensemble(
        law=LAW, q0=start, t_span=(0, 1), seeds=range(2), parameters={"gains.c1_alpha": [1.0, 4.0]},
        theorems=["os-1"], metrics=[], jobs=1,
    )  # fmt: skip
    assert dict(runs.sizes)["seed"] == 2
    assert runs["gains.c1_alpha"].values.tolist() == [1.0, 4.0]
    assert (runs.run == 0).all()
    with pytest.raises(ArgumentError, match="all runs would be the same"):
        fl.ensemble(fl.Flock(LAW, PAIR), range(2))
    with pytest.raises(ArgumentError, match="expected the one or the other"):
        fl.ensemble("hexagon", range(2), law=LAW)
    with pytest.raises(ArgumentError, match="has no such number"):
        fl.ensemble(fl.Flock(LAW, start), range(2), parameters={"gains.c9": 1.0}, jobs=1)


def test_a_store_knows_an_own_flock_by_its_numbers(tmp_path):
    def made(gain):
        law = fl.Algorithm1(gains={"c1_alpha": gain})
        return fl.ensemble(law=law, q0=PAIR, t_span=(0, 0.5), theorems=[], metrics=["strain"], store=tmp_path / "kept")

    first, again, other = made(1.0), made(1.0), made(9.0)
    assert first.identical(again)
    assert first.strain.item() != other.strain.item()


def test_a_store_tells_starts_and_claims_apart_by_what_their_functions_hold(tmp_path):
    def stored(side, limit, extra=None):
        draw = lambda seed: side * np.random.default_rng(seed).random((2, 2))  # noqa: E731
        near = fl.claim("near", lambda run: limit - run.q.max(axis=(1, 2)) + (extra is not None))
        flock = fl.Flock(LAW, draw, t_span=(0, 0.1))
        return fl.ensemble(flock, [0], theorems=[near], metrics=["strain"], store=tmp_path / "kept", jobs=1)

    first = stored(9.0, 20.0)
    assert first.identical(stored(9.0, 20.0))
    assert stored(9.0, 21.0).margin.item() == pytest.approx(first.margin.item() + 1.0)
    assert stored(5.0, 20.0).strain.item() != first.strain.item()
    with pytest.raises(ArgumentError, match="claim near: its function holds a value that a store cannot write"):
        stored(9.0, 20.0, extra=object())


def test_falsify_refuses_a_theorem_about_another_law_before_it_searches():
    with pytest.raises(
        ArgumentError, match=r"os-3 on own flock: Algorithm 2 is applied .*which no start meets; expected"
    ):
        fl.falsify("os-3", law=LAW, q0=PAIR, t_span=(0, 1), budget=10**9)


def test_falsify_searches_from_an_own_start():
    found = fl.falsify("os-1", law=LAW, q0=PAIR, p0=[[1.0, 0.0], [-1.0, 0.0]], t_span=(0, 1), claim="ii", budget=3)
    assert found.evaluations == 3
    assert found.scenario == "own flock"


def test_a_theorem_is_found_by_the_name_that_its_source_prints():
    assert fl.theorem("Theorem 3").id == fl.theorem("olfati-saber 2006, theorem 3").id == "os-3"
    with pytest.raises(ArgumentError, match=r"several theorems are printed as 'Theorem 1'.*os-1.*zone-1-printed"):
        fl.theorem("Theorem 1")
    with pytest.raises(UnknownNameError, match="unknown theorem 'Theorem 33'"):
        fl.theorem("Theorem 33")


def test_own_claim_is_judged_by_its_margin():
    run = fl.simulate(LAW, PAIR, np.zeros((2, 2)), (0, 5))
    reach = float(np.abs(run.q).max())

    def bound(limit):
        return fl.claim("near", lambda run: limit - np.abs(run.q).max(axis=(1, 2)), statement="agents stay near")

    verdict = fl.verify(bound(reach + 1.0), run)
    assert verdict.status == "verified"
    assert [(need.status, need.name in verdict.claims[0].detail) for need in verdict.hypotheses] == [("assumed", True)]
    steps = fl.verify(bound(reach + 1.0), law=fl.SemiImplicitEuler(LAW, 0.05), q0=PAIR, t_span=(0, 5))
    assert (steps.status, steps.hypotheses) == ("verified", ())  # a map has no state between its steps
    assert fl.verify(bound(reach - 0.1), run).status == "refuted"
    assert fl.verify(bound(reach), run).status == "inconclusive"
    with pytest.raises(ArgumentError, match="expected a number, or one for each sample"):
        fl.verify(fl.claim("none", lambda run: None), run)
    with pytest.raises(ArgumentError, match="expected a name and a function of a run"):
        fl.claim("slow", 3.0)
    for truth in (lambda run: True, lambda run: run.t < 9.0):
        with pytest.raises(ArgumentError, match=r"'near' is true or false: .*at least 0 where the claim holds"):
            fl.verify(fl.claim("near", truth), run)
    of_agents = fl.claim("near", lambda run: reach + 1.0 - np.linalg.norm(run.q, axis=2))
    assert fl.verify(of_agents, run).claims[0].detail.startswith("near: margin 1 at t = ")


def test_several_theorems_and_claims_are_judged_on_one_run():
    far = fl.claim("far", lambda run: run.q[:, 1, 0] - 1.0)
    run = fl.simulate(LAW, PAIR, np.zeros((2, 2)), (0, 1))
    verdicts = fl.verify([far, "os-1"], run)
    assert [(v.theorem, v.status) for v in verdicts] == [("far", "verified"), ("os-1", fl.verify("os-1", run).status)]
    assert verdicts == fl.verify((far, "os-1"), law=LAW, q0=PAIR, t_span=(0, 1))
    flock = fl.Flock(LAW, PAIR, t_span=(0, 1), name="mine")
    (verdict,) = flock.verify(theorems=[far])
    assert (verdict.subject, verdict.to_dataframe().margin.item()) == ("mine", pytest.approx(verdict.claims[0].margin))
    for wrong in (run, far.check.margin, 3):
        with pytest.raises(ArgumentError, match=r"expected a name, such as 'os-3', or a claim of your own, fl.claim"):
            fl.verify(wrong, run)


def test_a_claim_that_no_executor_can_take_says_how_to_write_it():
    near = fl.claim("near", lambda run: 9.0)
    with ProcessPoolExecutor(1) as pool, pytest.raises(ArgumentError, match="written with def at the top of a module"):
        fl.ensemble(fl.Flock(LAW, PAIR, t_span=(0, 1)), [0], theorems=[near], executor=pool)


def test_gains_as_a_dictionary():
    assert fl.Algorithm2(gains={"c1_alpha": 2.0}, target=fl.StaticTarget((0.0,))).gains == fl.Gains(c1_alpha=2.0)
    with pytest.raises(UnknownNameError, match=r"unknown gain 'c1'; .*c1_alpha"):
        fl.Algorithm1(gains={"c1": 2.0})


UNGUARDED = """\
import numpy as np, flockana as fl
print("script begins")
runs = fl.ensemble("head-on", range(3), theorems=["os-1"], metrics=[], jobs=2)
print(runs.sizes["seed"], "runs")
"""


@pytest.mark.slow
def test_a_script_without_a_guard_is_run_once_and_told_why_it_is_slow(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(UNGUARDED)
    there = os.environ | {"PYTHONPATH": str(Path(fl.__file__).resolve().parent.parent)}
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=300, env=there, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == ["script begins", "3 runs"]
    assert 'line 3 of the script is not under `if __name__ == "__main__":`' in done.stderr


def test_a_start_is_drawn_from_the_seed_by_whatever_shows_or_exports_it(tmp_path):
    flock = fl.Flock(LAW, start, t_span=(0, 1))
    for given in ((flock, {}), (None, {"law": LAW, "q0": start, "t_span": (0, 1)})):
        shown = fl.player(given[0], seed=4, **given[1])
        assert np.array_equal(shown.trajectory.q[0], start(4))
    assert fl.player(shown.trajectory).trajectory is shown.trajectory
    made = fl.export_lammps(LAW, start, t_span=(0, 1), folder=tmp_path / "made", seed=4)
    again = fl.export_lammps(LAW, start(4), t_span=(0, 1), folder=tmp_path / "again")
    assert [path.read_text() for path in made.files] == [path.read_text() for path in again.files]
    drawn = [fl.animate(flock, tmp_path / f"{k}.gif", seed=k, seconds=0.1).read_bytes() for k in (0, 4)]
    assert drawn[0] != drawn[1]
    with pytest.raises(ArgumentError, match="trajectory = 3: expected a run, as simulate"):
        fl.player(3)


@pytest.mark.slow
def test_gif_lasts_as_long_as_asked(tmp_path):
    from PIL import Image

    path = fl.animate(path=tmp_path / "pair.gif", law=LAW, q0=PAIR, t_span=(0, 5), seconds=1.0, fps=15.0)
    with Image.open(path) as film:
        total = 0
        for k in range(film.n_frames):
            film.seek(k)
            total += film.info["duration"]
    assert total == 1000


test_what_cannot_be_explored_is_refused_before_a_page_is_served = refused(
    ({"scenario": "hexagom"}, "hexagon"),
    ({"scenario": "hexagon", "port": 10**30}, "port = 1.*: expected a whole number from 0"),
    ({"scenario": "hexagon", "browser": "no"}, "browser"),
    make=fl.explore,
    kind=FlockanaError,
)
