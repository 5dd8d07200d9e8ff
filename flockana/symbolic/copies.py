"""Agents that follow copies of a γ-agent with dynamics: energy balance, and separation of the copies."""

import sympy as sp

from flockana.symbolic.derivation import Derivation, Step

T = sp.Symbol("t", real=True)
C1, C2 = sp.symbols("c_1 c_2", nonnegative=True)
K1, K2, STIFFNESS, DAMPING = sp.symbols("k_1 k_2 k b", real=True)


def copies_balance() -> Derivation:
    """Derive what the pull to a copy adds to dH/dt, a component of one agent: q'' = f - c1 (q - q_r) - c2 (q' - q_r').

    f is all else; what it does, p f, is counted where its energy is.
    """
    q, place, other = (sp.Function(name)(T) for name in ("q", "q_r", "f"))
    p, rate = q.diff(T), place.diff(T)
    acceleration = other - C1 * (q - place) - C2 * (p - rate)
    energy = C1 * (q - place) ** 2 / 2 + p**2 / 2
    along = energy.diff(T).subs(q.diff(T, 2), acceleration) - p * other
    stated = -C2 * p * (p - rate) - C1 * (q - place) * rate
    steps = (
        Step("Energy of one agent and its copy, a component of each:", energy),
        Step("Its rate along the law, without the power of all else:", sp.expand(along)),
    )
    return Derivation("Balance of an agent and its copy", steps, stated, (sp.expand(along - stated),))


def copies_part() -> Derivation:
    """Derive how far a copy is from the mean of all, for f_r = -k q - b p: one equation for any number of copies."""
    copies = [sp.Function(f"q_{i}")(T) for i in range(3)]
    mean = sum(copies) / 3
    pulls = (K1 * (mean - q) + K2 * (mean - q).diff(T) for q in copies)
    pulled = {q.diff(T, 2): -STIFFNESS * q - DAMPING * q.diff(T) + pull for q, pull in zip(copies, pulls, strict=True)}
    away = copies[0] - mean
    left = away.diff(T, 2).subs(pulled)
    right = -(STIFFNESS + K1) * away - (DAMPING + K2) * away.diff(T)
    d = sp.Function("d")(T)
    result = sp.Eq(d.diff(T, 2), (-DAMPING - K2) * d.diff(T) + (-STIFFNESS - K1) * d)
    steps = (Step("Of a copy less the mean:", result),)
    return Derivation("How copies part", steps, result, (sp.expand((left - right).doit()),))
