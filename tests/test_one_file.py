"""A new law, interaction, obstacle, theorem, scenario, proof or figure is one new file: toys that no table names."""

import importlib
import sys
from pathlib import Path

import numpy as np
import pytest

import flockana as fl

TOYS = Path(__file__).parent / "toys"
ROOMS = ("interactions", "environment", "measures", "plots", "sources")


@pytest.fixture(scope="module")
def toys():
    """The toys' folders joined to the package's own, as if their files had been put there."""
    packages = {room: importlib.import_module(f"flockana.{room}") for room in ROOMS}
    caches = (
        importlib.import_module("flockana.theorems.catalogue").catalogue,
        importlib.import_module("flockana.scenarios.scenario").catalogue,
        importlib.import_module("flockana.report.figures").pictures_of_laws,
        importlib.import_module("flockana.base.serialize").parameter_classes,
        importlib.import_module("flockana.measures.measure").measures,
        importlib.import_module("flockana.theorems.errata").errata,
        importlib.import_module("flockana.base.bibtex_entries").bibliography,
    )
    before = set(sys.modules)
    for room, package in packages.items():
        package.__path__.append(str(TOYS / room))
    for cache in caches:
        cache.cache_clear()
    yield {
        name: getattr(importlib.import_module(f"flockana.{module}"), name)
        for name, module in (
            ("ToyMorse", "interactions.toy_morse"),
            ("ToySwarm", "sources.toy_2026.laws"),
            ("ToySlab", "environment.toy_slab"),
        )
    }
    for room, package in packages.items():
        package.__path__.remove(str(TOYS / room))
    for name in set(sys.modules) - before:
        if ".toy_" in name:
            del sys.modules[name]
    for cache in caches:
        cache.cache_clear()


@pytest.fixture(scope="module")
def run(toys):
    return fl.scenario("toy-swarm").run()


def test_a_run_with_its_energy_and_metrics(run, toys):
    assert run.status == "complete"
    assert np.abs(run.energy_residual).max() < 1e-7 * run.energy()[0]
    found = run.metrics()
    assert float(found["toy_speed"][-1]) < 1e-4
    assert float(found["connectivity"][-1]) == 1.0
    assert float(found["normalised_deviation_energy"][-1]) < 1e-3


def test_a_measure(run, toys):
    reach = run.metric("toy_reach")
    np.testing.assert_array_equal(reach, np.linalg.norm(run.q, axis=2).max(axis=1))
    assert run.metrics()["toy_reach"].attrs == {"long_name": "farthest from the origin", "units": "length"}
    assert fl.plots.measure(run, "toy_reach").get_ylabel() == "farthest from the origin (length)"
    many = fl.ensemble("toy-swarm", [0], theorems=["toy-rest"], metrics=["toy_reach"])
    assert float(many["toy_reach"][0]) == pytest.approx(reach[-1], rel=1e-12)


def test_a_plot(run, toys):
    toy_hodograph = importlib.import_module("flockana.plots.toy_hodograph").toy_hodograph
    (line, *_) = toy_hodograph(run).get_lines()
    np.testing.assert_array_equal(line.get_xydata(), run.p[:, 0])


def test_saved_and_loaded(run, toys, tmp_path):
    assert fl.Trajectory.load(run.save(tmp_path / "toy.nc")).law == run.law
    assert fl.cite(run.law) == "@misc{toy, title = {A toy}}"
    assert fl.rescale(run.law, time=2.0).k == 0.5


def test_theorem_and_scenario(run, toys):
    item = fl.scenario("toy-swarm")
    assert {"toy-swarm"} <= set(fl.scenarios())
    assert [verdict.status for verdict in item.verify(run)] == ["verified"]
    assert fl.verify("toy-rest", run).claim("slow").status == "verified"
    assert fl.verify("alpha-flocking", run).claim("giant").status == "verified"
    assert fl.verify("os-1", run).status == "vacuous"


def test_an_erratum(toys):
    assert str(fl.theorem("T1").erratum) == "T1 · Toy: drag keeps the energy ✗ · right: it loses k Σ‖p_i‖² ·"
    assert fl.verify("T1").claim("printed").status == "refuted"
    assert fl.theorem("T1").title == "Drag keeps the energy (as printed)"


def test_the_toy_paper_is_short():
    files = [path for path in (TOYS / "sources" / "toy_2026").iterdir() if path.is_file()]
    assert sum(len(path.read_text().splitlines()) for path in files) < 150


def test_derivatives_and_linearisation(run, toys):
    q, p = run.q[5], run.p[5]
    law, h = run.law, 1e-6
    for k in range(q.size):
        e = np.zeros(q.size)
        e[k] = h
        e = e.reshape(q.shape)
        numeric = (law.acceleration(0.0, q + e, p) - law.acceleration(0.0, q - e, p)) / (2.0 * h)
        np.testing.assert_allclose(law.jacobian(0.0, q, p)[q.size :, k], numeric.ravel(), atol=1e-7)
    found = fl.linearise(law, fl.find_equilibrium(law, run.q[-1]))
    assert (found.stable, len(found.zero_modes)) == (True, 3)


def test_an_equilibrium_by_the_kernels_alone(toys):
    """No formula of the pair law is known to CasADi: IPOPT takes value, gradient and Hessian from the kernels."""
    law, q = toys["ToySwarm"](toys["ToyMorse"]()), [[0.0, 0.0], [2.8, 0.3], [1.2, 2.4]]
    for law_of_pairs in (law, fl.Algorithm1(law.pair), fl.Algorithm2(law.pair, target=fl.StaticTarget((0.0, 0.0)))):
        found = fl.find_equilibrium(law_of_pairs, q)
        assert (found.kind, found.rigid_modes, found.zero_modes, found.residual < 1e-12) == ("minimum", 3, 0, True)
    assert fl.find_equilibrium(law, q).strain() < 1e-9
    assert fl.find_equilibrium(law, q, method="root").kind == "minimum"


def test_an_obstacle(toys):
    law = fl.Algorithm3(toys["ToyMorse"](), target=fl.StaticTarget((9.0, 0.0)), obstacles=(toys["ToySlab"](),))
    run = fl.simulate(law, [[-9.0, 0.0], [-9.0, 3.0]], np.zeros((2, 2)), (0.0, 20.0))
    assert run.clearance().lower > 0.0  # the target is behind the slab, and stays out of reach
    assert run.q[-1, :, 0].max() < -1.0
    assert np.abs(run.energy_residual).max() < 1e-6 * abs(run.energy()[0])


def test_ensemble_falsification_report_and_plots(run, toys):
    many = fl.ensemble("toy-swarm", [0, 1], theorems=["toy-rest"])
    assert (many["status"] == "complete").all()
    found = fl.falsify("toy-rest", fl.scenario("toy-swarm"), budget=4, seed=0)
    assert (found.claim, found.verdict.status) == ("slow", "verified")
    pictures = importlib.import_module("flockana.report.figures").pictures(run)
    assert [picture.caption for picture in pictures] == ["Largest speed."]
    assert fl.plots.snapshot(run, velocities=False).get_title(loc="left") == "$t$ = 20"


def test_a_proof(toys):
    import proofs

    proofs.__path__.append(str(TOYS / "proofs"))
    try:
        proof = importlib.import_module("proofs.toy_proof").PROOF
    finally:
        proofs.__path__.remove(str(TOYS / "proofs"))
    assert [step.holds for step in proof.steps()] == [True]
