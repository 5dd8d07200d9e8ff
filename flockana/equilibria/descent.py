"""Minima of large flocks: damped motion, annealing where pairs collapsed, sparse Newton steps.

A flock that its γ-agent presses so hard that agents slide onto each other has minima without number, and one that goes
downhill at once stays in a poor one. So a flock whose neighbours parted on the way down is warmed up and cooled slowly
(Langevin's equation, always with the same noise), and the lower of both ends is taken. A flock that keeps its
neighbours is left alone: then the minimum is the one that belongs to the start.
"""

from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.equilibria.potential import Potential, inside_obstacle
from flockana.lattice.elimination import Elimination
from flockana.measures.centre_frame import moving_frame
from flockana.measures.nets import links

_ROUGH = 1e-3  # relative force at which basins are compared
_COARSE = 1e-5  # at which Newton's method takes over
_STEP, _LONGEST = 0.1, 1.0  # of the law's own time √(length/force): first and longest step of the damped motion
_STRIDE = 0.35  # of d: how far an agent goes in a step at most
_HEATS, _COOLING = (0.05, 0.02, 0.005), 1500  # first temperatures, of force times length; steps until none is left
_QUIET, _DRAG = 0.5, 0.06  # stable time step over 1/ω of the fastest motion; share of the velocity lost in a step
_PARTED = 1.0  # of d: neighbours that moved so far against each other are no longer neighbours of the same net
_NEAR = 1e-7  # relative force below which only the force is compared, as energies agree to rounding
_DONE = 1e-14  # and at which there is nothing left to refine
_TRIES = 12
_LEAST = 1e-10  # of the stiffness: eigenvalues below are taken for that
_ENOUGH = 0.1  # of the fall of energy that a Newton step promises


class Descent(NamedTuple):
    """Result of a descent: configuration, whether the force vanishes there, and a message."""

    q: FloatArray
    converged: bool
    message: str


def descend(potential: Potential, q: FloatArray, max_iter: int) -> Descent:
    """Return a minimum reached downhill from q; anneal if pairs of agents fell onto each other on the way."""
    steps, message = 100 * max_iter, "Converged"
    best_state = relax(potential, q, steps, tol=_ROUGH)
    for heat in _HEATS if pairs_collapsed(potential, q, best_state) else ():
        annealed_state = relax(potential, anneal(potential, best_state, heat), steps, tol=_ROUGH)
        if potential.energy(annealed_state) < potential.energy(best_state):
            best_state, message = annealed_state, "Converged, annealed"
    best_state, converged = newton(potential, relax(potential, best_state, steps), max_iter)
    return Descent(best_state, converged, message if converged else "Newton's method did not converge")


def relax(potential: Potential, q: FloatArray, steps: int, *, tol: float = _COARSE) -> FloatArray:
    """Follow x'' = −∇U with a drag that keeps the motion downhill (FIRE: Bitzek et al. 2006)."""
    time_unit, stride = sqrt(potential.pair.length / potential.force_scale), _STRIDE * potential.pair.length
    force_tolerance = tol * potential.force_scale
    step, mixing_factor, downhill_steps, v = _STEP * time_unit, 0.1, 0, np.zeros_like(q)
    for _ in range(steps):
        force = potential.force(q)
        if _largest(force) <= force_tolerance:
            break
        if float(np.vdot(force, v)) > 0.0:
            v = (1.0 - mixing_factor) * v + mixing_factor * sqrt(float(np.vdot(v, v) / np.vdot(force, force))) * force
            downhill_steps += 1
            if downhill_steps > 5:
                step, mixing_factor = min(1.1 * step, _LONGEST * time_unit), 0.99 * mixing_factor
        else:
            v, step, mixing_factor, downhill_steps = np.zeros_like(q), 0.5 * step, 0.1, 0
        v = v + step * force
        step_length = step * _largest(v)
        next_q = q + step * min(1.0, stride / step_length) * v
        if inside_obstacle(potential.law, next_q):
            v, step = np.zeros_like(q), 0.5 * step
        else:
            q = next_q
    return q


def pairs_collapsed(potential: Potential, start: FloatArray, end: FloatArray) -> bool:
    """Return whether neighbours moved against each other by more than their distance."""
    i, j = links(start, potential.pair.range).T
    motion = end - start
    return bool(np.any(np.linalg.norm(motion[j] - motion[i], axis=1) > _PARTED * potential.pair.length))


def anneal(potential: Potential, q: FloatArray, warm: float) -> FloatArray:
    """Return positions after simulating Langevin's equation with a temperature that falls to zero."""
    length_scale, scale = potential.pair.length, potential.force_scale
    step = _QUIET / sqrt(float(abs(potential.stiffness(q)).sum(axis=1).max()) or scale / length_scale)
    share_kept, rng, v = 1.0 - _DRAG, np.random.default_rng(0), np.zeros_like(q)
    for k in range(_COOLING):
        heat = warm * scale * length_scale * (1.0 - k / _COOLING)
        noise = rng.standard_normal(q.shape)
        v = share_kept * v + step * potential.force(q)
        v += sqrt(heat * (1.0 - share_kept**2)) * (noise if potential.pinned else moving_frame(noise))
        next_q = q + step * v
        if inside_obstacle(potential.law, next_q):
            v = -v
        else:
            q = next_q
    return q


def newton(potential: Potential, q: FloatArray, steps: int) -> tuple[FloatArray, bool]:
    """Minimise by Newton's method, with moduli of eigenvalues where the Hessian is not positive."""
    # A step is no longer than the trust in the quadratic model, which follows from how well it foretold the last one.
    length, scale = potential.pair.length, potential.force_scale
    trust, force = 0.1 * length, potential.force(q)
    for _ in range(steps):
        if _largest(force) <= _DONE * scale:
            break
        hessian = potential.stiffness(q)
        if not np.isfinite(hessian.data).all():  # a force with a vertical tangent
            break
        threshold = _LEAST * float(abs(hessian).sum(axis=1).max() or scale / length)
        step = Elimination(hessian, q, least=threshold).solve(force.ravel()).reshape(q.shape)
        for _ in range(_TRIES):
            step = step * min(1.0, trust / _largest(step))
            next_q, after = q + step, potential.force(q + step)
            if not inside_obstacle(potential.law, next_q) and _better(force, after, step, hessian, _NEAR * scale):
                break
            trust = 0.25 * _largest(step)
        else:
            break
        q, force, trust = next_q, after, max(trust, 2.0 * _largest(step))
    return q, _largest(force) <= _NEAR * scale


def _better(force: FloatArray, after: FloatArray, step: FloatArray, hessian: Any, near: float) -> bool:
    """Return whether a step achieved enough of the predicted decrease of energy, or of force near the end."""
    # The fall of energy is the work of the force by the trapezoidal rule: no large energies to subtract.
    if _largest(force) <= near:
        return _largest(after) < _largest(force)
    expected_gain = float(np.vdot(force, step)) - 0.5 * float(step.ravel() @ (hessian @ step.ravel()))
    return 0.5 * float(np.vdot(force + after, step)) > _ENOUGH * abs(expected_gain)


def _largest(vectors: FloatArray) -> float:
    return float(np.sqrt(np.einsum("ij,ij->i", vectors, vectors).max()))
