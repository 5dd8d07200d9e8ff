"""The trees on five nodes, counted by hand: Cayley's 125, of which 4! are paths from a given end."""

import networkx

import flockana as fl
from flockana.sources.jond_2025.theorems.j19_root_of_a_tree import globally_reachable, out_trees


def test_trees_are_counted_as_cayley_does_and_paths_as_permutations():
    assert [len(out_trees(n)) for n in (2, 3, 4, 5)] == [1, 3, 16, 125]
    assert [sum(map(bool, map(globally_reachable, out_trees(n)))) for n in (3, 4, 5)] == [2, 6, 24]
    claims = {claim.name: claim for claim in fl.verify("J19").claims}
    assert (claims["root"].computed, claims["star"].computed, claims["corrected"].computed) == (0, 24, 125)
    assert claims["star"].witness == [(0, 1), (0, 2), (0, 3), (0, 4)]


def test_the_end_of_a_path_is_reached_from_all_and_a_cycle_everywhere():
    assert globally_reachable(networkx.path_graph(4, create_using=networkx.DiGraph)) == {3}
    assert globally_reachable(networkx.cycle_graph(4, create_using=networkx.DiGraph)) == {0, 1, 2, 3}
