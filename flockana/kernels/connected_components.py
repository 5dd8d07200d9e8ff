"""Connected components of a graph by union-find.

Links may come in any order and in parts, so no more of them than one part need be in memory.
"""

from math import sqrt

import numpy as np

from flockana.jit import kernel, subroutine
from flockana.kernels.agent_sums import square_between


@subroutine
def root_of(parent, i):
    """Return the root of agent i's component, and shorten the path to the root."""
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


@subroutine
def merge(parent, i, j):
    """Merge the components of two agents."""
    a, b = root_of(parent, i), root_of(parent, j)
    if a < b:
        parent[b] = a
    else:
        parent[a] = b


@kernel
def unite(parent, first, second):
    """Merge the components of both ends of every link; `parent` starts as 0 … n − 1."""
    for k in range(first.size):
        merge(parent, first[k], second[k])


@kernel
def labelled(parent):
    """Label of each agent's component, counted from 0 in the order of their first agents."""
    labels, count = np.empty(parent.size, np.int32), 0
    for i in range(parent.size):
        if parent[i] == i:
            labels[i] = count
            count += 1
        else:  # what it knows is of a smaller number, and has its label
            labels[i] = labels[parent[i]]
    return labels


@kernel
def squared_excess(q, first, second, d):
    """Σ (‖q_j − q_i‖ − d)² over links."""
    total = 0.0
    for k in range(first.size):
        squared_value = square_between(q, first[k], second[k])
        total += (sqrt(squared_value) - d) ** 2
    return total
