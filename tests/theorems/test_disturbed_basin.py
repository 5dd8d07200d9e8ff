"""The input-to-state theorem: verified in a light wind, vacuous in a strong one, of noise and of other laws."""

import numpy as np
import pytest

from flockana import Algorithm1, Delayed, Disturbed, find_equilibrium, rescale, simulate, verify

PAIR = find_equilibrium(Algorithm1(), [[0.0], [7.0]]).q


def verdict(law, **how):
    return verify("disturbed-basin", simulate(law, PAIR, 0.0 * PAIR, (0.0, 10.0), **how))


@pytest.mark.slow
def test_a_light_wind_is_borne():
    found = verdict(Disturbed(Algorithm1(), swing=[[0.1], [-0.1]], frequency=0.7))
    assert (found.status, found.rigour) == ("verified", "symbolic")
    assert [claim.name for claim in found.claims] == ["stays", "ultimate"]
    assert all(claim.margin > 0.0 for claim in found.claims)


@pytest.mark.slow
def test_it_is_the_same_in_other_units_and_its_numbers_are_the_units_own():
    run = simulate(Disturbed(Algorithm1(), swing=[[0.1], [-0.1]], frequency=0.7), PAIR, 0.0 * PAIR, (0.0, 10.0))
    here, there = (verify("disturbed-basin", rescale(run, length=length)) for length in (1.0, 1000.0))
    assert there.status == "verified"
    assert "in lengths of ℓ, rounded" in there.hypotheses[1].detail
    assert there.hypotheses[1].margin == pytest.approx(1000.0 * here.hypotheses[1].margin, rel=2e-3)
    for one, other in zip(here.claims, there.claims, strict=True):
        assert other.computed == pytest.approx(1000.0 * one.computed, rel=1e-3)
        assert other.margin == pytest.approx(1000.0 * one.margin, rel=2e-3)


@pytest.mark.slow
def test_a_wind_on_all_alike_moves_no_shape():
    found = verdict(Disturbed(Algorithm1(), force=(100.0,)))
    assert found.status == "verified"
    assert found.claim("ultimate").computed < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "how", "reason"),
    [
        (Disturbed(Algorithm1(), force=[[1.0], [-1.0]]), {}, "drive the flock out"),
        (Disturbed(Algorithm1(), times=(0.0, 5.0), table=[[[0.0], [0.0]], [[1.0], [-1.0]]]), {}, "drive the flock out"),
        (Disturbed(Algorithm1(), force=lambda t: ((0.0,), (0.0,))), {}, "no bound is known of a force that is a funct"),
        (Disturbed(Algorithm1(), intensity=0.1), {"dt": 0.01}, "wrapped in Disturbed"),
        (Disturbed(Delayed(Algorithm1(), 0.01)), {"dt": 0.01}, "wrapped in Disturbed, Delayed"),
        (Algorithm1(), {}, "the law is Algorithm1"),
    ],
)
def test_else_it_is_vacuous_with_the_reason(law, how, reason):
    found = verdict(law, **how)
    assert found.status == "vacuous"
    assert reason in found.claims[0].detail or any(reason in one.detail for one in found.hypotheses)


def test_what_is_taken_off_is_the_mean():
    from flockana.theorems.disturbed_basin import largest_push

    law = Disturbed(Algorithm1(), force=(3.0,), swing=[[1.0], [3.0]])
    assert largest_push(law, (2, 1)) == pytest.approx(np.sqrt(2.0))
    gusts = Disturbed(Algorithm1(), times=(0.0, 1.0), table=[[[2.0], [0.0]], [[1.0], [4.0]]], force=(3.0,))
    assert largest_push(gusts, (2, 1)) == pytest.approx(np.sqrt(4.5))
