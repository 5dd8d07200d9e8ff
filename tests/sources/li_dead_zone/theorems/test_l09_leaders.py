"""Erratum L9: pinned agents and leaders, against what is known of them."""

import numpy as np

from flockana import LinearTarget, plots, rescale, scenario
from flockana.plots.snapshot import in_view
from flockana.report.figures import pictures
from flockana.sources.li_dead_zone.theorems.l09_leaders import led_run
from tests.plots.artists import axes


def test_the_middle_agents_are_pinned_each_to_its_own_leader():
    leaders = LinearTarget((0.0, 0.0), (-1.0, 0.0)), LinearTarget((30.0, 0.0), (1.0, 0.0))
    law = led_run(leaders, ((0.0, 0.0), (30.0, 0.0))).law.continuous
    assert law.pinned == (0, 7)
    assert law.group == (0,) * 7 + (1,) * 7


def test_groups_that_start_mixed_lose_agents_and_groups_apart_lose_none():
    for seed in (0, 1):
        entry = scenario("dead-zone-leaders", seed=seed)
        run = entry.run()
        told = {claim.name: claim for claim in entry.reported(run)[0].claims}
        group, x = np.array(run.law.continuous.group), run.q[-1, :, 0]
        wrong = int((group[x < 12.5] == 1).sum() + (group[x > 12.5] == 0).sum())  # leaders left the middle, 12.5
        assert told["same-leader"].computed == wrong > 0
    entry = scenario("dead-zone-leaders", gap=20.0)
    assert not [text for verdict in entry.verify(entry.run()) for text in entry.surprises(verdict)]


def test_the_report_draws_leaders_and_says_so():
    entry = scenario("dead-zone-leaders")
    run = entry.run()
    drawn = pictures(run)
    assert "Stars are the leaders" in drawn[0].caption
    ax = plots.snapshot(run, 0.0, ax=axes())
    places = [c.get_offsets().tolist() for c in ax.collections if len(getattr(c, "get_offsets", list)()) == 1]
    assert places[-2:] == [[[12.5, 12.5]], [[12.5, 12.5]]]
    assert in_view(run.law.continuous, run)[:, 0].max() >= 12.5 + 60.0
    assert rescale(entry, length=100.0).law.law.leaders[0].q == (1250.0, 1250.0)
