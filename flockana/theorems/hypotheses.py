"""Hypotheses that several theorems share: which law it is, which gains it has, what lies below what."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from flockana.dynamics.trajectory import Trajectory
from flockana.interactions import AlphaInteraction, BetaInteraction, Gains
from flockana.theorems.theorem import Claim, Hypothesis, Status

_PARTS = {"alpha": AlphaInteraction, "beta": BetaInteraction, "gains": Gains}


def applied(run: Trajectory, name: str, *laws: type) -> Hypothesis:
    """That a run is one of these laws, and of nothing that only descends from it and may push otherwise.

    Parameters
    ----------
    run : Trajectory
        The run.
    name : str
        The laws, as the hypothesis names them.
    *laws : type
        Classes of laws.
    """
    law = run.law
    other = [
        f"{part} is {type(getattr(law, part)).__name__}" for part, known in _PARTS.items() if _else(law, part, known)
    ]
    exact = type(law) in laws and not other
    detail = ", ".join([type(law).__name__, *(other if type(law) in laws else [])])
    return Hypothesis(f"{name} is applied", "met" if exact else "unmet", detail=detail)


def _else(law: Any, part: str, known: type) -> bool:
    return hasattr(law, part) and type(getattr(law, part)) is not known


def positive(run: Trajectory, **gains: str) -> Hypothesis:
    """That gains are positive, which take part in what a theorem says.

    Parameters
    ----------
    run : Trajectory
        A run of a law with gains.
    **gains : str
        How each is written, by its name in `Gains`; one for all agents.
    """
    values = {text: float(getattr(run.law.gains, name)) for name, text in gains.items()}
    least = min(values.values())
    return Hypothesis(
        " and ".join(f"{text} > 0" for text in values),
        "met" if least > 0.0 else "unmet",
        least,
        ", ".join(f"{text} = {value:g}" for text, value in values.items()),
    )


def one_gain(run: Trajectory) -> Hypothesis:
    """That c1γ and c2γ are common to all agents: else the shape does not separate from the centre of mass.

    Parameters
    ----------
    run : Trajectory
        A run of a law with gains.
    """
    several = run.law.gains.per_agent
    detail = "gains are given per agent" if several else ""
    return Hypothesis("one c1γ and one c2γ for all agents", "unmet" if several else "met", detail=detail)


def with_alpha_gain(run: Trajectory, name: str, *laws: type) -> list[Hypothesis]:
    """One of these laws, c1α > 0, and common gains where it has a γ-agent; what comes first is missed first.

    Parameters
    ----------
    run : Trajectory
        The run.
    name : str
        The laws, as the hypothesis names them.
    *laws : type
        Classes of laws with an α-interaction.
    """
    law = applied(run, name, *laws)
    if law.status == "unmet":
        return [law]
    single = [one_gain(run)] if run.law.target is not None else []
    return [law, *single, positive(run, c1_alpha="c1α")]


def vacuous(needs: Iterable[Hypothesis], names: Iterable[str]) -> list[Claim]:
    """Vacuous claims if a hypothesis is unmet, with the reason; none otherwise.

    Parameters
    ----------
    needs : iterable of Hypothesis
        Hypotheses without which nothing is worth computing.
    names : iterable of str
        Names of the claims.

    Examples
    --------
    >>> vacuous([Hypothesis("c1α > 0", "met", 1.0)], ["i"])
    []
    """
    unmet = next((need for need in needs if need.status == "unmet"), None)
    return [] if unmet is None else [Claim(name, "vacuous", detail=f"{unmet.name}: {unmet.detail}") for name in names]


def below(name: str, value: float, bound: float, error: float, detail: str) -> Hypothesis:
    """That a number lies below a bound: assumed where rounding would decide it.

    Parameters
    ----------
    name : str
        The condition.
    value, bound : float
        The two.
    error : float
        Of their difference.
    detail : str
        In words.

    Examples
    --------
    >>> [below("x < 1", x, 1.0, 1e-9, "").status for x in (0.5, 1.0, 1.5)]
    ['met', 'assumed', 'unmet']
    """
    margin = bound - value
    if abs(margin) <= error:
        return Hypothesis(name, "assumed", margin, f"{detail}; equal but for rounding")
    return Hypothesis(name, "met" if margin > 0.0 else "unmet", margin, detail)


def conceded(status: Status, needs: Iterable[Hypothesis]) -> Status:
    """The status of a claim whose hypotheses may be no more than assumed: what fails then may be they.

    Parameters
    ----------
    status : str
        As judged.
    needs : iterable of Hypothesis
        Hypotheses of the claim.

    Examples
    --------
    >>> conceded("refuted", [Hypothesis("every solution stays together", "assumed")])
    'inconclusive'
    """
    return "inconclusive" if status == "refuted" and any(need.status == "assumed" for need in needs) else status
