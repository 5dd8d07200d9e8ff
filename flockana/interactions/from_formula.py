"""`pair_law`: pair law from sympy expressions, text or numbers."""

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

from flockana.base.errors import ArgumentError, format_value
from flockana.base.units import Powers
from flockana.base.value_checks import ensure_positive
from flockana.interactions.formula import FormulaInteraction


class PairLawWarning(UserWarning):
    """Warning about defects of a pair law: a pole, a jump, or an extra sign change of the force."""


def pair_law(
    potential: Any = None,
    *,
    force: Any = None,
    adjacency: Any,
    range: float,
    length: float,
    parameters: Mapping[str, float] | None = None,
    units: Mapping[str, Powers] | None = None,
) -> FormulaInteraction:
    """Return a pair law from a formula, compiled like a hand-written one, for all laws that accept one.

    Formulas are sympy expressions, text or numbers, in the distance s, or in the σ-norm z with a parameter ``eps``;
    r and d mean range and length, r_z and d_z their σ-norms, and every other name is a parameter. Pieces are
    ``Piecewise`` with conditions linear in the distance. A law that is infinite within the range or jumps at it, or
    whose force changes its sign besides d, is made with a `PairLawWarning`, and shows it
    (`FormulaInteraction.remarks`). What theorems ask for and the formula lacks is in `FormulaInteraction.faults`.

    Parameters
    ----------
    potential : sympy.Expr, str or float, optional
        ψ; where it rises with the distance, agents attract each other.
    force : sympy.Expr, str or float, optional
        Instead of it dψ/ds or dψ/dz, where ψ has no closed form, as that of Olfati-Saber has none: positive attracts.
    adjacency : sympy.Expr, str or float
        a_ij, by which velocities are averaged; 0 for none.
    range : float
        Beyond which pairs do not interact, in the user's length unit.
    length : float
        That neighbours are held at, or another length that the law has.
    parameters : mapping of str to float, optional
        A value for each name.
    units : mapping of str to (int, int), optional
        Powers of length and time of each parameter, so that `flockana.rescale` knows them.

    Examples
    --------
    >>> law = pair_law("k*((r**2 - s**2)**4/8 - (r**2 - d**2)*(r**2 - s**2)**3/6)", adjacency="(1 - s/r)**2",
    ...                range=3.0, length=2.0, parameters={"k": 0.01})
    >>> law.faults, law.lattice, law.facts.zeros
    ((), (2.0, 3.0), (2.0,))
    """
    if (potential is None) == (force is None):
        raise ArgumentError(
            f"potential = {potential!r}, force = {force!r}: expected a potential or a force, one of the two"
        )
    for name, table in (("parameters", parameters), ("units", units)):
        if not isinstance(table, Mapping | None):
            raise ArgumentError(f"{name} = {format_value(table)}: expected a dictionary by the parameters' names")
    for name, both in (units or {}).items():
        if not (isinstance(both, Sequence) and len(both) == 2 and all(type(power) is int for power in both)):
            raise ArgumentError(f"units[{name!r}] = {format_value(both)}: expected whole powers (length, time)")
    law = FormulaInteraction(
        potential=_as_text("potential", potential),
        force_formula=_as_text("force", force),
        adjacency_formula=_as_text("adjacency", adjacency),
        r=ensure_positive("range", range),
        d=ensure_positive("length", length),
        parameters=tuple((parameters or {}).items()),
        powers=tuple((name, *both) for name, both in (units or {}).items()),
    )
    if serious_remarks := [remark for remark in law.remarks if not remark.startswith("two agents rest at")]:
        warnings.warn(f"pair_law: {'; '.join(serious_remarks)}", PairLawWarning, stacklevel=2)
    return law


def _as_text(name: str, formula: Any) -> str:
    """Return a formula as text; sympy is imported only when needed."""
    if formula is None:
        return ""
    if isinstance(formula, str):
        return formula
    import sympy as sp

    from flockana.symbolic.formula_grammar import write_formula

    if isinstance(formula, int | float) or (isinstance(formula, sp.Expr) and not formula.has(sp.Indexed)):
        return write_formula(sp.sympify(formula))
    raise ArgumentError(f"{name} = {formula!r}: expected a sympy expression, text or a number")
