from flockana.environment.targets import StaticTarget
from flockana.interactions import Gains
from flockana.lammps.pull import pull_commands
from flockana.laws.terms.navigation import Navigation


def test_the_pull_to_a_point_at_rest():
    assert list(pull_commands(Navigation(StaticTarget((5.0,)), Gains(c1_gamma=2.0, c2_gamma=3.0)))) == [
        "variable target_x equal 5.0",
        "variable target_vx equal 0.0",
        'variable pull_x atom "-2.0*(x-v_target_x)+3.0*v_target_vx"',
        "fix drag all viscous 3.0",
        "fix pull all addforce v_pull_x 0.0 0.0",
    ]
