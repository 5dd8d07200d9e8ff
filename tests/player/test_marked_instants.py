from types import SimpleNamespace

from flockana.player.marked_instants import marks_of


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
