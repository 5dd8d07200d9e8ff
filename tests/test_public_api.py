import subprocess
import sys
from dataclasses import is_dataclass
from types import FunctionType, ModuleType

import pytest

import flockana
from flockana.base.module_discovery import modules

HEAVY = ("numba", "sympy", "matplotlib", "xarray", "scipy", "numpy", "jinja2", "rich", "typer")


def python(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def test_importing_flockana_loads_nothing_heavy():
    assert python(f"import sys, flockana; print([m for m in {HEAVY!r} if m in sys.modules])") == "[]"


def test_the_command_line_answers_help_without_loading_numerics():
    code = f"""
import sys
from flockana.cli.main import main
try:
    main(["--version"])
except SystemExit as end:
    print(end.code, [m for m in {HEAVY[:7]!r} if m in sys.modules])
"""
    assert python(code).splitlines()[-1] == "0 []"


@pytest.mark.slow
def test_a_run_is_verified_and_reported_without_loading_what_derives_solves_or_draws(tmp_path):
    code = f"""
import sys
from flockana.cli.main import main
try:
    main(["verify", "hexagon", "-o", {str(tmp_path)!r}])
except SystemExit as end:
    print(end.code, [m for m in ("sympy", "casadi", "matplotlib", "control", "xarray") if m in sys.modules])
"""
    assert python(code).splitlines()[-1] == "0 []"


def test_a_run_is_made_without_scipy_s_integrators_and_what_they_load():
    """They take as long to load as all else that a short run does; scipy.linalg is what numba loads to compile."""
    code = """
import sys
from flockana.laws.olfati_saber import Algorithm1
from flockana.dynamics.simulate import simulate
run = simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
print(run.status, [m for m in ("scipy.integrate", "scipy.optimize") if m in sys.modules])
"""
    assert python(code).splitlines()[-1] == "complete []"


def test_every_public_name_resolves():
    found = {name: getattr(getattr(flockana, name), "__name__", name) for name in flockana.__all__}
    assert {name: its.rpartition(".")[2] for name, its in found.items()} == {name: name for name in found}
    assert found.keys() > {*dir(flockana)} - {"__version__"}
    assert len(dir(flockana)) < 50


def test_functions_win_over_modules_of_the_same_name_and_submodules_are_reachable():
    code = """
import flockana.dynamics.simulate, flockana.scenarios, flockana.theorems, flockana.measures.nets
from flockana import simulate, scenarios, theorems, symbolic
print(*(type(x).__name__ for x in (simulate, scenarios, theorems, flockana.simulate)), end=" ")
print(flockana.measures.nets.__name__, flockana.metrics.__name__, end=" ")
print(*(len(vars(m)) > 9 for m in (symbolic.dead_zone, symbolic.bearing_distance)))  # lecture 9 asks for one of them so
"""
    names = "flockana.measures.nets flockana.measures.metrics"
    assert python(code) == f"function function function function {names} True True"
    assert isinstance(flockana.simulate, FunctionType)
    assert isinstance(sys.modules["flockana.dynamics.simulate"], ModuleType)


def test_a_name_that_does_not_exist_is_an_attribute_error():
    with pytest.raises(AttributeError, match=r"No flockana attribute veirfy; did you mean 'verify'\?"):
        _ = flockana.veirfy
    with pytest.raises(AttributeError, match="No flockana attribute flock"):
        flockana.flock  # noqa: B018
    with pytest.raises(ImportError):
        from flockana import flock  # noqa: F401


def test_setting_a_public_name_by_hand_still_works(monkeypatch):
    monkeypatch.setattr(flockana, "simulate", 3)
    assert flockana.simulate == 3


def test_parameters_and_results_are_frozen():
    """All but what is counted up or held while something runs."""
    rooms = ("base", "symbolic", "interactions", "environment", "measures", "lattice", "laws", "stability", "theorems")
    thawed = [
        f"{thing.__module__}.{name}"
        for room in rooms
        for module in modules(f"flockana.{room}")
        for name, thing in vars(module).items()
        if isinstance(thing, type) and thing.__module__ == module.__name__ and is_dataclass(thing)
        if not thing.__dataclass_params__.frozen
    ]
    assert thawed == []
