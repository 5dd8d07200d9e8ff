"""Theorem files make no claims and no runs of their own: statuses are decided in one place."""

import ast
from pathlib import Path

import pytest

import flockana
from flockana.theorems.proof_register import CITES, RIGOUR
from proofs.proof import load

PACKAGE = Path(flockana.__file__).parent
PATTERNS = ("theorems/*.py", "sources/*/theorems.py", "sources/*/theorems/*.py")
FILES = sorted(path for pattern in PATTERNS for path in PACKAGE.glob(pattern))
ALLOWED = {
    "simulate": {"observed_run.py", "second_runs.py", "verification.py", "recording_verdicts.py"},
    "Claim": {"claims.py", "theorem.py"},
}


def calls(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            function = node.func
            yield function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


def test_no_theorem_file_simulates_or_makes_a_claim_by_itself():
    made = {file: {*calls(ast.parse(file.read_text(encoding="utf-8")))} for file in FILES}
    assert len(made) > 100
    wrong = [
        (file.name, name) for file in made for name in made[file] & ALLOWED.keys() if file.name not in ALLOWED[name]
    ]
    assert wrong == []


@pytest.mark.parametrize("name", RIGOUR)
def test_the_rigour_of_a_proof_is_that_of_its_weakest_step(name):
    proof = load(name)
    assert (proof.rigour, proof.cites) == (RIGOUR[name], CITES.get(name, ()))


def named_proofs():
    """Ids that theorem files give as `proof=` or `disproof=`, as literals or by a constant of the module."""
    for file in FILES:
        tree = ast.parse(file.read_text(encoding="utf-8"))
        constants = {
            node.targets[0].id: node.value.value
            for node in tree.body
            if isinstance(node, ast.Assign)
            and isinstance(node.targets[0], ast.Name)
            and isinstance(node.value, ast.Constant)
        }
        for node in ast.walk(tree):
            if isinstance(node, ast.keyword) and node.arg in ("proof", "disproof"):
                value = node.value
                name = value.value if isinstance(value, ast.Constant) else constants.get(getattr(value, "id", ""))
                if isinstance(name, str):
                    yield name


def test_every_proof_that_a_claim_names_is_in_the_table():
    assert {*named_proofs()} - {*RIGOUR} == set()
