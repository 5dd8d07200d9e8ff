"""Thirty of the cases of `tests.adversarial.test_side_roads`, in every run of the tests."""

import pytest

from tests.adversarial.side_roads import ROADS, hold


@pytest.mark.slow
@pytest.mark.parametrize("road", ROADS)
def test_a_few_cases_beside_the_main_road(road):
    hold(road, 0.15)
