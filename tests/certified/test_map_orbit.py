"""Errors of maps' runs: against exact fractions, of chaotic maps, and of runs that are none of their map."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import flockana as fl
from flockana.certified.map_orbit import map_errors
from flockana.dynamics.map_errors import nudged_errors
from flockana.lattice import hexagonal_patch

PULLED = fl.Algorithm2(gains=fl.Gains(c1_gamma=1.5, c2_gamma=0.7), target=fl.StaticTarget((2.0,)))
LAW = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
WILD = np.random.default_rng(1).uniform(0.0, 12.0, (7, 2))


def fractions(kind, steps):
    """States of one agent under a linear pull, in exact fractions."""
    h, q, p, c1, c2 = Fraction(1, 10), Fraction(0), Fraction(1), Fraction(3, 2), Fraction(7, 10)
    states = [(q, p)]
    for _ in range(steps):
        u = -c1 * (q - 2) - c2 * p
        if kind is fl.Heun:
            q2, p2 = q + h * p, p + h * u
            u2 = -c1 * (q2 - 2) - c2 * p2
            q, p = q + h / 2 * (p + p2), p + h / 2 * (u + u2)
        else:
            f = {fl.ExplicitEuler: Fraction(0), fl.TaylorStep: Fraction(1, 2), fl.SemiImplicitEuler: Fraction(1)}[kind]
            q, p = q + h * p + f * h * h * u, p + h * u
        states.append((q, p))
    return states


@pytest.mark.parametrize("kind", [fl.ExplicitEuler, fl.TaylorStep, fl.SemiImplicitEuler, fl.Heun])
def test_enclosures_hold_the_exact_orbit_and_are_tight(kind):
    run = fl.simulate(kind(PULLED, 0.1), [[0.0]], [[1.0]], (0.0, 3.0))
    errors = map_errors(run)
    assert (errors.enclosed, errors.known_until) == (True, run.t[-1])
    for k, (q, p) in enumerate(fractions(kind, len(run.t) - 1)):
        off = abs(Fraction(float(run.q[k, 0, 0])) - q), abs(Fraction(float(run.p[k, 0, 0])) - p)
        assert off[0] <= Fraction(float(errors.q[k, 0])) <= off[0] + Fraction(1, 10**15)
        assert off[1] <= Fraction(float(errors.p[k, 0])) <= off[1] + Fraction(1, 10**15)


def test_nothing_is_known_after_rounding_has_taken_over():
    """Seven agents with steps too long for their net; a relabelled and mirrored start rounds otherwise."""
    run = fl.simulate(fl.TaylorStep(LAW, 0.12), WILD, 0.0 * WILD, (0.0, 24.0))
    order, mirror = np.array([3, 5, 1, 0, 6, 2, 4]), np.array([-1.0, 1.0])
    other = fl.simulate(run.law, WILD[order] * mirror, 0.0 * WILD, (0.0, 24.0))
    apart = np.linalg.norm(other.q * mirror - run.q[:, order], axis=2)
    assert apart[-1].max() > 0.1
    ball, nudged = map_errors(run), nudged_errors(run)
    for errors in (ball, nudged):
        assert 5.0 < errors.known_until < 20.0
        known = run.t <= errors.known_until
        assert np.isinf(errors.q[~known]).all()
        assert errors.reason
        assert (apart[known] <= (2.0 * errors.q[known]).max(axis=1, keepdims=True) + 1e-12).all()
    assert (ball.enclosed, nudged.enclosed) == (True, False)
    assert ball.known_until >= nudged.known_until


def test_a_run_that_is_not_its_maps_is_known_at_its_start_alone():
    run = fl.simulate(fl.TaylorStep(LAW, 0.01), hexagonal_patch(1, 7.0), np.zeros((7, 2)), (0.0, 0.2))
    other = replace(run, law=fl.TaylorStep(replace(LAW, gains=fl.Gains(c1_gamma=500.0)), 0.01))
    for errors in (map_errors(other), nudged_errors(other)):
        assert errors.known_until < 0.1
        assert "left the orbit" in errors.reason or "does not lead" in errors.reason


def test_where_there_are_no_balls_a_nudge_tells():
    headings = fl.HeadingAveraging(range=9.0)
    speeds = np.tile([[1.0, 0.2]], (7, 1)), headings.velocities(np.linspace(0.0, 1.0, 7))
    for law, p in zip((fl.TaylorStep(fl.CuckerSmale(), 0.1), headings), speeds, strict=True):
        run = fl.simulate(law, WILD, p, (0.0, 2.0))
        errors = map_errors(run)
        assert (errors.enclosed, errors.known_until) == (False, run.t[-1])
        assert errors.q.max() < 1e-10
