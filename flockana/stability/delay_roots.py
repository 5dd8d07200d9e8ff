"""Characteristic roots of linear flocks with one or several delays, by Chebyshev collocation and Newton's method."""

from collections.abc import Sequence
from math import inf, pi
from typing import NamedTuple

import numpy as np

from flockana.base.value_checks import ComplexArray, FloatArray, ensure_count, ensure_kind, ensure_positive
from flockana.equilibria.curvature import EPS
from flockana.stability.delay import DelaySystem, kernels, neutral_roots
from flockana.stability.eigenvalue_errors import eigenvalues
from flockana.stability.strong_components import strong_components

_ROUNDINGS = 16.0  # of eps times the terms of the characteristic matrix
_STEPS = 12  # of Newton's method
_LEFT = 1e-6  # of the characteristic matrix: what is left of it at a root, a double one even


class LatePart(NamedTuple):
    """Delayed terms of the stiffness K and damping D of a linear flock, with their delay."""

    delay: float
    stiffness: FloatArray
    damping: FloatArray


Parts = Sequence[LatePart]


def characteristic(parts: Parts, s: complex) -> ComplexArray:
    """Return the characteristic matrix s² + Σ (K_k + s D_k) e^(−sτ_k), singular at the roots."""
    full_matrix = s * s * np.eye(len(parts[0].stiffness), dtype=np.complex128)
    for delay, k, d in parts:
        full_matrix += (k + s * d) * np.exp(-s * delay)
    return full_matrix


def _slope(parts: Parts, s: complex) -> ComplexArray:
    """Return the derivative of the characteristic matrix with respect to s."""
    full_matrix = 2.0 * s * np.eye(len(parts[0].stiffness), dtype=np.complex128)
    for delay, k, d in parts:
        full_matrix += (d - delay * (k + s * d)) * np.exp(-s * delay)
    return full_matrix


def rightmost_roots(system: DelaySystem, delay: float, *, nodes: int = 16, count: int = 6) -> ComplexArray:
    """Return the rightmost characteristic roots, without neutral ones, by Chebyshev collocation.

    The delayed state over [−τ, 0] is a polynomial through nodes + 1 Chebyshev points (Breda, Maset, Vermiglio 2005);
    each root is then refined by Newton's method on the characteristic matrix itself, which has no such error. Groups of
    agents that hear each other are taken one by one, so that chains of equal agents have their roots to rounding.

    Parameters
    ----------
    system : DelaySystem
        The linearised flock.
    delay : float
        τ > 0.
    nodes : int
        Degree of the polynomial; the matrix has 2N (nodes + 1) rows.
    count : int
        Most roots wanted; conjugates count too.

    Returns
    -------
    complex ndarray, shape (count,) or shorter
        Largest real part first. A flock of which nothing is late has a finite number of them.

    Examples
    --------
    At the margin of x'' = −x'(t − τ) the roots ±j are the rightmost:

    >>> one = DelaySystem((np.zeros((1, 1)), np.zeros((1, 1))), (np.zeros((1, 1)), np.ones((1, 1))), neutral=1)
    >>> [round(float(abs(s)), 9) for s in rightmost_roots(one, 0.5 * pi, count=2) - np.array([1j, -1j])]
    [0.0, 0.0]
    """
    ensure_kind("system", system, DelaySystem, "what delay_system(...) gives")
    parts = LatePart(0.0, *system.prompt), LatePart(ensure_positive("delay", delay), *system.late)
    return rightmost(parts, system.neutral, nodes=nodes, count=count)


def rightmost(parts: Parts, neutral: int, *, nodes: int = 16, count: int = 6) -> ComplexArray:
    """Return `rightmost_roots` for any number of delays; `neutral` roots at 0 are left out."""
    nodes, count = ensure_count("nodes", nodes), ensure_count("count", count)
    groups = strong_components(*(part for item in parts for part in item[1:])).indices
    sub = [[LatePart(tau, k[np.ix_(rows, rows)], d[np.ix_(rows, rows)]) for tau, k, d in parts] for rows in groups]
    zeros = [_neutral(part) if neutral else 0 for part in sub]
    if sum(zeros) == neutral:
        upper = [_of_group(part, zero, nodes, count) for part, zero in zip(sub, zeros, strict=True)]
    else:  # motions softer than rounding tells: the smallest roots of the whole
        upper = [_of_group(list(parts), neutral, nodes, count)]
    roots = np.concatenate(upper)
    roots = roots[np.lexsort((roots.imag, -roots.real))]
    pairs = [(s,) if s.imag == 0.0 else (s, s.conjugate()) for s in roots.tolist()]  # each with its conjugate
    return np.array([s for pair in pairs for s in pair], dtype=np.complex128)[:count]


def _neutral(parts: Parts) -> int:
    """Return the number of characteristic roots at 0 of a group of agents that hear each other."""
    blank = np.zeros_like(parts[0].stiffness)
    stiffness, damping = sum((part.stiffness for part in parts), blank), sum((part.damping for part in parts), blank)
    delayed_sum = sum((part.delay * part.stiffness for part in parts), blank)
    return neutral_roots(*kernels(stiffness), damping, delayed_sum)


def _of_group(parts: Parts, neutral: int, nodes: int, count: int) -> ComplexArray:
    """Return the refined rightmost roots with Im s >= 0 of a group of agents that hear each other."""
    size = len(parts[0].stiffness)
    zero, one = np.zeros((size, size)), np.eye(size)
    used_parts = [part for part in parts if part.stiffness.any() or part.damping.any()]
    longest = max((tau for tau, *_ in used_parts), default=0.0)
    first = sum((_companion(part) for part in used_parts if part.delay == 0.0), np.block([[zero, one], [zero, zero]]))
    if longest == 0.0:
        values = eigenvalues(first)[0]
    else:
        generator = np.kron(_chebyshev(nodes) * (2.0 / longest), np.eye(2 * size))
        generator[: 2 * size] = np.kron(np.eye(1, nodes + 1), first)
        for part in used_parts:
            if part.delay > 0.0:
                weights = _interpolation(nodes, 1.0 - 2.0 * part.delay / longest)
                generator[: 2 * size] += np.kron(weights[None, :], _companion(part))
        values = np.linalg.eigvals(generator)
    values = np.delete(values, np.argsort(np.abs(values), kind="stable")[:neutral])
    upper = values[values.imag >= 0.0]
    upper = upper[np.argsort(-upper.real, kind="stable")]
    if longest == 0.0:
        return upper[:count]
    refined = (_refine(parts, complex(s), longest) for s in upper[: 2 * count])
    return np.array([s for s in refined if s is not None][:count], dtype=np.complex128)


def _companion(part: LatePart) -> FloatArray:
    zero = np.zeros_like(part.stiffness)
    return np.block([[zero, zero], [-part.stiffness, -part.damping]])


def root_error(system: DelaySystem, s: complex, delay: float) -> float:
    """Return an error bound of a refined characteristic root, from its residual and rounding."""
    return error_of_root((LatePart(0.0, *system.prompt), LatePart(delay, *system.late)), s)


def error_of_root(parts: Parts, s: complex) -> float:
    """Return an error bound of a characteristic root, for any number of delays."""
    u, singular_values, vh = np.linalg.svd(characteristic(parts, s))
    slope_size = abs(complex(u[:, -1].conj() @ _slope(parts, s) @ vh[-1].conj()))
    terms = (abs(np.exp(-s * tau)) * (np.linalg.norm(k) + abs(s) * np.linalg.norm(d)) for tau, k, d in parts)
    push = float(singular_values[-1]) + _ROUNDINGS * EPS * (float(sum(terms)) + abs(s) ** 2)
    return float(min(push / slope_size if slope_size > 0.0 else inf, np.sqrt(push)))


def _points(nodes: int) -> tuple[FloatArray, FloatArray]:
    """Return the Chebyshev points cos(πk/nodes), from 1 to −1, and their barycentric weights."""
    k = np.arange(nodes + 1)
    return np.cos(pi * k / nodes), np.where((k == 0) | (k == nodes), 0.5, 1.0) * (-1.0) ** k


def _chebyshev(nodes: int) -> FloatArray:
    """Return the differentiation matrix on the Chebyshev points (Trefethen 2000, chapter 6)."""
    x, weight = _points(nodes)
    matrix = np.outer(1.0 / weight, weight) / (x[:, None] - x[None, :] + np.eye(nodes + 1))
    return matrix - np.diag(matrix.sum(axis=1))


def _interpolation(nodes: int, at: float) -> FloatArray:
    """Return the weights of the values at the Chebyshev points for interpolation at a point."""
    x, weight = _points(nodes)
    node_differences = at - x
    if (is_near := np.abs(node_differences) <= 4.0 * EPS).any():
        return is_near.astype(np.float64)
    return weight / node_differences / np.sum(weight / node_differences)


def _refine(parts: Parts, s: complex, longest: float) -> complex | None:
    """Refine (v, s) with M(s) v = 0 by Newton's method from the singular vector at s; None without convergence."""
    start = s
    v = np.linalg.svd(characteristic(parts, s))[2][-1].conj()
    conjugate = v.conj()
    for _ in range(_STEPS):
        matrix, slope = characteristic(parts, s), _slope(parts, s) @ v
        bordered_matrix = np.block([[matrix, slope[:, None]], [conjugate[None, :], np.zeros((1, 1))]])
        try:
            step = np.linalg.solve(bordered_matrix, np.append(-matrix @ v, 1.0 - conjugate @ v))
        except np.linalg.LinAlgError:  # a defective root: as near as it comes
            break
        v, s = v + step[:-1], s + complex(step[-1])
        if abs(step[-1]) <= 1e-14 * max(abs(start), 1.0 / longest):
            break
    is_near = abs(s - start) <= 0.1 * max(abs(start), 1.0 / longest)
    s = s if is_near and np.isfinite(s) else start
    s = complex(s.real, 0.0) if start.imag == 0.0 else s
    singular_values = np.linalg.svd(characteristic(parts, s), compute_uv=False)
    return s if singular_values[-1] <= _LEFT * max(singular_values[0], abs(s) ** 2) else None
