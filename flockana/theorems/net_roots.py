"""Roots of nets: agents heard by all others, directly or through others."""

from typing import Any

import numpy as np

from flockana.theorems.hypotheses import condition
from flockana.theorems.theorem import Hypothesis

_SHOWN = 4  # agents of a group


def closed_groups(weights: Any) -> list[list[int]]:
    """Return the groups of agents that hear nobody outside (weights_ij > 0: i hears j); a root is a group of one."""
    # There is a root exactly if there is one group; a net is strongly connected exactly if that is all agents.
    import networkx

    hearing_graph = networkx.from_numpy_array(np.asarray(weights), create_using=networkx.DiGraph)
    return sorted(sorted(group) for group in networkx.attracting_components(hearing_graph))


def describe_groups(groups: list[list[int]]) -> str:
    """Return in words the root of a net, or the groups that hear nobody outside."""
    if len(groups) == 1:
        return f"root {groups[0][0]}"
    texts = (", ".join(map(str, group[:_SHOWN])) + (" ..." if len(group) > _SHOWN else "") for group in groups[:2])
    return f"{len(groups)} groups hear nobody outside: {' and '.join(texts)}"


def has_root(weights: Any) -> Hypothesis:
    """Return the hypothesis that one agent is heard by all."""
    groups = closed_groups(weights)
    name = "one agent is heard by all, directly or through others"
    remedy = "let all but one of these groups hear another"
    return condition(name, len(groups) == 1, detail=describe_groups(groups), remedy=remedy)
