import re

import numpy as np
import pytest

import flockana as fl
from flockana.explore import streamed_runs
from flockana.explore.page_case import Case
from flockana.explore.streamed_runs import TooLargeError, ensure_small, watched
from flockana.player.run_codec import decode


def parts(**more):
    return Case("law", "Algorithm1", n=12, duration=2.0, **more).parts


def test_first_frames_then_the_whole(monkeypatch):
    monkeypatch.setattr(streamed_runs, "_FIRST", 0.0)
    shown, flock = [], parts()
    run = watched(flock, shown.append, limit=60.0, cancelled=lambda: False)
    own = fl.simulate(flock.law, flock.q0, flock.p0, flock.t_span)
    np.testing.assert_array_equal(run.q, own.q)
    (_, early), (_, whole) = decode(shown[0]), decode(shown[-1])
    assert len(shown) >= 2
    assert early["t"][-1] < whole["t"][-1] == np.float32(2.0)
    for one in (early, whole):  # frames of the run, at their times
        k = [int(np.argmin(abs(run.t.astype(np.float32) - t))) for t in one["t"]]
        np.testing.assert_array_equal(one["q"], run.q[k].astype(np.float32))
        np.testing.assert_allclose(one["series_0"], run.energy()[k], rtol=1e-6)


def test_a_newer_question_breaks_it_off():
    asked = []

    def cancelled():
        asked.append(1)
        return len(asked) > 5

    with pytest.raises(KeyboardInterrupt):
        watched(parts(), lambda data: None, limit=60.0, cancelled=cancelled)
    assert len(asked) == 6


def test_it_is_foretold_from_the_pace(monkeypatch):
    """Three seconds a sample: long before the limit it is clear that there are too many of them."""
    clock = iter(np.arange(0.0, 1e6, 3.0))
    monkeypatch.setattr(streamed_runs.time, "perf_counter", lambda: next(clock))
    with pytest.raises(TooLargeError) as found:
        watched(parts(), lambda data: None, limit=60.0, cancelled=lambda: False)
    told = re.search(r"about (\S+) minutes .* 2 time units, (\S+) of them took (\S+) s", str(found.value))
    minutes, done, gone = map(float, told.groups())
    assert gone < 60.0
    assert minutes == pytest.approx(gone * 2.0 / done / 60.0, rel=0.1)
    assert minutes > 4.0


def test_too_many_agents_are_refused_before_anything_runs():
    small, large = parts(), Case("law", "Algorithm1", n=streamed_runs.AGENTS + 1).parts
    ensure_small(small)
    with pytest.raises(TooLargeError, match=r"3001 agents.* MB"):
        ensure_small(large)


def test_a_long_run_is_shown_by_some_of_its_samples():
    t = np.linspace(0.0, 1.0, 901)
    q = np.sin(t)[:, None, None] * np.ones((1, 2, 1)) + np.array([[[0.0], [9.0]]])
    run = fl.Trajectory(t, q, 0 * q, 0 * q, fl.Algorithm1())
    shown = []
    assert streamed_runs.shown(run, shown.append) is run
    _, arrays = decode(shown[0])
    assert arrays["t"].tolist() == run.t.astype(np.float32).tolist()  # as many numbers as this a page takes
    many = [np.repeat(x, 200, axis=1) for x in (q, 0 * q, 0 * q)]
    streamed_runs.shown(fl.Trajectory(t, *many, fl.Algorithm1()), shown.append)
    assert len(decode(shown[1])[1]["t"]) == streamed_runs._NUMBERS // (2 * 400)
