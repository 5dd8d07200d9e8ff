"""Steps that z3 decides over the real numbers: what it cannot decide in time is unknown, never false.

A step that others rest on is a lemma: they take it from the object that proved it, so that no copy of it can differ.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp
import z3

from proofs.proof import Step


@dataclass(frozen=True)
class Lemma:
    """An implication for all real values of its variables, with the step that proved it, or did not."""

    step: Step
    given: tuple[Any, ...]
    goal: Any
    when: Any = None

    def at(self, values: Mapping[Any, Any] | None = None) -> Any:
        """It as a hypothesis, with other terms for some of its variables; nothing, if it was not proved."""
        if self.step.holds is not True:
            return z3.BoolVal(True)
        pairs = [(variable, z3.RealVal(0) + term) for variable, term in (values or {}).items()]
        return z3.substitute(z3.Implies(z3.And(*self.given), self.goal), *pairs)

    def then(self, values: Mapping[Any, Any] | None = None) -> Any:
        """Its conclusion, on its condition `when`, of things that meet the rest of its hypotheses by what they are."""
        if self.step.holds is not True:
            return z3.BoolVal(True)
        pairs = [(variable, z3.RealVal(0) + term) for variable, term in (values or {}).items()]
        return z3.substitute(self.goal if self.when is None else z3.Implies(self.when, self.goal), *pairs)


def lemma(text: str, goal: Any, *given: Any, when: Any = None, latex: str = "", seconds: float = 60.0) -> Lemma:
    """An implication that others rest on; yield its `step`."""
    known = given if when is None else (*given, when)
    return Lemma(implication(text, goal, *known, latex=latex, seconds=seconds), known, goal, when)


def real(expression: sp.Expr, names: Mapping[sp.Expr, Any]) -> Any:
    """A rational expression of sympy as a term of z3, each of `names` as the term given."""
    if expression in names:
        return names[expression]
    if expression.is_Rational:
        return z3.Q(int(expression.p), int(expression.q))
    parts = [real(part, names) for part in expression.args if not expression.is_Pow]
    if expression.is_Add:
        return z3.Sum(parts)
    if expression.is_Mul:
        return z3.Product(parts)
    if expression.is_Pow and expression.exp.is_Integer:
        base, power = real(expression.base, names), abs(int(expression.exp))
        whole = z3.Product([base] * power) if power > 1 else base
        return whole if expression.exp > 0 else 1 / whole
    raise TypeError(f"{expression}: expected a rational expression of {', '.join(map(str, names))}")


def impossible(text: str, *constraints: Any, latex: str = "", seconds: float = 60.0) -> Step:
    """The step that no real values of the variables meet all constraints."""
    answer, evidence = _ask(constraints, seconds)
    holds = True if answer == z3.unsat else False if answer == z3.sat else None
    return Step(text, holds, latex, f"z3: {f'met by {evidence}' if holds is False else evidence}")


def implication(text: str, goal: Any, *given: Any, latex: str = "", seconds: float = 60.0) -> Step:
    """The step that the hypotheses `given` imply the goal, for all real values of the variables.

    Hypotheses that contradict each other would imply anything: they must have a model.
    """
    answer, evidence = _ask(given, seconds)
    if answer != z3.sat:
        return Step(text, False if answer == z3.unsat else None, latex, f"z3 on the hypotheses alone: {evidence}")
    return impossible(text, *given, z3.Not(goal), latex=latex, seconds=seconds)


def _ask(constraints: Any, seconds: float) -> tuple[Any, str]:
    """z3's answer with its model, or why it has none."""
    solver = z3.SolverFor("QF_NRA")
    solver.set("timeout", int(1000 * seconds))
    solver.add(*constraints)
    answer = solver.check()
    if answer == z3.sat:
        return answer, str(solver.model()).replace("\n", "")
    return answer, "no values exist" if answer == z3.unsat else f"unknown, {solver.reason_unknown()}"
