"""Weights of zones: one number, or one for each pair."""

import flockana as fl
from tests.refused import refused

test_bad_input = refused(
    (lambda: fl.ZoneWeights(separation=(1.0, 2.0)), r"separation has shape \(2,\): expected one number, or \(n, n\)"),
    (lambda: fl.ZoneWeights(alien=(1.0, 2.0)), r"alien has shape \(2,\): expected one number, or \(n, K\)"),
    (lambda: fl.ZoneWeights(cohesion=((1.0, 2.0, 3.0), (1.0, 2.0, 3.0))), r"cohesion has shape \(2, 3\)"),
)
