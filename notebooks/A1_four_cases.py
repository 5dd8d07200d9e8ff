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
# # Assignment: the four cases of a course project
#
# **Aims.** Do a project that a course sets, from simulation to conclusion; tell what the law does from what a
# simulation adds; replace guesses about a figure by a transfer function.
#
# The project (`fl.cite(fl.scenario("msn-case1"))`) lets 100 agents in the plane flock under Olfati-Saber's algorithms,
# with $d = 15$, $r = 18$, $\varepsilon = 0.1$, $h = 0.1$, $a = b = 3$, from rest, for 4.851 time units. Its γ-agent
# moves by iterations of 0.009 time units, and the velocity that it hands over is per iteration: $p_r = 0.009\,\dot
# q_r$.
#
# | case | scenario | law | γ-agent | points |
# |---|---|---|---|---|
# | 1 | `msn-case1` | Algorithm 1 | none | 6 |
# | 2 | `msn-case2` | Algorithm 2 | at rest at $(150, 150)$ | 5 |
# | 3 | `msn-case3` | Algorithm 2 | a sine of amplitude 100 | 4 |
# | 4 | `msn-case4` | Algorithm 2 | a circle of radius 100 about $(50, 50)$ | 10 |
#
# Case 1 has $c_1^\alpha = 50$, $c_2^\alpha = 2\sqrt{50}$; case 2 $c_1^\alpha = c_2^\alpha = c_1^\gamma = 1$ and no
# damping, $c_2^\gamma = 0$; cases 3 and 4 $c_1^\alpha = 100$, $c_2^\alpha = 20$, $c_1^\gamma = 70$, $c_2^\gamma =
# 2\sqrt{70}$.
#
# Sine and circle have the same frequency, $2\pi\cdot 0.025/5$ per iteration.
#
# ## How it is marked
#
# 25 points, those of the questions. Numbers are graded to the precision asked for. Sentences are read, each by a rubric
# with one part for each point: a part counts if it is there, is right, and is supported by a figure or a formula of
# yours. A figure supports a sentence if its axes say what they show, and in which unit. Work together on the
# simulations; write the sentences alone.

# %%
import numpy as np

import flockana as fl
from flockana import plots
from flockana.course import grade, shows

# %% [markdown] tags=["exercise"]
# ## Case 1: Algorithm 1
#
# **1.** ★★★ (3 points, program) For each of the four cases the project asks for the first and last snapshot, all
# trajectories, the speeds, the connectivity and the path of the centre of mass, each over its time or place. Write a
# function `figures(run)` that draws these on at least six axes, labels both axes of each, returns the axes as a list or
# an array, and look at all four cases with it.

# %% tags=["answer"]
figures = ...


# %% tags=["solution"]
def six_figures(run):
    axes = plots.subplots(2, 3, size=(13, 7.4))[1]
    plots.snapshot(run, time=run.t[0], ax=axes[0, 0], bar=False)
    plots.snapshot(run, ax=axes[0, 1], bar=False)
    plots.trajectories(run, ax=axes[0, 2])
    plots.speeds(run, ax=axes[1, 0])
    plots.measure(run, "connectivity", ax=axes[1, 1])
    plots.centre_path(run, ax=axes[1, 2])
    return axes


figures = six_figures
runs = {case: fl.scenario(f"msn-case{case}").run() for case in (1, 2, 3, 4)}
for run in runs.values():
    figures(run)

# %% tags=["check"]
grade(
    figures,
    lambda f: all(
        shows(
            np.ravel(f(run)),
            (
                run.q[0],
                run.q[-1],
                [*run.q[0], *run.q[-1]],
                [[run.t[k], np.hypot(*run.p[k, 1])] for k in (0, -1)],
                [[run.t[k], run.metrics().connectivity.values[k]] for k in (0, -1)],
                [run.q[k].mean(axis=0) for k in (0, -1)],
            ),
        )
        for run in [fl.simulate(fl.Algorithm1(), [[0, 0], [6, 0], [3, 5]], [[0, 0], [0, 1], [1, 0]], (0, 1))]
    ),
    form="function",
    hint="six axes, both labelled: each of the six quantities is looked for, at its first and last instant",
)

# %% [markdown] tags=["exercise"]
# **2.** ★ (1 point, derivation) All agents start at rest. How far does the centre of mass move in case 1, exactly?

# %% tags=["answer"]
drift = ...

# %% tags=["solution"]
drift = 0.0  # every pair acts equally and oppositely, so Σp stays 0

# %% tags=["check"]
grade(drift, 0.0, hint="add up the inputs of all agents")

# %% [markdown] tags=["exercise"]
# **3.** ★★ (2 points, words) The group falls apart, and speeds differ widely between agents. Which theorem on
# Algorithm 1 does that contradict, if any, and which of its hypotheses fails? Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# None. Theorem 1 assumes that every solution which starts in a level set of H stays a cohesive flock. This start is
# connected, $C = 1$ at $t = 0$, but it does not stay so: $C = 0.29$ at the end. One solution that starts in the level
# set and is no flock breaks the hypothesis, and the theorem is vacuous. The energy still falls, as the energy identity
# says, and agents out of range of all others keep their velocities.
#
# **Rubric, a point each:** no contradiction: the hypothesis of a cohesive flock fails; the energy falls all the same,
# and agents without neighbours keep their velocity.

# %% [markdown] tags=["exercise"]
# ## Case 2: a target at rest, no damping
#
# **4.** ★ (1 point, derivation) With which period does the centre of mass swing in case 2? (Four significant digits.)

# %% tags=["answer"]
period = ...

# %% tags=["solution"]
period = 2.0 * np.pi  # ω_n = √c1γ = 1

# %% tags=["check"]
grade(period, 6.28318531, digits=4, hint="the centre obeys a linear equation of second order without damping")

# %% [markdown] tags=["exercise"]
# **5.** ★ (1 point, derivation) Suppose the centre of mass starts at $(25, 25)$. Which $x$ does it reach on the other
# side, exactly? (The project reads 300 from its figure, for $(25, 25)$.)

# %% tags=["answer"]
far_side = ...

# %% tags=["solution"]
far_side = 150.0 + (150.0 - 25.0)

# %% tags=["check"]
grade(far_side, 275.0, hint="the swing is symmetric about the target")

# %% [markdown] tags=["exercise"]
# **6.** ★★★ (3 points, words) In case 2 the connectivity is 1 throughout. Does the group flock? Name the hypothesis
# of Theorem 3 that fails, say what is true of the shape nevertheless and why, and what is true of the centre. Answer
# in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# Theorem 3 needs c2 gamma > 0, which fails, so the theorem says nothing here. The centre of mass is an oscillator
# without damping and swings through the target for ever, so the target is not reached. The shape still loses energy
# by the velocity consensus between neighbours, because the energy of the shape does not contain the motion of the
# centre; so relative velocities shrink while the common velocity swings.
#
# **Rubric, a point each:** c2γ > 0 fails, so Theorem 3 is vacuous; the shape dissipates by the consensus term; the
# centre swings without damping.

# %% [markdown] tags=["exercise"]
# ## Case 3: a sine
#
# **7.** ★★ (2 points, derivation) From the linear equation of the centre of mass with $p_r = k_v\,\dot q_r$, $k_v =
# 0.009$: by which factor is the amplitude of the flock's sine smaller than the γ-agent's, in the long run? (Four
# significant digits.)

# %% tags=["answer"]
sine_ratio = ...

# %% tags=["solution"]
omega = 2.0 * np.pi * 0.025 / 5.0 / 0.009


def ratio(omega, c1, c2, k_v=0.009):
    return abs(c1 + 1j * omega * k_v * c2) / abs(c1 - omega**2 + 1j * omega * c2)


sine_ratio = ratio(omega, 70.0, 2.0 * np.sqrt(70.0))

# %% tags=["check"]
grade(
    sine_ratio,
    0.851764095,
    digits=4,
    hint="the transfer function from q_r to q_c at s = iω; ω per time unit, not per iteration",
)

# %% [markdown] tags=["exercise"]
# **8.** ★★ (2 points, words) The project writes that the smaller sine is probably due to the velocity of the γ-agent,
# whose $y$ component reverses instantaneously. Is that so? Give a reason, and the cause. Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# It is not so: the velocity of a sine is a cosine, which changes continuously, and the response of the centre to it
# is a sine of the same frequency. Its amplitude is the modulus of the transfer function. The cause is that the
# γ-agent hands over only 0.009 of its velocity, so that the centre is braked towards a velocity near zero; with the
# true velocity the ratio would be above one.
#
# **Rubric, a point each:** the velocity of a sine does not jump; the velocity handed over is 0.009 of the true one,
# which sets the ratio.

# %% [markdown] tags=["exercise"]
# ## Case 4: a circle
#
# **9.** ★★ (2 points, experiment) Measure the ratio of the radii in case 4 with $p_r = \dot q_r$ handed over in the
# place of $0.009\,\dot q_r$, everything else equal: simulate `msn-case4` with the target
# `fl.scenario("msn-case4").law.target.target`. (Three significant digits; is the circle of the flock larger or
# smaller?)

# %% tags=["answer"]
true_ratio = ...

# %% tags=["solution"]
from flockana.stability.tracking import response_ratio

case4 = fl.scenario("msn-case4").run()
law = fl.Algorithm2(case4.law.alpha, case4.law.gains, case4.law.target.target)
true_ratio = response_ratio(fl.simulate(law, case4.q[0], case4.p[0], case4.t[[0, -1]]))[0]
print(f"{true_ratio:.4f}; predicted {ratio(omega, 70.0, 2.0 * np.sqrt(70.0), 1.0):.4f}")

# %% tags=["check"]
grade(
    true_ratio,
    1.10931368,
    digits=3,
    hint="flockana.stability.tracking.response_ratio(run)[0], or fit a circle to the end of the centre's path",
)

# %% [markdown] tags=["exercise"]
# **10.** ★★ (2 points, design) Keep $c_1^\gamma = 70$ and $k_v = 0.009$. Which $c_2^\gamma$ makes the two circles
# equally large? (Four significant digits.)

# %% tags=["answer"]
equal_circles = ...

# %% tags=["solution"]
equal_circles = np.sqrt((70.0**2 - (70.0 - omega**2) ** 2) / (omega**2 * (1.0 - 0.009**2)))
print(ratio(omega, 70.0, equal_circles))

# %% tags=["check"]
grade(equal_circles, 11.306, digits=4, hint="set the squared modulus of numerator and denominator equal")

# %% [markdown] tags=["exercise"]
# **11.** ★★★ (3 points, counterexample) The project: the faster the γ-agent runs round its circle, the smaller the
# circle of the flock. Refute it for this law with $k_v = 0.009$: give gains and two angular velocities, the list
# $[c_1^\gamma, c_2^\gamma, \omega_1, \omega_2]$, all positive and $\omega_1 < \omega_2$, for which the flock's circle
# at $\omega_2$ is at least twice as large as at $\omega_1$.

# %% tags=["answer"]
faster_and_larger = ...

# %% tags=["solution"]
faster_and_larger = [70.0, 1.0, 1.0, np.sqrt(70.0)]  # little damping: resonance at √c1γ

# %% tags=["check"]
grade(
    faster_and_larger,
    lambda g: (
        len(g) == 4
        and min(g) > 0.0
        and g[2] < g[3]
        and abs(g[0] + 0.009j * g[3] * g[1]) / abs(g[0] - g[3] ** 2 + 1j * g[3] * g[1])
        >= 2.0 * abs(g[0] + 0.009j * g[2] * g[1]) / abs(g[0] - g[2] ** 2 + 1j * g[2] * g[1])
    ),
    form="list",
    hint="when does a damped oscillator answer most strongly?",
)

# %% [markdown] tags=["exercise"]
# **12.** ★★★ (3 points, words) Write the conclusion on case 4 that the project should have written: which of its
# three explanations (the start inside the circle, the speed, the velocity handed over) holds, how each was tested,
# and what a user of Algorithm 2 should take from it. Answer in your own words.

# %% [markdown] tags=["answer"]
# *Your answer:*

# %% [markdown] tags=["solution"]
# The start does not matter in the long run, because its part of the solution decays with the poles of the centre of
# mass; a start outside gives the same circle. The speed matters only through the transfer function, and with little
# damping a faster target gives a larger circle, so the rule of the project is false. The velocity handed over
# decides: with the true velocity the measured ratio is above one, with 0.009 of it 0.85, as predicted. A user must
# hand over the velocity in the units of the law.
#
# **Rubric, a point each:** the start is excluded by the decay of the homogeneous part; speed is excluded as a rule by
# the transfer function; the velocity handed over is the cause, tested by prediction and measurement.
