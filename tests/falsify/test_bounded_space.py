"""The search space: which starts and parameters a point stands for, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from flockana.base.errors import ArgumentError
from flockana.falsify.bounded_space import law_parameter, search_space
from flockana.scenarios import scenario

HEAD_ON = scenario("head-on")


class TestSpace:
    def test_the_box_is_the_flock_s_with_a_tenth_of_room(self):
        case = replace(HEAD_ON, q0=np.array([[0.0, 5.0], [10.0, 5.0]]), p0=np.array([[3.0, 0.0], [-1.0, 0.0]]))
        space = search_space(case)
        np.testing.assert_array_equal(space.low, [-1.0, 4.0, -1.0, 4.0, -6.0, -6.0, -6.0, -6.0])
        np.testing.assert_array_equal(space.high, [11.0, 6.0, 11.0, 6.0, 6.0, 6.0, 6.0, 6.0])
        start = space.case(space.start)
        np.testing.assert_allclose(start.q0, case.q0, rtol=1e-14)
        np.testing.assert_allclose(start.p0, case.p0, atol=1e-14)

    def test_a_flock_at_one_place_and_at_rest_has_room_all_the_same(self):
        space = search_space(replace(HEAD_ON, q0=np.zeros((2, 1)), p0=np.zeros((2, 1))))
        assert (space.low.tolist(), space.high.tolist()) == ([-1.0] * 4, [1.0] * 4)

    def test_a_region_about_each_agent_or_a_box_for_all(self):
        near = search_space(HEAD_ON, vary="q", region=0.5)
        np.testing.assert_array_equal(near.low, [-0.5, 6.5])
        box = search_space(HEAD_ON, vary=["q"], region=(2.0, [9.0]))
        np.testing.assert_array_equal(box.case(np.zeros(2)).q0, [[2.0], [2.0]])
        np.testing.assert_array_equal(box.start, [0.0, 5.0 / 7.0])  # agent 0 starts outside: the nearest point

    def test_parameters_are_varied_on_a_logarithmic_scale_and_what_is_not_varied_stays(self):
        ranges = {"gains.c1_alpha": (0.3, 3000.0), "gains.c2_gamma": (0.0, 4.0)}
        space = search_space(HEAD_ON, vary=(), parameters=ranges)
        assert space.dimension == 2
        middle = space.case(np.full(2, 0.5))
        assert law_parameter(middle.law, "gains.c1_alpha") == pytest.approx(30.0, rel=1e-12)
        assert law_parameter(middle.law, "gains.c2_gamma") == 2.0
        assert middle.q0 is HEAD_ON.q0
        assert middle.law.alpha == HEAD_ON.law.alpha
        assert space.start[0] == pytest.approx(0.5, rel=1e-12)
        ends = [law_parameter(space.case(np.full(2, x)).law, "gains.c1_alpha") for x in (0.0, 1.0)]
        assert ends == [0.3, 3000.0]

    @pytest.mark.parametrize(
        ("options", "message"),
        [
            ({"vary": "v"}, "vary = 'v': expected 'q', 'p', both"),
            ({"vary": ("q", "q")}, "expected 'q', 'p', both"),
            ({"vary": ()}, "nothing is varied"),
            ({"region": (1.0, 1.0)}, "expected low < high on every axis"),
            ({"region": (1.0,)}, r"expected two bounds \(low, high\)"),
            ({"region": ([0.0, 0.0], 1.0)}, "expected a number or 1 of them for each corner"),
            ({"region": (0.0, np.inf)}, "expected finite numbers"),
            ({"region": 1e-18}, "region = 1e-18: expected more than the rounding of positions up to 7, such as 7e-09"),
            ({"region": 1e-300}, "region = 1e-300: expected more than the rounding"),
            ({"region": 1e308}, "region = 1e[+]308: expected bounds whose difference is a finite number"),
            ({"region": (-1e308, 1e308)}, r"region = \(-1e[+]308, 1e[+]308\): expected bounds whose difference"),
            ({"speed": 1e308}, "speed = 1e[+]308: expected bounds whose difference"),
            ({"parameters": {"gains.c3": (1.0, 2.0)}}, "gains.c3: Algorithm1 has no such number"),
            ({"parameters": {"alpha": (1.0, 2.0)}}, "alpha: Algorithm1 has no such number"),
            ({"parameters": {"gains.c1_alpha": (2.0, 1.0)}}, r"gains.c1_alpha = \(2, 1\): expected low < high"),
            ({"parameters": {"gains.c1_alpha": 2.0}}, r"expected two bounds \(low, high\)"),
        ],
    )
    def test_bad_bounds(self, options, message):
        with pytest.raises(ArgumentError, match=message):
            search_space(HEAD_ON, **options)
