"""Constructors of claims, one for each kind of evidence, which alone decide statuses.

A claim about a run holds if a margin, an enclosure over time, is nowhere negative. Where its needs are met a proof
decides instead, and the numbers stand beside it.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from flockana.theorems.claim import does_not_hold
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.errata import erratum_of, printed
from flockana.theorems.proof_register import CITES, RIGOUR
from flockana.theorems.theorem import About, Check, Claim, Hypothesis, Needs, Rigour, Status, Theorem, Tolerances
from flockana.theorems.verdict_summary import overall


def judged(name: str, margin: Enclosure, needs: Needs = (), *, about: About = "run", **fields: Any) -> Claim:
    """Return a claim that holds if no entry of its margin is negative.

    Numbers of one run verify nothing about all cases, though they refute it, and decide nothing about a limit. A proof
    or disproof decides where all needs are met; numbers that say the opposite make the claim inconclusive, and say so.

    Parameters
    ----------
    margin : Enclosure
        At least 0 where the claim holds: a number, or one for each instant.
    needs : iterable of Hypothesis
        Hypotheses of the claim.
    about : {"run", "limit", "all"}
        What the claim speaks of.
    rigour : {"numeric", "interval"}
        How the margin is known.
    proof, disproof : str, optional
        Id of an executable proof of exactly this claim, or of its negation, under the needs.
    detail : str
        In words.
    **fields
        Further fields of the claim, such as `computed`, `stated` and `witness`.

    Examples
    --------
    >>> [judged("i", Enclosure.around(margin, 0.1)).status for margin in (0.5, 0.05, -0.5)]
    ['verified', 'inconclusive', 'refuted']
    >>> judged("i", Enclosure.around(0.05, 0.1), proof="cohesion").status
    'verified'
    """
    return conclude(name, _status_of(margin, about), margin.worst, needs, about=about, **fields)


def conclude(
    name: str,
    by_numbers: Status,
    margin: Enclosure,
    needs: Needs = (),
    *,
    about: About,
    rigour: Rigour = "numeric",
    proof: str | None = None,
    disproof: str | None = None,
    detail: str = "",
    **fields: Any,
) -> Claim:
    """Return a claim from its status by numbers or certificates, its hypotheses and its proof.

    Parameters
    ----------
    by_numbers : str
        Status by numbers or certificates alone.
    margin : Enclosure
        The margin that decided, a scalar.
    """
    needs = tuple(needs)
    status, how, contradicted = with_needs(by_numbers, needs, about), rigour, ""
    cited_names: tuple[str, ...] = ()
    proved: Status = "verified" if proof else "refuted"
    if (key := proof or disproof) and all(requirement.status == "met" for requirement in needs):
        if by_numbers in ("verified", "refuted") and by_numbers != proved:
            status, contradicted = "inconclusive", key
            detail = f"{detail}; the numbers contradict the proof {key!r}: the run or the library is at fault"
        else:
            status, how, cited_names = proved, RIGOUR[key], CITES.get(key, ())
    margin_ends = (float(end) for end in (margin.mid, margin.lo, margin.hi))
    best = next((end for end in margin_ends if np.isfinite(end)), 0.0)  # finite, so that a search can compare margins
    return Claim(
        name,
        status,
        how,
        margin=best,
        error=float(best - margin.lo if best >= 0.0 else margin.hi - best),
        proof=proof,
        disproof=disproof,
        detail=detail.lstrip("; "),
        needs=needs,
        about=about,
        contradicts=contradicted,
        cites=cited_names,
        **fields,
    )


def _status_of(margin: Enclosure, about: About) -> Status:
    """Return a status by the sign of a margin alone."""
    if about == "limit":
        return "inconclusive"
    if (margin.hi < 0.0).any():
        return "refuted"
    return "verified" if about == "run" and (margin.lo >= 0.0).all() else "inconclusive"


def with_needs(status: Status, needs: tuple[Hypothesis, ...], about: About) -> Status:
    """Return a status under hypotheses: vacuous if one is unmet; assumed ones allow facts about the run only.

    Parameters
    ----------
    status : str
        Status by numbers or certificates alone.
    """
    statuses = {requirement.status for requirement in needs}
    if "unmet" in statuses:
        return "vacuous"
    return status if "assumed" not in statuses or (status == "verified" and about == "run") else "inconclusive"


def counted(name: str, most: int, certain: int, possible: int, needs: Needs = (), **fields: Any) -> Claim:
    """Return a claim that at most `most` events happen, from counts of certain and possible ones.

    Parameters
    ----------
    most : int
        How many there may be.
    certain, possible : int
        How many there are at least, and at most.

    Examples
    --------
    >>> [counted("links", 3, *range_).status for range_ in ((2, 3), (2, 4), (4, 5))]
    ['verified', 'inconclusive', 'refuted']
    """
    margin = most + 0.5 - Enclosure(certain, certain if certain > most else possible, possible)
    return judged(name, margin, needs, **fields)


def spectral(name: str, margin: float, error: float, needs: Needs = (), **fields: Any) -> Claim:
    """Return a claim about eigenvalues, roots or integrals with a margin error from the residual.

    So are claims about stored numbers, such as a configuration (`of_state`), and about the orbit of a map in floating
    point (`of_map`), whose margins have rounding errors alone.

    Parameters
    ----------
    margin, error : float
        The margin and how far it may be off: by a residual, Weyl's bound, the quadrature's estimate or rounding.

    Examples
    --------
    >>> spectral("stable", 0.5, 1e-12).status, of_state("apart", -1.0, 1e-12).status
    ('verified', 'refuted')
    >>> of_map("reunite", float("nan"), 0.0).status
    'inconclusive'
    """
    return judged(name, Enclosure.around(margin, error), needs, **fields)


of_state = of_map = spectral


def by_count(name: str, failures: int, needs: Needs = (), **fields: Any) -> Claim:
    """Return a claim by the number of failing instants or cases, where rounding cannot change a sign.

    Parameters
    ----------
    failures : int
        How many there are.

    Examples
    --------
    >>> by_count("falls", 0).status, by_count("falls", 2).status
    ('verified', 'refuted')
    """
    return judged(name, Enclosure.of(float(-failures or 1)), needs, **fields)


def exact(name: str, holds: bool, **fields: Any) -> Claim:
    """Return a claim decided by algebra, without numerical error.

    Examples
    --------
    >>> exact("printed", 1 + 1 == 3, detail="1 + 1 = 3").status
    'refuted'
    """
    return Claim(name, "verified" if holds else "refuted", "symbolic", about="all", **fields)


def equal(name: str, residual: Any, **fields: Any) -> Claim:
    """Return an identity claim that holds if the symbolic residual is 0.

    Parameters
    ----------
    residual : expression or sequence of expressions
        The difference of the two sides, which becomes the witness.

    Examples
    --------
    >>> equal("corrected", 0).computed, equal("printed", [0, 1]).status
    ('residual 0', 'refuted')
    """
    has_several = isinstance(residual, list | tuple)
    is_equal = all(row == 0 for row in residual) if has_several else bool(residual == 0)
    computed_text = "residual 0" if is_equal else "a residual that is not 0"
    witness = [str(row) for row in residual] if has_several else str(residual)
    return exact(name, is_equal, computed=computed_text, witness=witness, **fields)


def vacuous(name: str, reason: str | Hypothesis, **fields: Any) -> Claim:
    """Return a vacuous claim, for a reason or under an unmet hypothesis.

    Parameters
    ----------
    reason : str or Hypothesis
        Why, in words, or the hypothesis.

    Examples
    --------
    >>> vacuous("iv", Hypothesis("c1α > 0", "unmet", 0.0, "c1α = 0")).detail
    'c1α > 0 does not hold: c1α = 0'
    """
    if isinstance(reason, Hypothesis):
        reason_text = f"{does_not_hold(reason.name)}: {reason.detail}".removesuffix(": ")
        return Claim(name, "vacuous", detail=reason_text, needs=(reason,), **fields)
    return Claim(name, "vacuous", detail=reason, **fields)


def undecided(name: str, detail: str, needs: Needs = (), **fields: Any) -> Claim:
    """Return an undecided claim; vacuous if a hypothesis is unmet.

    Examples
    --------
    >>> undecided("rate", "the velocities match from the start").status
    'inconclusive'
    """
    status = with_needs("inconclusive", needs := tuple(needs), "run")
    return Claim(name, status, detail=detail, needs=needs, **fields)


_EXPECTED: Mapping[Status, str] = {"refuted": "printed", "verified": "corrected"}


def statement_of(check: Callable[..., Any]) -> str:
    """Return the statement of a theorem: the docstring of the function that checks it, as one paragraph."""
    return " ".join((check.__doc__ or "").split())


def _from_table(name: str, claims: Iterable[str], fields: Mapping[str, Any]) -> dict[str, Any]:
    """Return a theorem's data from its row of ``errata.csv``, if any, and the names of corrections."""
    row, right = erratum_of(name), {"corrected"}
    fields_known: dict[str, Any] = {}
    if row is not None:
        fields_known = {"title": printed(name), "source": f"{row.printer}, {row.where}", "references": row.references}
        fields_known["source"] += ", corrected" if fields.get("author") == "corrected" else ""
        right |= {row.right_claim[0]} if row.sort != "confirmed" else set()
    return fields_known | {"corrected": tuple(sorted({*claims} & right - {*fields.get("ours", ())}))}


def run_theorem(name: str, **fields: Any) -> Callable[[Check], Theorem]:
    """Return a decorator that turns a checking function into a theorem about runs.

    Parameters
    ----------
    name : str
        Id of the theorem; its statement is the function's docstring.
    **fields
        Further fields of `Theorem`; of an erratum as in `erratum`.

    Examples
    --------
    >>> @run_theorem("still", title="Nothing moves", source="a toy")
    ... def theorem(seen, tolerances):
    ...     "All agents stay where they are."
    ...     return [], []
    >>> theorem.statement
    'All agents stay where they are.'
    """
    table_fields = _from_table(name, fields.get("claims", ()), fields)
    return lambda check: Theorem(
        id=name, kind="trajectory", check=check, **{"statement": statement_of(check), **table_fields, **fields}
    )


def erratum(
    name: str, *, expected: Mapping[Status, str] = _EXPECTED, **fields: Any
) -> Callable[[Callable[[Tolerances], list[Claim]]], Theorem]:
    """Return a decorator that turns a function into an erratum, checked without a user's run.

    The function returns the claims, from the tolerances; its docstring is the statement.

    Parameters
    ----------
    expected : mapping of str to str
        By expected status the names of claims, with blanks between; by default of "printed" and "corrected". The
        status of the whole follows from them.
    **fields
        Further fields of `Theorem`. Title, source and references are by default those of ``errata.csv``; `corrected` is
        a claim of that name, and the claim that the table has as the right statement of what is not confirmed, unless
        it is in `ours`.

    Examples
    --------
    >>> @erratum("two", title="1 + 1 is 2", source="arithmetic", expected={"verified": "sum"})
    ... def two(tolerances):
    ...     "1 + 1 = 2."
    ...     return [exact("sum", 1 + 1 == 2)]
    >>> dict(two.expected), two.examine(Tolerances())[1][0].status
    ({'two': 'verified', 'two:sum': 'verified'}, 'verified')
    """
    each = {claim: status for status, claims in expected.items() for claim in claims.split()}
    table_fields = _from_table(name, each, fields)

    def made(check: Callable[[Tolerances], list[Claim]]) -> Theorem:
        judge: dict[str, Any] = {"kind": "fixed", "check": lambda tolerances: ([], check(tolerances))}
        item = Theorem(id=name, **{"statement": statement_of(check), **table_fields, **judge, **fields})
        by_author = overall(status for claim, status in each.items() if item.by(claim) == item.author)
        return replace(item, expected={name: by_author} | {f"{name}:{claim}": status for claim, status in each.items()})

    return made
