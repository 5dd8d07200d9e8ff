from flockana.dynamics.simulate import simulate
from flockana.laws.cucker_smale import CuckerSmale
from flockana.theorems.together import theorems_about, verify_together


def test_theorems_about_a_law_are_those_whose_law_it_is():
    law, q = CuckerSmale(), [[0.0], [1.0]]
    found = theorems_about(law, q, q)
    assert "cucker-smale" in found
    assert "os-1" not in found
    assert "cucker-smale" in [verdict.theorem for verdict in verify_together(simulate(law, q, q, (0.0, 5.0)))]
