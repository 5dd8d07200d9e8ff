"""Every argument of every public function, class and method is documented in its Parameters section."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from dataclasses import fields, is_dataclass

import pytest

import flockana

# the compiled inner loops are left out: users meet them through the functions that check their arguments
MODULES = sorted(
    info.name
    for info in pkgutil.walk_packages(flockana.__path__, "flockana.")
    if not info.name.startswith("flockana.kernels")
)


def documented(text: str) -> set[str]:
    """Names of a numpydoc Parameters section, joined ones such as ``q, p`` split."""
    section = re.search(r"^Parameters\n-+\n(.*?)(?=^\S[^\n]*\n-{3,}$|\Z)", text, re.MULTILINE | re.DOTALL)
    names: set[str] = set()
    for line in section[1].splitlines() if section else []:
        if re.match(r"[\w*]", line):
            names |= {name.strip().lstrip("*") for name in line.split(" : ")[0].split(",")}
    return names


def arguments(function) -> set[str]:
    parameters = inspect.signature(function).parameters
    return {name for name in parameters if name not in ("self", "cls") and not name.startswith("_")}


def public(module):
    """(qualified name, docstring, arguments) of all that the module itself defines."""
    for name, item in vars(module).items():
        if name.startswith("_") or getattr(item, "__module__", None) != module.__name__:
            continue
        if inspect.isfunction(item):
            yield name, inspect.getdoc(item), arguments(item)
        elif inspect.isclass(item):
            if is_dataclass(item):
                yield name, inspect.getdoc(item), {f.name for f in fields(item) if f.init}
            for key, member in vars(item).items():
                function = getattr(member, "__func__", member)
                if not key.startswith("_") and inspect.isfunction(function):
                    # an override says no more than what it overrides
                    yield f"{name}.{key}", inspect.getdoc(getattr(item, key)), arguments(function)


@pytest.mark.parametrize("name", MODULES)
def test_every_argument_is_documented(name):
    module = importlib.import_module(name)
    assert inspect.getdoc(module), f"{name} has no docstring"
    missing = {}
    for item, text, names in public(module):
        lacking = names - documented(text or "")
        # results that no user builds describe their fields as attributes
        lacking -= documented((text or "").replace("Attributes\n----------", "Parameters\n----------"))
        if lacking or not text:
            missing[item] = sorted(lacking) or "no docstring"
    assert missing == {}


def test_the_reader_of_sections_reads_them():
    text = "Do.\n\nParameters\n----------\nq, p : ndarray\n    Both.\n*names : str\n\nReturns\n-------\nx : int\n"
    assert documented(text) == {"q", "p", "names"}
    assert documented("Do.") == set()
