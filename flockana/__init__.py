"""flockana: does this flock provably do what the theorem says, and how does it behave near its equilibrium?

The public names stand in ``__init__.pyi``, once; each is imported when it is first used.
"""

from flockana.base.lazy_imports import attach_stub

_load, _, __all__ = attach_stub(__name__, __file__)
# what a newcomer's Tab shows; everything else in __all__ is reachable by its name
_FIRST = (
    "Algorithm1 Algorithm2 Algorithm3 AlphaInteraction CircleTarget CuckerSmale Flock Gains LinearTarget Recording "
    "Sphere StaticTarget Tolerances Trajectory Wall animate certify cite claim compare compose ensemble explore "
    "falsify find_equilibrium fit lattice linearise pair_law player plots read_recording scenario scenarios simulate "
    "stability symbolic theorem theorems verify"
)


def __getattr__(name: str) -> object:
    try:
        return _load(name)
    except AttributeError:
        from difflib import get_close_matches

        close_matches = get_close_matches(name, __all__, n=1)
        hint = f"; did you mean {close_matches[0]!r}?" if close_matches and not name.startswith("_") else ""
        raise AttributeError(f"No flockana attribute {name}{hint}", name=name) from None


def __dir__() -> list[str]:
    return [*_FIRST.split(), "__version__"]
