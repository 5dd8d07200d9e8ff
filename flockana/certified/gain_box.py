"""Stability of an equilibrium for all gains in a box: a proof that follows the equilibrium and bounds its modes.

With y = q − q_r an equilibrium of Algorithm 2 solves c1α ∇V(y) + c1γ_i y_i = 0, which only κ_i = c1γ_i/c1α matter to.
Krawczyk's test for all κ of the box at once encloses it: y_i = c + z_i, Σ z_i = 0, its turn about the γ-agent fixed. A
box in which it holds has one equilibrium for each choice of gains, which depends on them continuously. There K and D
are symmetric and rotations are in the kernel of K; D is positive definite as every c2γ_i > 0, c2α ≥ 0. What is left to
show is that K is positive but for rotations. V does not feel translations: with δ_i = v_i − v_0 and κ_i ≥ κ,
vᵀKv/c1α ≥ δᵀ(∇²V + κ (1 − 11ᵀ/n)) δ, agent 0 left out.
"""

from dataclasses import dataclass, replace
from itertools import product
from math import isfinite
from typing import Any, Literal

import numpy as np
from flint import arb, arb_mat, fmpq

from flockana.base.errors import ArgumentError, format_value
from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import FloatArray, ensure_nonnegative, ensure_points
from flockana.certified.balls import AlphaParameters, ball
from flockana.certified.krawczyk import column, krawczyk_shift, least_eigenvalue
from flockana.certified.structural_potential import Structure, in_lengths_of_unit, outer
from flockana.equilibria.final_state import generators
from flockana.equilibria.solve import RESIDUAL, find_equilibrium
from flockana.interactions import AlphaInteraction
from flockana.laws.olfati_saber import Algorithm2
from flockana.stability.gain_sweeps import GAINS
from flockana.stability.linearise import linearise

MOST = 7  # agents
_ON_A_LINE = 1e-9  # relative: a rotation that moves no agent
_FINEST, _GROWTH, _GROWTHS = 1e-9, 1.25, 20  # first radius of the box, and how it grows


@dataclass(frozen=True)
class GainBox(ShortRepr):
    """Stability of an equilibrium for all gains in a box: proved, refuted by gains, or neither.

    Parameters
    ----------
    status : {"verified", "refuted", "inconclusive"}
        For all gains of the box there is one equilibrium near the nominal one, up to rotations, and all its other modes
        decay; the equilibrium near it is unstable for the gains `witness`; or neither is certain.
    witness : tuple of float
        c1α, c2α, c1γ, c2γ of the box with which a mode of the equilibrium grows; empty without one.
    moved : float
        By how much a link of the equilibrium may change within the box, proved, in units of length; NaN without proof.
    """

    status: Literal["verified", "refuted", "inconclusive"]
    witness: tuple[float, ...] = ()
    moved: float = float("nan")


def gain_box(law: Algorithm2, q: Any, spread: float) -> GainBox:
    """Decide whether an equilibrium stays stable if every gain of every agent deviates by up to a fraction.

    Proved in ball arithmetic, for the law as it is: for all c1α, c2α and all c1γ, c2γ of the agents in the box, there
    is exactly one equilibrium near that of the nominal gains but for rotations about the γ-agent, it depends on them
    continuously, and every mode that is no rotation decays. It is refuted if the equilibrium that is found from there
    with gains of a corner is unstable.

    Parameters
    ----------
    law : Algorithm2
        The law with its nominal gains.
    q : Equilibrium or array_like, shape (n, m)
        Equilibrium of the nominal gains, or positions near it, of at most 7 agents.
    spread : float
        Share by which each gain may be smaller or larger, 0 <= spread < 1.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> triangle = [[0.0, 0.0], [7.0, 0.0], [3.5, 6.0621778264910706]]
    >>> gain_box(Algorithm2(target=StaticTarget((0.0, 0.0))), triangle, 0.1).status
    'verified'
    """
    q = ensure_points("q", getattr(q, "q", q))
    spread = ensure_nonnegative("spread", spread)
    if type(law) is not Algorithm2 or not isinstance(law.alpha, AlphaInteraction):
        raise ArgumentError(f"law: expected Algorithm2(...) with AlphaInteraction(...), got {type(law).__name__}")
    law.check_dimension(q.shape[1])
    law.check_agents(len(q))
    if len(q) > MOST:
        raise ArgumentError(f"q has {len(q)} agents: expected at most {MOST}; robustness_margins takes more")
    target = law.target
    if target is not None and not (target.consistent and target.constant_velocity):
        raise ArgumentError(f"target = {format_value(target)}: expected one of constant velocity, which it reports")
    if spread >= 1.0:
        raise ArgumentError(f"spread = {spread:g}: expected a share below 1")
    equilibrium = find_equilibrium(law, q)
    if not (equilibrium.success and equilibrium.residual <= RESIDUAL):
        return GainBox("inconclusive")
    proof = _proved(law, np.asarray(equilibrium.q), spread)
    if isfinite(proof):
        return GainBox("verified", moved=proof)
    for share in product((1.0 - spread, 1.0 + spread), repeat=3):
        shares = zip(GAINS, (*share, 1.0 - spread), strict=True)
        gains: dict[str, Any] = {name: factor * np.asarray(getattr(law.gains, name))[()] for name, factor in shares}
        changed_law = replace(law, gains=replace(law.gains, **gains))
        there = find_equilibrium(changed_law, equilibrium.q)
        if there.success and any(mode.decay_rate < -mode.error for mode in linearise(changed_law, there).modes):
            return GainBox("refuted", tuple(float(np.min(x)) for x in gains.values()))
    return GainBox("inconclusive")


def _proved(law: Algorithm2, q: FloatArray, spread: float) -> float:
    """Return the share by which link lengths may change in the proved box of gains; NaN without a proof."""
    unit: float = getattr(law.alpha, "unit", 1.0)
    rescaled_law, no_number = in_lengths_of_unit(law), float("nan")
    gains, (n, m) = rescaled_law.gains, q.shape
    pull, drag = (np.broadcast_to(x, q.shape)[:, 0].tolist() for x in (gains.pull, gains.drag))
    if not (gains.c1_alpha > 0.0 and gains.c2_alpha >= 0.0 and min(pull) > 0.0 and min(drag) > 0.0):
        return no_number
    y = (q - (0.0 if law.target is None else law.target.position(0.0))) / unit
    low, high = (ball(1 - side * fmpq(*spread.as_integer_ratio())) for side in (1, -1))
    kappa = [(ball(x) * low / high / gains.c1_alpha).union(ball(x) * high / low / gains.c1_alpha) for x in pull]
    structure = Structure(AlphaParameters.of(rescaled_law.alpha), fmpq(1), fmpq(0), fmpq(0), fmpq(0), n, m)
    box = _enclose(structure, y, kappa)
    if box is None or not _is_stiff(structure, box, min((x.lower() for x in kappa), key=float)):
        return no_number
    widest = max(float(x.rad()) for x in box)
    return float(np.nextafter(2.0 * np.sqrt(m) * widest * unit, np.inf))


def _turns(y: FloatArray) -> FloatArray:
    """Return orthonormal rotations about the γ-agent, as columns of shape (n m, k)."""
    turns = np.array([(y @ generator.T).ravel() for generator in generators(y.shape[1])]).reshape(-1, y.size)
    basis, singular_values, _ = np.linalg.svd(turns.T, full_matrices=False)
    return np.asarray(basis[:, singular_values > _ON_A_LINE * singular_values.max(initial=0.0)])


def _enclose(structure: Structure, y: FloatArray, kappa: list[arb]) -> list[arb] | None:
    """Return balls of the equilibrium's displacement z = y − c for all gain ratios κ in the box; None if unproved."""
    n, m = y.shape
    centre, turns = y.mean(axis=0), _turns(y)
    size, k = n * m, turns.shape[1]
    weights = [kappa[i // m] for i in range(size)]
    start = (y - centre).ravel().tolist() + (centre).tolist() + [0.0] * k

    def places(x: Any) -> list[arb]:
        return [x[i] + x[size + i % m] for i in range(size)]

    def equations(x: Any) -> list[arb]:
        at = places(x)
        outer = [
            w * a + sum((turns[i, j] * x[size + m + j] for j in range(k)), arb(0))
            for i, (w, a) in enumerate(zip(weights, at, strict=True))
        ]
        forces = [f + own_force for f, own_force in zip(structure.gradient(x[:size]), outer, strict=True)]
        forces[:m] = [sum(outer[a::m], arb(0)) for a in range(m)]  # of all agents, to which pairs add nothing
        mean_values = [sum((x[m * i + a] for i in range(n)), arb(0)) for a in range(m)]
        gauges = [sum((turns[i, j] * (at[i] - float(y.ravel()[i])) for i in range(size)), arb(0)) for j in range(k)]
        return [*forces, *mean_values, *gauges]

    def slope(x: Any) -> arb_mat:
        full_matrix = [[arb(0)] * (size + m + k) for _ in range(size + m + k)]
        for i, row in enumerate(structure.hessian(x[:size]).tolist()):
            a, target_rows = i % m, {i % m, i}  # the first rows are those of all agents
            if i >= m:
                full_matrix[i][:size] = row
            for r in target_rows:
                full_matrix[r][i] += weights[i]
                full_matrix[r][size + a] += weights[i]
            full_matrix[size + a][i] = arb(1)
            for j in range(k):
                for r in target_rows:
                    full_matrix[r][size + m + j] += float(turns[i, j])
                full_matrix[size + m + j][i] = arb(float(turns[i, j]))
                full_matrix[size + m + j][size + a] += float(turns[i, j])
        return arb_mat(full_matrix)

    solution = _grow_box(equations, slope, [arb(x) for x in start])
    if solution is None:
        return None
    at = places(solution)  # the forces are orthogonal to the turns at the equilibrium: what holds the turn is then 0
    tangents = structure.rotation_tangents(at)
    products = arb_mat(
        [[sum((float(turns[i, j]) * t[i] for i in range(size)), arb(0)) for j in range(k)] for t in tangents]
    )
    if k and least_eigenvalue(products.transpose() * products) is None:  # its columns may be dependent
        return None
    return solution[:size]


def _grow_box(equations: Any, slope: Any, centre: list[arb]) -> list[arb] | None:
    """Return balls around the unique zero of equations near a centre; radii grow until Krawczyk's test succeeds."""
    radii = [arb(_FINEST)] * len(centre)
    for _ in range(_GROWTHS):
        try:
            shift = krawczyk_shift(equations, slope, centre, radii)
        except ZeroDivisionError:  # singular to the last bit
            return None
        if all(abs(entry) < radius for entry, radius in zip(shift, radii, strict=True)):
            return [x + entry for x, entry in zip(centre, shift, strict=True)]
        radii = [arb(max(_FINEST, _GROWTH * float(abs(entry).upper()))) for entry in shift]
        if not all(radius.is_finite() for radius in radii):
            return None
    return None


def _is_stiff(structure: Structure, z: list[arb], least: arb) -> bool:
    """Return whether the form ∇²V + κ (1 − 11ᵀ/n), agent 0 left out, is certainly positive apart from rotations."""
    # A pair's block in the ball is at least its middle less its radius ρ: the form is at least one of numbers. With
    # s TTᵀ of the middle of a rotation added it exceeds g; across the true one it then exceeds g − s ‖T − middle‖².
    n, m = structure.n, structure.m
    if n == 1:
        return True
    blocks = []
    for i, j, gap, s in structure.near(z):
        tension = structure.tension(s)
        block = outer(gap, tension, (structure.stiffness(s) - tension) / s)
        loss = sum((entry.rad() ** 2 for row in block for entry in row), arb(0)).sqrt()
        loss = arb(loss.upper())
        rows = enumerate(block)
        blocks.append((i, j, [[x.mid() - (loss if a == b else 0) for b, x in enumerate(row)] for a, row in rows]))
    full_hessian = structure.assembled(blocks).tolist()
    form = arb_mat(
        [
            [full_hessian[i][j] + least * ((i == j) - ball(fmpq(int(i % m == j % m), n))) for j in range(m, n * m)]
            for i in range(m, n * m)
        ]
    )
    turns = [[x - t[k % m] for k, x in enumerate(t)][m:] for t in structure.rotation_tangents(z)]
    tie_weight, rounding_loss = arb(max(float(abs(entry).upper()) for entry in form.entries())), arb(0)
    for rotation in turns:
        size = arb(sum((x.mid() ** 2 for x in rotation), arb(0)).mid())
        if not size > 0:
            continue
        midpoint_column = column([x.mid() for x in rotation])
        form = form + tie_weight / size * midpoint_column * midpoint_column.transpose()
        rounding_loss += tie_weight / size * sum((x.rad() ** 2 for x in rotation), arb(0))
    bound = least_eigenvalue(form)
    return bound is not None and bool(bound > rounding_loss)
