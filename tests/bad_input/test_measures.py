import numpy as np
import pytest

import flockana as fl
from flockana import lattice
from tests.bad_input import values

OF_POSITIONS = ("cohesion_radius", "velocity_mismatch", "inertia", "min_distance", "order")
BUILDERS = {"line": 1, "triangular": 1, "hexagonal_spiral": 1, "square": 2, "honeycomb": 2} | dict.fromkeys(
    ("simple_cubic", "fcc", "hcp", "bcc"), 3
)


def cases():
    for name in OF_POSITIONS:
        yield name, values.POINTS, getattr(fl, name)
    for name in ("connectivity", "giant_share", "links"):
        function = getattr(fl, name)
        yield f"{name} q", values.POINTS, lambda v, f=function: f(v, 8.4)
        yield f"{name} r", values.POSITIVE, lambda v, f=function: f(values.Q, v)
    yield "deviation_energy q", values.POINTS, lambda v: fl.deviation_energy(v, 7.0, 8.4)
    yield "deviation_energy d", values.POSITIVE, lambda v: fl.deviation_energy(values.Q, v, 8.4)
    yield "deviation_energy r", values.POSITIVE, lambda v: fl.deviation_energy(values.Q, 7.0, v)
    for name, function in (
        ("components", fl.components),
        ("laplacian", fl.laplacian),
        ("coordination", lattice.coordination),
    ):
        yield f"{name} n", values.SIZES, lambda v, f=function: f(v, [[0, 1]])
        yield f"{name} links", values.LINKS, lambda v, f=function: f(3, v)
    weights = {"texts": ["a"], "nan": [float("nan")], "two": [1.0, 2.0], "a number": 3.0, "truth values": [True]}
    yield "laplacian weights", weights, lambda v: fl.laplacian(3, [[0, 1]], v)
    for name in ("is_planar", "kuratowski", "is_complete"):
        function = getattr(lattice, name)
        yield f"{name} n", values.COUNTS, lambda v, f=function: f(v, [[0, 1]])
        yield f"{name} links", values.LINKS, lambda v, f=function: f(3, v)
    for name in ("crossings", "defects", "rigidity", "rigidity_matrix"):
        function = getattr(lattice, name)
        yield f"{name} q", values.POINTS, lambda v, f=function: f(v, [[0, 1]])
        yield f"{name} links", values.LINKS, lambda v, f=function: f(values.Q, v)
    for name in ("edge_length_error", "is_alpha_lattice", "strain"):
        function = getattr(lattice, name)
        yield f"{name} q", values.POINTS, lambda v, f=function: f(v, 7.0, 8.4)
        yield f"{name} d", values.POSITIVE, lambda v, f=function: f(values.Q, v, 8.4)
        yield f"{name} r", values.POSITIVE, lambda v, f=function: f(values.Q, 7.0, v)
    yield "is_alpha_lattice tol", values.NOT_NEGATIVE, lambda v: lattice.is_alpha_lattice(values.Q, 7.0, 8.4, tol=v)
    for name in ("harborth", "planar_bound"):
        yield name, values.COUNTS, getattr(lattice, name)
    for name, axes in BUILDERS.items():
        function = getattr(lattice, name)
        for k in range(axes):
            table = values.SIZES

            def build(v, f=function, k=k, axes=axes):
                return f(*(v if i == k else 2 for i in range(axes)), 7.0)

            yield f"{name} size {k}", table, build
        yield f"{name} d", values.POSITIVE, lambda v, f=function, axes=axes: f(*[2] * axes, v)
    yield "hexagonal_patch k", values.without(values.SIZES, "zero"), lambda v: lattice.hexagonal_patch(v, 7.0)
    yield "joint_windows n", values.SIZES, lambda v: fl.joint_windows(v, [[[0, 1]]])
    yield "joint_windows links", values.without(values.LINKS, "none"), lambda v: fl.joint_windows(3, [v])
    nets = {"none": None, "a number": 3, "a text": "01", "no axis": np.array(1.0), "numbers": [0, 1]}
    yield "joint_windows nets", nets, lambda v: fl.joint_windows(3, v)
    yield "max_ratio", values.NAMES, lattice.max_ratio


@pytest.mark.parametrize(("table", "call"), values.rows(cases()))
def test_what_is_none_is_refused(table, call):
    values.refused(table, call)


def test_a_lattice_beyond_memory_says_what_it_would_take():
    with pytest.raises(
        fl.errors.ArgumentError, match=r"would take 3.2e\+14 bytes, more than half .*ask for fewer agents"
    ):
        lattice.line(10**13, 7.0)
    with pytest.raises(fl.errors.ArgumentError, match="ask for fewer agents"):
        lattice.fcc(10**5, 10**5, 10**5, 7.0)
