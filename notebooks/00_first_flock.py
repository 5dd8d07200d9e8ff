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
# # A first flock in five minutes
#
# **Aims.** Run a published simulation of a flock, see how far its numbers can be trusted, ask a theorem about it,
# and read the answer.
#
# ## A scene
#
# Over Rome on a winter evening some thousand starlings turn as one. No bird leads, none sees them all; each watches
# a handful of neighbours. Engineers want the same of machines: three hundred drones that draw a picture in the night
# sky, a convoy of robots in a warehouse, a school of underwater gliders. Each machine has a radio of short range and
# a computer of its own. **How should one agent move, knowing only its neighbours, so that all together move as one
# and nobody collides?** And how would we know that it works: not in the ten simulations that we ran, but always?
#
# The course answers the first question with a law of 2006 that much of the field builds on, and the second with
# theorems, their proofs, and the errors in both. This first lecture runs the law once and asks one theorem about it.
# It needs no more than Newton's second law.
#
# ## Two agents on a line
#
# Start with the smallest flock there is. An agent is a *double integrator*: a point with position $q_i$ and velocity
# $p_i$ whose acceleration $u_i$ we choose,
#
# $$\dot q_i = p_i, \qquad \dot p_i = u_i .$$
#
# Let two agents stand on a line, 6.7 apart, and let each be told to keep 7 from the other. The law of this lecture
# pushes them apart, they overshoot, come back, and friction between them takes the energy out:

# %%
import numpy as np

import flockana as fl
from flockana import plots
from flockana.course import Prediction, figures, grade, is_own

times = np.linspace(0.0, 6.0, 400)
two = fl.simulate(fl.Algorithm1(), [[0.0], [6.7]], [[0.0], [0.0]], (0.0, 6.0), t_eval=times)
figure, axes = plots.subplots(1, 2, size=(10, 3.2))
axes[0].plot(two.t, two.q[:, :, 0], label=["agent 1", "agent 2"])
axes[0].set(xlabel="time", ylabel="position (length)")
axes[0].legend()
axes[1].plot(two.t, two.q[:, 1, 0] - two.q[:, 0, 0])
axes[1].axhline(7.0, color="black", linestyle=":")
_ = axes[1].set(xlabel="time", ylabel="distance of the two (length)")

# %% [markdown]
# **Figure 0.1.** Two agents that start at rest 6.7 apart. Left: they move by the same amount in opposite directions,
# so that their middle stays at 3.35. Right: the distance swings about 7 (dotted) and settles there.

# %% tags=["predict"]
guess = ...  # in lengths
Prediction(
    "And if they start 6 apart instead of 6.7: how far apart are they at t = 6?",
    guess,
    np.ptp(fl.simulate(fl.Algorithm1(), [[0.0], [6.0]], [[0.0], [0.0]], (0.0, 6.0)).q[-1]),
)

# %% [markdown]
# Three things are worth a look already. The *middle* does not move: what one agent gains the other loses. The
# distance *overshoots*: the law is a spring with a damper, and a control engineer will ask for its damping ratio
# (lecture 06). And the two keep 7 only because of their start. An agent sees no farther than a *range* $r$, here
# 8.4: from 9 apart they would not have moved at all. From 6 apart they push so hard that they leave each other's range
# and never return. Such failures are the subject of lecture 02.
#
# ## The law
#
# For any number of agents, Olfati-Saber (*IEEE Transactions on Automatic Control* 51(3), 2006) lets every agent do
# three things at once:
#
# $$\begin{gathered}
#   u_i = \underbrace{c_1^\alpha \sum_{j \in N_i} \phi_\alpha(\|q_j - q_i\|_\sigma)\, n_{ij}}_{\text{keep the
#   distance}}
#   + \underbrace{c_2^\alpha \sum_{j \in N_i} a_{ij}(q)\,(p_j - p_i)}_{\text{match velocities}} \\[1ex]
#   \underbrace{{} - c_1^\gamma (q_i - q_r) - c_2^\gamma (p_i - p_r)}_{\text{go where the group is to go}} .
# \end{gathered}$$
#
# Read it from the left, and let the details wait.
#
# - $N_i$ is the set of *neighbours* of agent $i$: all $j \ne i$ with $\|q_j - q_i\| < r$.
# - The first sum is a force along the line to each neighbour. Its size $\phi_\alpha$ is negative, a push, for pairs
#   nearer than $d = 7$; positive, a pull, for pairs between $d$ and $r$; and zero beyond. The vector
#   $n_{ij} = (q_j - q_i)/\sqrt{1 + \varepsilon\|q_j - q_i\|^2}$ points from $i$ to $j$.
# - The second sum draws the velocity of $i$ towards those of its neighbours. The weight $a_{ij}$ falls smoothly from
#   1 to 0 at the range.
# - The last two terms are a spring and a damper to a *γ-agent*, a virtual target with position $q_r$ and velocity
#   $p_r$ that all agents know. They are what tells a flock where to go.
#
# The four *gains* $c_1^\alpha, c_2^\alpha, c_1^\gamma, c_2^\gamma$ weigh the terms. The odd norm $\|\cdot\|_\sigma$
# and the functions $\phi_\alpha$ and $a_{ij}$ are built from scratch in lecture 01, the first two terms (Algorithm
# 1) are studied in lecture 02, all of it (Algorithm 2) in lecture 03.

# %%
figure, ax = plots.subplots(size=(6, 3.4))
_ = figures.target_pull(ax=ax)

# %% [markdown]
# **Figure 0.2.** A γ-agent (triangle) and its pull on five agents (dots). The pull is a spring: the farther away an
# agent is, the longer is its arrow. The cross is the centre of mass $q_c$ of the five.
#
# ## Run it
#
# The paper's own example has 150 agents that start at random, in many small groups around the origin, two hundred
# lengths behind a γ-agent that flies to the right. The library keeps it under a name:

# %%
case = fl.scenario("paper-flocking")
print(case.title)
print(case.source)
run = case.run()
print(f"{run.n} agents, from t = {run.t[0]:g} to {run.t[-1]:g}, {run.stats['steps']} steps")
figure, axes = plots.subplots(1, 2, size=(11, 5))
plots.snapshot(run, time=run.t[0], ax=axes[0])
_ = plots.snapshot(run, time=run.t[-1], ax=axes[1])

# %% [markdown]
# **Figure 0.3.** The flock at the start and at $t = 60$. A line joins neighbours; its colour says how far its length
# is from 7. From 95 pieces one net has formed, with a pattern of triangles, and it moves with the γ-agent.
#
# Watch it happen. The player below runs in the notebook; drag its slider, and look for the moment at which the last
# stray agents join (exercise 7).

# %%
run.player(height=520)

# %% [markdown]
# ## How far can the numbers be trusted?
#
# A simulation is a long sum of small steps, and each step makes an error. Which digits of the picture are true?
# Comparing two tolerances gives a hint; physics gives a better one. The law has an *energy* $H$, potential plus
# kinetic, whose rate of change $\dot H$ can be written down exactly (lectures 02 and 03). So the integrator carries
# $\int\dot H\,dt$ beside the state, and what is left of
#
# $$H(t) - H(0) - \int_0^t \dot H\,dt$$
#
# is the error that it made: for the true solution this is zero at all times.

# %%
energy, left = run.energy(), abs(run.energy_residual).max()
print(f"energy falls from {energy[0]:.6g} to {energy[-1]:.6g}")
print(f"the balance is off by {left:.1g} at most, that is {left / energy[0]:.0e} of the energy at the start")

# %% tags=["facts"]
assert left / energy[0] < 1e-7
assert len(set(fl.components(150, fl.links(run.q[0], 8.4)))) == 95
assert set(fl.components(150, fl.links(run.q[-1], 8.4))) == {0}
assert abs(two.q[:, :, 0].sum(axis=1) - 6.7).max() < 1e-9
assert abs(np.diff(two.q[-1, :, 0])[0] - 7.0) < 0.05
thrown = fl.simulate(fl.Algorithm1(), [[0.0], [6.0]], [[0.0], [0.0]], (0.0, 6.0))
assert np.diff(thrown.q[-1, :, 0])[0] > 8.4
assert np.diff(two.q[:, :, 0]).max() > 7.05  # it overshoots

# %% [markdown]
# A small residual does not prove that the solution is right: an error that keeps the energy would not show. But a
# large one proves that it is wrong, and it costs nothing to look. Make it a habit.
#
# ## Ask a theorem
#
# Olfati-Saber's Theorem 3 promises four things of this law, if $c_1^\gamma$ and $c_2^\gamma$ are positive: the group
# stays within a bounded distance of its centre (*cohesion*); it tends to a local minimum of an energy; all
# velocities become equal; and few pairs collide. Does this run keep the promise? The library knows the theorem by
# the name `os-3`:

# %%
verdict = fl.verify("os-3", run)
print(verdict.status)
for claim in verdict.claims:
    print(f"{claim.name:>11}: {claim.status}")

# %% [markdown]
# One word for the whole, and one for each claim. They mean:
#
# | word | meaning |
# |---|---|
# | verified | the hypotheses are met, and the claim holds in this run, with all rounding errors accounted for |
# | refuted | the hypotheses are met, and the claim is certainly false in this run |
# | vacuous | a hypothesis of the claim is not met: the theorem says nothing about this run |
# | inconclusive | the run is too short or too coarse to decide |
#
# A theorem is a contract: *if* these hypotheses, *then* these claims. So a verdict looks at hypotheses first. Two
# claims on collisions read *vacuous* here: they need an initial energy below a bound $c^*$, and 150 agents at random
# places have far more. That no two agents met in this run is true, and it is not the theorem that says so.
# `print(verdict)` shows hypotheses and numbers in full.
#
# ## What surprised, and what the verdict does not say
#
# - **One name, four claims, two kinds of answer.** A theorem is rarely true or false of a run as a whole. Ask claim
#   by claim.
# - **A limit was verified from a finite run.** "Velocities become equal" speaks of $t \to \infty$, and we stopped
#   at 60. The library does not extrapolate a curve: it certifies that the state at the end lies near a strict
#   minimum of the energy, which the solution cannot leave. Lecture 13 shows how.
# - **Nothing is said about other starts.** The verdict is about this run. How often flocking succeeds from random
#   starts is a question for statistics (lecture 10); that it always does would be a question for a proof, and part
#   of the printed theorem turns out to be false (lecture 07).
# - **Nothing is said about real birds or drones.** Delay, noise, limits of thrust and lost messages are not in the
#   law.
#
# ## Summary
#
# - A flock here is a set of double integrators; each keeps a distance from its neighbours, matches their velocities,
#   and follows a γ-agent.
# - A run carries its own error: what is left of the energy balance.
# - A theorem is asked about a run by name. Hypotheses come first, and a claim whose hypothesis fails is vacuous,
#   which is neither true nor false.

# %% [markdown] tags=["exercise"]
# ## Exercises
#
# **1.** ★ (1 point, reading) Run the scenario `collapse` and ask erratum E11 about it. What is the status of the
# verdict?

# %% tags=["answer"]
collapse_status = ...

# %% tags=["solution"]
collapse = fl.scenario("collapse").run()
collapse_status = fl.verify("E11", collapse).status
_ = plots.snapshot(collapse)

# %% tags=["check"]
grade(collapse_status, "refuted", hint="fl.verify(name, run).status, one word")

# %% [markdown] tags=["exercise"]
# **2.** ★★ (2 points, program) Theorem 1 (`os-1`) assumes a flock that stays one. A run of `paper-fragmentation`
# breaks that at $t = 0$ already: its relative connectivity $C = (n - \text{number of components})/(n-1)$ is 0.13
# there. (The verdict names the instant at which $C$ is least, not the first at which it is below 1.) Write a
# function `connectivity(q, r)` that computes $C$ from positions of shape (n, 2), $n \ge 2$, without the library. A
# component is a largest set of agents that are linked by paths; two agents are linked if they are nearer than $r$.

# %% tags=["answer"]
connectivity = ...


# %% tags=["solution"]
def by_labels(q, r):
    q = np.asarray(q, dtype=float)
    linked = np.linalg.norm(q[:, None] - q, axis=2) < r
    label = np.arange(len(q))
    for _ in q:  # every agent takes the least label in its neighbourhood, until labels fill the components
        label = np.where(linked, label, len(q)).min(axis=1)
    return (len(q) - len(set(label.tolist()))) / (len(q) - 1)


connectivity = by_labels
fragments = fl.scenario("paper-fragmentation").run()
print(fl.verify("os-1", fragments))
print(connectivity(fragments.q[0], fragments.law.alpha.r), float(fragments.metrics().connectivity[0]))

# %% tags=["check"]
grade(
    connectivity,
    lambda f: (
        is_own(f)
        and np.allclose(
            [f(np.array([[0.0, 0.0], [3.0, 4.0], [x, 0.0], [x + 4.0, 0.0], [9.0, 9.0]]), 5.0) for x in (2.0, 4.0, 7.0)]
            + [f(np.array([[2.0 * k, 0.0] for k in (0, 3, 1, 4, 2, 5)]), 2.5)],
            [0.75, 0.75, 0.25, 1.0],
            atol=1e-12,
        )
    ),
    form="function",
    hint="try three agents in a row by hand, of which the outer two are out of range; and two exactly r apart",
)

# %% [markdown] tags=["exercise"]
# **3.** ★ (1 point, experiment) scipy would have integrated with `rtol=1e-3` and `atol=1e-6`, had we not asked for
# better. Start seven agents at rest in a hexagon that is 1.1 times too large,
# `1.1 * fl.lattice.hexagonal_patch(1, 7.0)`, under `fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))`, for 10 time
# units. What is the largest energy residual at those tolerances, to two significant digits? (Compare it with the one
# at the library's own tolerances.)

# %% tags=["answer"]
residual = ...

# %% tags=["solution"]
law = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
hexagon = 1.1 * fl.lattice.hexagonal_patch(1, 7.0)
loose = fl.simulate(law, hexagon, 0.0 * hexagon, (0.0, 10.0), rtol=1e-3, atol=1e-6)
tight = fl.simulate(law, hexagon, 0.0 * hexagon, (0.0, 10.0))
residual = abs(loose.energy_residual).max()
print(f"{residual:.3g}, and {abs(tight.energy_residual).max():.3g} at the library's tolerances")

# %% tags=["check"]
grade(residual, 0.0033461, digits=2, hint="fl.simulate takes rtol and atol; the residual has two signs")

# %% [markdown] tags=["exercise"]
# **4.** ★★ (2 points, derivation) One agent without neighbours is at $(3, 0)$ with the velocity $(0, 2)$; the
# γ-agent rests at the origin, $c_1^\gamma = 1$, $c_2^\gamma = 2$. (a) Which vector is $u$? (b) How large is $\|u\|$?
# (c) At which rate does its kinetic energy $\tfrac12\|p\|^2$ change at this instant? Give the list
# $[u_x, u_y, \|u\|, \text{rate}]$, exactly.

# %% tags=["answer"]
push = ...

# %% tags=["solution"]
push = [-3.0, -4.0, 5.0, -8.0]  # the rate is ⟨p, u⟩ = 2 · (−4)

# %% tags=["check"]
grade(push, [-3.0, -4.0, 5.0, -8.0], hint="write down both components of u; differentiate ½‖p‖² by the chain rule")

# %% [markdown] tags=["exercise"]
# **5.** ★★ (2 points, counterexample) Counterexample hunt: is $d$ the only distance at which two agents exert no
# force on each other? Give positions of two agents in the plane, an array of shape (2, 2), that are not 7 apart and
# feel no force under Algorithm 1 with $d = 7$, $r = 8.4$.

# %% tags=["answer"]
pair = ...

# %% tags=["solution"]
pair = [[0.0, 0.0], [9.0, 0.0]]  # out of range; two agents in one place would do as well, as n_ij = 0

# %% tags=["check"]
grade(
    pair,
    lambda x: np.shape(x) == (2, 2) and (np.linalg.norm(np.subtract(*x)) >= 8.4 or np.array_equal(*x)),
    form="list",
    hint="look at what the sum runs over",
)

# %% [markdown] tags=["exercise"]
# **6.** ★★ (2 points, words) A verdict of a theorem about a run reads *vacuous*. One student says: the theorem is
# false for this law. Another says: the theorem holds for this run. What is wrong with each, and what has been
# learnt? Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# The theorem is an implication, and its hypothesis does not hold in this run. So the run says nothing against the
# theorem and nothing for it: the conclusion may hold or fail here. What has been learnt is that this theorem cannot
# be used to predict this run, and which hypothesis keeps it from that.
#
# **Rubric, a point each:** an implication whose hypothesis fails is neither refuted nor confirmed; what is learnt is
# which hypothesis fails, or that another theorem is needed.

# %% [markdown] tags=["exercise"]
# **7.** ★★ (2 points, player) Drag the slider of the player above. At which time does the flock become one net, to
# stay so? Give it to within 1 time unit. (`run.metrics().connectivity` holds $C$ at every sample, if you want to
# check by the numbers.)

# %% tags=["answer"]
joined = ...

# %% tags=["solution"]
apart = np.flatnonzero(run.metrics().connectivity.values < 1.0)
joined = float(run.t[apart[-1] + 1])
print(joined)

# %% tags=["check"]
grade(joined, 2.2795, within=1.0, hint="the player shows the number of components; wait until it stays at 1")

# %% [markdown] tags=["exercise"]
# **8.** ★★ (2 points, proof) Prove that the mean position of two agents under Algorithm 1, that is without a
# γ-agent, moves at constant velocity, whatever $\phi_\alpha$ is; and say which property of $n_{ij}$ and of $a_{ij}$
# your proof uses, so that it holds for $n$ agents too.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Add up the inputs: $u_1 + u_2 = c_1^\alpha\phi_\alpha(\|q_2-q_1\|_\sigma)(n_{12} + n_{21}) +
# c_2^\alpha(a_{12}(p_2-p_1) + a_{21}(p_1-p_2))$. The norm does not change if the agents are exchanged,
# $n_{21} = -n_{12}$ and $a_{21} = a_{12}$, so both brackets vanish and $\tfrac{d}{dt}\tfrac12(p_1+p_2) = 0$. For $n$
# agents the sum over all $i$ and $j \in N_i$ holds each pair twice, once in each order, because $j \in N_i$ exactly
# if $i \in N_j$; each pair cancels in the same way.
#
# **Rubric, a point each:** the sum of both inputs is computed and vanishes; $n_{ij}$ is odd and $a_{ij}$ even under
# exchange, and neighbourhood is mutual.
