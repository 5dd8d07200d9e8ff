"""A proof backs the theorems whose claims cite it, and no others: read off the sources, in both directions."""

import ast
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

from flockana.base.module_discovery import modules, source_modules
from flockana.theorems.catalogue import theorems_in
from proofs.proof import load, names

IDS = set(names())
HOLDERS = [*modules("flockana.theorems"), *source_modules("theorems")]
MODULES = {module.__name__ for module in HOLDERS}
TABLES = ("RIGOUR", "CITES")  # of all proofs, or followed by themselves


@cache
def parsed(module):
    """Top-level definitions of a module by name, and where its imported names come from."""
    origin = find_spec(module).origin
    body = ast.parse(Path(origin).read_text(encoding="utf-8")).body if origin else []  # a folder of modules
    own, imported = {}, {}
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            own[node.name] = node
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            own |= {name.id: node for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)}
        elif isinstance(node, ast.ImportFrom) and ".theorems" in (node.module or ""):
            names = (alias for alias in node.names if alias.name != "check")  # what another theorem finds is its own
            imported |= {alias.asname or alias.name: (node.module, alias.name) for alias in names}
    return own, imported


def strings(node):
    return {one.value for one in ast.walk(node) if isinstance(one, ast.Constant) and isinstance(one.value, str)} & IDS


def cited(module, name, seen):
    """Ids of proofs that a definition gives to claims, and all that it uses."""
    own, imported = parsed(module)
    if name in imported:
        return cited(*imported[name], seen)
    if name not in own or (module, name) in seen:
        return set()
    seen.add((module, name))
    node, found = own[name], set()
    if isinstance(node, (ast.Assign, ast.AnnAssign)) and name.lstrip("_").isupper() and name not in TABLES:
        found |= strings(node.value)  # PROOF = "..."
    for one in ast.walk(node):
        if isinstance(one, ast.keyword) and one.arg in ("proof", "disproof"):
            found |= strings(one.value)
        elif isinstance(one, ast.Call) and getattr(one.func, "id", "") == "proved":
            found |= strings(one) or {"energy-identities"}  # which it names by default
        elif isinstance(one, ast.Return) and one.value is not None and name == "_enclosed":
            found |= strings(one.value)
        elif isinstance(one, ast.Attribute) and (source := ".".join(imported.get(getattr(one.value, "id", ""), ""))):
            found |= cited(source, one.attr, seen) if source in MODULES and one.attr != "theorem" else set()
        elif isinstance(one, ast.Name) and isinstance(one.ctx, ast.Load) and one.id != name:
            found |= cited(module, one.id, seen)
    return found


def cites():
    """(theorem, proof) for every claim's proof."""
    return {
        (item.id, proof)
        for module in HOLDERS
        for name, item in theorems_in(module).items()
        for proof in cited(module.__name__, name, set())
    }


def test_backs_and_cites_agree():
    said = {(key, proof) for proof in IDS for key in load(proof).theorems}
    found = cites()
    assert said - found == set(), "backed, and not cited"
    assert found - said == set(), "cited, and not backed"
