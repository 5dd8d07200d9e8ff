"""Erratum E1: the printed energy climbs by the kinetic energy; the corrected identity is algebra."""

from flockana.laws.olfati_saber import Algorithm1


def test_e1_the_printed_energy_climbs_by_the_kinetic_energy(verdict_of):
    claim = verdict_of("E1").claim("printed-run")
    # two agents fall from 8 to 7: what V loses becomes ½Σp² less what damping takes, and the printed H counts it twice
    drop = 30.0 * Algorithm1().alpha.psi_alpha(Algorithm1().alpha.sigma_norm(8.0))
    assert 0.5 * drop < claim.computed < drop
    assert claim.error < 1e-6 * claim.computed
