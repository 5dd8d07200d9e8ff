"""Objects as a notebook and `print` show them."""

import re

import numpy as np
import pytest

import flockana as fl


@pytest.fixture(scope="module")
def run():
    return fl.scenario("hexagon").run()


def test_verdict_is_a_table_in_html_and_latex(run):
    verdict = fl.verify("os-1", run)
    html = verdict._repr_html_()
    assert html.count("<tr>") == 1 + len(verdict.hypotheses) + len(verdict.claims)
    assert "<caption" in html and "✓ verified" in html  # noqa: PT018
    latex = verdict.to_latex()
    assert latex.count(r"\\") == 1 + len(verdict.claims)
    assert latex.startswith(r"\begin{tabular}")
    assert not re.search(r"(?<!\\)[%&#_](?![^$]*\$)", latex.splitlines()[3].replace(" & ", " "))


def test_equilibrium_and_linearisation_print_facts(run):
    equilibrium = fl.find_equilibrium(run.law, run.q[-1])
    linear = fl.linearise(run.law, equilibrium)
    assert "kind               minimum" in str(equilibrium)
    assert str(linear).count("\n  mode ") == 5
    assert f"λ = {linear.modes[0].eigenvalue.real:.4g} ± {linear.modes[0].frequency:.4g}i" in str(linear)
    for each in (equilibrium, linear, run):
        assert "<td" in each._repr_html_()
        assert "Algorithm1" in each._repr_html_()


def test_a_large_linearisation_is_shown_without_its_poles():
    q = fl.lattice.triangular(500, 7.0)
    shown = str(fl.linearise(fl.Algorithm1(), q, np.zeros_like(q)))
    assert "slowest_modes(...)" in shown


def test_an_ensemble_is_a_table_of_shares():
    law = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
    flock = fl.Flock(law, lambda seed: np.random.default_rng(seed).normal(0.0, 6.0, (4, 2)), t_span=(0.0, 1.0))
    runs = fl.ensemble(flock, range(2), theorems=["energy"], parameters={"gains.c1_gamma": [0.5, 1.0]}, jobs=1)
    first, heads, *rows = str(runs).splitlines()
    assert first.endswith(": 4 runs")
    assert heads.split() == ["parameters", "claim", "runs", "verified,", "%", "refuted,", "%"]
    assert rows[-1].split()[:6] == ["gains.c1_gamma", "=", "1.0", "energy:balance", "2", "100.0"]
    assert len(rows) == 2 * runs.claim.size
    html = runs._repr_html_()
    assert html.startswith("<table>")
    assert html.partition("</table>")[0].count("<tr>") == 1 + len(rows)
    assert repr(runs) == str(runs)
    many = fl.ensemble(flock, [0], theorems=["energy", "os-3"], jobs=1)
    assert repr(many).splitlines()[:11] == str(many).splitlines()[:11]
    assert repr(many).splitlines()[11:] == [f"… {many.claim.size - 9} more rows; print(...) shows all"]
    part = runs[["margin"]]
    assert str(part) == repr(part)
    assert "xarray" in repr(part)


def test_a_flock_a_scenario_a_theorem_and_a_tube_print_one_line():
    law = fl.Algorithm1()
    assert repr(fl.Flock(law, [[0.0], [9.0]], name="two")) == "<Flock 'two': 2 agents, Algorithm1, t = 0 to 20>"
    assert "a drawn start" in repr(fl.Flock(law, lambda seed: [[0.0], [9.0]]))
    assert repr(fl.scenario("hexagon")).endswith("; 7 agents, m = 2, Algorithm1, t = 0 to 30>")
    assert repr(fl.theorem("os-1")).startswith("<Theorem 'os-1': Algorithm 1")
    tube = fl.enclose(law, [[0.0], [9.0]], [[1.0], [2.0]], (0.0, 2.0))
    assert repr(tube) == f"<Tube of 2 agents, m = 1, Algorithm1, {len(tube.taken)} steps, t = 0 to 2, complete>"
