"""Gains for each agent: what is asked for, and what a search that finds so much is said to show."""

from types import SimpleNamespace

import numpy as np
import pytest

from flockana import AlphaInteraction, Gains, Tolerances, theorem
from flockana.lattice import hexagonal_spiral
from flockana.sources.montanari_2025 import theorems as heterogeneous_gains

OPTIONS = [("printed", 12, {"rotation": "counted"}), ("apart", 12, {"rotation": "apart"}),
           ("simplified", 30, {"form": "simplified"})]  # fmt: skip


class Found:
    """A search that finds rates as told, certified by roots with errors as told."""

    def __init__(self, patch, alike, apart, errors=((0.0, 0.0), (0.0, 0.0))):
        self.asked, self.rates, self.errors = [], (alike, apart), errors
        patch.setattr(heterogeneous_gains, "gain_problem", self.problem)
        patch.setattr(heterogeneous_gains, "design_gains", self.design)
        patch.setattr(heterogeneous_gains, "eigenvalues", self.eigenvalues)
        self.claims = theorem("heterogeneous-gains").examine(Tolerances())[1]

    def problem(self, q, **options):
        self.asked.append((q, options))
        return SimpleNamespace(matrix=lambda gains: gains)

    def design(self, problem, starts):
        assert starts == 1
        alike, apart = self.rates
        return SimpleNamespace(problem=problem, rate_homogeneous=alike, rate_heterogeneous=apart, ratio=apart / alike,
                               homogeneous=0, heterogeneous=1)  # fmt: skip

    def eigenvalues(self, k):
        """A root further left, found badly, and the slowest, at minus the rate."""
        rate = self.rates[k]
        return np.array([-3.0 * rate + 1j, -rate]), np.array([9.0, 1.0]) * self.errors[k]


@pytest.mark.parametrize(
    ("ratio", "status"), [(1.5, "verified"), (1.011, "verified"), (1.01005, "inconclusive"), (1.0, "inconclusive")]
)
def test_a_gain_counts_from_a_hundredth_on_and_less_refutes_nothing(monkeypatch, ratio, status):
    found = Found(monkeypatch, 2.0, 2.0 * ratio)
    for claim in found.claims:
        assert claim.status == status
        assert claim.margin == pytest.approx(ratio - 1.01, rel=1e-9)
        assert claim.error == pytest.approx(1e-4 * ratio, rel=1e-12, abs=0.0)
        assert (claim.computed["alike"], claim.computed["per agent"]) == (2.0, 2.0 * ratio)
        assert claim.witness == {"ratio": pytest.approx(ratio)}
    said = f"at least {2.0 * ratio:.4f} with gains for each agent, {100.0 * (ratio - 1.0):.2g} % faster"
    assert said in found.claims[0].detail


def test_relative_errors_of_both_slowest_roots_add_up(monkeypatch):
    """0.04 of 2 and 0.3 of 3; how the faster roots are known does not matter."""
    found = Found(monkeypatch, 2.0, 3.0, (np.array([5.0, 0.04]), np.array([5.0, 0.3])))
    for claim in found.claims:
        assert claim.error == pytest.approx(1.5 * (0.02 + 0.1 + 1e-4), rel=1e-12)
        assert claim.status == "verified"
    assert "by more than 1%" in found.claims[0].stated


def test_which_flocks_are_asked_about(monkeypatch):
    found = Found(monkeypatch, 2.0, 3.0)
    assert [claim.name for claim in found.claims] == [name for name, *_ in OPTIONS]
    for claim, (q, options), (_, n, more) in zip(found.claims, found.asked, OPTIONS, strict=True):
        np.testing.assert_array_equal(q, hexagonal_spiral(n, AlphaInteraction().d))
        assert options == {"alpha": AlphaInteraction(), "gains": Gains(), **more}
        assert claim.computed["n"] == n


@pytest.mark.slow
def test_what_the_search_finds(verdict_of):
    """The rate of a double root at −√5, of alike gains within 5, with the rotation apart: that no gains better."""
    verdict = verdict_of("heterogeneous-gains")
    assert [claim.status for claim in verdict.claims] == ["verified", "inconclusive", "verified"]
    assert verdict.claim("apart").computed["alike"] == pytest.approx(5.0**0.5, rel=1e-6)
    assert verdict.claim("printed").margin == pytest.approx(0.198, abs=1e-3)
    assert verdict.claim("simplified").margin == pytest.approx(0.0252, abs=1e-3)
