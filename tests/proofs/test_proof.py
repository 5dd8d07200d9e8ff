"""Proofs and claims name each other, and a slip in a formula makes one fail; that they hold: `python -m proofs`."""

import inspect
from functools import partial
from importlib import import_module

import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

import numpy as np
import sympy as sp
import z3

from flockana import Algorithm1, Algorithm2, Algorithm3, Capsule, Sphere, StaticTarget, simulate, theorems, verify
from flockana.symbolic import obstacles, scalar_functions, structural_identity
from flockana.theorems.proof_register import RIGOUR
from proofs import cohesion, signs_of_phi, smoothness, structural_split, theorem6
from proofs.proof import RIGOURS, Proof, Step, names, proofs
from proofs.smt import implication, impossible, lemma
from tests.proofs.steps import failing


@pytest.mark.parametrize("proof", proofs(), ids=lambda proof: proof.id)
def test_a_proof_says_what_it_is(proof):
    assert proof.rigour in RIGOURS
    assert proof.title
    assert proof.statement.endswith(".")
    assert proof.hypotheses
    assert set(proof.theorems) <= set(theorems())
    assert inspect.isgeneratorfunction(proof.steps)
    assert 0.0 < proof.time_limit <= 240.0


def test_helpers_and_the_template_are_no_proofs():
    assert not {"proof", "run", "smt", "intervals", "certificates", "-template", "template"} & set(names())
    assert {"cohesion", "energy-identities", "enclosures", "theorem6"} <= set(names())
    assert names() == tuple(sorted(names()))


def test_the_template_is_a_proof_that_holds():
    assert [step.holds for step in import_module("proofs._template").PROOF.steps()] == [True, True]


def test_sampling_is_no_rigour():
    with pytest.raises(ValueError, match="rigour = 'numeric': expected one of symbolic, smt, interval; sampling is no"):
        Proof("x", "x", "x", "numeric", lambda: iter([]))


def obstructed(obstacle):
    law = Algorithm3(target=StaticTarget((0.0, 0.0)), obstacles=(obstacle,))
    return simulate(law, [[10.0, 0.0], [17.0, 0.0]], np.zeros((2, 2)), (0.0, 0.5))


def on_a_line(law):
    return simulate(law, [[0.0], [6.0]], [[0.0], [0.0]], (0.0, 0.5))


ENERGY, OBSTACLES = dict.fromkeys(("rate", "balance"), "energy-identities"), dict.fromkeys(("rate", "balance"))
RUNS = {
    "two agents": ("energy", ENERGY, lambda: on_a_line(Algorithm1())),
    "pursuit": ("os-3", {"i": "cohesion"}, lambda: on_a_line(Algorithm2(target=StaticTarget((0.0,))))),
    "capsule": ("os-6", OBSTACLES, lambda: obstructed(Capsule((30.0, 0.0), (30.0, 5.0), 1.0))),
    "sphere": ("os-6", dict.fromkeys(OBSTACLES, "theorem6"), lambda: obstructed(Sphere((30.0, 0.0), 1.0))),
}


@pytest.mark.parametrize("run", RUNS)
def test_a_claim_on_a_run_names_the_proof_that_covers_it(run):
    theorem, expected, made = RUNS[run]
    verdict = verify(theorem, made())
    assert {name: verdict.claim(name).proof for name in expected} == expected
    rigours = {name: RIGOUR.get(proof, "numeric") for name, proof in expected.items()}
    assert {name: verdict.claim(name).rigour for name in expected} == rigours


def test_z3_decides_proves_refutes_and_distrusts_contradictions():
    x, y, z = z3.Reals("x y z")
    assert implication("square", x * x >= 0).holds is True
    false = implication("wrong", x > 0, x >= 0)
    assert (false.holds, false.evidence) == (False, "z3: met by [x = 0]")
    void = implication("anything", x > 5, x > 1, x < 0)
    assert void.holds is False
    assert void.evidence == "z3 on the hypotheses alone: no values exist"
    assert impossible("no root", x * x + 1 == 0, latex="x").latex == "x"
    hard = impossible("hard", x**4 * y**3 + z**5 * x == 3, y**5 * z**2 - x**7 == y, z**3 + x**5 * y == 7, seconds=1e-3)
    assert hard.holds is None
    assert "unknown, " in hard.evidence


def wrong_taper(z, *, h=scalar_functions.AlphaSymbols.h):
    """The bump's cosine over twice its range: it ends at ½."""
    return (1 + sp.cos(sp.pi * (z - h) / (2 * (1 - h)))) / 2


def test_a_wrong_bump_breaks_both_proofs_about_it(monkeypatch):
    for module in (signs_of_phi, smoothness):
        monkeypatch.setattr(module, "taper", wrong_taper)
    assert failing(signs_of_phi.PROOF.steps())[0].startswith("the taper of ρ_h is a square")
    assert "ρ_h at z = 1: value and slope agree from both sides" in failing(smoothness.PROOF.steps())


def test_a_linear_gamma_force_would_split(monkeypatch):
    monkeypatch.setattr(structural_split, "gamma_force", lambda q, *rest: -structural_split.GAINS.c1_gamma * q)
    assert len(failing(structural_split.PROOF.steps())) == 2


def test_cohesion_rests_on_its_lemmas(monkeypatch):
    monkeypatch.setattr(cohesion, "potential_signs", lambda: iter([Step("ψ_α >= 0", False)]))
    assert failing(cohesion.PROOF.steps()) == ["ψ_α >= 0"]
    x = z3.Real("x")
    with monkeypatch.context() as patched:
        patched.setattr(cohesion, "potential_lemma", lambda: lemma("ψ_α >= 0, unproved", x > 0, x >= 0))
        assert any("V >= 0" in text for text in failing(cohesion._radius()))
    monkeypatch.setattr(cohesion, "structural_identity", partial(structural_identity, lambda_=sp.Symbol("lambda")))
    assert [text[:5] for text in failing(cohesion.PROOF.steps())] == ["m = 1", "m = 2", "m = 3", "ψ_α >"]


def test_a_beta_agent_that_does_not_follow_breaks_theorem_6(monkeypatch):
    honest = obstacles.sphere_beta

    def too_fast(q, p, centre, radius):
        position, rate = honest(q, p, centre, radius)
        return position, 2 * rate

    monkeypatch.setattr(obstacles, "sphere_beta", too_fast)
    broken = failing(theorem6.obstacle_steps())
    # on a line the tangential part, which is twice too fast, is 0
    assert [text.partition(":")[0] for text in broken] == [f"sphere, m = {m}" for m in (2, 2, 3, 3)]
