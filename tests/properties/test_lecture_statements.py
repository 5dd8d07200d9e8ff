"""What lectures and model answers say in words, by numbers: statements that were false once."""

import math

import numpy as np

import flockana as fl
from flockana.course import build
from flockana.course.course_pages import number_of
from flockana.scenarios.one_start import entries

TEXT = {
    number_of(source): " ".join(source.read_text(encoding="utf-8").replace("\n# ", " ").split())
    for source in build.sources()
}


def components(q, r):
    return len(set(fl.components(len(q), fl.links(q, r))))


def test_the_components_of_the_first_film_join_after_its_end():
    case = fl.scenario("notebook-algorithm1")
    assert case.t_span[1] == 5.0
    run = fl.simulate(case.law, case.q0, case.p0, (0.0, 12.0), t_eval=np.linspace(0.0, 12.0, 1201))
    counts = [components(q, case.law.alpha.r) for q in run.q]
    at_5 = counts[int(np.searchsorted(run.t, 5.0))]
    assert (counts[0], at_5, counts[-1]) == (4, 3, 1)
    joined = run.t[max(k for k, count in enumerate(counts) if count > 1) + 1]
    assert f"{joined:.2f}" == "7.12"
    assert "from $t = 7.12$ on" in TEXT["A2"]
    assert "four components at the start and three at the end of the film" in TEXT["A2"]


def test_case_1_starts_connected_and_ends_in_pieces():
    run = fl.scenario("msn-case1").run()
    reached = run.metrics()["connectivity"].values
    assert (reached[0], f"{reached[-1]:.2f}") == (1.0, "0.29")
    assert "$C = 1$ at $t = 0$" in TEXT["A1"]
    assert "$C = 0.29$ at the end" in TEXT["A1"]


def test_the_floor_of_lecture_07_passes_c_star_at_23():
    alpha = fl.AlphaInteraction()
    floor = {n: (n * (n - 1) // 2 - n**2 // 3) * float(alpha.psi_alpha(alpha.r_alpha)) for n in range(2, 200)}
    assert f"{floor[23]:.1f} {floor[22]:.1f} {alpha.c_star:.1f}" == "56.7 51.5 52.4"
    assert min(n for n in floor if floor[n] > alpha.c_star) == 23
    assert all(floor[n] > alpha.c_star for n in range(23, 200))
    assert "56.7 > 52.4" in TEXT["07"]
    assert "that is 51.5" in TEXT["07"]


def test_the_law_of_lecture_11_repels_below_d_and_attracts_from_there_to_r():
    formula = "k/2*((r**2-s**2)**4/4 - (r**2-d**2)*(r**2-s**2)**3/3 + (r**2-d**2)**4/12)"
    well = fl.pair_law(formula, adjacency="(1 - s/r)**2", range=3.0, length=2.0, parameters={"k": 0.01})
    assert np.all(well.force(np.linspace(0.05, 1.99, 99)) > 0.0)
    assert np.all(well.force(np.linspace(2.01, 2.99, 99)) < 0.0)
    s = np.array([0.5, 1.0, 2.5, 2.9])
    assert np.allclose(-well.force(s), 0.01 * s * (s**2 - 4.0) * (9.0 - s**2) ** 2)
    assert math.isclose(well.energy(3.0) - well.energy(2.0), 0.01 * 5.0**4 / 24.0, rel_tol=1e-12)


def test_connectedness_bounds_positions_and_a_level_set_does_not():
    assert "in a connected net of $n$ agents no two are farther apart than $(n-1)r$" in TEXT["02"]
    law = fl.Algorithm1()
    far = [law.energy(0.0, [[0.0, 0.0], [x, 0.0]], np.zeros((2, 2))) for x in (10.0, 1e6)]
    assert far[0] == far[1]


def test_the_bump_is_defined_where_the_exercises_need_it():
    assert "\\rho_h(z) = \\begin{cases} 1 & 0 \\le z < h" in TEXT["01"]
    assert "with $0 < a \\le b$" in TEXT["01"]


def test_the_bound_on_links_asks_for_three_agents():
    from flockana import lattice

    assert "(ii) it has at most $3n - 6$ links, $m = 2$, $n \\ge 3$" in TEXT["04"]
    assert len(lattice.links(lattice.line(2, 7.0), 8.4)) == 1 > 3 * 2 - 6


def test_neighbours_of_the_zones_are_others_and_the_strength_is_named():
    from flockana.sources.jond_2025.symbolic import spanning_trees

    assert "$\\mathcal R_i = \\{j \\ne i : d_{ij} \\le z_c\\}$" in TEXT["08"]
    assert "\\mu" in spanning_trees.spacing_spectrum(2).result._repr_latex_()
    assert "(The output writes `μ` for the strength $w_0$ of the spring.)" in TEXT["08"]


def test_matching_under_the_dead_zone_is_called_measured_wherever_the_theorem_is_printed():
    assert "velocities match within components is measured and not proved" in TEXT["12"]
    law = fl.DeadZoneFlocking()
    run = fl.simulate(law, [[0.0, 0.0], [5.0, 0.0]], np.zeros((2, 2)), (0.0, 0.5))
    assert fl.verify("dead-zone-1-corrected", run).claim("components").proof is None
    assert "(measured, not proved;" in fl.theorem("dead-zone-1-corrected").statement
    promise = next(entry.promise for entry in entries() if entry.theorem == "dead-zone-1-corrected")
    assert "is measured, not proved" in promise


def test_what_sets_the_rate_of_late_consensus():
    from flockana.stability import consensus_root

    values, tau = [0.586, 2.0, 3.414], 0.01
    rates = [-consensus_root(value, tau).real for value in values]
    assert min(rates) == rates[0]  # the smallest positive eigenvalue, for small delays
    assert "for small $\\tau$ that of $\\lambda_2$" in TEXT["12"]


def test_a_flat_obstacle_traps_one_agent_though_it_is_convex():
    bar = fl.scenario("paper-trapped-convex").law
    alone = fl.Algorithm3(gains=bar.gains, target=bar.target, obstacles=bar.obstacles)
    face = alone.obstacles[0].clearance(np.array([[50.0, 0.0]]))[0]
    settled = fl.simulate(alone, [[50.0, 0.5]], [[0.0, 0.0]], (0.0, 400.0))
    assert face > 4.2  # it starts out of the bar's reach
    assert np.linalg.norm(settled.p[-1]) < 1e-6
    assert abs(settled.q[-1, 0, 1]) < 1e-3  # back on the axis, before the bar
    assert settled.q[-1, 0, 0] < 51.0
    assert "*flat* face has $R_k = \\infty$ and traps, at the outer balance, although it is convex" in TEXT["05"]
