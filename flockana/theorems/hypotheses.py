"""Hypotheses shared by several theorems: on laws, gains, pair laws and inequalities."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from flockana.base.function_facts import Fact, conjunction
from flockana.interactions import AlphaInteraction, BetaInteraction, FormulaInteraction, Gains
from flockana.interactions.distance_functions import DistanceFunction
from flockana.laws.composition import Composition
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.observed_run import Observed
from flockana.theorems.theorem import Decided, Hypothesis

if TYPE_CHECKING:
    from flockana.certified.tube import Tube

_MEMBERS = {"alpha": AlphaInteraction, "beta": BetaInteraction, "gains": Gains}


def condition(
    name: str,
    holds: bool,
    margin: float | None = None,
    detail: str = "",
    *,
    error: float | None = None,
    decided: Decided = "exact",
    remedy: str = "",
) -> Hypothesis:
    """Return a hypothesis with a given name that is met or unmet, never assumed.

    Parameters
    ----------
    margin : float, optional
        How far it is met (positive) or missed (negative).
    decided : {"exact", "proved", "enclosed"}
        By which means; exact means from parameters, a start, or a closed form.
    remedy : str
        What would meet it.

    Examples
    --------
    >>> condition("c1α > 0", False, 0.0).status
    'unmet'
    """
    return Hypothesis(name, "met" if holds else "unmet", margin, detail, error, decided, remedy=remedy)


def law_is(
    name: str, *laws: type, formulas: bool = False, composed: bool = False, one_gain: bool = False
) -> Callable[[Observed], Hypothesis]:
    """Return the hypothesis that a run's law is of given kinds; a theorem's `law`.

    Parameters
    ----------
    name : str
        The laws, as the hypothesis names them.
    *laws : type
        Classes of laws; what descends from one of them may push otherwise and is another law.
    formulas : bool
        Whether the pair law may be a user's, by its formula (`flockana.pair_law`).
    composed : bool
        Whether a composition of the laws' terms meets it too, or a pair law from a formula.
    one_gain : bool
        Whether all agents must have one c1γ and one c2γ.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> law_is("Algorithm 1", Algorithm1).__name__
    'applied_to'
    """

    def applied_to(run: Observed) -> Hypothesis:
        if composed and type(run.law) is Composition:
            terms = ", ".join(type(term).__name__ for term in run.law.terms)
            return condition("a composition of terms is applied", True, detail=terms)
        law, is_known = run.law, type(run.law) in laws
        accepted_kinds = (FormulaInteraction,) if formulas or composed else ()
        other = [
            f"{member} is {type(getattr(law, member)).__name__}"
            for member, kind in _MEMBERS.items()
            if hasattr(law, member) and type(getattr(law, member)) not in (kind, *accepted_kinds)
        ]
        detail = ", ".join([law.title, *(other if is_known else [])])
        if one_gain and is_known and not other and law.gains.per_agent:
            return common_gains(run)
        return condition(f"{name} is applied", is_known and not other, detail=detail)

    return applied_to


def hypothesis_from_fact(name: str, fact: Fact) -> Hypothesis:
    """Return a hypothesis about a function, with the status of a fact about it.

    Examples
    --------
    >>> hypothesis_from_fact("ψ is C¹", Fact("unmet", "the force jumps at s = 1")).status
    'unmet'
    """
    left = f" (open on a length of {fact.width:.2g})" if fact.status == "assumed" and fact.width > 0.0 else ""
    return Hypothesis(name, fact.status, detail=fact.detail + left, decided="proved")


def smooth_pair(run: Observed) -> Hypothesis:
    """Return the hypothesis that the pair law is C¹ off coincidence, and smooth at its range.

    A force without a limit where two agents meet is no fault here: runs that come to that point end.
    """
    law = run.law
    entry_of = {entry.function: entry for entry in law.functions if entry.stiffness != 0.0 or entry.function is None}
    facts = [_fact_of(function, "smooth", entry.name) for function, entry in entry_of.items()]
    if law.pair is not None and law.pair not in entry_of:
        facts.append(law.pair.facts.smooth)
    fact = facts[0] if len(facts) == 1 else conjunction(facts, "so is each function")
    return hypothesis_from_fact("the pair law is C¹ and vanishes at its range", fact)


def weight_nonnegative(run: Observed) -> Hypothesis:
    """Return the hypothesis that no adjacency is negative, so that consensus never drives velocities apart."""
    name = "a_ij >= 0 at every distance"
    entries = [entry for entry in run.law.functions if entry.damping != 0.0 or entry.function is None]
    if not entries:
        return Hypothesis(name, "met", detail="no velocities are averaged")
    facts = [_fact_of(entry.function, "weight", entry.name) for entry in entries]
    return hypothesis_from_fact(name, facts[0] if len(facts) == 1 else conjunction(facts, "so is each function"))


def _fact_of(function: DistanceFunction | None, name: str, whose: str) -> Fact:
    """Return a fact about a function of the law; assumed if the law does not declare one."""
    fact: Fact = Fact("assumed", f"{whose} is not known") if function is None else getattr(function.facts, name)
    return fact


def positive(run: Observed | Tube, **gains: str) -> Hypothesis:
    """Return the hypothesis that some gains of the law are positive.

    Parameters
    ----------
    **gains : str
        How each is written, by its name in `Gains`; common to all agents.
    """
    values = {text: float(getattr(run.law.gains, name)) for name, text in gains.items()}
    smallest = min(values.values())
    detail = ", ".join(f"{text} = {value:g}" for text, value in values.items())
    remedy = "raise " + " and ".join(text for text, value in values.items() if not value > 0.0)
    return condition(" and ".join(f"{text} > 0" for text in values), smallest > 0.0, smallest, detail, remedy=remedy)


def common_gains(run: Observed | Tube) -> Hypothesis:
    """Return the hypothesis that all agents have the same c1γ and c2γ, so that shape and centre decouple."""
    has_several = run.law.gains.per_agent
    detail = "gains are given per agent" if has_several else ""
    remedy = "give all agents one c1γ and one c2γ"
    return condition("one c1γ and one c2γ for all agents", not has_several, detail=detail, remedy=remedy)


def has_lattice(run: Observed) -> Hypothesis:
    """Return the hypothesis that the law has a lattice scale d and an interaction range r."""
    is_known = run.law.lattice is not None
    return condition("the law has a scale d and a range r", is_known, detail=run.law.title)


def alpha_gain(run: Observed) -> list[Hypothesis]:
    """Return the hypotheses c1α > 0, and common gains where the law has a γ-agent."""
    return [*([common_gains(run)] if run.law.target is not None else []), positive(run, c1_alpha="c1α")]


def positive_room(name: str, room: Enclosure, detail: str, *, remedy: str = "") -> Hypothesis:
    """Return the hypothesis that a number is positive, assumed if its enclosure contains 0.

    Parameters
    ----------
    room : Enclosure
        The number, such as a bound less what lies below it.

    Examples
    --------
    >>> [positive_room("x < 1", 1.0 - Enclosure.around(x, 1e-9), "").status for x in (0.5, 1.0, 1.5)]
    ['met', 'assumed', 'unmet']
    """
    margin, error = float(room.mid), float(room.half_width)
    if room.lo > 0.0 or room.hi <= 0.0:
        return condition(name, bool(room.lo > 0.0), margin, detail, error=error, decided="enclosed", remedy=remedy)
    return Hypothesis(name, "assumed", margin, f"{detail}; equal within the error", error, remedy=remedy)
