"""Erratum J18: large flocks from all directions, and neighbours of an agent."""


def test_a_large_flock_from_all_directions_falls_into_many(verdict_of):
    claim = verdict_of("J18").claim("any-direction")
    assert min(claim.witness["components by seed"]) > 1
    neighbours = verdict_of("J18").claim("local").computed
    assert neighbours[100] < neighbours[500] < 1.25 * neighbours[100]
