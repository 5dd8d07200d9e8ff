"""The shipped recording is what its script makes, and is read with its gaps; its switch of names is found."""

import pytest

import flockana as fl
from flockana.recorded.example_recording import example_recording
from tools import make_recording


def test_the_file_is_what_the_script_writes():
    assert make_recording.TARGET.read_text(encoding="utf-8") == make_recording.table()


def test_short_gaps_are_filled_and_the_long_one_is_not():
    rec = example_recording()
    full = rec.filled(most_acceleration=50.0, longest=0.3)
    assert rec.filled().gaps == rec.gaps
    assert 0 < full.gaps < rec.gaps
    assert not full.present[50:70, 5].any()
    assert float(full.metrics(d=7.0, r=8.4)["agents"].min()) >= 12


@pytest.mark.slow
def test_the_switch_of_names_is_no_motion_of_the_law_and_what_follows_is():
    law = fl.Algorithm2(target=fl.StaticTarget((21.0, 3.5)))
    rec = example_recording().filled(most_acceleration=50.0, longest=0.5)
    switched = fl.verify("energy", rec.window(3.24, 5.0), law=law).hypotheses[0]
    assert switched.status == "unmet"
    assert "at t = 3.6" in switched.detail or "at t = 4" in switched.detail
    assert fl.verify("energy", rec.window(4.1, 6.0), law=law).hypotheses[0].status == "met"
