import numpy as np

from benchmarks.timing import interleaved, ratio


def test_all_take_their_turn_in_every_round():
    order: list[str] = []
    found = interleaved({name: lambda name=name: order.append(name) for name in "ab"}, rounds=3, least=0.0)
    assert "".join(order) == "aabb" + 3 * "ab"  # each is called twice before: to compile, and to be measured
    assert {name: values.shape for name, values in found.items()} == {"a": (3,), "b": (3,)}


def test_a_short_function_is_repeated_and_the_time_is_that_of_one_call():
    calls = []
    found = interleaved({"a": lambda: calls.append(0)}, rounds=1, least=1e-3)
    assert len(calls) > 10
    assert found["a"][0] < 1e-3


def test_the_ratio_is_the_median_round_by_round():
    assert ratio(np.array([2.0, 40.0, 3.0]), np.array([1.0, 10.0, 2.0])) == 2.0
