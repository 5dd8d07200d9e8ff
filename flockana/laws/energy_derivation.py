"""Derivation by sympy of a law's energy identity with its own pair law, for every number of agents."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from flockana.base.errors import ArgumentError
from flockana.interactions import AlphaInteraction
from flockana.interactions.formula import FormulaInteraction
from flockana.laws.terms.navigation import Navigation
from flockana.laws.terms.pairs import PairTerm

if TYPE_CHECKING:
    from flockana.symbolic.derivation import Step
    from flockana.symbolic.energy import EnergyIdentity


def law_derivation(law: Any, m: int = 2) -> EnergyIdentity:
    """Return the derivation of a law's potential, force, energy and dH/dt, with LaTeX output."""
    # The sums are over n agents, whatever n is: the identity is derived from one generic pair and one generic agent, in
    # the σ-norm z_ij, of which every function of a pair's distance is one.
    from flockana.symbolic.energy import algorithm1_identity, structural_identity

    kinds = [type(term) for term in law.terms]
    pull = law.term(Navigation)
    is_plain_pull = pull is None or (pull.unit is None and not pull.gains.per_agent)
    if kinds not in ([PairTerm], [PairTerm, Navigation]) or not is_plain_pull:
        raise ArgumentError(
            f"{type(law).__name__} is no sum of a pair term and a linear pull common to all agents: "
            "expected such a law, as Algorithm 1 or 2 is, for its derivation"
        )
    identity = algorithm1_identity(m) if pull is None else structural_identity(m)
    return replace(
        identity, name=f"{type(law).__name__}: {identity.name}", steps=(*_pair_steps(law.pair), *identity.steps)
    )


def _pair_steps(pair: Any) -> tuple[Step, ...]:
    if isinstance(pair, FormulaInteraction):
        return pair.derivation().steps
    if isinstance(pair, AlphaInteraction):
        from flockana.symbolic.pair_formula import alpha_steps

        return alpha_steps()
    raise ArgumentError(f"{type(pair).__name__} has no formula: expected pair_law(...) or AlphaInteraction(...)")
