"""Derivations: steps of text, equation and condition, LaTeX output, and computed residuals."""

from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True)
class Step:
    """One step of a derivation: text, equation and condition.

    Parameters
    ----------
    text : str
        What is done, as LaTeX text: inline mathematics between dollar signs.
    equation : sympy.Basic
        The equation or expression reached.
    condition : sympy.Basic
        When it holds; ``true`` if always.

    Examples
    --------
    >>> x = sp.Symbol("x")
    >>> Step("Square.", sp.Eq(x**2, 4), x > 0).latex()
    '& \\\\text{Square.} \\\\\\\\\\n& \\\\quad x^{2} = 4 \\\\qquad \\\\text{if } x > 0'
    """

    text: str
    equation: sp.Basic
    condition: sp.Basic = sp.true

    def latex(self) -> str:
        """Return the step of a derivation as two rows of a LaTeX ``aligned`` environment."""
        condition = "" if self.condition == sp.true else rf" \qquad \text{{if }} {sp.latex(self.condition)}"
        return f"& \\text{{{self.text}}} \\\\\n& \\quad {sp.latex(self.equation)}{condition}"


def latex_steps(title: str, steps: tuple[Step, ...]) -> str:
    r"""Return a titled sequence of derivation steps as one LaTeX ``aligned`` environment."""
    rows = [rf"& \textbf{{{title}}}", *(step.latex() for step in steps)]
    return "\\begin{aligned}\n" + " \\\\\n".join(rows) + "\n\\end{aligned}"


class Printed:
    """Base class of derivations shown as LaTeX in notebooks: steps under a title."""

    title: str
    steps: tuple[Step, ...]

    def latex(self) -> str:
        """Return the steps of a derivation as LaTeX."""
        return latex_steps(self.title, self.steps)

    def _repr_latex_(self) -> str:
        return f"$${self.latex()}$$"


@dataclass(frozen=True)
class Derivation(Printed):
    """Derivation: a result with the steps that lead to it.

    Parameters
    ----------
    steps : tuple of Step
        How, each with its condition.
    result : sympy.Basic
        What comes out.
    residuals : tuple of sympy.Expr
        Left minus right side of every equation that was checked by computing: all 0 if it holds.

    Examples
    --------
    >>> Derivation("Nothing", (), sp.Integer(0), (sp.Integer(0),)).holds
    True
    """

    title: str
    steps: tuple[Step, ...]
    result: sp.Basic
    residuals: tuple[sp.Expr, ...]

    @property
    def holds(self) -> bool:
        """Return whether every computed residual of the derivation vanishes identically."""
        return all(residual == 0 for residual in self.residuals)
