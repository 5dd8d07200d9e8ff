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
# # Assignment: two runs of a notebook
#
# **Aims.** Rebuild a published simulation from its formulas, find out which of its sentences its runs support, and mend
# the run that does not do what its law is for.
#
# A student notebook (`fl.cite(fl.scenario("notebook-algorithm1"))`) animates two runs. The first is Algorithm 1 with
# unit gains, $d = 1.9$, $r = 2.8$, $\varepsilon = 0.1$, $h = 0.4$, $a = 7$, $b = 9$, 27 agents in a box of 13 for 5
# time units. The second is Algorithm 2 with $d = 1.7$, $r = 2.5$, $\varepsilon = 0.01$, $h = 0.2$, $a = 7$, $b = 15$,
# $c_1^\gamma = 0$, $c_2^\gamma = 0.5$, 35 agents for 15 time units; its γ-agent stays at $(5, 5)$ and reports the
# velocity $(0.7, 0.1)$. The scenarios `notebook-algorithm1` and `notebook-algorithm2` hold them as continuous systems,
# `notebook-algorithm1-map` and `notebook-algorithm2-map` as the notebook steps them.
#
# | part | points |
# |---|---|
# | the law, from its formulas | 5 |
# | the first run | 4 |
# | the second run | 10 |
#
# ## How it is marked
#
# 19 points, those of the questions. Numbers are graded to the precision asked for. Sentences are read by a rubric with
# one part for each point: a part counts if it is there, is right, and is supported by a figure or a formula of yours.

# %%
import numpy as np

import flockana as fl
from flockana import plots
from flockana.course import grade, is_own

first, second = (fl.scenario(f"notebook-algorithm{k}").run() for k in (1, 2))
figure, axes = plots.subplots(1, 2, size=(11, 4.6))
for ax, run in zip(axes, (first, second), strict=True):
    plots.snapshot(run, ax=ax, bar=False)

# %% [markdown] tags=["exercise"]
# ## The law
#
# **1.** ★ (1 point, derivation) What is $c$ of the first run, from its $a$ and $b$? (Four significant digits.)

# %% tags=["answer"]
c = ...

# %% tags=["solution"]
c = abs(7.0 - 9.0) / np.sqrt(4.0 * 7.0 * 9.0)

# %% tags=["check"]
grade(c, 0.125988158, digits=4, hint="the condition is φ(0) = 0")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, program) Write a function `action(z)` that computes $\phi_\alpha(z)$ of the first run from its
# formulas (lecture 01), for $0 \le z \le 2 r_\alpha$, without the library.

# %% tags=["answer"]
action = ...


# %% tags=["solution"]
def by_formula(z):
    d_alpha, r_alpha = ((np.sqrt(1.0 + 0.1 * x**2) - 1.0) / 0.1 for x in (1.9, 2.8))
    x = z / r_alpha
    bump = 1.0 if x < 0.4 else 0.5 * (1.0 + np.cos(np.pi * (x - 0.4) / 0.6)) if x < 1.0 else 0.0
    s = z - d_alpha + abs(7.0 - 9.0) / np.sqrt(4.0 * 7.0 * 9.0)
    return bump * 0.5 * ((7.0 + 9.0) * s / np.sqrt(1.0 + s**2) + (7.0 - 9.0))


action = by_formula

# %% tags=["check"]
grade(
    action,
    lambda f: (
        is_own(f)
        and np.allclose(
            [float(f(z)) for z in (0.0, 0.5, 1.0, 1.66, 2.5, 3.3, 3.4, 6.0)],
            fl.AlphaInteraction(d=1.9, r=2.8, eps=0.1, h=0.4, a=7.0, b=9.0).phi_alpha(
                np.array([0.0, 0.5, 1.0, 1.66, 2.5, 3.3, 3.4, 6.0])
            ),
            atol=1e-9,
        )
    ),
    form="function",
    hint="three pieces of the bump; φ is taken at z − d_α; both scales are σ-norms",
)

# %% [markdown] tags=["exercise"]
# **3.** ★★ (2 points, derivation) Nearer than 0.05 the notebook multiplies $q_j - q_i$ by ten before it computes
# $n_{ij}$, and leaves $\phi_\alpha$ as it is. By which factor does the push of two agents grow that are 0.04 apart in
# the first run? (Four significant digits.)

# %% tags=["answer"]
factor = ...

# %% tags=["solution"]
factor = 10.0 * np.sqrt((1.0 + 0.1 * 0.04**2) / (1.0 + 0.1 * 0.4**2))

# %% tags=["check"]
grade(factor, 9.92168, digits=4, hint="the length of n_ij, for ten times the difference and for the difference")

# %% [markdown] tags=["exercise"]
# ## The first run
#
# **4.** ★ (1 point, derivation) Which velocity has the centre of mass of the first run at the end, if it starts with
# the mean velocity $(v_0, 0)$? Give the multiple of $v_0$, exactly.

# %% tags=["answer"]
share = ...

# %% tags=["solution"]
share = 1.0  # Algorithm 1 conserves momentum

# %% tags=["check"]
grade(share, 1.0, hint="add up the inputs of all agents")

# %% [markdown] tags=["exercise"]
# **5.** ★★★ (3 points, words) The notebook concludes from its first film that Algorithm 1 makes the agents flock.
# Which parts of a flock's definition does the run show, which not, and would a longer film help? Answer in your own
# words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Inside each component velocities come together, as the energy identity suggests, and distances come near d. But the
# group has four components at the start and three at the end of the film. A longer film does show more: the components
# happen to drift towards each other, meet, and form one component from $t = 7.12$ on. Nothing in Algorithm 1 guarantees
# that. A component that feels no other keeps its momentum, so whether two of them meet is decided by their starts; with
# other starts they part for ever.
#
# **Rubric, a point each:** velocities match and distances settle within components only; the group is not connected
# during the film; a longer run was made and joins, or it is said that the momentum of each component decides, and that
# the law guarantees neither outcome.

# %% [markdown] tags=["exercise"]
# ## The second run
#
# **6.** ★★ (2 points, derivation) In the second run the mean velocity $p_c$ obeys a linear equation. After what time is
# its distance from the velocity that the γ-agent reports a thousandth of what it was at the start? (Four significant
# digits.)

# %% tags=["answer"]
wait = ...

# %% tags=["solution"]
wait = np.log(1000.0) / 0.5  # d(p_c − p_r)/dt = −c2γ (p_c − p_r), as c1γ = 0

# %% tags=["check"]
grade(wait, 13.8155106, digits=4, hint="c1γ = 0: what is left of the equation of the centre?")

# %% [markdown] tags=["exercise"]
# **7.** ★★★ (3 points, words) The notebook says that the second run moves toward the common goal. What do the agents
# do instead? Say which number of the law is responsible, and why the energy falls all the same. Answer in your own
# words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# The agents take on the velocity (0.7, 0.1) which the γ-agent reports, and so move past the point (5, 5) and away from
# it for ever. Responsible is c1 gamma = 0: the position of the γ-agent does not occur in the law. The energy of the
# shape, without the pull, falls by the velocity consensus and by the velocity feedback, both of which need no pull;
# but then it does not bound the size of the group, which splits.
#
# **Rubric, a point each:** they follow the velocity and leave the place; c1γ = 0; the dissipation does not depend on
# c1γ, but without it the energy bounds no size.

# %% [markdown] tags=["exercise"]
# **8.** ★★ (2 points, derivation) Let $c_1^\gamma = c_2^\gamma = 0.5$ instead. At which $x$ does the centre of mass
# come to rest, exactly? (The γ-agent still stays at $(5, 5)$ and reports $(0.7, 0.1)$.)

# %% tags=["answer"]
rest = ...

# %% tags=["solution"]
rest = 5.0 + 0.5 / 0.5 * 0.7

# %% tags=["check"]
grade(rest, 5.7, hint="set velocity and acceleration of the centre to 0")

# %% [markdown] tags=["exercise"]
# **9.** ★★★ (3 points, design) Choose $[c_1^\gamma, c_2^\gamma]$, neither above 5, such that the second run, from its
# own start and with everything else as it is, ends as one component whose centre is at most 0.2 from $(5, 5)$ and whose
# speeds are all below 0.01, after its 15 time units.

# %% tags=["answer"]
mended = ...

# %% tags=["solution"]
mended = [5.0, 1.2]  # the centre rests (c2γ/c1γ)(0.7, 0.1) off: c2γ < 0.28 c1γ, and enough c2γ to come to rest in time
law = fl.Algorithm2(
    second.law.alpha, fl.Gains(c1_alpha=1.0, c2_alpha=1.0, c1_gamma=mended[0], c2_gamma=mended[1]), second.law.target
)
run = fl.simulate(law, second.q[0], second.p[0], (0.0, 15.0))
print(np.linalg.norm(run.q[-1].mean(axis=0) - 5.0), np.linalg.norm(run.p[-1], axis=1).max())

# %% tags=["check"]
grade(
    mended,
    lambda g: (
        len(g) == 2
        and max(g) <= 5.0
        and next(
            set(fl.components(35, fl.links(run.q[-1], 2.5))) == {0}
            and np.linalg.norm(run.q[-1].mean(axis=0) - 5.0) <= 0.2
            and np.linalg.norm(run.p[-1], axis=1).max() < 0.01
            for second in [fl.scenario("notebook-algorithm2")]
            for law in [
                fl.Algorithm2(
                    second.law.alpha,
                    fl.Gains(c1_alpha=1.0, c2_alpha=1.0, c1_gamma=g[0], c2_gamma=g[1]),
                    second.law.target,
                )
            ]
            for run in [fl.simulate(law, second.q0, second.p0, (0.0, 15.0))]
        )
    ),
    form="list",
    hint="where does the centre come to rest, and how fast? two conditions on two gains",
)
