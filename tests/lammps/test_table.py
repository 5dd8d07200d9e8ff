from flockana.interactions import AlphaInteraction
from flockana.lammps.table import inner_cutoff, pair_table
from flockana.laws.terms.pairs import PairTerm


def test_a_table_begins_near_contact_and_its_force_vanishes_at_the_range():
    assert inner_cutoff(PairTerm(AlphaInteraction(r=8.0), 1.0, 1.0)) == 8e-6
    table = pair_table(PairTerm(AlphaInteraction(), 30.0, 0.0), 1000, 1e-5)
    assert table.force[0] > 0.0
    assert abs(table.force[-1]) < 1e-12
    assert table.energy_error < 1e-2
