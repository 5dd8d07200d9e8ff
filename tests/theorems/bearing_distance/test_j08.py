"""Erratum J8: with the estimated velocity the flock disperses."""

import numpy as np


def test_the_estimate_scatters_the_flock(verdict_of):
    assert np.median(verdict_of("J8").claim("holds-together").witness["components by seed"]) == 10
    assert min(verdict_of("J8").claim("equivalent").witness["mean error of the estimate, by seed"]) > 5.0
