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
# ## A true statement that says nothing
#
# Theorem 1(iii) of Olfati-Saber (2006): if $H(x(0), v(0)) < c^* = \psi_\alpha(0)$, no two agents ever collide. (The
# gains are 1 in this lecture.) True: the energy does not rise, and a coincident pair alone costs $c^*$. But **every
# pair out of range costs $\psi_\alpha(r_\alpha)$ too**, and there are about $n^2/2$ of those.

# %%
import numpy as np

import flockana as fl
from flockana import lattice, plots
from flockana.course import grade
from flockana.equilibria.barrier import energy_floor, lattice_reach, least_infeasible_size

alpha = fl.AlphaInteraction()
sizes = np.arange(2, 31)
best = [alpha.potential_energy(lattice.hexagonal_spiral(n, alpha.d)) for n in sizes.tolist()]
floor = [energy_floor(alpha, n) for n in sizes.tolist()]
figure, ax = plots.subplots(size=(6, 3.4))
ax.plot(sizes, best, "o-", label="V of the best α-lattice")
ax.plot(sizes, floor, "s--", label="proved floor of V, any state")
ax.axhline(alpha.c_star, color="black", linestyle=":", label="c*")
ax.set(xlabel="n, agents", ylabel="energy", ylim=(0, 150))
ax.legend()
largest, empty = lattice_reach(alpha), least_infeasible_size(alpha)
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
# 4. Turán: a graph of $n$ nodes without such a subgraph has at most $\lfloor n^2/3\rfloor$ edges.
# 5. The other $\tfrac12n(n-1) - \lfloor n^2/3\rfloor$ pairs cost at least $\psi_\alpha(r_\alpha)$ each, and cheap ones
#    cost at least 0.
# 6. At $n = 23$ the bracket is $253 - 176 = 77$, and $77\,\psi_\alpha(r_\alpha) = 56.7 > 52.4 = c^*$; at $n = 22$ it is
#    70, that is 51.5. From 23 on the bracket grows with $n$. $\square$
#
# A certificate that does not go vacuous replaces $c^*$ by the barrier $\min\{V : \text{two agents coincide}\}$. `os-1`
# checks both:

# %%
hexagon = fl.scenario("hexagon").run()
print(fl.verify("os-1", hexagon))

# %% [markdown]
# ## A false statement that nearly always looks true
#
# "Almost every solution converges to an α-lattice." However many runs end in a lattice, they do not prove it, and one
# *strict local minimum* of $V$ that is no lattice refutes it, because it attracts an open set of starts. Five agents
# suffice: two of them share the place of one, and the four places form a rhombus that is almost a lattice.

# %%
print(fl.verify("E3").claim("double-agent").detail)

# %% [markdown]
# ## A statement that counts the wrong thing
#
# Theorem 3(iv): if $H_\lambda(0) < (k+1)c^*$, at most $k$ distinct pairs could collide. Energy bounds what happens
# *at one instant*. Three agents on a line, an energy of $1.9\,c^*$, hence $k = 1$:

# %%
line = fl.scenario("three-agents-1d").run()
verdict = fl.verify("os-3", line)
for name in ("iv-printed", "iv-instant"):
    print(f"{name:>10}: {verdict.claim(name).status:9} {verdict.claim(name).detail}")

early = line.window(0.0, 0.04)
figure, ax = plots.subplots(size=(6, 3))
ax.plot(early.t, early.q[:, :, 0])
_ = ax.set(xlabel="t (time)", ylabel="x (length)")

# %% [markdown]
# **Figure 7.2.** Three agents on a line. The fast one passes the second and then the third: two collisions of
# distinct pairs, one after the other.
#
# Two crossings within 0.03 time units can hide between samples. The library therefore looks along the interpolated
# paths, and bounds what it cannot see.
#
# ## All errata at once
#
# What is printed, and what is right. `E1` to `E16` are of lecture slides and student projects on the paper; of none is
# it shown that the paper has it. An erratum is *wrong*, *incomplete* (true with a hypothesis that is missing),
# *vacuous* (true of next to nothing) or, after all, *confirmed*.

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
# Errata are no disgrace. Every source of this course is worth reading *because* its statements are sharp enough to
# be wrong.
#
# ## Summary
#
# - A true theorem may have a hypothesis that no state satisfies.
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
# **5.** ★★★ (3 points, words) In your own words: a strict local minimum of $V$ that is no lattice refutes a claim
# about *almost every* solution of Algorithm 1 with a connected flock. Why is one such minimum enough?

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# At a strict local minimum, up to motions of the whole, the energy is a Lyapunov function, and damping makes it fall,
# so the minimum attracts an open neighbourhood of states. An open set has positive measure, so the solutions that
# start in it are not almost none.
#
# **Rubric, a point each:** the minimum is asymptotically stable, up to motions of the whole; so it attracts an open
# set; which has positive measure, so that not almost every solution does otherwise.

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
# **7.** ★ (1 point, player) Show `early.player()`. How many times does one agent pass another? (A whole number.)

# %% tags=["answer"]
passes = ...

# %% tags=["solution"]
early.player()
order = np.argsort(early.q[:, :, 0], axis=1)
passes = int(np.any(np.diff(order, axis=0) != 0, axis=1).sum())

# %% tags=["check"]
grade(passes, 2, hint="one agent is fast: whom does it overtake?")

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
