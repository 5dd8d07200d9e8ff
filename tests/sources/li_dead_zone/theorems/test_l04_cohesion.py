"""Erratum L4: the number of flocks that end connected falls with the box that they start in."""

from flockana.sources.li_dead_zone.theorems.l04_cohesion import connected_count


def test_share_of_connected_flocks_falls_with_the_box():
    near, far = (connected_count(box, seeds=4, n=20, t_end=20.0) for box in (15.0, 150.0))
    assert (near, far) == (4, 0)
