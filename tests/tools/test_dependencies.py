import pytest

from tools import dependencies


def test_every_direct_dependency_is_held_at_its_bound():
    found = dependencies.lowest()
    assert all(line.count("==") == 1 for line in found)
    names = [line.partition("==")[0] for line in found]
    assert {"numpy", "numba", "casadi", "pytest", "z3-solver", "nbformat", "ipykernel"} <= set(names)
    assert len(set(names)) == len(names)


def test_a_requirement_without_a_lower_bound_cannot_be_tested():
    with pytest.raises(ValueError, match=r"'numpy' in pyproject\.toml: expected NAME>=VERSION"):
        dependencies.pinned(["numpy"])
    with pytest.raises(ValueError, match="expected NAME>=VERSION"):
        dependencies.pinned(["numpy>=2.0,!=2.1"])
