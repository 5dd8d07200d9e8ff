"""What is measured of any run: over time, and the number that an ensemble keeps of it."""

from math import isnan

import pytest

from flockana import Algorithm1, DeadZoneFlocking, DeadZoneInteraction, MinimalFlocking, SemiImplicitEuler, simulate
from flockana.measures.measure import measures


@pytest.mark.parametrize("law", [DeadZoneFlocking(), SemiImplicitEuler(DeadZoneFlocking(), 0.01)])
def test_a_dead_zone_flock_has_components_at_its_range_and_no_strain(law):
    run = simulate(law, [[0.0, 0.0], [5.0, 0.0], [100.0, 0.0]], [[0.0, 0.0]] * 3, (0.0, 0.02))
    found = {name: it.number(run) for name, it in measures().items()}
    assert (found["components"], found["giant_share"]) == (2.0, pytest.approx(2.0 / 3.0))
    assert isnan(found["strain"])
    assert law.pair == DeadZoneInteraction()


def test_a_law_without_a_pair_interaction_has_no_net():
    law = MinimalFlocking(edges=[(0, 1)], spacing=1.0)
    assert law.pair is None
    run = simulate(law, [[0.0], [1.0]], [[0.0], [0.0]], (0.0, 0.1))
    assert isnan(measures()["components"].number(run))


def test_the_number_of_a_measure_over_time_is_its_last_value():
    q, p = [[0.0, 0.0], [7.5, 0.0], [3.0, 6.0], [40.0, 1.0]], [[1.0, 0.0], [0.5, 0.5], [0.0, 0.0], [1.0, 2.0]]
    run = simulate(Algorithm1(), q, p, (0.0, 1.0))
    for measure in measures().values():
        if measure.over_time is not None and measure.of_run is None:
            assert measure.number(run) == run.metric(measure.name)[-1]
    assert measures()["min_distance"].number(run) == run.min_distance()


def test_a_measure_says_what_it_is():
    measure = measures()["cohesion_radius"]
    assert (measure.label, measure.summary) == ("R, cohesion radius (length)", "R, cohesion radius, at the end")
    assert measures()["order"].label == "polar order"


def test_axes_end_at_1_for_shares_and_cosines_alone_and_are_logarithmic_for_what_decays():
    known = measures().items()
    shares = {"connectivity", "giant_share", "followers", "order", "coordination"}
    assert {name for name, it in known if it.at_most_one} == shares
    assert {name for name, it in known if it.logarithmic} == {"normalised_velocity_mismatch", "velocity_diameter"}
