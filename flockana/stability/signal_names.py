"""Linearised flocks as python-control systems, with a name for every state, input and output.

The flock is a `Linearisation`, whose properties these functions are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, ensure_fits
from flockana.lattice.rigidity import rigidity_matrix
from flockana.laws import Navigation
from flockana.laws.wrapper_base import WrappingLaw
from flockana.stability.mode_names import translations

if TYPE_CHECKING:
    import control


def labels(name: str, n: int, m: int) -> list[str]:
    """Return the names of a vector quantity of n agents, such as q0_x, in the order of ``q.ravel()``."""
    return [f"{name}{i}_{axis}" for i in range(n) for axis in "xyz"[:m]]


def axes_of(name: str, m: int) -> list[str]:
    """Return the names of the components of one vector, such as q_x and q_y."""
    return [f"{name}_{axis}" for axis in "xyz"[:m]]


def _target_inputs(flock: Any) -> tuple[FloatArray, list[str]]:
    """Return the input columns for position and velocity of the γ-agent, and their names; none without it."""
    size, m, law = flock.q.size, flock.q.shape[1], flock.law
    while isinstance(law, WrappingLaw):
        law = law.law
    if (pull := law.term(Navigation)) is None:
        return np.zeros((size, 0)), []
    by_position, by_velocity = pull.target_derivatives(flock.t, flock.q)
    return np.hstack([by_position.reshape(size, m), by_velocity.reshape(size, m)]), axes_of("qr", m) + axes_of("pr", m)


def _lengths(flock: Any) -> tuple[FloatArray, list[str]]:
    rates = rigidity_matrix(flock.q, flock.links).toarray() if len(flock.links) else np.zeros((0, flock.q.size))
    return rates, [f"l{i}_{j}" for i, j in flock.links.tolist()]


def _system(
    blocks: tuple[Any, Any],
    drive: FloatArray,
    read: FloatArray,
    names: tuple[list[str], list[str], list[str]],
    title: str,
) -> control.StateSpace:
    """Return the state-space system of x'' = −K x − D x' + B u, y = C x."""
    import control

    stiffness, damping = blocks
    k, (inputs, outputs) = stiffness.shape[0], (drive.shape[1], read.shape[0])
    ensure_fits("the state space", (2 * k + outputs, 2 * k + inputs), "use A_sparse")
    A = np.block([[np.zeros((k, k)), np.eye(k)], [-stiffness, -damping]])
    B = np.vstack([np.zeros((k, inputs)), drive])
    C = np.hstack([read, np.zeros((outputs, k))])
    states, causes, effects = names
    return control.ss(A, B, C, np.zeros((outputs, inputs)), states=states, inputs=causes, outputs=effects, name=title)


def whole_system(flock: Any) -> control.StateSpace:
    """Return the system of all agents: see `Linearisation.state_space`."""
    n, m = flock.q.shape
    ensure_fits("A", flock.A_sparse.shape, "use A_sparse and slowest_modes(...)")
    unit = translations(n, m)
    target, target_names = _target_inputs(flock)
    length_rows, length_names = _lengths(flock)
    drive_matrix = np.hstack([np.eye(n * m), target])
    readings = np.vstack([unit.T / np.sqrt(n), np.eye(n * m) - unit @ unit.T, length_rows])
    names = (
        labels("q", n, m) + labels("p", n, m),
        labels("f", n, m) + target_names,
        axes_of("qc", m) + labels("x", n, m) + length_names,
    )
    return _system((flock.stiffness.toarray(), flock.damping.toarray()), drive_matrix, readings, names, "flock")


def structural_system(flock: Any) -> control.StateSpace:
    """Return the system of the shape alone: see `Linearisation.structural`."""
    flock.ensure_split()
    n, m = flock.q.shape
    if n == 1:
        raise ArgumentError("n = 1: expected at least two agents; one has no shape")
    ensure_fits("A", flock.A_sparse.shape, "use A_sparse and slowest_modes(...)")
    unit = translations(n, m)
    kept_size = (n - 1) * m
    lift_matrix = np.vstack([np.eye(kept_size), -np.tile(np.eye(m), (1, n - 1))])  # the last agent's deviation
    shape_projection = (np.eye(n * m) - unit @ unit.T)[:kept_size]
    length_rows, length_names = _lengths(flock)
    blocks = ((flock.stiffness[:kept_size] @ lift_matrix), (flock.damping[:kept_size] @ lift_matrix))
    names = (labels("x", n - 1, m) + labels("v", n - 1, m), labels("f", n, m), labels("x", n, m) + length_names)
    return _system(blocks, shape_projection, np.vstack([lift_matrix, length_rows @ lift_matrix]), names, "shape")


def translational_system(flock: Any) -> control.StateSpace:
    """Return the system of the centre of mass alone: see `Linearisation.translational`."""
    flock.ensure_split()
    n, m = flock.q.shape
    mean = translations(n, m).T / np.sqrt(n)
    target, target_names = _target_inputs(flock)
    split_system = flock.second_order.split
    names = (axes_of("qc", m) + axes_of("pc", m), labels("f", n, m) + target_names, axes_of("qc", m))
    blocks = (np.diag(split_system.stiffness), np.diag(split_system.damping))
    return _system(blocks, mean @ np.hstack([np.eye(n * m), target]), np.eye(m), names, "centre")
