"""A proof to start from: copy it to `proofs/<name>.py`, and `python -m proofs <name>` checks it.

Say first what is proved of what, then let a machine check each step; what a machine cannot check (a mean value theorem,
a sum regrouped) is said in a step's text or evidence, never passed over. A step is

- symbolic: `Step(text, condition)`, with a condition that sympy has reduced to True, such as ``residual == 0``;
- smt: `implication(text, goal, *given)` or `impossible(text, *constraints)` of `proofs.smt`, over all real numbers;
- interval: a comparison of balls from `flockana.certified.scalar_functions_in_balls`, which is true only if it is
  certain.

`holds` is None where the machine cannot tell. A sample, however large, is no step.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication


def _identity() -> Iterator[Step]:
    a, b = sp.symbols("a b", real=True)
    yield Step(
        "half the square of the difference is left over",  # what is proved, in words
        sp.expand((a**2 + b**2) / 2 - a * b - (a - b) ** 2 / 2) == 0,  # by whom: True, False, or None
        r"\tfrac12(a^2 + b^2) - ab = \tfrac12(a - b)^2",  # the formula, for the certificate
        "expanded: 0",  # what the machine answered
    )


def _inequality() -> Iterator[Step]:
    a, b = z3.Reals("a b")
    yield implication("ab <= ½(a² + b²)", 2 * a * b <= a**2 + b**2, a >= 0, b >= 0, latex=r"ab \le \tfrac12(a^2 + b^2)")


def _steps() -> Iterator[Step]:
    yield from _identity()
    yield from _inequality()


PROOF = Proof(
    id="template",  # the file's name, with hyphens
    title="A mean is at least a product",
    statement="ab <= ½(a² + b²), with equality for a = b only",
    hypotheses="a, b >= 0",
    rigour="smt",  # the weakest of its steps: symbolic, smt or interval
    steps=_steps,
    size=2,  # how many steps there are, so that a loop that runs short proves nothing
    theorems=(),  # entries of `flockana theorems` that it backs; their claims name it by proof="..."
    time_limit=120.0,  # seconds, after which it is killed and nothing is proved
)
