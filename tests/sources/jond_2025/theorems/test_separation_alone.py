"""Swings of the minimal model by their closed forms: a pair, a path, a driven chain, and two that pass each other."""

from math import cos, exp, pi, sin, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq

from flockana import Tolerances, theorem
from flockana.sources.jond_2025.theorems import separation_alone as zone_separation
from flockana.theorems.observed_run import observed


@pytest.fixture(scope="module")
def seen():
    runs = []

    def kept(*given, **options):
        runs.append((observed(*given, **options), options))
        return runs[-1][0]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(zone_separation, "observed", kept)
        claims = theorem("zone-separation").examine(Tolerances(agreement=0.03, energy=1e-4))[1]
    assert all((options["rtol"], options["atol"]) == (1e-11, 1e-12) for _, options in runs)
    return {claim.name: claim for claim in claims}, [one.run for one, _ in runs]


@pytest.mark.slow
def test_a_pair_swings_about_its_spacing_with_the_frequency_of_two_mu(seen):
    claim, run = seen[0]["alone"], seen[1][0]
    period = 2.0 * pi / sqrt(6.0)
    assert claim.status == "verified"
    assert claim.stated == {"period": pytest.approx(period, rel=1e-14), "amplitude": 0.5}
    end = pytest.approx(0.5, rel=1e-9)
    assert claim.computed == {"period": pytest.approx(period, rel=1e-10), "amplitude at the end": end}
    assert claim.witness == {"q(0)": [[0.0, 0.0], [2.5, 0.0]], "p(0)": "0"}
    assert "with amplitude 0.5" in claim.detail
    assert (run.t[0], run.t[-1]) == (0.0, pytest.approx(20.0 * period, rel=1e-14))
    x = run.q[:, 1, 0] - run.q[:, 0, 0]
    off = np.abs(x - 2.0 - 0.5 * np.cos(sqrt(6.0) * run.t)).max()
    assert off < 1e-8
    assert 0.03 - claim.margin == pytest.approx(2.0 * off, abs=1e-8)
    assert claim.error < 1e-8


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.9, 1.0 - 1e-6])
def test_a_pair_that_swings_otherwise_is_told(monkeypatch, share):
    """Planted: the frequency of so much μ. After 20 periods nothing agrees, or all but 1e-4 of a period does."""
    monkeypatch.setattr(zone_separation, "_MU", 3.0 * share)
    law = zone_separation.MinimalFlocking
    monkeypatch.setattr(zone_separation, "MinimalFlocking", lambda **given: law(**given | {"mu": 3.0}))
    claim = zone_separation._pair(Tolerances(agreement=1e-5))
    assert claim.status == "refuted"
    assert claim.margin == pytest.approx(1e-5 - (2.0 if share == 0.9 else 20.0 * pi * 1e-6), rel=0.1)


def energy(q, p):
    """H of the path of five about its centre: of each edge ½ μ (|x| − ρ)², with μ = 3 and ρ = 2."""
    gaps = np.linalg.norm(np.diff(q, axis=0), axis=1)
    return 0.5 * float(((p - p.mean(axis=0)) ** 2).sum()) + 1.5 * float(((gaps - 2.0) ** 2).sum())


@pytest.mark.slow
def test_a_path_keeps_its_energy_until_it_is_aligned(seen):
    claim, (alone, aligned) = seen[0]["energy"], seen[1][1:3]
    assert [run.law.sigma for run in (alone, aligned)] == [0.0, 1.0]
    drift = max(abs(h / alone.energy()[0] - 1.0) for h in alone.energy())
    for run in (alone, aligned):
        assert (run.t[0], run.t[-1], run.n) == (0.0, 60.0, 5)
        assert max(np.abs(run.q[0, 0]).max(), np.abs(np.diff(run.q[0], axis=0)).max()) <= 2.0
        assert np.abs(run.p[0]).max() <= 1.0
        centre = run.q[0].mean(axis=0) + np.multiply.outer(run.t, run.p[0].mean(axis=0))
        np.testing.assert_allclose(run.q.mean(axis=1), centre, atol=1e-8)
    assert claim.status == "verified"
    assert claim.error < 1e-8
    assert claim.computed == {
        "drift of H without alignment": pytest.approx(drift, rel=1e-12, abs=0.0),
        "H(T)/H(0) with it": pytest.approx(aligned.energy()[-1] / aligned.energy()[0], rel=1e-12, abs=0.0),
    }
    assert 0.0 < claim.computed["H(T)/H(0) with it"] < 1e-9
    assert claim.margin == pytest.approx(1e-4 - max(claim.computed.values()), rel=1e-9, abs=0.0)
    assert claim.witness["H(0)"] == pytest.approx(energy(alone.q[0], alone.p[0]), rel=1e-12)
    assert "over 60 time units" in claim.detail


def test_a_chain_resonates(seen):
    """y₂ = ½ a ω t sin ωt: ½ of x₀ = 39.5 π and 1/(4 x₀) more at most, seen at 40 instants of a period."""
    claim, run, x = seen[0]["chain"], seen[1][3], 39.5 * pi
    assert claim.status == "verified"
    assert claim.error < 1e-6
    assert claim.stated == pytest.approx(0.5 * x, rel=1e-12)
    assert 0.5 * x * cos(pi / 40.0) < claim.computed < 0.5 * x + 0.25 / x + 1e-3
    assert claim.margin == pytest.approx(0.03, abs=1e-6)
    assert claim.witness == {"q(0)": [[0.0], [2.01], [4.01]], "edges": ((0, 1), (1, 2))}
    assert "after 20 periods" in claim.detail
    assert run.t[-1] == pytest.approx(40.0 * pi / sqrt(3.0), rel=1e-14)
    y = np.abs(np.diff(run.q[:, :, 0], axis=1)[:, 1]) - 2.0
    np.testing.assert_allclose(y, 0.005 * sqrt(3.0) * run.t * np.sin(sqrt(3.0) * run.t), atol=1e-7)


def test_two_that_are_fast_pass_each_other_and_swing_about_the_spacing_beyond(seen):
    """Until they meet x = 1 − 4 e^(−t) sin t; then z = x + 1 has the same equation, from 1 and the speed of then."""
    claim, run = seen[0]["close-encounters"], seen[1][4]
    met = brentq(lambda t: 1.0 - 4.0 * exp(-t) * sin(t), 0.0, 0.5)
    speed = -4.0 * exp(-met) * (cos(met) - sin(met))
    late = run.t[run.t > met] - met
    z = np.exp(-late) * (np.cos(late) + (1.0 + speed) * np.sin(late))
    assert (run.t[0], run.t[-1]) == (0.0, 2.0)
    assert claim.status == "refuted"
    assert claim.computed == claim.margin == pytest.approx(z.min() - 1.0, rel=1e-6)
    assert claim.error < 1e-8
    assert claim.witness == {"q(0)": [[0.0], [1.0]], "p(0)": [[2.0], [-2.0]]}
