"""Erratum E14: the slides' Reynolds form of Algorithm 1 loses −S_i q_i, and with it translation invariance."""

import numpy as np

from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm1
from flockana.measures.reynolds import reynolds
from flockana.theorems.theorem_toolkit import EPS, Claim, FloatArray, Tolerances, equal, erratum, of_state

_SHIFT = 10.0  # of d


def _three() -> tuple[AlphaInteraction, FloatArray]:
    """Return a pair law and three agents on a line, the middle one repelled from behind, attracted ahead."""
    alpha = AlphaInteraction()
    return alpha, np.array([[0.0], [5.0], [13.0]]) * alpha.d / 7.0


def _forces(alpha: AlphaInteraction, q: FloatArray, *, printed: bool) -> FloatArray:
    """Return the pair forces u^g of all agents in Reynolds form, corrected, or as printed without −S_i q_i."""
    rules, forces = reynolds(q, np.zeros_like(q), alpha=alpha, gains=Gains(c1_alpha=1.0)), np.zeros_like(q)
    for ends in (rules.links, rules.links[:, ::-1]):
        np.add.at(forces, ends[:, 0], rules.stress[:, None] * (q[ends[:, 1]] - (0.0 if printed else q[ends[:, 0]])))
    return forces


def _example() -> Claim:
    """Return the claim that a shift of ten lengths leaves the printed force on the middle agent unchanged."""
    alpha, q = _three()
    here, there = (float(_forces(alpha, q + w, printed=True)[1, 0]) for w in (0.0, _SHIFT * alpha.d))
    magnitude = float(np.abs(q).max() + _SHIFT * alpha.d) * alpha.strength
    return of_state("translation", -abs(there - here), 16.0 * EPS * magnitude, about="all").described(
        computed={"here": here, "there": there},
        stated="the force does not depend on where the origin is",
        witness={"q": q.tolist(), "moved by": _SHIFT * alpha.d},
        detail=f"three agents at 0, 5, 13: on the middle one {here:.4g} as printed, {there:.4g} with all moved by "
        f"{_SHIFT * alpha.d:g}; the law gives {float(_law(alpha, q)[1, 0]):.4g} in both places",
    )


def _law(alpha: AlphaInteraction, q: FloatArray) -> FloatArray:
    return Algorithm1(alpha, Gains(c1_alpha=1.0)).acceleration(0.0, q, np.zeros_like(q))


def _state() -> Claim:
    """Return the claim that the corrected Reynolds form equals the law's force, before and after a shift."""
    alpha, q = _three()
    bound = 64.0 * EPS * (1.0 + _SHIFT) * alpha.strength * 2.0
    states = [q + w for w in (0.0, _SHIFT * alpha.d)]
    worst = float(np.max([np.abs(_forces(alpha, x, printed=False) - _law(alpha, x)).max() for x in states]))
    text = f"the corrected form is the force that the law computes, to {worst:.2g}"
    return of_state("state", bound - worst, 0.0).described(
        computed=worst, stated=f"the law's own force, to rounding ({bound:.2g})", witness={"q": q.tolist()}, detail=text
    )


@erratum(
    "E14", expected={"refuted": "printed translation", "verified": "corrected state"}, corrected=("corrected", "state")
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The slides rewrite u_i^g = Σ_j s_ij q_j − S_i q_i as S_i⁺⟨q⟩⁺ + S_i⁻⟨q⟩⁻, the pull to the mean of positive
    friends and the push from that of the negative ones. The term −S_i q_i is lost, and the force depends on the origin.
    The correct form is S_i⁺(⟨q⟩⁺ − q_i) + S_i⁻(⟨q⟩⁻ − q_i).
    """
    from flockana.symbolic.errata import reynolds_form

    printed_form, true_form = reynolds_form(printed=True), reynolds_form()
    return [
        equal("printed", list(printed_form.residuals), stated="u_i^g = S_i⁺⟨q⟩⁺ + S_i⁻⟨q⟩⁻").described(
            detail="the residual is −S_i q_i, S_i = S_i⁺ + S_i⁻; moved by w, the printed force grows by S_i w"
        ),
        _example(),
        equal("corrected", list(true_form.residuals)).described(
            stated="u_i^g = S_i⁺(⟨q⟩⁺ − q_i) + S_i⁻(⟨q⟩⁻ − q_i), the same wherever the origin is",
            detail="for any numbers of positive and negative friends, by sympy",
        ),
        _state(),
    ]
