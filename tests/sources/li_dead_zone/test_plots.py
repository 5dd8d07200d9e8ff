import numpy as np
import pytest

from flockana import Algorithm1, DeadZoneFlocking, DeadZoneInteraction, plots, simulate
from flockana.base.errors import ArgumentError


def dots(ax):
    return {
        (round(float(line.get_xdata()[0]), 6), round(float(line.get_ydata()[0]), 6)): line.get_markerfacecolor()
        != "white"
        for line in ax.lines
        if line.get_marker() == "o"
    }


def test_each_jump_has_a_closed_and_an_open_end():
    ax = plots.dead_zone_force(DeadZoneInteraction(ramp=0.0))
    ends = dots(ax)
    assert ends == {
        (3.5, 0.035): True,
        (3.5, -32.611681): False,
        (12.5, 0.125): True,
        (12.5, 1.948101): False,
        (15.0, 2.085703): False,
        (15.0, 0.0): True,
    }
    assert len(dots(plots.dead_zone_force(DeadZoneInteraction()))) == 2  # at r only


def test_no_curve_leads_across_a_jump():
    pair = DeadZoneInteraction(ramp=0.0)
    curves = [line.get_xydata() for line in plots.dead_zone_force(pair).lines if len(line.get_xdata()) > 9]
    assert len(curves) == 4
    for curve in curves:
        assert curve[:, 1] == pytest.approx(-pair.force(curve[:, 0]))
        assert np.abs(np.diff(curve[:, 1])).max() < 10.0  # the jump at d1 is 32.6 high


def test_both_energies_are_drawn():
    run = simulate(DeadZoneFlocking(), [[0.0, 0.0], [16.0, 0.0]], [[1.0, 0.0], [-1.0, 0.0]], (0.0, 3.0))
    ax = plots.dead_zone_energies(run)
    saturated, literal = (line.get_ydata() for line in ax.lines[:2])
    assert np.array_equal(saturated, run.energy())
    assert np.diff(literal).max() > 5.0 > np.diff(saturated).max()


def test_bad_input_is_named():
    run = simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    with pytest.raises(ArgumentError, match="expected a run of DeadZoneFlocking"):
        plots.dead_zone_energies(run)
