"""Narrowest features of a law's parts, to be resolved by the steps of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

from flockana.interactions.distance_functions import LawFunction

if TYPE_CHECKING:
    from flockana.environment.gamma_agent_copies import Copies
    from flockana.environment.target import Target


class Feature(NamedTuple):
    """Narrowest rise or fall of one part of a law, over distance or in time."""

    name: str  # of the part, in words
    of: Literal["pairs", "agents", "time"]  # what must not leap over it within a step
    width: float | None  # in units of length or of time; None if unknown
    function: LawFunction | None = None  # of the distance of two agents, whose slopes may tell more


class Unknown(NamedTuple):
    """Feature of a law or term that does not declare its functions."""

    whose: str

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Entry for the functions of the distance that a law or term reads, but does not declare."""
        return (LawFunction(f"what {self.whose} reads", None),)

    def features(self) -> tuple[Feature, ...]:
        """Return a feature of unknown width, for a law or term that does not declare its functions."""
        return tuple(map(function_feature, self.functions))


def function_feature(function: LawFunction) -> Feature:
    """Return the narrowest feature of a function of the distance of two agents."""
    width = None if function.function is None else function.function.feature
    return Feature(function.name, "pairs", width, function)


def target_feature(target: Target | Copies) -> Feature:
    """Return the narrowest feature in time of the motion of a γ-agent, or of its copies."""
    return Feature("the γ-agent", "time", target.feature)
