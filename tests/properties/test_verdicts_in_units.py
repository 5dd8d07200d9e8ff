"""What a theorem says of a short run is the same in all units."""

import pytest

import flockana as fl
from flockana.theorems.run_verdicts import theorems_about
from tests.properties.test_every_law import LAWS, OWN_RATE, state
from tests.theorems.made_up import same_in_all_units

Q, P, *_ = state(5)
TREE = fl.MinimalFlocking(edges=tuple((k, k + 1) for k in range(len(Q) - 1)), spacing=7.0, normalised=False)
MOVING = {name: law for name, (law, _) in LAWS.items() if name not in OWN_RATE} | {"a tree": TREE}


@pytest.fixture(scope="module", params=MOVING)
def run(request):
    law = MOVING[request.param]
    if isinstance(law, fl.NetAveraging):
        return fl.simulate(law, Q, 0.0 * P, (0.0, 3.0))
    return fl.simulate(law, Q, None if isinstance(law, fl.VelocityLaw) else P, (0.0, 0.3))


@pytest.mark.slow
@pytest.mark.parametrize("scaling", [(1e-6, 1.0), (1e3, 1e-3), (25.4, 60.0)])
def test_what_is_said_of_a_law_is_said_in_all_units(run, scaling):
    for name in theorems_about(run.law, Q, P):
        same_in_all_units(name, run, scaling)
