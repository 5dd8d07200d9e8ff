"""Claims by how they are decided, by a margin against 0 or by algebra, and theorems that are checked by themselves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from flockana.theorems.theorem import Claim, Hypothesis, Status, Theorem, Tolerances, judge, overall


def judged(
    name: str,
    margin: float,
    error: float,
    needs: Iterable[Hypothesis] = (),
    *,
    verifies: bool = True,
    refutes: bool = True,
    **fields: Any,
) -> Claim:
    """A claim that holds if its margin is positive by more than an error, and its hypotheses are met.

    Parameters
    ----------
    name : str
        Of the claim.
    margin, error : float
        The margin and its numerical error; 0 for a whole number.
    needs : iterable of Hypothesis
        Hypotheses of the claim.
    verifies, refutes : bool
        Whether a margin beyond the error decides: a sample verifies no statement about all cases, and a finite run
        refutes no limit. What would be decided is then inconclusive.
    **fields
        Further fields of the claim, such as `computed`, `stated`, `witness` and `detail`.

    Examples
    --------
    >>> judged("i", 0.5, 0.1).status, judged("i", -0.5, 0.1).status, judged("i", -0.5, 0.1, refutes=False).status
    ('verified', 'refuted', 'inconclusive')
    """
    status = judge(margin, error, needs)
    if (status == "verified" and not verifies) or (status == "refuted" and not refutes):
        status = "inconclusive"
    return Claim(name, status, margin=margin, error=error, **fields)


def exact(name: str, holds: bool, **fields: Any) -> Claim:
    """A claim that algebra decides, without a numerical error.

    Parameters
    ----------
    name : str
        Of the claim.
    holds : bool
        Whether it is true.
    **fields
        Further fields of the claim.

    Examples
    --------
    >>> exact("printed", 1 + 1 == 3, detail="1 + 1 = 3").status
    'refuted'
    """
    return Claim(name, "verified" if holds else "refuted", "symbolic", **fields)


def equal(name: str, residual: Any, **fields: Any) -> Claim:
    """An identity by its residual, as computed by sympy, a number or several: it holds if all of it is 0.

    Parameters
    ----------
    name : str
        Of the claim.
    residual : expression or sequence of expressions
        The difference of the two sides, which becomes the witness.
    **fields
        Further fields of the claim.

    Examples
    --------
    >>> equal("corrected", 0).computed, equal("printed", [0, 1]).status
    ('residual 0', 'refuted')
    """
    several = isinstance(residual, list | tuple)
    holds = all(row == 0 for row in residual) if several else bool(residual == 0)
    computed = "residual 0" if holds else "a residual that is not 0"
    witness = [str(row) for row in residual] if several else str(residual)
    return exact(name, holds, computed=computed, witness=witness, **fields)


def erratum(
    name: str,
    *,
    title: str,
    statement: str,
    source: str,
    check: Callable[[Tolerances], list[Claim]],
    expected: Mapping[str, Status],
    references: tuple[str, ...] = ("olfati-saber-2006",),
) -> Theorem:
    """A statement that is checked by itself, on no run of the user's: an erratum, with what is expected of its claims.

    Parameters
    ----------
    name : str
        Its id.
    title, statement, source : str
        As in `Theorem`.
    check : callable
        Returns the claims, from the tolerances.
    expected : mapping of str to str
        Status that is expected of each claim; that of the whole follows from them.
    references : tuple of str
        Keys of the bibliography.

    Examples
    --------
    >>> two = erratum(
    ...     "two", title="1 + 1 is 2", statement="1 + 1 = 2", source="arithmetic",
    ...     check=lambda tolerances: [exact("sum", 1 + 1 == 2)], expected={"sum": "verified"},
    ... )
    >>> dict(two.expected), two.examine(Tolerances())[1][0].status
    ({'two': 'verified', 'two:sum': 'verified'}, 'verified')
    """
    return Theorem(
        id=name,
        title=title,
        statement=statement,
        source=source,
        kind="fixed",
        check=lambda tolerances: ([], check(tolerances)),
        references=references,
        expected={name: overall(expected.values())} | {f"{name}:{claim}": status for claim, status in expected.items()},
    )
