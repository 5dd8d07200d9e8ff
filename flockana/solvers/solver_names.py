"""Solvers by name."""

from collections.abc import Callable
from functools import cache, partial
from typing import Any

from flockana.base.errors import ArgumentError
from flockana.base.module_discovery import modules
from flockana.base.value_checks import ensure_kind, ensure_known
from flockana.solvers.fixed_steps import FixedStep
from flockana.solvers.scipy_solver import KINDS, Scipy
from flockana.solvers.solver import Solver

ADAPTIVE = ("DOP853", "RK45", "RK23", "Radau", "BDF", "LSODA")
METHODS = (*ADAPTIVE, "RK4", "scipy-DOP853", "scipy-RK45", "scipy-RK23")  # that integrate a law to a tolerance
_EXAMPLE = 'a solver such as RK4(0.01), or its name, such as "DOP853"'


@cache
def solvers() -> dict[str, Callable[..., Solver]]:
    """Return solver constructors by name; fixed-step ones take `dt`."""
    classes = [k for module in modules("flockana.solvers") for k in vars(module).values() if isinstance(k, type)]
    named = {k.__name__: k for k in classes if issubclass(k, Solver) and hasattr(k, "order") and k is not Scipy}
    named["Euler-Maruyama"] = named.pop("EulerMaruyama")
    scipy_solvers = {name: partial(Scipy, kind) for kind in KINDS for name in (f"scipy-{kind}", Scipy(kind).name)}
    return {**named, **scipy_solvers}


def solver_of(method: Any, dt: float | None) -> Solver:
    """Return the solver of a method name; a solver object is returned as it is.

    Raises
    ------
    ArgumentError
        If there is no such solver, or `dt` is missing or meaningless.

    Examples
    --------
    >>> solver_of("RK4", 0.01), solver_of("DOP853", None).order
    (RK4(dt=0.01), 8)
    """
    if not isinstance(method, str):
        ensure_kind("method", method, Solver, _EXAMPLE)
        if dt is not None:
            raise ArgumentError(f"dt = {dt!r}: {method!r} brings its step; expected no other")
        return method
    makers = solvers()
    ensure_known("method", method, tuple(makers))
    maker = makers[method]
    if not (isinstance(maker, type) and issubclass(maker, FixedStep)):
        if dt is not None:
            raise ArgumentError(f"dt = {dt!r}: {method} chooses its own steps; give t_eval to choose output times")
        return maker()  # type: ignore[return-value]  # a class of solvers, or a function that makes one
    if dt is None:
        raise ArgumentError(f"dt = None: method {method} needs a fixed step, such as dt=0.005")
    return maker(dt)
