import gc

from flockana.base.garbage import relaxed_gc


def test_the_collector_is_relaxed_within_the_block_alone():
    before = gc.get_threshold()
    with relaxed_gc():
        assert gc.get_threshold()[0] == 100000
    assert gc.get_threshold() == before
