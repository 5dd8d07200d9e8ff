"""Names of modes: translation, rotation, breathing, or a number."""

from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.equilibria.final_state import generators, rigid_motions

_NAMED = 1e-6  # how far a rigid motion may be from the kernel that it is found in


def translations(n: int, m: int) -> FloatArray:
    """Return unit translations along the axes, one per column, shape (n m, m)."""
    return np.tile(np.eye(m), (n, 1)) / np.sqrt(n)


def normalised(vector: Any, *, real: bool) -> Any:
    """Return a mode of unit length in standard phase: real part largest, first large component positive."""
    vector = vector / np.linalg.norm(vector)
    vector = vector * np.exp(-0.5j * np.angle(np.sum(vector**2)))
    magnitude = np.abs(vector.real)
    if vector.real[np.argmax(magnitude > (1.0 - _NAMED) * magnitude.max())] < 0.0:
        vector = -vector
    return vector.real / np.linalg.norm(vector.real) if real else vector


def _rotations(q: FloatArray) -> list[tuple[str, FloatArray]]:
    """Return infinitesimal rotations about the centre, by axis, not normalised."""
    x, m = q - q.mean(axis=0), q.shape[1]
    names = ("rotation",) if m == 2 else ("rotation z", "rotation y", "rotation x")  # as `generators` has the planes
    turns = [(name, (x @ generator.T).ravel()) for name, generator in zip(names, generators(m), strict=False)]
    return turns[::-1]


def pure_fields(q: FloatArray) -> list[tuple[str, FloatArray]]:
    """Return the unit displacement fields that name modes: uniform expansion, translations, rotations."""
    fields = [("breathing", (q - q.mean(axis=0)).ravel())]
    fields += [(f"translation {'xyz'[c]}", column) for c, column in enumerate(translations(*q.shape).T)]
    fields += _rotations(q)
    return [(name, field / np.linalg.norm(field)) for name, field in fields if np.linalg.norm(field) > 0.0]


def name_kernel(kernel: FloatArray, q: FloatArray) -> tuple[list[str], FloatArray]:
    """Return names and an orthonormal basis of a stiffness kernel, rigid motions first."""
    names: list[str] = []
    basis = np.zeros((q.size, 0))
    for name, flow in pure_fields(q):
        if name == "breathing":  # of a flock without neighbours it costs nothing, but it is no rigid motion
            continue
        remainder = flow - basis @ (basis.T @ flow)
        is_in_kernel = np.linalg.norm(flow - kernel @ (kernel.T @ flow)) <= _NAMED
        if is_in_kernel and np.linalg.norm(remainder) > _NAMED:
            names, basis = [*names, name], np.column_stack([basis, remainder / np.linalg.norm(remainder)])
    rigid, unit = rigid_motions(q), translations(*q.shape)
    for fields, kind in ((unit, "translation"), (rigid, "rotation")):  # along no axis, or about the γ-agent
        left = _complement(kernel, basis)
        u, singular_values, _ = np.linalg.svd(left.T @ fields, full_matrices=False)
        mixed_motions = _complement(left @ u[:, singular_values > 1.0 - _NAMED], basis)
        names, basis = [*names, *[kind] * mixed_motions.shape[1]], np.column_stack([basis, mixed_motions])
    soft_modes = _complement(kernel, basis)
    names += [f"soft {k}" for k in range(1, soft_modes.shape[1] + 1)]
    return names, np.column_stack([basis, soft_modes])


def _complement(kernel: FloatArray, named: FloatArray) -> FloatArray:
    """Return an orthonormal basis of the part of a kernel that is orthogonal to the named motions."""
    if kernel.shape[1] == 0:
        return kernel
    basis, singular_values, _ = np.linalg.svd(kernel - named @ (named.T @ kernel), full_matrices=False)
    return basis[:, singular_values > 0.5]
