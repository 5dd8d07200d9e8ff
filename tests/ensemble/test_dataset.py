from flockana.ensemble.dataset import metric_name


def test_a_function_given_by_its_module_is_a_variable_of_its_own_name():
    assert metric_name("strain") == "strain"
    assert metric_name("my.module:spread") == "spread"
