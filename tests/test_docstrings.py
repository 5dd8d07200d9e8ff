"""Arguments that users give are documented unless name and type say all; every other function says what it does."""

import importlib
import inspect
import pkgutil
import re
from dataclasses import fields, is_dataclass

import flockana

MODULES = sorted(info.name for info in pkgutil.walk_packages(flockana.__path__, "flockana."))

# What nobody reaches from `flockana.X` but all who extend it write against, and modules of results.
EXTENSION = (
    "flockana.laws.law",
    "flockana.laws.discrete",
    "flockana.laws.terms.term",
    "flockana.theorems.theorem",
    "flockana.theorems.hypotheses",
    "flockana.theorems.claims",
    "flockana.falsify.bounded_space",
)
RESULTS = ("flockana.falsify.counterexample", "flockana.stability.decay", "flockana.stability.tracking")

# Functions without an example: those that draw, serve or write files, and measures of a whole run.
NO_EXAMPLE = {
    *("animate", "explore", "check_certificate", "write_certificate", "write_tube_certificate", "replay"),
    *("ultimate_bound", "ensure_run", "is_flock", "is_quasi_flock", "is_cohesive", "is_dynamic_flock", "nets"),
    *("cohesion_radii", "spreads", "min_distances", "diameters", "orders", "coordinations"),
}

# Names that mean the same in every signature: a sentence is written where they mean more.
EVIDENT = {
    *("ax", "fps", "path", "progress", "seconds", "title", "velocities"),  # of figures
    *("d", "dt", "lengths", "m", "n", "q", "p", "r", "s", "t", "z"),  # s: distances, z: σ-norms
    *("alpha", "gains", "interaction", "law", "mode", "name", "options", "seed", "t_span", "target", "tolerances"),
    "trajectory",
    *("about", "claim", "detail", "disproof", "error", "fields", "holds", "needs", "proof", "rigour"),  # of claims
    *("check", "fact", "remedy", "run", "solver", "steps", "verdict"),
}


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


def defined_in(module):
    return [item for item in vars(module).values() if getattr(item, "__module__", None) == module.__name__]


def reachable():
    """Functions and classes behind the public names, with the classes that these inherit from."""
    shown = [getattr(flockana, name) for name in flockana.__all__]
    items = [item for item in shown if not inspect.ismodule(item)]
    for module in [item for item in shown if inspect.ismodule(item)]:
        items += [getattr(module, name) for name in getattr(module, "__all__", ())] or defined_in(module)
    for name in EXTENSION:
        items += defined_in(importlib.import_module(name))
    for name in RESULTS:
        items += [item for item in defined_in(importlib.import_module(name)) if inspect.isclass(item)]
    classes = [base for item in items if inspect.isclass(item) for base in item.__mro__]
    functions = [item for item in items if inspect.isfunction(item)]
    ours = {item for item in (*classes, *functions) if item.__module__.startswith("flockana")}
    return sorted(ours, key=lambda item: (item.__module__, item.__qualname__))


def interface(item):
    """(name, docstring, arguments) of a function, or of a class and its public methods."""
    if inspect.isfunction(item):
        yield item.__qualname__, inspect.getdoc(item), arguments(item)
        return
    if is_dataclass(item):
        yield item.__qualname__, inspect.getdoc(item), {f.name for f in fields(item) if f.init}
    for key, member in vars(item).items():
        function = getattr(member, "__func__", member)
        if not key.startswith("_") and inspect.isfunction(function):
            # an override says no more than what it overrides, and `rescale` documents the factors of `in_units`
            names = set() if key == "in_units" else arguments(function)
            yield f"{item.__qualname__}.{key}", inspect.getdoc(getattr(item, key)), names


def lacking(text: str, names: set[str]) -> list[str]:
    # results that no user builds describe their fields as attributes
    return sorted(
        names
        - EVIDENT
        - documented(text)
        - documented(text.replace("Attributes\n----------", "Parameters\n----------"))
    )


def test_every_argument_that_a_user_gives_is_documented():
    missing = {
        f"{item.__module__}.{name}": lacking(text or "", names) or "no docstring"
        for item in reachable()
        if not item.__name__.startswith("_")
        for name, text, names in interface(item)
        if not text or lacking(text, names)
    }
    assert missing == {}


def test_every_module_and_function_says_what_it_does():
    modules = [importlib.import_module(name) for name in MODULES]
    assert [module.__name__ for module in modules if not inspect.getdoc(module)] == []
    silent = [
        f"{module.__name__}.{described}"
        for module in modules
        for item in defined_in(module)
        if not getattr(item, "__name__", "_").startswith("_") and (inspect.isfunction(item) or inspect.isclass(item))
        for described, text, _ in interface(item)
        if not text
    ]
    assert silent == []


def test_public_functions_have_an_example():
    functions = [item for item in reachable() if inspect.isfunction(item) and not item.__name__.startswith("_")]
    shown = [item for item in functions if item.__module__ not in EXTENSION and ".plots" not in item.__module__]
    assert {item.__name__ for item in shown if ">>>" not in (inspect.getdoc(item) or "")} - NO_EXAMPLE == set()


def test_public_functions_and_inherited_classes_are_reached():
    names = {f"{item.__module__}.{item.__qualname__}" for item in reachable()}
    assert {"flockana.dynamics.simulate.simulate", "flockana.laws.law.LawOfMotion"} <= names
    assert {"flockana.plots.time_series.energy", "flockana.theorems.theorem.Theorem"} <= names
