from flockana.falsify.confirmation_run import tightened_options


def test_a_run_is_confirmed_with_a_thousandth_of_the_tolerance_by_an_adaptive_method():
    options = tightened_options({"method": "RK4", "dt": 0.1, "t_eval": [1.0]})
    assert sorted(options) == ["rtol", "t_eval"]
    assert round(options["rtol"], 14) == 1e-11
