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
# The floor is a theorem of its own. A pair that lowers $V$ below $\psi_\alpha(r_\alpha)$ is between 6.568 and 8.4
# long, a ratio below $\sqrt2$; among four points of the plane some two distances have a ratio of at least $\sqrt2$;
# so no four agents are pairwise such, and Turán bounds the number of such pairs (erratum E4).
#
# A certificate that does not go vacuous replaces $c^*$ by the barrier $\min\{V : \text{two agents coincide}\}$. `os-1`
# checks both:

# %%
hexagon = fl.scenario("hexagon").run()
print(fl.verify("os-1", hexagon))

# %% [markdown]
# ## A false statement that nearly always looks true
#
# "Almost every solution converges to an α-lattice." From 40 random starts you may well see 40 lattices. A strict local
# minimum of $V$ that is no lattice refutes it all the same, because it has an open basin. Five agents suffice:

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
# **2.** ★ (1 point, derivation) Erratum E9: a constant input $u = 2$ for one step $\Delta t = 0.1$ from rest. How far
# does the printed update move the agent, exactly?

# %% tags=["answer"]
moved = ...

# %% tags=["solution"]
u, dt = 2.0, 0.1
moved = (u * dt) * dt + 0.5 * u * dt**2

# %% tags=["check"]
grade(moved, 0.03, hint="the printed update uses the new velocity, and adds ½ u dt² to it")

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
# **5.** ★★★ (3 points, words) In your own words, at least 30 of them: a strict local minimum of $V$ that is no lattice
# refutes a claim about *almost every* solution of Algorithm 1 with a connected flock. Why is one such minimum enough?
# (A text; the check counts words, and your lecturer reads it.)

# %% tags=["answer"]
basin = ...

# %% tags=["solution"]
basin = """At a strict local minimum, up to motions of the whole, the energy is a Lyapunov function, and damping makes
it fall, so the minimum attracts an open neighbourhood of states. An open set has positive measure, so the
solutions that start in it are not almost none."""
# Rubric, a point each:
# the minimum is asymptotically stable, up to motions of the whole; so it attracts an open
# set; which has positive measure, so that not almost every solution does otherwise.

# %% tags=["check"]
grade(basin, lambda text: len(text.split()) >= 30, form="text", hint="a text of at least 30 words")

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
