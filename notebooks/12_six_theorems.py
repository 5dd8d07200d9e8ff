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
# # Six theorems on one flock
#
# **Aims.** Put the field's classics side by side: one start, many laws. What does each theorem promise from there,
# which hypothesis does the work, and what happens where it fails?
#
# Ten agents near a patch of a lattice, all at one speed, with headings about one direction:

# %%
import numpy as np

import flockana as fl
from flockana import plots
from flockana.course import grade
from flockana.scenarios.one_start import ENTRIES, compare, one_start

q, p = one_start()
ax = plots.configuration(q, p, r=8.4, title="the start of them all")
print(f"{len(q)} agents, position diameter {fl.diameter(q):.3g}, velocity diameter {fl.diameter(p):.3g}")

# %% [markdown]
# ## What is promised
#
# Two kinds of promise. Some say what an **energy** does: it falls, so that velocities agree, *if* something keeps the
# flock together. Others say what **averaging** does: a mean of neighbours never leaves their span, so that the spread
# of velocities shrinks, *if* the nets connect the agents often enough, or the weights fall slowly enough with distance.
# The theorems differ in these conditions.

# %%
for entry in ENTRIES:
    print(f"{entry.name} ({entry.theorem}):\n    {entry.promise}\n")

# %% [markdown]
# And in full, as the library checks them:

# %%
import textwrap

for entry in ENTRIES:
    print(f"{entry.theorem}. {fl.theorem(entry.theorem).title}")
    print(textwrap.indent(textwrap.fill(fl.theorem(entry.theorem).statement, 100), "    "), "\n")

# %% [markdown]
# ## What happened

# %%
outcomes = compare()
axes = plots.side_by_side(outcomes)

# %%
for outcome in outcomes:
    happened = f"velocity diameter x {outcome.velocity_share:.1e}, {outcome.groups} group(s)"
    print(f"{outcome.entry.name:>20}  {outcome.verdict.status:12} {happened}")
ax = plots.velocity_diameters(outcomes)

# %% [markdown]
# A **vacuous** verdict beside a flock that flocks is no contradiction: the theorem says nothing about this start. Which
# hypothesis failed stands in the verdict:

# %%
for outcome in outcomes:
    for hypothesis in outcome.verdict.hypotheses:
        if hypothesis.status != "met":
            print(f"{outcome.entry.name}: {hypothesis.name} is {hypothesis.status}\n    {hypothesis.detail}\n")

# %% [markdown]
# ## A hypothesis about the whole run: joint connectivity
#
# Jadbabaie, Lin and Morse let each agent take the mean heading of itself and its neighbours, $\theta_i(t + 1) =
# \frac{1}{1 + |N_i(t)|}\bigl(\theta_i(t) + \sum_{j \in N_i(t)} \theta_j(t)\bigr)$.
#
# > **Theorem** (Jadbabaie, Lin and Morse 2003). If there is an infinite sequence of contiguous, non-empty, bounded
# > intervals of time, starting at $t = 0$, across each of which the agents are linked together, that is the union of
# > the nets of the interval is connected, then all headings tend to a common one.
#
# No single net need be connected: it is enough that the links seen over a window of time connect all, window after
# window, for ever. Over a run we can see windows; "for ever" needs an argument. Two groups that meet:

# %%
meet = fl.scenario("headings-meet").run()
figure, axes = plots.subplots(1, 2, size=(9.0, 3.4))
plots.joint_windows(meet.window(0.0, 60.0), ax=axes[0])
plots.diameters(meet, ax=axes[1])
print(fl.verify("jlm-headings", meet))

# %% [markdown]
# The argument: once headings nearly agree, all that distances can still change adds up to less than what each of them
# is away from $r$. So no link is ever made or lost again, and a net that stays connected averages its headings to one.
#
# Where the groups part, the same verdict shows that they never meet again:

# %%
print(fl.verify("jlm-headings", fl.scenario("headings-part").run()))

# %% [markdown]
# ## A hypothesis about time: delay
#
# > **Theorem** (Olfati-Saber and Murray 2004). On a fixed, undirected, connected net all solutions of $\dot x(t) =
# > -Lx(t-\tau)$ tend to the mean of their starts if and only if $0 \le \tau < \pi/(2\lambda_n)$.
#
# A disturbance along an eigenvector of $\lambda_k$ grows like $e^{st}$ with $s = -\lambda_k e^{-s\tau}$. The root that
# decides is $s = W_0(-\lambda_n\tau)/\tau$ with Lambert's function, $W_0(z)\,e^{W_0(z)} = z$. A further link never
# lowers $\lambda_n$, so a better connected net never bears *more* delay:

# %%
from flockana.stability import consensus_root, consensus_system, delay_margin

for name, pairs in {"path": [(0, 1), (1, 2), (2, 3)], "complete": [(i, j) for j in range(4) for i in range(j)]}.items():
    net = fl.laplacian(4, np.array(pairs)).toarray()
    margin, largest = delay_margin(consensus_system(net)), np.linalg.eigvalsh(net)[-1]
    print(f"{name:>9}: τ* = {margin.delay:.6f}, largest λ = {largest:.4g}")

# %% [markdown]
# Four agents on a path, each of which hears late. Move the delay, as a share of the margin:

# %%
from flockana.course.frames import slider

path = fl.laplacian(4, np.array([(0, 1), (1, 2), (2, 3)])).toarray()
bears = delay_margin(consensus_system(path)).delay
step = bears / 200.0


def late(ax, share):
    wait = round(share * bears / step)
    x = [np.array([2.0, -1.0, 0.5, -1.5])] * (wait + 1)  # at rest until now
    for _ in range(4000):
        x.append(x[-1] - step * path @ x[-1 - wait])
    ax.plot(step * np.arange(len(x) - wait), x[wait:])
    ax.set(xlim=(0.0, 20.0 * bears), ylim=(-4.0, 4.0), xlabel="t (time)", ylabel="$x_i$")


shares = (0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0, 1.05, 1.1)
slider(late, shares, name="τ/τ*", title="consensus of four agents that hear late", start=3)

# %% [markdown]
# ## Summary
#
# - Theorems on flocking either let an energy fall or average; both need a hypothesis that keeps the agents in touch.
# - Joint connectivity is a hypothesis on a whole run; delay bounds depend on the largest eigenvalue of the Laplacian.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, derivation) Two neighbours head 10° to the left and 10° to the right of due east. Under the mean of
# headings in $[0, 2\pi)$, which way do they head after one step, in degrees, exactly?

# %% tags=["answer"]
degrees = ...

# %% tags=["solution"]
degrees = (10.0 + 350.0) / 2.0

# %% tags=["check"]
grade(degrees, 180.0, hint="10° to the right of east is 350°; `fl.verify('jlm-cut')` has more of it")

# %% [markdown] tags=["exercise"]
# **2.** ★ (1 point, derivation) What delay does consensus on a star of 6 agents bear? (Its largest eigenvalue is its
# number of agents; four significant digits.)

# %% tags=["answer"]
delay = ...

# %% tags=["solution"]
delay = np.pi / (2.0 * 6.0)

# %% tags=["check"]
grade(delay, 0.26179939, digits=4, hint="the margin is stated above for any net")

# %% [markdown] tags=["exercise"]
# **3.** ★ (1 point, experiment) Nets of four agents: link 0-1, then 1-2, then nothing, then 2-3, then 0-1, 1-2 and 2-3
# at once. Into how many contiguous, jointly connected windows do the five instants divide, at most? (A whole number.)

# %% tags=["answer"]
count = ...

# %% tags=["solution"]
nets = [[(0, 1)], [(1, 2)], [], [(2, 3)], [(0, 1), (1, 2), (2, 3)]]
count = len(fl.joint_windows(4, [np.array(net, dtype=int).reshape(-1, 2) for net in nets]))

# %% tags=["check"]
grade(count, 2, hint="a window ends as soon as its links connect all four")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, derivation) At 1.5 times the delay margin of two agents that are linked ($\lambda_2 = 2$): at
# what rate does their difference grow, per time unit? (Four significant digits.)

# %% tags=["answer"]
rate = ...

# %% tags=["solution"]
rate = consensus_root(2.0, 1.5 * np.pi / 4.0).real

# %% tags=["check"]
grade(rate, 0.247105912, digits=4, hint="the deciding root is Lambert's; a rate is its real part")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, design) Design: six agents on a ring with weights $w$ on all links have $\lambda_n = 4w$ and
# $\lambda_2 = w$. Their messages take 0.5 time units. Which $w$ must not be reached? (Four significant digits.)

# %% tags=["answer"]
weight = ...

# %% tags=["solution"]
weight = np.pi / (2.0 * 4.0 * 0.5)

# %% tags=["check"]
grade(weight, 0.78539816, digits=4, hint="the delay margin, solved for the weight")

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) Take two of the six theorems, one on energy and one on averaging. Which hypothesis keeps
# the agents of each in touch, who sees to it, the law or an assumption, and what does a start look like that breaks it?
# In your own words, at least 30 of them. (The check counts words, and your lecturer reads the text.)

# %% tags=["answer"]
touch = ...

# %% tags=["solution"]
touch = """For Algorithm 2 the pull of the target keeps the flock in a ball, so cohesion comes from the law, for every
start. For averaging of headings the nets must connect the agents jointly, again and again, which is assumed
about the whole run: two groups that head away from each other break it, and then their headings need not
agree."""
# Rubric, a point each:
# for each theorem the hypothesis and who sees to it; a start that breaks one of them.

# %% tags=["check"]
grade(touch, lambda text: len(text.split()) >= 30, form="text", hint="a text of at least 30 words")
