"""Forces and potential of a pair law in M dimensions: a template (`flockana.kernels.bound_templates`).

Candidates are gathered into blocks, those within range kept without a branch; the pair law runs over a block in a loop
that the compiler turns into vector instructions, if the law has no branches of its own; and what it gives is added to
both agents. The compiler may not fuse products and sums, though it would save a fourteenth: every processor gives the
same bits.
"""

from zlib import crc32

import numpy as np

from flockana.jit import inlined, kernel, parallel, prange, register_jitable, subroutine
from flockana.kernels.alpha import norm_alpha as norm  # bound
from flockana.kernels.alpha import pair_alpha_potential as potential  # bound
from flockana.kernels.alpha import stress_alpha as pair  # bound
from flockana.kernels.cell_grid import cut_into_slabs, empty_cuts, later_in_row, sort_into_grid
from flockana.kernels.pair_helpers import BLOCK
from flockana.kernels.pair_helpers import apart_2 as apart  # bound
from flockana.kernels.pair_helpers import as_they_are as as_tuple  # bound

M = 2  # bound
NORMED = True  # bound

# numba names loops of several threads by an address and the types of what they take: one type that is a law's own
# keeps two laws apart that two processes compiled.
OWN = np.zeros(0, f"S{crc32(__name__.encode()) % 2**24 + 1}")


@inlined
def _law(count, s2, w, a, par, c1):
    """Write weight w and adjacency a of a block of pairs from their squared distances.

    Roots and divisions wait for each other, and a processor looks only some hundred instructions ahead: where a law
    begins with a norm, two short loops keep its dividing unit busier than one long one.
    """
    if NORMED:
        for k in range(count):
            w[k], a[k] = norm(s2[k], par)
        for k in range(count):
            stress, adjacency = pair(w[k], a[k], par)
            w[k], a[k] = c1 * stress, adjacency
    else:
        for k in range(count):
            stress, adjacency = pair(s2[k], par)
            w[k], a[k] = c1 * stress, adjacency


@register_jitable
def _add(count, pairs, room, x, v, u, par, gains):
    """Add the forces of a block of pairs to u; return Σ a ‖p_j − p_i‖².

    `room` are the squared distances and two rows for w and a; `gains` are (c1, c2).
    """
    (first_agents, second_agents), (s2, w, a), (c1, c2) = pairs, room, gains
    if not (x.shape[1] == M and v.shape[1] == M and u.shape[1] == M):
        return np.nan  # never: the compiler now knows that rows are M numbers apart
    _law(count, s2, w, a, par, c1)
    total = 0.0
    for k in range(count):
        i, j, weight, drag = first_agents[k], second_agents[k], w[k], c2 * a[k]
        gap, velocity_difference, v2 = apart(x, i, j), apart(v, i, j), 0.0
        for c in range(M):
            v2 += velocity_difference[c] * velocity_difference[c]
        total += a[k] * v2
        for c in range(M):
            u[i, c] += weight * gap[c] + drag * velocity_difference[c]
        for c in range(M):
            u[j, c] -= weight * gap[c] + drag * velocity_difference[c]
    return total


@register_jitable
def _gather(x, limit, listed, begin, end, pairs, s2):
    """Copy the pairs within range from a section of a pair list; return their number."""
    (first_agents, second_agents), near_pairs = listed, pairs
    count = 0
    if x.shape[1] != M:
        return count  # never, as above
    for k in range(begin, end):
        i, j = np.uint64(first_agents[k]), np.uint64(second_agents[k])
        squared_value = 0.0
        for c in range(M):
            gap = x[j, c] - x[i, c]
            squared_value += gap * gap
        s2[count], near_pairs[0][count], near_pairs[1][count] = squared_value, i, j
        count += squared_value < limit
    return count


@register_jitable
def _act_in_slab(own, s, x, v, u, numbers, listed, work):
    """Add the forces of a slab's pairs to u; write the sum Σ a ‖p_j − p_i‖² into the slab's work space."""
    total, r, par, (slab_cuts, near, workspace) = 0.0, numbers[2], as_tuple(numbers[4:]), work
    pairs, block = (near[2 * s], near[2 * s + 1]), (workspace[3 * s], workspace[3 * s + 1], workspace[3 * s + 2])
    for begin in range(slab_cuts[s], slab_cuts[s + 1], BLOCK):
        end = min(begin + BLOCK, slab_cuts[s + 1])
        count = _gather(x, max(r * r, 5e-324), listed, begin, end, pairs, block[0])
        total += _add(count, pairs, block, x, v, u, par, (numbers[0], numbers[1]))
    block[0][0] = total


@subroutine
def act(t, x, v, u, numbers, panels, listed):
    """Add the forces of the listed pairs to u and return their power: even slabs at once, then odd ones."""
    first, second, cuts, near, room = listed.first, listed.second, listed.cuts, listed.near, listed.room
    slabs, total, marker = cuts.size - 1, 0.0, OWN[:0]
    for parity in range(2):
        for half in prange((slabs + 1 - parity) // 2):
            _act_in_slab(marker, 2 * np.int64(half) + parity, x, v, u, numbers, (first, second), (cuts, near, room))
    for s in range(slabs):
        total += room[3 * s, 0]
    return -numbers[1] * total


@register_jitable
def _energy_in_slab(own, s, x, numbers, panels, listed, cuts, near, room):
    """Write Σ ψ over the pairs of a slab that are within range, and their number, into work space."""
    total, r, par, pairs, block = 0.0, numbers[2], numbers[4:], 0, (near[2 * s], near[2 * s + 1])
    for begin in range(cuts[s], cuts[s + 1], BLOCK):
        count = _gather(x, max(r * r, 5e-324), listed, begin, min(begin + BLOCK, cuts[s + 1]), block, room[3 * s])
        pairs += count
        for k in range(count):
            total += potential(room[3 * s, k], par, panels)
    room[3 * s, 0], room[3 * s, 1] = total, pairs


@subroutine
def energy(t, x, v, numbers, panels, listed):
    """Return the energy c1 Σ ψ of all pairs, with the constant potential of those beyond the range."""
    first, second_agents, cuts, near_pairs, room = listed.first, listed.second, listed.cuts, listed.near, listed.room
    slabs, total, pairs, n, marker = cuts.size - 1, 0.0, np.int64(0), x.shape[0], OWN[:0]
    for s in prange(slabs):
        _energy_in_slab(marker, np.int64(s), x, numbers, panels, (first, second_agents), cuts, near_pairs, room)
    for s in range(slabs):
        total, pairs = total + room[3 * s, 0], pairs + np.int64(room[3 * s, 1])
    beyond = n * (n - 1) // 2 - pairs
    return numbers[0] * (total + beyond * numbers[3] if beyond > 0 else total)  # it may be infinite there


parallel_act, parallel_energy = parallel(act), parallel(energy)


@register_jitable
def _linked(x, ends, begin, end, near, s2):
    """Write pairs i, j and squared distances of links `begin` to `end`, given as agent numbers in one row."""
    for k in range(begin, end):
        i, j, squared_value = np.uint64(ends[2 * k]), np.uint64(ends[2 * k + 1]), 0.0
        for c in range(M):
            squared_value += (x[j, c] - x[i, c]) ** 2
        s2[k - begin], near[0, k - begin], near[1, k - begin] = squared_value, i, j
    return end - begin


@subroutine
def act_links(t, x, v, u, numbers, panels, listed):
    """Add the forces of links to u and return their power; `numbers` are c1, c2, link count, links, and par."""
    total, links, near_pairs = 0.0, np.int64(numbers[2]), listed.near
    par, pairs = as_tuple(numbers[3 + 2 * links :]), (near_pairs[0], near_pairs[1])
    workspace = (listed.room[0], listed.room[1], listed.room[2])
    for begin in range(0, links, BLOCK):
        count = _linked(x, numbers[3:], begin, min(begin + BLOCK, links), near_pairs, workspace[0])
        total += _add(count, pairs, workspace, x, v, u, par, (numbers[0], numbers[1]))
    return -numbers[1] * total


@subroutine
def energy_links(t, x, v, numbers, panels, listed):
    """Return the energy c1 Σ ψ over links."""
    total, links = 0.0, np.int64(numbers[2])
    for begin in range(0, links, BLOCK):
        count = _linked(x, numbers[3:], begin, min(begin + BLOCK, links), listed.near, listed.room[0])
        for k in range(count):
            total += potential(listed.room[0, k], numbers[3 + 2 * links :], panels)
    return numbers[0] * total


@inlined
def _sweep(cells, start, rows, flock, r2, par, gains, pairs, room):
    """Add the forces between agents in some grid cells and later agents to a sorted flock (q, p, u)."""
    (x, v, net_forces), (first_agents, second_agents), s2 = flock, pairs, room[0]
    count, total = np.int64(0), 0.0  # typed: of a literal, `_add` would be compiled once more
    if x.shape[1] != M:
        return np.nan  # as above
    for cell in range(cells[0], cells[1]):
        for i in range(start[cell], start[cell + 1]):
            for row in range(-1, np.int64(rows.size)):
                begin, end = later_in_row(start, rows, cell, i, row)
                for j in range(begin, end):
                    squared_value = 0.0
                    for c in range(M):
                        gap = x[j, c] - x[i, c]
                        squared_value += gap * gap
                    s2[count], first_agents[count], second_agents[count] = squared_value, i, j
                    count += squared_value < r2
                    if count == BLOCK:
                        total += _add(count, pairs, room, x, v, net_forces, par, gains)
                        count = np.int64(0)
    return total + _add(count, pairs, room, x, v, net_forces, par, gains)


@kernel
def forces(q, p, r, numbers, c1, c2, u, room):
    """Add c1 w (q_j − q_i) + c2 a (p_j − p_i) to u_i and its opposite to u_j, over all pairs within r.

    Return Σ a ‖p_j − p_i‖². `room`, (3, n, M), is for the flock sorted by cell. It is numpy's, which asks for large
    pages where numba does not: small ones take a third of the time of a million agents.
    """
    order, start, rows = sort_into_grid(q, r)
    x, v, net_forces = room[0], room[1], room[2]
    for k in range(order.size):
        for c in range(M):
            x[k, c], v[k, c], net_forces[k, c] = q[order[k], c], p[order[k], c], 0.0
    pairs, cells = (np.empty(BLOCK, np.uint64), np.empty(BLOCK, np.uint64)), (0, start.size - 2)
    block, par = (np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)), as_tuple(numbers)
    total = _sweep(cells, start, rows, (x, v, net_forces), max(r * r, 5e-324), par, (c1, c2), pairs, block)
    for k in range(order.size):
        for c in range(M):
            u[order[k], c] += net_forces[k, c]
    return total


@register_jitable
def _sweep_slab(own, low, high, start, rows, flock, r2, numbers, gains):
    """Sum pair forces (`_sweep`) over the cells of a slab."""
    pairs, par = (np.empty(BLOCK, np.uint64), np.empty(BLOCK, np.uint64)), as_tuple(numbers)
    workspace = np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)
    return _sweep((low, high), start, rows, flock, r2, par, gains, pairs, workspace)


@kernel
def forces_in_slabs(q, p, r, numbers, c1, c2, u, room):
    """Add all pair forces of a large flock, as `forces` does: even slabs at once, then odd slabs."""
    order, start, rows = sort_into_grid(q, r)
    x, v, net_forces, slab_cuts, marker, total = room[0], room[1], room[2], empty_cuts(q.shape[0]), OWN[:0], 0.0
    slabs, r2 = cut_into_slabs(start, rows, slab_cuts), max(r * r, 5e-324)
    totals = np.empty(slabs)
    for k in prange(order.size):
        for c in range(M):
            x[k, c], v[k, c], net_forces[k, c] = q[order[k], c], p[order[k], c], 0.0
    for parity in range(2):
        for slab_pair in prange((slabs + 1 - parity) // 2):
            s = 2 * np.int64(slab_pair) + parity
            low, high = slab_cuts[s + 1], slab_cuts[s + 2]
            totals[s] = _sweep_slab(marker, low, high, start, rows, (x, v, net_forces), r2, numbers, (c1, c2))
    for k in prange(order.size):
        for c in range(M):
            u[order[k], c] += net_forces[k, c]
    for k in range(slabs):
        total += totals[k]
    return total


parallel_forces_in_slabs = parallel(forces_in_slabs)


@kernel
def forces_of(q, p, first, second, numbers, c1, c2, u):
    """Add the forces over given pairs within range; return the dissipation sum, as `forces` does."""
    total, par = 0.0, as_tuple(numbers)
    workspace, pairs = (
        (np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)),
        (np.empty(BLOCK, np.uint64), np.empty(BLOCK, np.uint64)),
    )
    for begin in range(0, first.size, BLOCK):
        count = min(BLOCK, first.size - begin)
        for k in range(count):
            i, j, s2 = np.uint64(first[begin + k]), np.uint64(second[begin + k]), 0.0
            for c in range(M):
                s2 += (q[j, c] - q[i, c]) ** 2
            workspace[0][k], pairs[0][k], pairs[1][k] = s2, i, j
        total += _add(count, pairs, workspace, q, p, u, par, (c1, c2))
    return total
