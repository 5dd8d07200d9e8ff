# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # What the theorems really say: vacuous bounds and errata
#
# **Aims.** Read a theorem as a contract: which hypothesis does the work, when can it be met at all, and how would you
# notice that a printed claim is false?
#
# ## A scene
#
# A safety engineer reads a paper on drone shows: "no two agents ever collide, if the initial energy is below $c^*$".
# She computes the energy of her show, finds it a hundred times above, and asks the authors whether collisions are to
# be feared. They answer that in simulations there were none. **What does the theorem say about her show?** Nothing.
# Could it ever say something about a show of her size? That is a question one can decide with pencil and paper, and
# papers seldom do. This lecture reads printed theorems as contracts: who has to deliver what, and can anyone?
#
# ## Two agents
#
# For two agents the theorem is fine. At rest at the distance $d$ they have $H = 0$, and any speeds with
# $\tfrac12(\|p_1\|^2+\|p_2\|^2) < c^* = 52.4$ are below the bound. Then they never meet: to meet, one has to climb
# the whole wall. Add a third agent out of range of both. It feels nothing and does nothing, and yet $H$ has grown by
# $2\psi_\alpha(r_\alpha) = 1.47$, because $V$ counts pairs out of range. Add ten more bystanders, and the bound is
# broken by agents that do not even move. That is the mechanism; how fast does it bite?
#
# ## How to read a theorem: who delivers what?
#
# A theorem is a contract. Its hypotheses are what *you* deliver, its conclusion is what you get, and its proof is the
# only place that shows which hypothesis pays for which conclusion. Take the contract of the scene.
#
# > **Theorem 1(iii)** (Olfati-Saber 2006, as lecture slides on it print it). Let agents obey Algorithm 1 with gains 1,
# > and let $H(0) < c^* = \psi_\alpha(0)$. Then no two agents ever collide.
#
# *Proof.*
#
# 1. $\dot H = -p^\top\hat L(q)p \le 0$ (lecture 02), so $H(t) \le H(0) < c^*$ at all times.
# 2. The kinetic energy is not negative, so $V(q(t)) \le H(t) < c^*$.
# 3. If agents $i$ and $j$ coincided at the time $t$, the pair alone would cost $\psi_\alpha(0) = c^*$, and all other
#    pairs cost at least 0. So $V(q(t)) \ge c^*$, against 2. $\square$
#
# The proof is correct, and three lines long. Read it again with a pencil, and ask of each line what it *wastes*. Line 2
# throws the kinetic energy away: harmless, it ends small. Line 3 throws all other pairs away: "at least 0". But **every
# pair out of range costs $\psi_\alpha(r_\alpha)$**, and of $n$ agents on a lattice all pairs are out of range, about
# $n^2/2$, but for its links, fewer than $3n$. So line 3 gives away an amount that grows like $n^2$, while $c^*$ stays
# what it is. The waste of a proof shows up as a hypothesis that is hard to deliver.
#
# ## A true statement that says nothing

# %%
import numpy as np

import flockana as fl
from flockana import lattice, plots
from flockana.course import Prediction, grade
from flockana.equilibria.energy_barrier import energy_floor, lattice_reach, least_infeasible_size

alpha = fl.AlphaInteraction()
sizes = np.arange(2, 31)
best = [alpha.potential_energy(lattice.hexagonal_spiral(n, alpha.d)) for n in sizes.tolist()]
floor = [energy_floor(alpha, n) for n in sizes.tolist()]
rim = float(alpha.psi_alpha(alpha.r_alpha))
largest, empty = lattice_reach(alpha), least_infeasible_size(alpha)

# %% tags=["predict"]
guess = ...
Prediction(
    "The hypothesis asks for V below c*. From how many agents on does no state at all deliver that?", guess, empty
)

# %%
figure, ax = plots.subplots(size=(6, 3.4))
ax.plot(sizes, best, "o-", label="V of the best α-lattice")
ax.plot(sizes, floor, "s--", label="proved floor of V, any state")
ax.axhline(alpha.c_star, color="black", linestyle=":", label="c*")
ax.set(xlabel="n, agents", ylabel="energy", ylim=(0, 150))
ax.legend()
print(f"lattices stay below c* up to n = {largest}, and from n = {empty} on no state does")

# %% [markdown]
# **Figure 7.1.** What the best lattice of $n$ agents costs (circles), and what every state costs at least, by the
# theorem below (squares). Where the circles pass $c^*$, no lattice meets the hypothesis; where the squares do, no
# state.
#
# The floor is a theorem of its own (erratum E4).
#
# > **Theorem.** For $m = 2$ and these parameters every state has
# >
# > $$V \ge \Bigl[\tfrac12 n(n-1) - \lfloor n^2/3\rfloor\Bigr]\,\psi_\alpha(r_\alpha),$$
# >
# > which is above $c^*$ for every $n \ge 23$.
#
# *Proof.* Call a pair *cheap* if it costs less than $\psi_\alpha(r_\alpha)$.
#
# 1. A cheap pair is between 6.568 and 8.4 long, because $\psi_\alpha$ falls up to $d$ and rises from there to $r$. The
#    ratio of these two lengths is $1.279 < \sqrt2$.
# 2. Among four points of the plane the largest distance is at least $\sqrt2$ times the least. (Three of them form an
#    angle of at least 90°; the side opposite to it is at least $\sqrt2$ times the shorter of the other two.)
# 3. By 1 and 2 no four agents are pairwise cheap: the graph of cheap pairs has no complete subgraph of four.
# 4. Turán: a graph of $n$ nodes without such a subgraph has at most $\lfloor n^2/3\rfloor$ edges. (Induction from $n-3$
#    to $n$: take three nodes that are pairwise joined; if there are none, there are even fewer edges. Each of the other
#    $n - 3$ is joined to at most two of the three. Count: $3 + 2(n-3) + \tfrac13(n-3)^2 = \tfrac13n^2$.)
# 5. The other $\tfrac12n(n-1) - \lfloor n^2/3\rfloor$ pairs cost at least $\psi_\alpha(r_\alpha)$ each, and cheap ones
#    cost at least 0.
# 6. At $n = 23$ the bracket is $253 - 176 = 77$, and $77\,\psi_\alpha(r_\alpha) = 56.7 > 52.4 = c^*$; at $n = 22$ it is
#    70, that is 51.5. From 23 on the bracket grows with $n$. $\square$
#
# At $n = 14$ the best lattice costs 45.6, which is below $c^*$, at $n = 15$ it costs 54.5. So from 15 agents on *no
# lattice, even at rest* meets the hypothesis, and a lattice is where the theorem's flock is meant to end.
#
# <details><summary>By counting</summary>
#
# Take $n = 7$. At most $\lfloor 49/3\rfloor = 16$ of the 21 pairs are cheap, so 5 pairs
# cost 0.736 each, and every state costs at least 3.68. (The best hexagon has 12 links, not 16, so 9 pairs are
# expensive and it costs 6.62: Turán's graph cannot be drawn in the plane with all its edges equally long. The floor
# is true and not sharp.) At $n = 14$ the best lattice has 29 links of 91 pairs and costs $62\cdot0.736 = 45.6$; at
# $n = 15$ it has 31 of 105.
#
# </details>
#
# **How to mend it.** Keep what line 3 threw away. Replace $c^*$ by the *barrier*, the least energy of a state in which
# two agents coincide, all other pairs counted: $\min\{V : \text{two agents coincide}\}$. Exercise 8 asks for the
# proof, which is as short as the one above. What changes is what the hypothesis costs:

# %%
from flockana.equilibria.energy_barrier import collision_barrier

counted = (2, 3, 5, 7, 8)
barriers = {n: collision_barrier(alpha, n, starts=3) for n in counted}
for n, found in barriers.items():
    print(f"n = {n}: rest {found.lowest:5.2f}, c* {alpha.c_star:.2f}, barrier {found.together:.2f}", end="")
    print(f"; allowed above rest: {alpha.c_star - found.lowest:.2f} by c*, {found.height:.2f} by the barrier")

# %% [markdown]
# The last column hardly falls: for these $n$, up to 8, the start may have some fifty units of energy above rest. With
# $c^*$ the allowance shrinks with every agent, and ends below 0. The minimum is searched from a few starts, so it is an
# upper bound of the barrier; a certificate needs the true one. `os-1` checks both forms on a run:

# %%
hexagon = fl.scenario("hexagon").run()
print(fl.verify("os-1", hexagon))

# %% tags=["facts"]
assert f"{2.0 * rim:.2f} {alpha.c_star:.1f}" == "1.47 52.4"
assert (13 * 12 // 2 - 1) * rim > alpha.c_star  # two at d, and eleven bystanders
pairs = {n: n * (n - 1) // 2 for n in (7, 14, 15, 22, 23)}
assert abs((pairs[7] - 16) * rim - 3.68) < 0.005
assert abs((pairs[7] - 12) * rim - best[5]) < 1e-9
assert abs(best[5] - 6.62) < 0.005
assert (lattice.harborth(14), lattice.harborth(15), largest) == (29, 31, 14)
assert abs(best[12] - 45.6) < 0.05
assert abs(best[13] - 54.5) < 0.05
assert empty == 23
assert all(found.height > 48.0 for found in barriers.values())

# %% [markdown]
# ## A false statement that nearly always looks true
#
# "Almost every solution converges to an α-lattice." However many runs end in a lattice, they do not prove it. What
# would refute it? One solution that does not would not: "almost every" allows exceptions, as long as their starts have
# measure zero (a saddle's stable set, say). But a *strict local minimum* of $V$ that is no lattice attracts a whole
# open set of starts, and an open set is not of measure zero. So we look for a minimum, not for a run.
#
# Put two agents into **one place**. Their vector $n_{ij}$ is zero, so they exert no force on each other, and if all
# places form a lattice, nobody feels anything: an equilibrium. Is it a minimum? Separate the two by a small distance
# $y$, half of it each. They repel, and win $2.49\,y^2$; their links stretch or shrink, and cost
# $1.86\,y^2\sum_k\cos^2x_k$ if the move makes the angle $x_k$ with link $k$.
#
# <details><summary>Both numbers</summary>
#
# 1. *They repel.* At small distances the force is $|\phi_\alpha(0)|\,y$ with $\phi_\alpha(0) = -4.99$, so they win
#    the energy $\tfrac12\cdot4.99\,y^2 = 2.49\,y^2$.
# 2. *Their links stretch or shrink.* A link is a spring of the stiffness 7.44 along its line (in lecture 06 we found
#    $\phi_\alpha'(d_\alpha)\,d^2/(1+\varepsilon d^2) = 0.896\cdot8.31$), and of none across it, because it is at its
#    rest length. So both agents pay
#    $2\cdot\tfrac12\cdot7.44\sum_k\bigl(\tfrac12y\cos x_k\bigr)^2 = 1.86\,y^2\sum_k\cos^2 x_k$.
#
# For two directions at 60° the sum of squares is $1 + \tfrac12\cos2x$, for $x$ counted from their middle. For three
# at 60° it is 1.5 in all directions, because the doubled angles are spread evenly.
#
# </details>
#
# So a place that holds two agents is stable exactly if $1.86\sum_k\cos^2 x_k > 2.49$ in every direction, that is
# if the sum is above 1.34. Now count.
#
# | place | links | least $\sum_k\cos^2 x_k$ | stable? |
# |---|---|---|---|
# | corner of a triangle | 2, at 60° | $1 - \tfrac12 = 0.5$ | no |
# | sharp corner of a rhombus | 2, at 60° | 0.5 | no |
# | blunt corner of a rhombus | 3, at 60° to the next | 1.5 | **yes** |
#
# A rhombus has four places, one of
# them doubled makes five agents: **five agents suffice**, and four, a triangle with a doubled corner, do not. The
# margin is small, $1.5$ against $1.34$, and nobody sees it in a run that happens to avoid it.

# %%
places = 7.0 * np.array([[0.0, 0.0], [1.0, 0.0], [0.5, np.sqrt(0.75)], [0.5, -np.sqrt(0.75)]])
doubled = {"blunt": [0, 0, 1, 2, 3], "sharp": [2, 0, 1, 2, 3]}
figure, axes = plots.subplots(1, 2, size=(11, 3.4))
plots.configuration(places, d=7.0, r=8.4, ax=axes[0], bar=False, title="circle: two agents share this place")
axes[0].plot(*places[0], "o", color="black", markersize=16, markerfacecolor="none")
apart, wells = np.linspace(-0.9, 0.9, 121), {}
for name, order in doubled.items():
    q = places[order]
    twin = next(k for k in range(1, 5) if order[k] == order[0])
    for angle, axis in ((0.0, "x"), (90.0, "y")):
        move = 0.5 * np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
        energy = []
        for y in apart:
            shifted = q.copy()
            shifted[0] += y * move
            shifted[twin] -= y * move
            energy.append(alpha.potential_energy(shifted) - alpha.potential_energy(q))
        wells[name, axis] = energy
        if (name, axis) != ("sharp", "y"):  # there it is as stiff as the blunt one
            axes[1].plot(apart, energy, label=f"{name} corner, along {axis}")
axes[1].set(xlabel="y, distance of the two (length)", ylabel="V above the doubled state", ylim=(-0.25, 0.18))
_ = axes[1].legend(loc="upper center")

# %% [markdown]
# **Figure 7.2.** Left: the places of a rhombus of side 7. Right: the energy when the two agents of a doubled corner
# separate, along the line of the two blunt corners ($x$) or at right angles to it ($y$). The blunt corner is a minimum
# in both directions, and a shallow one: 0.03 deep, lost when the two are half a length apart. The sharp corner is a
# maximum along $x$.
#
# The picture shows two directions of ten. The library computes all curvatures, and says the same:

# %%
print(fl.verify("E3").claim("double-agent").detail)

# %% tags=["facts"]
assert 0.02 < max(wells["blunt", "x"]) < 0.035
slope = float(alpha.phi_alpha(alpha.d_alpha + 1e-5) - alpha.phi_alpha(alpha.d_alpha - 1e-5)) / 2e-5
spring = slope * 49.0 / (1.0 + 0.1 * 49.0)
repel = -float(alpha.phi_alpha(0.0))
assert abs(spring - 7.44) < 0.005
assert abs(repel - 4.99) < 0.005
assert abs(2.0 * repel / spring - 1.34) < 0.005
for order, share in ((doubled["blunt"], 1.5), (doubled["sharp"], 0.5)):
    q, twin = places[order], next(k for k in range(1, 5) if order[k] == order[0])
    weak = np.array([1.0, 0.0]) if share < 1.0 else np.array([0.6, 0.8])
    shifted = q.copy()
    shifted[0] += 5e-4 * weak
    shifted[twin] -= 5e-4 * weak
    by_hand = (spring * share / 4.0 - repel / 2.0) * 1e-6
    assert abs((alpha.potential_energy(shifted) - alpha.potential_energy(q)) / by_hand - 1.0) < 1e-2

# %% [markdown]
# > **Theorem (a minimum refutes "almost every").** Let $q^*$ be a critical point of $V$ with a connected net, at which
# > $V$ has a positive curvature in every direction that is no motion of the whole. Then the starts from which
# > Algorithm 1 tends to copies of $q^*$ contain an open set.
#
# *Proof.*
#
# 1. Work in the frame of the centre of mass, and with shapes instead of positions: all states that differ by a motion
#    of the whole count as one. In this space $q^*$ is a strict minimum of $V$, and near it $\nabla V = 0$ at $q^*$
#    only, because all curvatures are positive. (A strict minimum without that might have other critical points at any
#    distance from it.)
# 2. So on a small sphere about $(q^*, 0)$ the energy $V + K$ is at least $V(q^*) + e$ for some $e > 0$ (a continuous
#    function has a least value on a compact set, and at $v = 0$ and $q = q^*$ only it is $V(q^*)$).
# 3. All states inside this sphere with $V + K < V(q^*) + e$ form an open set. The energy does not rise, so solutions
#    never cross the sphere.
# 4. By LaSalle they tend to states with $v^\top\hat L v = 0$ for ever. The net is connected near $q^*$, so $v = 0$, so
#    $\nabla V = 0$; inside a small enough sphere that holds at $q^*$ only, by 1. $\square$
#
# ## A statement that counts the wrong thing
#
# Theorem 3(iv): if $H_\lambda(0) < (k+1)c^*$, at most $k$ distinct pairs could collide. The proof reads: if $k + 1$
# pairs coincide, they cost $(k+1)c^*$ together. *At one instant*, yes. The word is missing in the statement. How would
# one exploit that? A fast agent passes another and *gets its energy back*: the wall is a potential, so what it takes
# going up it returns going down. The same energy can climb a second wall later. Three agents on a line, an energy of
# $1.9\,c^*$, hence $k = 1$:

# %%
line = fl.scenario("three-agents-1d").run()
verdict = fl.verify("os-3", line)
for name in ("iv-printed", "iv-instant"):
    print(f"{name:>10}: {verdict.claim(name).status:9} {verdict.claim(name).detail}")

early = line.window(0.0, 0.04)
figure, ax = plots.subplots(size=(6, 3))
ax.plot(early.t, early.q[:, :, 0], label=["the fast agent", "second", "third"])
ax.legend()
_ = ax.set(xlabel="t (time)", ylabel="x (length)")

# %% [markdown]
# **Figure 7.3.** Three agents on a line. The fast one passes the second and then the third: two collisions of
# distinct pairs, one after the other.
#
# Two crossings within 0.03 time units can hide between samples. The library therefore looks along the interpolated
# paths, and bounds what it cannot see.
#
# ## Four errata by hand
#
# Most errata need no computer. Do these four yourself before you read on; each takes a line.
#
# **E1: a factor that is not cosmetic.** A slide has $V + \sum\|p_i\|^2$ for the energy, without the ½. With
# $\dot q = p$ and $\dot p = -\nabla V - c_2^\alpha\hat L p$,
#
# $$\begin{aligned}
# \tfrac{d}{dt}\Bigl(V + \sum\|p_i\|^2\Bigr) &= \nabla V^\top p + 2p^\top\bigl(-\nabla V - c_2^\alpha\hat L
#   p\bigr) && \text{chain rule} \\
# &= -\nabla V^\top p - 2c_2^\alpha\,p^\top\hat Lp . && \text{no cancellation}
# \end{aligned}$$
#
# The first term has no sign. Whenever agents run downhill fast enough, the printed function rises. With ½ the two
# terms with $\nabla V$ cancel, and that cancellation *is* the theorem.
#
# **E6: the smallest case.** A lattice of the plane has at most $3n - 6$ links. For $n = 2$ that is 0, and two agents
# have one link. The bound needs $n \ge 3$, because the proof counts faces with three edges or more.
#
# **E7: shares of what?** Components of 1, 1, 1, 1 and 96 agents: the largest holds 0.96 of the *agents*. A slide prints
# this as the share of *links*. Isolated agents have no links, so the share of links is 1.
#
# **E8: rank of which matrix?** For a path of three agents
#
# $$A = \begin{pmatrix} 0&1&0\\1&0&1\\0&1&0 \end{pmatrix}, \qquad L = \begin{pmatrix}
#   1&-1&0\\-1&2&-1\\0&-1&1 \end{pmatrix}.$$
#
# The first and third rows of $A$ are equal, so its rank is 2, and $\operatorname{rank}(A)/n = \tfrac23$ would call the
# path unconnected. The rank of $L$ is 2, and $\operatorname{rank}(L)/(n-1) = 1$.
#
# Each of the four is found by the same move: *put in the smallest case that is allowed.*

# %% tags=["facts"]
path = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
assert np.linalg.matrix_rank(path) == 2
assert np.linalg.matrix_rank(np.diag(path.sum(axis=0)) - path) == 2
assert fl.verify("os-3", line).claim("iv-printed").status == "refuted"
assert fl.verify("os-3", line).claim("iv-instant").status == "verified"

# %% [markdown]
# ## All errata at once
#
# What is printed, and what is right. `E1` to `E16` are in lecture slides and student projects on the paper; none is
# shown to be in the paper itself. An erratum is *wrong*, *incomplete* (true with a hypothesis that is missing),
# *vacuous* (true, but of hardly any flock) or, after all, *confirmed*.

# %%
for sort in ("wrong", "incomplete", "vacuous", "confirmed"):
    print(f"\n{sort}")
    print(*(item for item in fl.errata() if item.sort == sort and item.id.startswith("E")), sep="\n")

# %% [markdown]
# ## What surprised, and how to read the next theorem
#
# Nothing in this lecture needed a new technique; it needed the question "can the hypothesis be met?", asked with
# numbers. A list for the next paper that you read:
#
# 1. Copy the theorem with all hypotheses, those in the text before it included.
# 2. Meet the hypotheses once, with numbers, for the smallest case. Then for the size that matters.
# 3. Which hypothesis does the work? Drop it and look for a counterexample.
# 4. Which words hide a quantifier: *almost every*, *at most $k$ pairs*, *for all later times*?
# 5. What would a simulation look like that refutes the claim? Look for that one, instead of for one that confirms it
#    (lecture 10).
#
# Three kinds of failure, then. A hypothesis that cannot be delivered makes a theorem *vacuous*: it stays true and
# becomes useless, and simulations will not show it, because they look fine. A conclusion that holds for typical
# starts and fails on an open set makes it *false*, and random simulations will hardly show that either. A missing
# word makes it *ambiguous*; readers fill the gap with what they need. In all three cases the proof showed where to
# look, and no run did.
#
# This lecture does **not** say that agents of a flock of 23 collide: nothing is not "no". Nor how often a flock
# ends in a lattice: a share has to be counted, over starts of a stated kind (lecture 10). Errata are no disgrace: every
# source of this course is worth reading *because* its statements are sharp enough to be wrong.
#
# ## Questions that come up
#
# *Why count pairs that are out of range at all? They do not act on each other.* Because a potential is defined up to a
# constant only within a path: to come into range again a pair must fall into the well, and the depth of the well is
# $\psi_\alpha(r_\alpha)$. If pairs out of range cost nothing, those at the distance $d$ would have to cost less than
# nothing, and "all terms are non-negative", which each proof uses, would be false.
#
# *Is a vacuous theorem a wrong theorem?* No. "Every even prime above 2 is green" is true. It cannot be used.
#
# *Could 23 agents be safe although the theorem is silent?* Yes; nearly all flocks of this course are. Silence is the
# point: one has to find out by other means.
#
# ## Summary
#
# - A true theorem may have a hypothesis that no state satisfies. What its proof throws away is what its hypothesis
#   costs.
# - The barrier, which counts all pairs, mends the bound.
# - A strict local minimum that is no lattice refutes convergence of almost every solution, because its basin is open.
# - Energy bounds what happens at one instant, not what happens one after another.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★★ (2 points, experiment) With $a = b = 1$ instead of 5 (all else equal), from which $n$ on does no state have
# $V < c^*$? (A whole number.)

# %% tags=["answer"]
n_none = ...

# %% tags=["solution"]
n_none = least_infeasible_size(fl.AlphaInteraction(a=1.0, b=1.0))

# %% tags=["check"]
grade(n_none, 23, hint="how do V and c* change when a = b does?")

# %% [markdown] tags=["exercise"]
# **2.** ★ (1 point, derivation) Erratum E9: a constant input $u = 2$ acts for one step $\Delta t = 0.1$ from rest. (a)
# How far does the printed update move the agent? (b) How far does it really move? Give the list of both, exactly.

# %% tags=["answer"]
moved = ...

# %% tags=["solution"]
u, dt = 2.0, 0.1
moved = [(u * dt) * dt + 0.5 * u * dt**2, 0.5 * u * dt**2]

# %% tags=["check"]
grade(moved, [0.03, 0.01], hint="the printed update uses the new velocity, and adds ½ u dt² to it")

# %% [markdown] tags=["exercise"]
# **3.** ★ (1 point, reading) A run of `paper-flocking` keeps all agents apart. What is the status of claim `iv-none` of
# `os-3` on it (one word), and why?

# %% tags=["answer"]
status = ...

# %% tags=["solution"]
status = fl.verify("os-3", fl.scenario("paper-flocking").run()).claim("iv-none").status

# %% tags=["check"]
grade(status, "vacuous", hint="is H_λ(0) < c*?")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, derivation) Agents that are all out of each other's range have $V = \tfrac12
# n(n-1)\psi_\alpha(r_\alpha)$. From which $n$ on is that at least $c^*$? (A whole number.)

# %% tags=["answer"]
scattered = ...

# %% tags=["solution"]
scattered = next(n for n in range(2, 99) if n * (n - 1) / 2 * alpha.psi_alpha(alpha.r_alpha) >= alpha.c_star)

# %% tags=["check"]
grade(scattered, 13, hint="how many pairs out of range cost as much as c*?")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, words) A reader objects to the double agent: "Two robots are never in one place, so this minimum
# is an artefact, and the claim on almost every solution is right in practice." Answer in your own words. (a) Must a
# start hold two coincident agents in order to end in this minimum? (b) What does Figure 7.2 say about how near it must
# be? (c) Change one hypothesis of the claim so that the double agent no longer refutes it, and say what that costs.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# (a) No. The minimum attracts an open set of states, by the theorem of the lecture: all states near it with little
# kinetic energy, in nearly all of which no two agents coincide. Only the limit does. (b) The well is 0.03 deep and
# about half a length wide: a start with two agents closer than that, everybody near its place, and little motion. So it
# is rare among random starts, and not of measure zero. (c) For instance: ask for $H(0)$ below the barrier. Then no two
# agents ever coincide, so this minimum cannot be reached; the cost is that all fast or strained starts are excluded. Or
# let $\phi_\alpha(0)$ be stronger against the links' stiffness: then the doubled corner is no minimum, and other
# strained minima have to be excluded in their turn.
#
# **Rubric, a point each:** an open set of starts, without coincidence; the size of the well read off the figure; a
# changed hypothesis with its price.

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, counterexample) Is a state with $V \ge c^*$ bound to hold two agents that are nearly in one
# place? Give positions in the plane, an array of shape (n, 2), $n \le 40$, of agents that are all at least 7 apart and
# have $V \ge c^*$, for `alpha`.

# %% tags=["answer"]
costly = ...

# %% tags=["solution"]
costly = np.array([[9.0 * (k % 4), 9.0 * (k // 4)] for k in range(13)])  # all out of range: 78 pairs cost more than c*

# %% tags=["check"]
grade(
    costly,
    lambda q: (
        2 <= len(q) <= 40
        and np.shape(q)[1] == 2
        and fl.min_distance(np.array(q, float)) >= 7.0 - 1e-9
        and fl.AlphaInteraction().potential_energy(np.array(q, float)) >= fl.AlphaInteraction().c_star
    ),
    form="list",
    hint="what does a pair out of range cost?",
)


# %% [markdown] tags=["exercise"]
# **7.** ★ (1 point, player) Show `early.player()`. At which times does one agent pass another? Give the list, each
# to within 0.003.

# %% tags=["answer"]
passing = ...

# %% tags=["solution"]
early.player()
order = np.argsort(early.q[:, :, 0], axis=1)
passing = early.t[1:][np.any(np.diff(order, axis=0) != 0, axis=1)]

# %% tags=["check"]
grade(passing, [0.0095, 0.0284], within=0.003, hint="one agent is fast: whom does it overtake?")

# %% [markdown] tags=["exercise"]
# **8.** ★★ (2 points, proof) Prove the certificate that does not go vacuous: if $H(0)$ is below the barrier
# $\min\{V : \text{two agents coincide}\}$, with $V$ in place of $c_1^\alpha V$ as the gains are 1, then no two
# agents ever coincide under Algorithm 1. Why is this bound never worse than $c^*$?

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# $H$ does not rise (lecture 02) and $V \le H$, because the kinetic energy is non-negative. If two agents coincided
# at some time, $V$ at that time would be at least the barrier, and so would $H \le H(0)$: a contradiction. Every
# state with two coincident agents has $V \ge \psi_\alpha(0) = c^*$, because that pair costs $c^*$ and the others at
# least 0; so the minimum over such states is at least $c^*$, and the new condition admits every start that the old
# one admits.
#
# **Rubric, a point each:** the contradiction from $V \le H \le H(0)$; the barrier is at least $c^*$, with its
# reason.
