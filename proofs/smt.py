"""Steps that z3 decides over the real numbers: what it cannot decide in time is unknown, never false."""

from __future__ import annotations

from typing import Any

import z3

from proofs.proof import Step


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
