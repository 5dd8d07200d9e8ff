from flockana.environment.targets import LinearTarget, RescaledVelocity
from flockana.stability.centre_path import path_and_factor


def test_a_target_that_reports_half_its_velocity_is_unwrapped():
    assert path_and_factor(RescaledVelocity(LinearTarget((0.0,), (2.0,)), 0.5))[1] == 0.5
