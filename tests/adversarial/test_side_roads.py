"""Three hundred cases beside the main road: none is decided against what is so."""

import pytest

from tests.adversarial.side_roads import ROADS, hold


@pytest.mark.parametrize("road", ROADS)
def test_nothing_is_decided_against_what_is_so(road):
    hold(road, 1.5)
