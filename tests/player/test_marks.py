"""Marks in a player: the instants that claims point to, in order, each once."""

from types import SimpleNamespace

import pytest

from flockana.player.codec import decode
from flockana.player.marks import marks_of


def verdict(theorem, **times):
    claims = [SimpleNamespace(name=name, witness=witness) for name, witness in times.items()]
    return SimpleNamespace(theorem=theorem, claims=claims)


RUN = SimpleNamespace(t=[0.0, 1.0, 4.0])


def test_of_one_instant_all_names_and_none_beyond_the_run():
    verdicts = [
        verdict("one", i={"time": 3.0}, ii={"time": 1}, iii={"time": 4.5}, iv={"time": "soon"}, v=None, vi="3.0"),
        verdict("two", i={"time": 3.0, "pair": (0, 1)}),
    ]
    assert marks_of(RUN, verdicts, [2.0]) == [(1.0, "one ii"), (2.0, "as in the source"), (3.0, "one i, two i")]
    assert marks_of(RUN, [], [0.5], named="seen") == [(0.5, "seen")]


def test_a_player_is_told_of_verdicts():
    import flockana as fl

    run = fl.simulate(fl.Algorithm1(), [[0.0, 0.0], [7.5, 0.0]], [[0.0, 0.0]] * 2, (0.0, 2.0))
    found = fl.verify("energy", run)
    header, _ = decode(run.player(verdicts=[found])._scene())
    assert [one["label"] for one in header["marks"]] == [name for _, name in marks_of(run, [found])]
    assert header["marks"][-1]["t"] == pytest.approx(found.claim("balance").witness["time"])
